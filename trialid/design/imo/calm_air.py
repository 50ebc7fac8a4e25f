"""A manoeuvre as the fitted ship would have sailed it in calm air, straight ahead until its order.

On the approach a rudder holds her against the wind. In calm air the same rudder would have turned
her off her course long before the order, so the wind is taken off from the order on: she comes to
it on a straight course, at the speed she had.
"""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.measure_slopes import Shows
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
from trialid.identification.fit import Fit, of_trial
from trialid.simulation.integrate import initial
from trialid.trial import Trial


def sail_in_calm_air(
    fit: Fit, trial: Trial, windy: SailedTrial, order: float, end: int
) -> SailedTrial | None:
    """A trial up to a sample, without wind from an order on [s]; None where she cannot.

    Parameters
    ----------
    windy
        The trial as she sails it in the wind; its speed at the order is what she begins with.
    """
    k = int(order / trial.period)
    try:
        begun = _sailing(fit, trial, windy, slice(k, end))
        calm_spread = replace(windy.spread, missing=_without_wind(windy.spread))
        made = sail(fit, begun, calm_spread, len(begun.starts))
    except (EffectError, NotIdentifiable):
        return None
    if made is None:
        return None
    by = made.by[..., : windy.by.shape[-1]]
    if windy.speed_by is not None:
        by = by + made.by[..., -1:] * windy.speed_by[k]
    speed = begun.start.get("u", float(trial.signals["u"][k]) if "u" in trial.signals else 0.0)
    before = _approach(speed, begun.start["psi"], k, trial.period)
    return SailedTrial(
        track=_joined(before, made.track),
        by=np.concatenate([np.zeros((k, *by.shape[1:])), by]),
        others=tuple((_joined(before, other), columns) for other, columns in made.others),
        spread=windy.spread,
    )


def _without_wind(spread: LikelySpread) -> tuple[Shows, ...]:
    return tuple(m for m in spread.missing if not is_wind(m.effect))


def _sailing(fit: Fit, trial: Trial, windy: SailedTrial, span: slice) -> Sailing:
    """Straight ahead at the order, all that is hers as in the wind."""
    model = with_track(fit, trial)
    for effect in (e for e in model.effects if is_wind(e)):
        model = model - effect.name
    values, _ = of_trial(fit.problem, fit.theta, trial, fit.level)
    start = dict.fromkeys(model.states, 0.0) | {"psi": float(windy.track["psi"][span.start])}
    starts = {}
    if windy.speed is not None:
        start["u"] = float(windy.speed[span.start])
        starts[initial("u")] = windy.by.shape[-1]
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
