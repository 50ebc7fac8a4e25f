"""A manoeuvre as the fitted ship would have sailed it, from its order on: in the wind, and in calm.

On the approach a rudder holds her against the wind. In calm air the same rudder would have turned
her off her course long before the order, so the wind is taken off from the order on: she comes to
it on a straight course, at the speed she had. What speeds and rate of turn the record has there is
where she begins: minutes of approach have led the model elsewhere.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.measure_slopes import Shows
from trialid.design.imo.recognise import samples_a_length
from trialid.design.imo.sailed_trial import (
    PLACE,
    SailedTrial,
    Sailing,
    Track,
    is_wind,
    sail,
    with_track,
)
from trialid.design.prediction.likely_spread import LikelySpread
from trialid.errors import EffectError, NotIdentifiable
from trialid.identification.fit import Fit
from trialid.identification.trial_score import of_trial
from trialid.simulation.integrate import initial
from trialid.trial import Trial
from trialid.white_noise import white_noise

MOTION: Final[tuple[str, ...]] = ("u", "v", "p", "r", "phi", "psi")


@dataclass(frozen=True)
class Motion:
    """How she moves at an order: by state, and the standard deviation of what noise left of it."""

    values: Mapping[str, float]
    noise: Mapping[str, float]


@dataclass(frozen=True)
class FromOrder:
    """A manoeuvre from its order on, in the wind as it blew, and without."""

    windy: SailedTrial
    calm: SailedTrial


def sail_from_order(
    fit: Fit, trial: Trial, windy: SailedTrial, order: float, end: int
) -> FromOrder | None:
    """A trial up to a sample, from an order on [s]; None where she cannot.

    Parameters
    ----------
    windy
        The trial from its beginning; its speed at the order is what she begins with where the fit
        compared none.
    """
    span = slice(int(order / trial.period), end)
    motion = _motion_at(fit, trial, span.start)
    try:
        blown, calm = (_sail_on(fit, trial, windy, span, motion, still) for still in (False, True))
    except (EffectError, NotIdentifiable):
        return None
    return None if blown is None or calm is None else FromOrder(blown, calm)


def _motion_at(fit: Fit, trial: Trial, k: int) -> Motion:
    """Speeds, rate and heading at a sample: the model's, by as much off as it was just before.

    Just before is half a ship length of way: a mean over it takes off noise. The heading counts
    from the course, a mean over the whole length, which has the same noise in that half.
    """
    [score] = [s for s in fit.scores if s.trial.name == trial.name]
    size, states = fit.model.ship.particulars, fit.problem.simulator.model.all_states
    length = samples_a_length(trial, size["L"], size["U0"])
    before = slice(max(k + 1 - length // 2, 0), k + 1)
    values = {n: float(score.response.states[k, states.index(n)]) for n in MOTION if n in states}
    noise = {}
    for place, name in enumerate(fit.problem.outputs):
        known = score.compared[before, place]
        if name in values and known.any():
            off = trial.signals[name][before] - score.response.y[before, place]
            values[name] += float(np.mean(off[known]))
            means = 1.0 / np.sum(known) - (1.0 / (length + 1) if name == "psi" else 0.0)
            noise[name] = white_noise(trial.signals[name]) * float(np.sqrt(max(means, 0.0)))
    return Motion(values, noise)


def _sail_on(
    fit: Fit,
    trial: Trial,
    windy: SailedTrial,
    span: slice,
    motion: Motion,
    calm: bool,
) -> SailedTrial | None:
    """On from the order."""
    begun = _sailing(fit, trial, windy, span, motion, calm)
    missing = _without_wind(windy.spread) if calm else windy.spread.missing
    made = sail(fit, begun, replace(windy.spread, missing=missing), len(begun.starts))
    if made is None:
        return None
    k, speed_at = span.start, begun.starts.get(initial("u"))
    by = made.by[..., : windy.by.shape[-1]]
    if speed_at is not None and windy.speed_by is not None and "u" not in motion.noise:
        by = by + made.by[..., speed_at, None] * windy.speed_by[k]
    turned = {*MOTION} - {"u"} if calm else set()  # there she is straight on her course, whatever
    noise = [
        made.by[..., begun.starts[initial(n)]] * (0.0 if n in turned else x)
        for n, x in motion.noise.items()
    ]
    speed = begun.start.get("u", float(trial.signals["u"][k]) if "u" in trial.signals else 0.0)
    before = _approach(speed, begun.start["psi"], k, trial.period)
    if not calm:  # held on her course against the wind, she is not on it all the time
        own = trial.signals if "psi" in fit.problem.outputs else windy.track
        before["psi"] = own["psi"][:k]
    return SailedTrial(
        track=_joined(before, made.track),
        by=_begun_late(by, k),
        others=tuple((_joined(before, other), columns) for other, columns in made.others),
        spread=windy.spread,
        noise=_begun_late(np.stack(noise, axis=-1), k) if noise else None,
    )


def _begun_late(by: Vector, k: int) -> Vector:
    """Slopes with none before a sample."""
    return np.concatenate([np.zeros((k, *by.shape[1:])), by])


def _without_wind(spread: LikelySpread) -> tuple[Shows, ...]:
    return tuple(m for m in spread.missing if not is_wind(m.effect))


def _sailing(
    fit: Fit,
    trial: Trial,
    windy: SailedTrial,
    span: slice,
    motion: Motion,
    calm: bool,
) -> Sailing:
    """What she is and how she moves at the order; in calm air straight ahead."""
    model = with_track(fit, trial)
    for effect in (e for e in model.effects if calm and is_wind(e)):
        model = model - effect.name
    values, _ = of_trial(fit, trial)
    begun = {"psi": float(windy.track["psi"][span.start]), **motion.values}
    kept = {n: x for n, x in begun.items() if n in ("u", "psi") or not calm}
    start = dict.fromkeys(model.states, 0.0) | kept
    wanted = [*motion.noise]
    if windy.speed is not None and "u" not in motion.noise:
        wanted.append("u")
    starts = {initial(n): windy.by.shape[-1] + i for i, n in enumerate(wanted)}
    part = replace(
        trial,
        signals={n: x[span] for n, x in trial.signals.items()},
        valid={n: x[span] for n, x in trial.valid.items()},
    )
    return Sailing(model=model, trial=part, values=values, start=start, starts=starts)


def _approach(speed: float, course: float, samples: int, period: float) -> dict[str, Vector]:
    """The straight way up to the order, which is at 0, 0."""
    run = speed * period * np.arange(-samples, 0)
    return {
        "psi": np.full(samples, course),
        "x": run * np.cos(course),
        "y": run * np.sin(course),
    }


def _joined(before: Mapping[str, Vector], track: Track) -> dict[str, Vector]:
    return {n: np.concatenate([before[n], track[n]]) for n in PLACE}
