"""Values that are surely no measurement, found on the channel's own clock and masked.

What nothing afloat can have, spikes and short runs of zeros (`spikes`), flat tops and sensors that
are stuck. A flat top is an extreme value that is held again and again, entered and left at speed.
What may be real is remarked and left as it is.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from trialid.alignment.brief_steps import long_dropouts, long_spikes
from trialid.alignment.clocks import Grid, Series, check
from trialid.alignment.fault_samples import (
    Fault,
    Samples,
    available_samples,
    joined_runs,
    resolution,
)
from trialid.alignment.jumps import jumps
from trialid.alignment.signal_limits import LIMITS
from trialid.alignment.sources import SignalSource
from trialid.alignment.spikes import WIDEST_SPIKE, dropouts, spikes
from trialid.alignment.wrapped_means import wrapped_means
from trialid.arrays import Mask, Vector
from trialid.errors import AlignmentError
from trialid.names import units
from trialid.names.quantities import is_input

KINDS = ("range", "dropouts", "spikes", "saturation", "stuck")
"""What may be found; a signal's `keep` names those that are left as they are."""

MOST_WRONG = 0.2
"""Share of impossible values above which the unit is wrong, not the values."""
FLAT = 4
"""Samples in a flat top, of which there must be two before the value is called a limit."""
LONG = 20
"""Samples at a limit that are told by themselves, of a value that stands for no `FLAT` elsewhere. A
rate of turn whose display ends at 30 deg/min was held for 576 in a turning circle, and fitted. Of
420 simulated records none has such a run, with half of this or twice."""
LAST_DIGITS = 1e-9
"""Share of a value within which others are the same, worked out another way."""
ABRUPT = 0.5
"""A flat top is entered with steps of this share of the usual ones at least."""
FROZEN_S = 5.0
FROZEN = 20.0
"""A sensor is frozen when it holds a value so long, and so many times longer than 99 in 100 of
its values are held, while others show that the ship moves. A coarse one often holds a value."""
ALIVE = 0.25
"""The ship moves when another motion spreads by this share of its spread over the trial."""
OTHERWISE, FAR, ENOUGH = np.deg2rad(3.0), 5.0, 3
"""[rad] By how much a heading goes on otherwise than a rate that is held says, how many times more
than in as long a time elsewhere, and in how many of these at least. In 1001 trials of outsiders
none is told by it, an outsider's four that froze for 40 s are; half and twice of both say the same.
"""
GO_TOGETHER = {
    "psi": ("r",), "r": ("psi", "phi", "v"), "phi": ("p", "r"), "p": ("phi", "r"),
    "v": ("r", "psi"),
}  # fmt: skip
"""Motions that cannot rest while the other moves, the surest one first."""


def mask_all(
    series: Sequence[Series],
    sources: Sequence[SignalSource],
    grid: Grid,
    keep: Mapping[str, Collection[str]],
    places: Sequence[str],
) -> tuple[list[Series], list[str]]:
    """All series of a trial without what is surely no measurement, and remarks on it.

    Raises AlignmentError for a unit that cannot be right, and where nothing is left.
    """
    left, remarks = [], []
    for one, source, place in zip(series, sources, places, strict=True):
        zero = 0.0 if source.offset == 0.0 and source.curve is None else np.nan
        kept, found = mask_faults(one, grid, keep.get(source.quantity, ()), zero, place)
        left.append(kept)
        remarks += found
    for i, (one, place) in enumerate(zip(tuple(left), places, strict=True)):
        fault = find_stuck(left, i, grid)
        if fault is not None:
            hide = "stuck" not in keep.get(one.quantity.name, ())
            remarks += _words(one, fault, grid, hide)
            left[i] = _without(one, fault.samples) if hide else one
        check(left[i], place)
    return left, remarks


def mask_faults(
    series: Series, grid: Grid, keep: Collection[str], zero: float, where: str
) -> tuple[Series, list[str]]:
    """The series without the values that are surely none, and remarks on what was found.

    Parameters
    ----------
    series
        On its own clock, stamps increasing.
    grid
        The clock of the trial, for the times in the remarks.
    keep
        Kinds of KINDS that are remarked but never masked.
    zero
        Value [SI] of a logged zero; NaN where that is not known.
    where
        For the error.

    Raises AlignmentError when so many values are impossible that the unit must be wrong.
    """
    remarks = list[str]()
    for find in FINDS:
        for fault in find(series, zero):
            _check_share(fault, series, where)
            hide = fault.sure and fault.kind not in keep
            remarks += _words(series, fault, grid, hide)
            series = _without(series, fault.samples) if hide else series
    return series, remarks


