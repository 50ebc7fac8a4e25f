"""Sentences of NMEA 0183 by their checksum alone, whatever stands around them."""

import re
from functools import reduce
from operator import xor

SENTENCE = re.compile(rb"[$!]([A-Z](?:(?![$!*])[ -~])*)\*([0-9A-Fa-f]{2})")
"""Printable characters, an address first; anything else a reader can see."""


def forged(log: bytes, original: bytes) -> set[bytes]:
    """Sentences of a damaged log that fit their checksum and were in no original.

    Eight bits of exclusive or cannot see them: two same bits turned in one column, a piece doubled
    or moved within its sentence, one chance in 256 for anything else.
    """
    return _sound(log) - _sound(original)


def _sound(log: bytes) -> set[bytes]:
    found = SENTENCE.findall(log)
    return {body for body, stated in found if reduce(xor, body, 0) == int(stated, 16)}
