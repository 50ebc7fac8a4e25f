"""What the fields of a sentence say of the number beside them: valid, its unit, its side."""

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.nmea0183.nmea0183_columns import texts
from trialid.ingest.nmea0183.nmea0183_layouts import Field, Letter
from trialid.ingest.nmea0183.nmea0183_sentences import Mask, Places, Sentences


def invalid_numbers(block: Sentences, rows: Places, one: Field) -> Mask:
    """True where the sentence itself says that the number is none."""
    invalid = np.zeros(len(rows), np.bool_)
    if one.status is not None:
        invalid |= other_letters(block, rows, one.status)
    if one.fix is not None:
        invalid |= _no_fix(block, rows, one.fix)
    return invalid


def other_letters(block: Sentences, rows: Places, expected: tuple[int, str]) -> Mask:
    """True where a field says something else than one of these letters; empty says nothing."""
    letter = block.letter(rows, expected[0])
    other = letter != 0
    for allowed in expected[1].encode():
        other &= letter != allowed
    return other


def _no_fix(block: Sentences, rows: Places, fix: Letter) -> Mask:
    """True where a field says that no satellite gave this position; of several systems, one may."""
    none = np.zeros(len(rows), np.bool_)
    for part, text in texts(block.data, block.field(rows, fix[0])):
        none[part] = bool(text) and not {*text} & {*fix[1]}
    return none


def whole_degrees(y: NDArray[np.float64]) -> tuple[NDArray[np.float64], Mask]:
    """Degrees of dddmm.mmmm, and where there are 60 minutes and more."""
    whole = np.trunc(y / 100.0)
    minutes = y - 100.0 * whole
    return whole + minutes / 60.0, np.isfinite(y) & (minutes >= 60.0)


def signed_numbers(
    block: Sentences, rows: Places, side: tuple[int, str], y: NDArray[np.float64]
) -> tuple[NDArray[np.float64], Mask]:
    """Numbers with the sign their side gives; one without a side is none, except zero."""
    at, plus, minus = side[0], side[1][0], side[1][1]
    letter = block.letter(rows, at)
    sign = np.where(letter == ord(plus), 1.0, np.where(letter == ord(minus), -1.0, np.nan))
    sign[(y == 0) & (letter == 0)] = 1.0
    return y * sign, np.isfinite(y) & np.isnan(sign)
