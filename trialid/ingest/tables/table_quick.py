"""Columns of a text by pandas, block by block, where nothing about it is odd.

Only the columns that somebody wants are kept, each once: a log of a gigabyte takes no more memory
than its numbers.
"""

import io
import itertools
from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.bytes.encoded_text import OddTextError
from trialid.ingest.bytes.growing import Growing
from trialid.ingest.tables.clock import table_stamps
from trialid.ingest.tables.table import MISSING, Values, reader_of_numbers
from trialid.ingest.tables.table_layout import SPACES, Layout, Top, count_bytes, decimal

if TYPE_CHECKING:
    import pandas as pd

    Series = pd.Series[Any]

EXACT_SINCE = (3, 1)
"""Version of pandas from which every number is read to the last bit without being asked to."""
Blocks = Callable[[], Iterable[tuple[bytes, int]]]
"""Text below the header in blocks of whole lines, each time from the beginning: it, its lines."""


@dataclass(frozen=True)
class Quick:
    """Columns (N,), NaN throughout where nobody wants them, and the decimal mark of the text.

    `utc` is True where stamps are instants of UTC and no local time.
    """

    columns: tuple[Values, ...]
    mark: str
    utc: bool


def columns(blocks: Blocks, top: Top, layout: Layout, needed: Collection[int]) -> Quick | None:
    """The columns of the blocks below `top`; None when anything is odd."""
    if len(top.heads) < 2 and layout.separator != SPACES:
        return None
    try:
        return _with_mark(blocks, top, layout, needed, layout.decimal)
    except OddTextError:
        return None


def _with_mark(
    blocks: Blocks, top: Top, layout: Layout, needed: Collection[int], mark: str | None
) -> Quick | None:
    """The columns with this decimal mark, None: as the text shows, wherever it does.

    Raises OddTextError when anything is odd.
    """
    held = {i: _Column(layout.form, i in layout.dated) for i in sorted(needed)}
    rows = 0
    for text, lines in blocks():
        shown = decimal(text, layout)
        if layout.decimal is None and mark == "." and shown == ",":
            return _with_mark(blocks, top, layout, needed, ",")
        mark = mark or shown
        frame = _frame(text, lines, top, layout, _used(layout, needed, mark, len(top.heads)), mark)
        for i, column in held.items():
            column.add(frame[i])
        rows += lines
    if not rows:
        raise OddTextError
    aware = {column.aware for column in held.values() if column.kind == "M"}
    if len(aware) > 1:
        raise OddTextError
    nobody = np.broadcast_to(np.float64(np.nan), rows)
    found = tuple(held[i].values() if i in held else nobody for i in range(len(top.heads)))
    return Quick(found, mark or ".", aware == {True})


def _used(layout: Layout, needed: Collection[int], mark: str, width: int) -> list[int]:
    """Columns to read: those needed, the first and the last, which show rows that are odd.

    All of them where blanks part them, or where commas were taken for decimal marks.
    """
    if layout.separator == SPACES or (layout.decimal is None and mark == ","):
        return list(range(width))
    return sorted({*needed, 0, width - 1})


def _frame(
    text: bytes, lines: int, top: Top, layout: Layout, used: list[int], mark: str
) -> "pd.DataFrame":
    """The block's columns; OddTextError where a row may be cut, too long, or hold nothing."""
    width = len(top.heads)
    comment = (layout.comment or "").encode()
    if any(one in text for one in (b'"', b"\x00", *([comment] if comment else []))):
        raise OddTextError
    spaced = layout.separator == SPACES
    separator = layout.separator.encode()
    if not spaced and count_bytes(text, separator) != lines * (width - 1):
        raise OddTextError
    frame = _read(text, layout, None if len(used) == width else used, mark)
    if frame is None or frame.shape != (lines, len(used)):
        raise OddTextError
    frame.columns = used
    if frame[width - 1].isna().any() and (spaced or not _even(text, separator, lines)):
        raise OddTextError  # a short row ends like an empty field
    if not spaced and frame[0].isna().any() and _blank(text, separator * (width - 1)):
        raise OddTextError
    if layout.decimal is None and mark == "," and not _clear(frame):
        raise OddTextError
    return frame


def _even(text: bytes, separator: bytes, lines: int) -> bool:
    """Whether every line has as many separators as every other."""
    whole = np.frombuffer(text, np.uint8)
    ends = np.flatnonzero(whole == ord("\n"))
    marks = np.flatnonzero(whole == separator[0]).reshape(lines, -1)
    within = ends[: lines - 1]
    return bool((marks[1:, 0] > within).all() and (marks[:-1, -1] < within).all())


