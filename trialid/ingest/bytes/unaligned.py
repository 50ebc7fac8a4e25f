"""Numbers that lie anywhere in a stretch of bytes, lifted out by numpy many at a time."""

import numpy as np
from numpy.typing import NDArray

Bytes = NDArray[np.uint8]
Places = NDArray[np.int64]


def numbers(data: Bytes, at: Places, kind: str) -> NDArray[np.generic]:
    """Numbers of numpy type `kind` that begin at the bytes `at` of `data`; (N,).

    >>> numbers(np.array([9, 1, 0, 2, 0], np.uint8), np.array([1, 3]), "<u2").tolist()
    [1, 2]

    Raises IndexError when one of them does not lie in the data.
    """
    dtype = np.dtype(kind)
    starts = len(data) - dtype.itemsize + 1
    if starts <= 0:
        if len(at):
            raise IndexError(f"a {dtype} does not lie in {len(data)} bytes")
        return np.zeros(0, dtype)
    every: NDArray[np.generic] = np.ndarray((starts,), dtype, data, 0, (1,))
    return every[at]


def alike(data: Bytes, at: Places, word: bytes) -> NDArray[np.bool_]:
    """True where the bytes from `at` on are those of `word`; (N,)."""
    if len(word) == 4:
        return np.equal(numbers(data, at, "<u4"), np.frombuffer(word, "<u4")[0])
    rows = data[at[:, None] + np.arange(len(word))]
    same: NDArray[np.bool_] = (rows == np.frombuffer(word, np.uint8)).all(axis=1)
    return same
