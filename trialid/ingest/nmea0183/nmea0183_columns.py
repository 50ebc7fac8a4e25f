"""Stretches of a block of sentences as texts and as numbers."""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.nmea0183.nmea0183_sentences import Bytes, Mask, Places, Span

LONGEST_NUMBER = 24
EXACT_DIGITS = 15
"""Decimal digits a float holds, and any quotient of two such is rounded once only."""


def table(data: Bytes, span: Span, width: int) -> Bytes:
    """The stretches as rows of equal width, zeros behind; (N, width)."""
    if not width or not len(span.a):
        return np.zeros((len(span.a), width), np.uint8)
    if int(span.a.max()) + width > len(data):
        data = np.concatenate([data, np.zeros(width, np.uint8)])
    cells = np.lib.stride_tricks.sliding_window_view(data, width)[span.a]
    length = span.b - span.a
    if length.min() < width:
        cells[np.arange(width) >= length[:, None]] = 0
    return cells


def alike(cells: Bytes) -> Iterator[tuple[Places, bytes]]:
    """Rows of a table grouped by their content: row numbers and content; meant for few groups."""
    rows = np.arange(len(cells))
    if not cells.size:
        yield rows, b"\0" * cells.shape[1]
        return
    padded = np.zeros((len(cells), -(-cells.shape[1] // 8) * 8), np.uint8)
    padded[:, : cells.shape[1]] = cells
    words = padded.view(np.uint64)
    for _ in range(64):
        same = words[:, 0] == words[0, 0]
        for column in range(1, words.shape[1]):
            same &= words[:, column] == words[0, column]
        yield rows[same], cells[0].tobytes()
        if same.all():
            return
        rows, cells, words = rows[~same], cells[~same], words[~same]
    groups: dict[bytes, list[int]] = {}
    for row, content in zip(rows.tolist(), cells, strict=True):
        groups.setdefault(content.tobytes(), []).append(row)
    for key, members in groups.items():
        yield np.array(members), key


def texts(data: Bytes, span: Span) -> Iterator[tuple[Places, str]]:
    """Stretches of at most 64 bytes grouped by what they say: row numbers and text."""
    width = int(min((span.b - span.a).max(initial=0), 64))
    for rows, content in alike(table(data, span, width)):
        yield rows, content.rstrip(b"\0").decode("ascii", "replace").strip()


def numbers(data: Bytes, span: Span) -> tuple[NDArray[np.float64], Mask]:
    """Decimal numbers, NaN where there is none, and where what stands there is no number; (N,).

    A number is a sign or none, digits with at most one point among them, and nothing else but
    spaces around: `-4.-3` is no number, nor is `1e5`.
    """
    a, b = _stripped(data, span)
    length = b - a
    y = np.full(len(a), np.nan)
    bad = length > LONGEST_NUMBER
    given = np.flatnonzero((length > 0) & ~bad)
    if not len(given):
        return y, bad
    part = Span(a[given], b[given])
    cells = table(data, part, int(length[given].max()))
    digit = (cells >= 48) & (cells <= 57)
    point = cells == 46
    sign = (cells[:, 0] == 45) | (cells[:, 0] == 43)
    digits = digit.sum(axis=1)
    sound = (digits + point.sum(axis=1) + sign == length[given]) & (point.sum(axis=1) <= 1)
    sound &= digits > 0
    y[given] = np.where(sound, _values(cells, digit, point), np.nan)
    bad[given] = ~sound
    for row in given[sound & (digits > EXACT_DIGITS)]:
        y[row] = float(data[a[row] : b[row]].tobytes())
    return y, bad


def _stripped(data: Bytes, span: Span) -> tuple[Places, Places]:
    a, b = span.a.copy(), span.b.copy()
    for _ in range(LONGEST_NUMBER):
        more = (a < b) & (data[np.minimum(a, len(data) - 1)] == 32)
        if not more.any():
            break
        a[more] += 1
    for _ in range(LONGEST_NUMBER):
        more = (a < b) & (data[b - 1] == 32)
        if not more.any():
            break
        b[more] -= 1
    return a, b


def _values(cells: Bytes, digit: Mask, point: Mask) -> NDArray[np.float64]:
    """Value of each row by its digits; right where there are no more than 15 of them."""
    whole = np.zeros(len(cells), np.float64)
    decimals = np.zeros(len(cells), np.intp)
    behind = np.zeros(len(cells), np.bool_)
    for column in range(cells.shape[1]):
        here = digit[:, column]
        whole = np.where(here, whole * 10 + (cells[:, column].astype(np.float64) - 48), whole)
        decimals += here & behind
        behind |= point[:, column]
    values = whole / np.power(10.0, decimals)
    return np.where(cells[:, 0] == 45, -values, values)
