"""Records that follow one another, beside a walk from one to the next."""

import numpy as np
import pytest

from trialid.ingest.bytes.linked_records import Stretch, linked_starts


def walked(starts, nexts, stretch):
    """The same, start by start."""
    index = {start: i for i, start in enumerate(starts)}
    kept, holes, reached, i = set(), [], stretch.reached, 0
    resume = stretch.end if stretch.closing is not None else stretch.end - stretch.header + 1
    while i < len(starts):
        last = stretch.closing is not None and stretch.closing <= nexts[i] <= stretch.end
        if stretch.closing is None and nexts[i] > stretch.end - stretch.header:
            resume = starts[i]
            break
        if not last and nexts[i] not in index:
            i += 1
            continue
        kept.add(i)
        if starts[i] > reached:
            holes.append((reached, starts[i]))
        reached = nexts[i]
        i = len(starts) if last else index[nexts[i]]
    return kept, tuple(holes), reached, max(resume, 0)


@pytest.mark.parametrize("closing", [True, False])
@pytest.mark.parametrize("share", [0.2, 0.6, 0.95])
def test_what_is_linked_is_what_a_walk_finds(share, closing):
    rng = np.random.default_rng(3)
    for _ in range(400):
        end = int(rng.integers(20, 200))
        starts = np.flatnonzero(rng.random(end) < rng.choice([0.1, 0.3, 0.7]))
        nexts = starts + rng.integers(1, 12, len(starts))
        true = rng.random(len(starts)) < share
        after = np.minimum(np.arange(len(starts)) + rng.integers(1, 4, len(starts)), len(starts))
        nexts = np.where(true, np.append(starts, end)[after], nexts)
        stretch = Stretch(int(rng.integers(-3, 3)), end, end - 3 if closing else None, 4)
        found = linked_starts(starts, nexts, stretch)
        walk = walked(starts.tolist(), nexts.tolist(), stretch)
        kept = set(np.flatnonzero(found.kept).tolist())
        assert (kept, found.holes, found.reached, found.resume) == walk