def _without(series: Series, samples: Mask) -> Series:
    return replace(series, y=np.where(samples, np.nan, series.y))


def _words(series: Series, fault: Fault, grid: Grid, hide: bool) -> Iterator[str]:
    """Count, first times, what was done; nothing of what lies outside the trial's window."""
    t = grid.seconds(series.t[fault.samples])
    t = t[(t >= 0.0) & (t <= grid.t[-1])]
    if not len(t):
        return
    first = ", ".join(f"{one:.1f}" for one in t[:3])
    done = "masked" if hide else "left as they are"
    more = ", ..." if len(t) > 3 else ""
    name, count = series.quantity.name, len(t)
    noun, done = ("value", done.replace("they are", "it is")) if count == 1 else ("values", done)
    yield f"{name}: {count} {noun} {fault.words}, at {first}{more} s; {done}"


def _check_share(fault: Fault, series: Series, where: str) -> None:
    total = int(np.isfinite(series.y).sum())
    wrong = int(fault.samples.sum())
    if fault.kind == "range" and wrong > MOST_WRONG * total:
        raise AlignmentError(
            f"{where}: {wrong} of {total} values are {fault.words}; the unit is wrong, or it is "
            "another quantity: correct unit, gain and offset, or take another channel"
        )


def _range(series: Series, zero: float) -> Iterator[Fault]:
    """Values that nothing afloat can have."""
    quantity = series.quantity
    limit = LIMITS.get(quantity.name)
    if limit is None:
        return
    with np.errstate(invalid="ignore"):
        beyond = (series.y < limit.low) | (series.y > limit.high)
    beyond &= np.isfinite(series.y)
    if quantity.name == "psi":
        beyond, limit = _beyond_a_turn(series.y), replace(limit, high=2 * np.pi)
    if beyond.any():
        size = limit.high * units.shown_factor(quantity)
        words = f"beyond {size:.4g} {quantity.shown}"
        if limit.low == 0.0 and bool(np.all(series.y[beyond] < 0)):
            words = "below zero"
        yield Fault("range", words, beyond, True)


def _beyond_a_turn(y: Vector) -> Mask:
    """Headings of more than a turn that stand alone; a logger that counts turns goes on so."""
    out = np.zeros(len(y), np.bool_)
    at = np.flatnonzero(np.isfinite(y))
    for first, last in joined_runs(np.abs(np.diff(y[at])) < np.pi):
        run = at[first : last + 1]
        lonely = len(run) <= WIDEST_SPIKE < len(at)
        out[run] = lonely and bool(np.all(np.abs(y[run]) > 2 * np.pi + 1e-3))
    return out


def _saturation(series: Series, zero: float) -> Iterator[Fault]:
    """Flat tops of a motion: its extreme value held, entered and left at speed."""
    s = available_samples(series)
    if is_input(series.quantity) or series.quantity.angle or len(s.y) < 10 * FLAT:
        return
    steps = np.abs(np.diff(s.y))
    usual = float(np.mean(steps[steps > 0])) if np.any(steps) else 0.0
    levels = resolution(s.y)
    for extreme in (s.y.max(), s.y.min()):
        if np.isclose(extreme, zero, rtol=0.0, atol=1e-12) or np.ptp(s.y) == 0:
            continue
        held = _held(s, extreme)
        alone = _held_here_alone(s, held)
        runs = held if alone else [r for r in held if _abrupt(s, r, usual, levels)]
        if alone or len(runs) >= 2:
            samples = np.zeros(len(series.y), np.bool_)
            for first, last in runs:
                samples[s.at[first : last + 1]] = True
            shown = extreme * units.shown_factor(series.quantity)
            tops = "1 flat top" if len(runs) == 1 else f"{len(runs)} flat tops"
            words = f"held at the limit {shown:.4g} {series.quantity.shown} in {tops}"
            yield Fault("saturation", words, samples, True)


def _held(s: Samples, value: float) -> list[tuple[int, int]]:
    """Runs of FLAT samples and more that have one and the same value."""
    same = np.abs(s.y - value) <= 1e-9 * abs(value)
    runs = joined_runs((same[1:] == same[:-1]) & s.near[1:])
    return [(i, j) for i, j in runs if same[i] and j - i + 1 >= FLAT]


