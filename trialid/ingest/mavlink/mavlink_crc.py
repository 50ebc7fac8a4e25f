"""The checksum of MAVLink frames, of many frames at a time.

CRC-16/MCRF4XX over the frame without its first byte and its checksum, then over one byte that
stands for the message's definition. Source: mavlink.io, serialization.
"""

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.bytes.linked_records import Places

POLYNOMIAL = 0x8408
START = 0xFFFF
BLOCK = 1 << 19
"""Bytes at a time: few enough that they and their checksums stay in the processor's cache."""


def _after(bits: int) -> NDArray[np.uint16]:
    """Checksum after so many bits, by the checksum before exclusive-ored with them."""
    crc = np.arange(1 << 16, dtype=np.uint16)
    for _ in range(bits):
        crc = np.where(crc & 1, (crc >> 1) ^ POLYNOMIAL, crc >> 1).astype(np.uint16)
    return crc


AFTER_TWO = _after(16)
BEFORE_ZERO = int(np.flatnonzero(_after(8) == START)[0])
"""From here a byte of zeros leads to START: with it in front an odd count of bytes is even."""


def checksums(
    data: NDArray[np.uint8], begins: Places, ends: Places, extra: NDArray[np.uint8]
) -> NDArray[np.uint16]:
    """Checksum of `data` from each begin to each end, then of the extra byte; (N,) all.

    >>> text = np.frombuffer(b"12345678", np.uint8)
    >>> nine = np.frombuffer(b"9", np.uint8)
    >>> hex(checksums(text, np.array([0]), np.array([8]), nine)[0])
    '0x6f91'
    """
    found = np.empty(len(begins), np.uint16)
    size = (ends - begins).astype(np.uint16)
    order, edge = np.argsort(size, kind="stable"), 0
    for one, count in enumerate(np.bincount(size).tolist()):
        step, last = max(BLOCK // (one + 2), 1), edge + count
        for first in range(edge, last, step):
            rows = order[first : min(first + step, last)]
            found[rows] = _of_size(data, begins[rows], one, extra[rows])
        edge = last
    return found


def _of_size(
    data: NDArray[np.uint8], begins: Places, size: int, extra: NDArray[np.uint8]
) -> NDArray[np.uint16]:
    """Checksums of stretches of one size, two bytes in one go."""
    every: NDArray[np.uint8] = np.ndarray((len(data) - size + 1, size), np.uint8, data, 0, (1, 1))
    odd = 1 - size % 2
    text = np.zeros((len(begins), odd + size + 1), np.uint8)
    text[:, odd:-1] = every[begins]
    text[:, -1] = extra
    crc = np.full(len(begins), BEFORE_ZERO if odd else START, np.uint16)
    for two in text.view("<u2").T:
        crc = AFTER_TWO[crc ^ two]
    return crc
