"""Records that follow one another without a gap: where one ends the next must begin.

Binary logs mark the start of a record with a byte or two that occur inside of records as well.
What tells a true start from a false one is that another start lies exactly where the record ends.
Runs of such records are found in whole arrays; Python looks only at where a run ends.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Places = NDArray[np.int64]

UNLINKED, UNDECIDED = -1, -2


@dataclass(frozen=True)
class Stretch:
    """The bytes looked at.

    Parameters
    ----------
    reached
        Where the last record found before them ended; less than zero when it ended before them.
    end
        How many there are.
    closing
        A record that ends here or later, up to `end`, is the file's last; None in the middle of a
        file.
    header
        Bytes of a record that must be there to see that it is one.
    """

    reached: int
    end: int
    closing: int | None
    header: int


@dataclass(frozen=True)
class Linked:
    """The records of a stretch of bytes.

    `kept` says which of the starts are records, (N,); `holes` are the bytes `begin, end` between
    them; `reached` is where the last record ended, `resume` the first byte to look at again with
    the bytes that follow.
    """

    kept: NDArray[np.bool_]
    holes: tuple[tuple[int, int], ...]
    reached: int
    resume: int


def linked_starts(starts: Places, nexts: Places, stretch: Stretch) -> Linked:
    """The records among `starts`; a start that no other follows is none.

    `starts` are places where a record may start, increasing, and `nexts` where the record after
    it would start; both (N,).
    """
    follower = _followers(starts, nexts, stretch)
    begins, ends, stray = _runs(follower)
    kept = np.zeros(len(starts), bool)
    holes, reached, i = [], stretch.reached, 0
    for begin, e, after in zip(
        begins.tolist(), ends.tolist(), follower[ends].tolist(), strict=True
    ):
        if e < i:
            continue
        i = max(i, begin)
        while stray[i]:
            i += 1
        last = e if after >= 0 else e - 1
        while last > i and stray[last]:
            last -= 1
        if last >= i:
            kept[i : last + 1] = ~stray[i : last + 1]
            if starts[i] > reached:
                holes.append((reached, int(starts[i])))
            reached = int(nexts[last])
        if after == UNDECIDED:
            return Linked(kept, tuple(holes), reached, int(starts[e]))
        i = after if after >= 0 else e + 1
    resume = stretch.end if stretch.closing is not None else stretch.end - stretch.header + 1
    return Linked(kept, tuple(holes), reached, max(resume, 0))


def _runs(follower: Places) -> tuple[Places, Places, NDArray[np.bool_]]:
    """First and last of each run of records, and which starts stand alone within or between them.

    A run goes on behind starts that no other follows: such are there by chance within records, and
    there are many.
    """
    run_end = follower != np.arange(1, len(follower) + 1)
    run_end[-1:] = True
    ends = np.flatnonzero(run_end)
    begins = np.concatenate([[0], ends[:-1] + 1])[: len(ends)]
    alone = (begins == ends) & (follower[ends] == UNLINKED)
    stray = np.zeros(len(follower), bool)
    stray[ends[alone]] = True
    begins, ends = begins[~alone], ends[~alone]
    goes_on = np.zeros(len(ends), bool)
    goes_on[:-1] = follower[ends[:-1]] == begins[1:]
    first = np.concatenate([[True], ~goes_on[:-1]])[: len(ends)]
    return begins[first], ends[~goes_on], stray


def _followers(starts: Places, nexts: Places, stretch: Stretch) -> Places:
    """Index of the start at which each record ends, the count for the last of the file; (N,)."""
    count = len(starts)
    follower = np.full(count, UNLINKED, np.int64)
    adjacent = np.zeros(count, bool)
    adjacent[:-1] = nexts[:-1] == starts[1:]
    follower[adjacent] = np.flatnonzero(adjacent) + 1
    rest = np.flatnonzero(~adjacent)
    found = np.minimum(np.searchsorted(starts, nexts[rest]), count - 1)
    hit = starts[found] == nexts[rest]
    follower[rest[hit]] = found[hit]
    if stretch.closing is None:
        follower[nexts > stretch.end - stretch.header] = UNDECIDED
    else:
        follower[(nexts >= stretch.closing) & (nexts <= stretch.end)] = count
    return follower