def _held_here_alone(s: Samples, held: list[tuple[int, int]]) -> bool:
    """Whether a value is held long that never stands still elsewhere: noise stops at no turn."""
    low, high = s.y.min(), s.y.max()
    longest = max((last - first + 1 for first, last in held), default=0)
    if longest < LONG or high - low < LAST_DIGITS * max(abs(low), abs(high)):
        return False
    runs = joined_runs((np.diff(s.y) == 0) & s.near[1:])
    elsewhere = {i: j - i + 1 for i, j in runs if s.y[i] not in (low, high)}
    levels = len(np.unique(s.y[list(elsewhere)]))
    return levels > LONG and max(elsewhere.values(), default=0) < FLAT


def _abrupt(s: Samples, run: tuple[int, int], usual: float, levels: float) -> bool:
    """True when the signal came to the value at speed, from several steps of resolution away."""
    first, last = run
    if first < 2 or last > len(s.y) - 3:
        return False
    outer = (s.y[first - 1] - s.y[first - 2], s.y[last + 2] - s.y[last + 1])
    return min(abs(step) for step in outer) > max(ABRUPT * usual, 3 * levels)


FINDS = (_range, wrapped_means, dropouts, long_dropouts, spikes, long_spikes, _saturation, jumps)
"""In this order: what one finds is hidden from the next."""


def find_stuck(series: Sequence[Series], i: int, grid: Grid) -> Fault | None:
    """Where motion `i` keeps one value while the others say that the ship moves."""
    one, s = series[i], available_samples(series[i])
    if one.quantity.mirror > 0 or is_input(one.quantity) or len(s.y) < 2:
        return None
    edges = np.flatnonzero(~((np.diff(s.y) == 0) & s.near[1:])) + 1
    first, last = np.append(0, edges), np.append(edges, len(s.y)) - 1
    spans = s.t[last] - s.t[first]
    usual = max(float(np.quantile(spans, 0.99)), one.period)
    samples = np.zeros(len(one.y), np.bool_)
    for k in np.flatnonzero(spans > max(FROZEN_S, FROZEN * usual)):
        held = s.at[first[k] : last[k] + 1]
        if _moves(series, i, (int(one.t[held[0]]), int(one.t[held[-1]]))):
            samples[held[1:]] = True
    if samples.any():
        return Fault("stuck", "did not change while the ship moved", samples, True)
    return None


def _moves(series: Sequence[Series], i: int, ends: tuple[int, int]) -> bool:
    """True when a motion that goes with this one is as lively as in the whole."""
    by_name = {one.quantity.name: one for one in series}
    names = GO_TOGETHER.get(series[i].quantity.name, ())
    told = [_lively(by_name[name], ends) for name in names if name in by_name]
    is_rate = series[i].quantity.name == "r" and "psi" in by_name
    otherwise = is_rate and _turns_otherwise(series[i], by_name["psi"], ends)
    return (bool(told) and told[0]) or otherwise


def _turns_otherwise(rate: Series, heading: Series, ends: tuple[int, int]) -> bool:
    """Whether her heading goes on quite otherwise than the rate, as it nowhere else does."""
    r, psi = available_samples(rate), available_samples(heading)
    if min(len(r.t), len(psi.t)) < 2:
        return False
    begin, end = ((stamp - int(rate.t[0])) / 1e9 for stamp in ends)
    went = np.append(0.0, np.cumsum(0.5 * (r.y[1:] + r.y[:-1]) * np.diff(r.t)))
    k, after = (int(x / (end - begin) + 1e-9) for x in (begin - r.t[0], r.t[-1] - begin))
    at = begin + (end - begin) * np.arange(-k, after + 1)  # as long times before and after
    shift = (int(heading.t[0]) - int(rate.t[0])) / 1e9
    # where no heading is recorded nothing is said of it
    turned = np.interp(at, psi.t + shift, psi.y, left=np.nan, right=np.nan)
    apart = np.abs(np.diff(turned - np.interp(at, r.t, went)))
    if k >= len(apart) or np.isfinite(apart).sum() <= ENOUGH:
        return False
    return bool(apart[k] > max(OTHERWISE, FAR * np.nanmedian(np.delete(apart, k))))


def _lively(series: Series, ends: tuple[int, int]) -> bool:
    """Rates against zero, which is rest; angles against their mean."""
    s = available_samples(series)
    stamps = series.t[s.at]
    level = 0.0 if series.quantity.name in {"r", "p"} else float(np.mean(s.y))
    inside = (stamps >= ends[0]) & (stamps <= ends[1])
    during = s.y[inside] - (float(np.mean(s.y[inside])) if level and inside.any() else 0.0)
    usual = float(np.sqrt(np.mean((s.y - level) ** 2)))
    return len(during) > FLAT and float(np.sqrt(np.mean(during**2))) > ALIVE * usual > 0
