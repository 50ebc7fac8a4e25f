"""Do the channels of a trial agree with one another? Findings as data, for errors and for reports.

What must hold whatever the ship: the rate of turn is the slope of the heading, the roll rate that
of the roll angle (`slopes`). Everything a healthy boat may do is only remarked. Nothing is ever
changed here.
"""

from collections.abc import Iterator, Mapping

import numpy as np

from trialid.alignment.agreement import relation, signs
from trialid.alignment.agreement.axes import check_axes
from trialid.alignment.agreement.channel_finding import Finding
from trialid.alignment.agreement.slopes import LOOSE, MOVING, TURNS, check_slopes
from trialid.alignment.clocks import EMPTIEST, FEWEST, Grid, Series, in_time_order
from trialid.alignment.resample import resample
from trialid.arrays import Mask, Vector
from trialid.names.quantities import RUDDERS, SLOPES
from trialid.trial import Trial, heel_in_calm

STILL = 0.1
"""[m/s] Speed at which no rudder steers: a moored boat's GPS shows 0.02 to 0.06 m/s."""


def of_trial(trial: Trial, stated: Mapping[str, str] | None = None) -> tuple[Finding, ...]:
    """Findings on the signals of a trial; `stated` holds the units that the pipeline states."""
    slopes = check_slopes(trial, stated or {}, trial)
    return (*slopes, *check_axes(trial), *_heel(trial), *_still(trial))


def of_series(
    series: Mapping[str, Series], stated: Mapping[str, str] | None = None
) -> tuple[Finding, ...]:
    """The same on one series for each quantity, as `inspect` has them before any trial.

    Where a rudder and a rate of turn are among them, the rudder's side is told too.
    """
    found: list[Finding] = []
    whole = trial_of_series(series)
    for pair in SLOPES.items():
        both = trial_of_series({name: series[name] for name in pair if name in series})
        found += check_slopes(both, stated or {}, whole or both) if both is not None else ()
    if whole is not None:
        found += (*check_axes(whole), *_heel(whole), *_still(whole), *_sides(whole))
    return tuple(found)


def trial_of_series(series: Mapping[str, Series]) -> Trial | None:
    """Series on one clock, that of the slowest, unfiltered.

    None where they do not overlap, and where nearly all of it would be between two samples.
    """
    straight = {name: in_time_order(one) for name, one in series.items()}
    able = {k: s for k, s in straight.items() if np.isfinite(s.y).sum() >= FEWEST}
    if not able:
        return None
    period = max(one.period for one in able.values())
    start = max(int(one.t[0]) for one in able.values())
    end = min(int(one.t[-1]) for one in able.values())
    samples = int((end - start) / 1e9 / period) + 1 if period > 0 else 0
    if not FEWEST <= samples <= EMPTIEST * max(len(one.t) for one in able.values()):
        return None
    grid = Grid(start, period, samples)
    laid = {name: resample(one, grid, smooth=False) for name, one in able.items()}
    signals = {name: values for name, (values, _) in laid.items()}
    valid = {name: known for name, (_, known) in laid.items()}
    return Trial("", "check", period, signals, valid)


def _heel(trial: Trial) -> Iterator[Finding]:
    """Which way the ship leans in a turn: displacement ships outward, planing boats inward."""
    turning = signs.rate_of_turn(trial)
    if turning is None or "phi" not in trial.signals:
        return
    u, known = _speed(trial)
    valid = turning[1] & trial.valid["phi"] & known
    centrifugal = turning[0] * u
    heel = heel_in_calm(trial, centrifugal, valid)
    found = relation.of_values(centrifugal, heel, valid, trial.period)
    turned = float(np.ptp(np.cumsum(np.where(valid, turning[0], 0.0)))) * trial.period
    if found is None or turned < TURNS or min(found.moves) < MOVING:
        return
    if abs(found.correlation) < LOOSE:
        return
    side = "inward" if found.correlation > 0 else "outward"
    words = f"heels {side} in turns: correlation of phi with r u {found.correlation:.2f}"
    if side == "inward":
        words += "; if she does not, phi counts to port, or all else that has a side does (z up)"
    evidence = {"correlation": found.correlation, "lag": found.lag}
    yield Finding("heel", "remark", ("phi", "r"), words, evidence)


def _speed(trial: Trial) -> tuple[Vector, Mask]:
    """Speed [m/s] where it was logged, else one: a turn is then judged as at steady speed."""
    if "u" in trial.signals:
        return trial.signals["u"], trial.valid["u"]
    return np.ones(trial.samples), np.ones(trial.samples, dtype=np.bool_)


def _still(trial: Trial) -> Iterator[Finding]:
    u, known = _speed(trial)
    if "u" in trial.signals and known.any() and np.quantile(np.abs(u[known]), 0.9) < STILL:
        middle = float(np.median(u[known]))
        words = f"the ship does not move: u is {middle:.2g} m/s, at dock or adrift no rudder steers"
        yield Finding("still", "remark", ("u",), words, {"u": middle})


def _sides(trial: Trial) -> Iterator[Finding]:
    """To which side each rudder counts as positive, judged by how the ship turns."""
    turning = signs.rate_of_turn(trial)
    for rudder in sorted(RUDDERS & trial.signals.keys()):
        if turning is None or not signs.runs_ahead(trial):
            continue
        found = signs.answer(trial, rudder, turning)
        if not found.sign:
            continue
        side = "port" if found.sign < 0 else "starboard"
        words = (
            f"{rudder} turns the ship to {side} when positive: correlation with {found.words} "
            f"{found.correlation:.2f}"
        )
        evidence = {"correlation": found.correlation}
        yield Finding("side", "remark", (rudder, "r"), words, evidence, f'positive = "{side}"')
