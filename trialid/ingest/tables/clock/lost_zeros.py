"""Fractions of a second written as a count, whose zeros in front were lost.

A program that joins seconds and nanoseconds with a point writes 34.065064401 s as `34.65064401`.
Read as it stands the clock steps back; with its zeros again it does not.
"""

import re
from collections.abc import Callable, Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

FRACTION: Final = re.compile(r"(?<=:\d\d\.)\d{1,9}")
"""What follows the seconds of a time of day."""

COUNTS: Final = (3, 6, 9)
"""Digits of a count of thousandths, of millionths and of nanoseconds."""

Instants = NDArray[np.int64]


def with_lost_zeros(
    texts: Sequence[str], t: Instants, read: Callable[[list[str]], Instants | None]
) -> tuple[Instants, str]:
    """The instants, and a remark where zeros were lost; as they are and '' else.

    Only where the clock steps back as it stands and nowhere with its zeros: of a fraction whose
    zeros at the end are left out the first is right, and of rows in disorder neither is.

    Parameters
    ----------
    texts, t
        What is written, and the instants [ns] as it stands; (N,).
    read
        Instants of such texts, or None where they are none.
    """
    if not np.any(np.diff(t) < 0):
        return t, ""
    found = [FRACTION.search(text) for text in texts]
    digits = max((len(one[0]) for one in found if one), default=0)
    short = sum(one is not None and len(one[0]) < digits for one in found)
    if digits not in COUNTS or not short:
        return t, ""
    padded = read([FRACTION.sub(lambda one: one[0].zfill(digits), text) for text in texts])
    if padded is None or np.any(np.diff(padded) < 0):
        return t, ""
    return padded, (
        f"in {short} of {len(texts)} rows the fraction of the second lost its zeros in front, as "
        f"'34.65' for 34.065: read as a count of {digits} digits, by which alone the clock never "
        "steps back"
    )
