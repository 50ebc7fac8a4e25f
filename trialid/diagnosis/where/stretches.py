"""Stretches of time that hold most of the error: windows that stand out, neighbours merged."""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.arrays import Mask
from trialid.diagnosis.where import words
from trialid.diagnosis.where.bins import bars, in_reports
from trialid.diagnosis.where.doing import ship_activity
from trialid.diagnosis.where.finding import Bars, Examined, Finding
from trialid.diagnosis.where.leftover import Leftover
from trialid.diagnosis.where.slice_test import Colour, Squares, squares, squares_of_each

Vector = NDArray[np.float64]

LEVEL: Final = 0.05
WINDOW: Final = 60.0
"""[s] for a ship of 175 m; the root of the length scales it."""

MOST: Final = 3
"""Stretches told of each output, the largest ones."""

FEWEST: Final = 4
ONE_SIDED: Final = 0.5
"""A mean above this share of the rms: a quarter of the squared error there is of one sign."""


@dataclass(frozen=True)
class Window:
    """Samples of one trial, counted over all trials."""

    trial: int
    start: int
    stop: int


def windows(left: Leftover) -> list[Window]:
    """Windows over every trial, all of about one length."""
    made = []
    for i, (part, span) in enumerate(zip(left.parts, left.spans, strict=True)):
        length = max(round(WINDOW * left.time_scale / part.trial.period), 8)
        count = max(round((span.stop - span.start) / length), 1)
        ends = np.linspace(span.start, span.stop, count + 1).round().astype(int)
        made += [Window(i, int(a), int(b)) for a, b in pairwise(ends)]
    return made


def spells(rows: list[Window]) -> list[tuple[int, ...]]:
    """Runs of windows of one trial to be judged: one, two, four at a time, and whole trials.

    An error that swings slowly says little in one window, however large it is.
    """
    made: list[tuple[int, ...]] = []
    for trial in sorted({w.trial for w in rows}):
        mine = tuple(k for k, w in enumerate(rows) if w.trial == trial)
        for size in (1, 2, 4):
            made += [mine[k : k + size] for k in range(0, len(mine) - size + 1, max(size // 2, 1))]
        made.append(mine)
    return list(dict.fromkeys(made))


def worst_stretches(left: Leftover, colour: Colour, output: int) -> Examined | str:
    """Stretches whose mean square stands out above that of all else, worst first."""
    rows = windows(left)
    if len(rows) < FEWEST:
        return f"the trials are shorter than {FEWEST} windows"
    tried = spells(rows)
    clock = np.arange(len(left.eps))
    inside = ((clock >= rows[s[0]].start) & (clock < rows[s[-1]].stop) for s in tried)
    held = squares_of_each(left, colour, output, inside)
    p = np.where(held.ratio > 1.0, 0.5 * held.p, 1.0)
    least = min(float(p.min()) * len(p), 1.0)
    if least > LEVEL:
        return Examined(least)
    worse = {spell[0] for k, spell in enumerate(tried) if len(spell) == 1 and held.ratio[k] > 1.0}
    standing = [tried[k] for k in np.argsort(p, kind="stable") if p[k] <= LEVEL / len(p)]
    runs = [run for run in (_trimmed(r, worse) for r in _runs(rows, standing)) if run]
    found = [_finding(left, colour, output, rows, run) for run in runs]
    return Examined(least, tuple(sorted(found, key=lambda f: -f.beyond)[:MOST]))


def _runs(rows: list[Window], standing: Sequence[Sequence[int]]) -> list[list[int]]:
    """The most certain of stretches that overlap, and neighbours of one trial together."""
    chosen: set[int] = set()
    for spell in standing:
        if chosen.isdisjoint(spell):
            chosen |= set(spell)
    runs: list[list[int]] = []
    for k in sorted(chosen):
        if runs and runs[-1][-1] == k - 1 and rows[k - 1].trial == rows[k].trial:
            runs[-1].append(k)
        else:
            runs.append([k])
    return runs


def _trimmed(run: list[int], worse: set[int]) -> list[int]:
    """A run without the windows at its ends that are no worse than the average."""
    kept = [i for i, k in enumerate(run) if k in worse]
    return run[kept[0] : kept[-1] + 1] if kept else []


def _finding(
    left: Leftover, colour: Colour, output: int, rows: list[Window], run: list[int]
) -> Finding:
    first, last = rows[run[0]], rows[run[-1]]
    mine = [k for k, w in enumerate(rows) if w.trial == first.trial]
    inside = np.zeros((len(left.eps), len(mine) + 1), dtype=bool, order="F")
    inside[first.start : last.stop, 0] = True
    for column, k in enumerate(mine, start=1):
        inside[rows[k].start : rows[k].stop, column] = True
    held = squares(left, colour, output, inside)
    trial, span = left.parts[first.trial].trial, left.spans[first.trial]
    a, b = [(k - span.start) * trial.period for k in (first.start, last.stop)]
    share, samples = float(held.share[0]), float(held.samples[0])
    act = ship_activity(left, slice(first.start, last.stop))
    said = (
        f"{words.name(left.outputs[output])} in {trial.name!r}, {a:.0f} to {b:.0f} s ({act}): "
        f"{words.share_sentence(samples, share)}, {share / samples:.1f} times the average"
    )
    value = _mean(left, output, slice(first.start, last.stop))
    if abs(value[0]) > ONE_SIDED * value[1]:
        said += f"; the prediction is {words.how_far_off(left, output, value[0])}"
    each = Squares(*(x[1:] for x in vars(held).values()))
    standing = np.isin(mine, run)
    picture = _picture(left, output, [rows[k] for k in mine], each, standing)
    return Finding(
        output=left.outputs[output],
        kind="stretch",
        share=share,
        beyond=share - samples,
        excess=share / samples,
        p_value=1.0,
        sentence=said,
        picture=picture,
        trial=trial.name,
        t_start=a,
        t_end=b,
        doing=act,
    )


def _mean(left: Leftover, output: int, stretch: slice) -> tuple[float, float]:
    """Mean and rms of measured less predicted, in the unit of reports; zero in a gap."""
    compared = left.compared[stretch, output]
    e = left.eps[stretch, output][compared] * in_reports(left, output)
    count = max(int(compared.sum()), 1)
    return float(e.sum() / count), float(np.sqrt(e @ e / count))


def _picture(
    left: Leftover, output: int, mine: list[Window], held: Squares, standing: Mask
) -> Bars:
    """All windows of the stretch's trial."""
    trial = mine[0].trial
    start, period = left.spans[trial].start, left.parts[trial].trial.period
    edges = np.array([(e - start) * period for e in (mine[0].start, *(w.stop for w in mine))])
    by = (f"time in {left.parts[trial].trial.name}", "s")
    return bars(
        left=left, output=output, by=by, edges=edges, held=held, mean=None, standing=standing
    )