def _blank(text: bytes, separators: bytes) -> bool:
    """Whether a line holds separators alone."""
    ends = (b"\n" + separators + end for end in (b"\n", b"\r"))
    first = text.startswith((separators + b"\n", separators + b"\r"))
    return first or text.endswith(b"\n" + separators) or any(one in text for one in ends)


def _read(text: bytes, layout: Layout, used: list[int] | None, mark: str) -> "pd.DataFrame | None":
    import pandas as pd

    version = tuple(int(part) for part in pd.__version__.split(".")[:2])
    options: dict[str, Any] = {
        "header": None,
        "sep": r"\s+" if layout.separator == SPACES else layout.separator,
        "decimal": mark,
        "thousands": layout.thousands,
        "dtype": dict.fromkeys(layout.texts, "str"),
        "keep_default_na": False,
        "na_values": sorted(layout.missing | _MISSING),
        "encoding_errors": "replace",
        "usecols": used,
        "low_memory": False,
        **({} if version >= EXACT_SINCE else {"float_precision": "round_trip"}),
    }
    try:
        return pd.read_csv(io.BytesIO(text), **options)
    except (ValueError, OverflowError):  # a ParserError is a ValueError
        return None


def _every_case(word: str) -> set[str]:
    pairs = [sorted({letter.lower(), letter.upper()}) for letter in word]
    return {"".join(letters) for letters in itertools.product(*pairs)}


_MISSING = frozenset().union(*(_every_case(word) for word in MISSING))


class _Column:
    """A column as it is gathered: numbers, stamps where it tells the time, or texts.

    Raises OddTextError where some blocks hold numbers and others texts.
    """

    def __init__(self, form: str | None, timed: bool) -> None:
        self.form = form
        self.timed = timed
        self.kind = ""
        self.aware = False
        self._rows = 0
        self._numbers = Growing(np.float64)
        self._stamps = Growing(np.int64)
        self._texts: list[NDArray[Any]] = []

    def add(self, column: "Series") -> None:
        """The next rows."""
        empty = bool(column.isna().all())
        kind = "f" if column.dtype.kind in "fiu" else "O"
        if empty and self.kind:
            kind = self.kind
        elif kind == "O" and self.timed and self.kind in ("", "M"):
            kind = "M" if self._is_stamps(column) else "O"
        if self.kind == "f" and kind == "O" and np.isnan(self._numbers.so_far()).all():
            self._texts, self.kind = [np.full(self._rows, None, object)], "O"
        if kind != (self.kind or kind):
            raise OddTextError
        self.kind = kind
        self._rows += len(column)
        self._keep(column)

    def _keep(self, column: "Series") -> None:
        if self.kind == "f":
            self._numbers.add(column.to_numpy(np.float64))
        elif self.kind == "O":
            self._texts.append(_objects(column))
        elif column.isna().any():
            raise OddTextError

    def _is_stamps(self, column: "Series") -> bool:
        """Whether all texts are dates written alike; they are kept then."""
        gaps = bool(column.isna().any())
        found = None if gaps else table_stamps.stamps_of_block(column.tolist(), self.form)
        if found is None or (self.kind and found[1] != self.aware):
            return False
        self.aware = found[1]
        self._stamps.add(found[0])
        return True

    def values(self) -> Values:
        """All rows; nothing can be added any more. (N,)."""
        if self.kind == "M":
            return self._stamps.array().view("datetime64[ns]")
        return np.concatenate(self._texts) if self.kind == "O" else self._numbers.array()


def _objects(column: "Series") -> NDArray[Any]:
    """Texts, each kept once, and None where there is none."""
    import pandas as pd

    plain = column.astype(str) if column.dtype.kind == "b" else column
    codes, different = pd.factorize(plain)
    return np.array([*map(str, different.tolist()), None], dtype=object)[codes]


def _clear(frame: "pd.DataFrame") -> bool:
    """True unless a text among numbers with a comma is a number with a point."""
    point = reader_of_numbers(".", None, frozenset())
    texts = (frame[i].dropna().unique() for i in frame if frame[i].dtype.kind == "O")
    return not any("." in text and is_number(text, point) for one in texts for text in one)


def is_number(text: Any, number: Callable[[Any], float]) -> bool:
    """True for a text that is read as a number, or as none."""
    try:
        number(text)
    except (ValueError, TypeError):
        return False
    return True
