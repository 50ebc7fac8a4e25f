"""Arrays that grow at their end without ever being held twice."""

import numpy as np
from numpy.typing import NDArray

SLACK = 1.125
MOST = 1 << 18
"""Numbers of slack at most: a long array is made longer without a copy, its slack is memory."""
FEWEST = 1024


class Growing:
    """Numbers that come in pieces, kept in one array that is made longer where it lies.

    Keeping the pieces and joining them at the end would need the memory twice.

    >>> grown = Growing(np.int64)
    >>> grown.add(np.array([1, 2])), grown.add(np.array([3]))
    (None, None)
    >>> grown.array().tolist()
    [1, 2, 3]
    """

    def __init__(self, kind: type[np.int64] | type[np.float64]) -> None:
        self.count = 0
        self._room: NDArray[np.generic] = np.empty(0, kind)

    def add(self, piece: NDArray[np.generic]) -> None:
        """Append the piece; (n,)."""
        end = self.count + len(piece)
        if end > len(self._room):
            # Nobody else has seen the array yet, so none can hold on to where it lay.
            self._room.resize(max(min(int(SLACK * end), end + MOST), FEWEST), refcheck=False)
        self._room[self.count : end] = piece
        self.count = end

    def so_far(self) -> NDArray[np.generic]:
        """A copy of those there are. (N,)."""
        return self._room[: self.count].copy()

    def array(self) -> NDArray[np.generic]:
        """All of them; nothing can be added any more. (N,)."""
        self._room.resize(self.count, refcheck=False)
        return self._room
