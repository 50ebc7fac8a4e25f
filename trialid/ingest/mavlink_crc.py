"""The checksum of MAVLink frames, of many frames at a time.

CRC-16/MCRF4XX over the frame without its first byte and its checksum, then over one byte that
stands for the message's definition. Source: mavlink.io, serialization.
"""

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.linked_records import Places

POLYNOMIAL = 0x8408
START = 0xFFFF
BLOCK = 32768
"""Frames at a time: few enough that they and their checksums stay in the processor's cache."""


def _table() -> NDArray[np.uint16]:
    crc = np.arange(256, dtype=np.uint16)
    for _ in range(8):
        crc = np.where(crc & 1, (crc >> 1) ^ POLYNOMIAL, crc >> 1).astype(np.uint16)
    return crc


TABLE = _table()


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
    for first in range(0, len(begins), BLOCK):
        part = slice(first, first + BLOCK)
        found[part] = _of_block(data, begins[part], ends[part], extra[part])
    return found


def _of_block(
    data: NDArray[np.uint8], begins: Places, ends: Places, extra: NDArray[np.uint8]
) -> NDArray[np.uint16]:
    order = np.argsort(begins - ends, kind="stable")
    at, length = begins[order], (ends - begins)[order]
    crc = np.full(len(at), START, np.uint16)
    fewer = np.searchsorted(-length, -np.arange(int(length.max(initial=0))), "left")
    for j, count in enumerate(fewer.tolist()):
        crc[:count] = _next(crc[:count], data[at[:count] + j])
    found = np.empty(len(at), np.uint16)
    found[order] = _next(crc, extra[order])
    return found


def _next(crc: NDArray[np.uint16], byte: NDArray[np.uint8]) -> NDArray[np.uint16]:
    return TABLE[(crc ^ byte) & 0xFF] ^ (crc >> 8)
