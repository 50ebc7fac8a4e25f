"""Whether a fit tells the current of a trial from what the wind drifts her.

Both carry her over the ground. A current does so on every heading alike, a wind by her side: where
the heading turns all round they differ; on a zig-zag's few headings they may not. What a record
tells is in the covariance of its fit, whatever the manoeuvre is called. That knows nothing of what
was held: a coefficient of the wind that nobody measured leads the current off, and no range tells.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.accuracy.coloured import with_priors
from trialid.accuracy.likely import WIDE, student
from trialid.accuracy.parameter_table import Accuracy
from trialid.arrays import Vector
from trialid.design.imo.sailed_trial import is_wind
from trialid.effects.track import CURRENT, current_in_speed
from trialid.identification.fit import Fit
from trialid.identification.output_error import Unknown, linearise
from trialid.ship.effect import Effect
from trialid.simulation.integrate import Departure, prepare

SHARE: Final = 0.5
"""Half of a 95 % range, as a share of both drifts together, from which on it reaches from all by
the wind to all by the current. Of 40 full turns, 20/20 and 10/10 zig-zags with a wind that was
read, each alone, 85, 95 and 57 % are told by it, 65, 80 and 8 % by half, 100, 100 and 92 % by
twice; what of 100 more holds is in `tests/benchmarks/results/wind_and_current.md`."""

SLOW: Final = 0.01
"""Share of her speed by which a current may be off all the same: over five lengths sailed, about
a turn of 180 deg, a twentieth of a length. Half of it changes none of those shares, by twice they
are 100, 100 and 62 %."""

LED: Final = 1.0
"""Standard errors by which a held coefficient of the wind may lead a current off, itself off by
what is likely: as much as noise does. By half of it 80, 92 and 55 % are told, by twice 85, 95 and
57 %. Of 40 full turns whose wind is held to grip on the wrong side of midships 35 % are told by it,
12 % by half, 85 % by twice, and 96, 100 and 94 % of what is told holds. With `C_aw` held at half
of what it is, whose ranges hold 76 % of 200 currents, 2, 0 and 18 % are told."""

SLIGHT: Final = 0.01
"""Share of her speed below which a current in that is worth no word: a diameter is 2 % off by it.
At 15 kn it is 0.08 m/s: a zig-zag of 5 deg alone reads 0.1 to 0.35 out of still water, circles
0.01."""

SURE: Final = 2.0
"""Ranges from still water from which on a current in her speed is said: of two boats without any,
whose models lacked something, it was 1.5 and 0.9. Half of it says one of them, twice neither; of
0.8 m/s it is 10 and more."""

WORDS: Final = "cannot tell wind and current apart"


def cannot_tell(fit: Fit, accuracy: Accuracy) -> tuple[str, ...]:
    """What to read beside the currents of a fit, a line at most; empty where each is told."""
    trials = [t.name for t in fit.problem.trials]
    trials = [t for t in trials if f"{CURRENT[0]} [{t}]" in {p.name for p in accuracy.parameters}]
    if not trials:
        return ()
    winds = [e for e in fit.model.effects if is_wind(e)]
    blown = {n for e in winds for n in e.parameters}
    wind = [x.name for x in fit.problem.unknowns if x.column in blown]
    if not wind:
        known = all({"V_aw", "gamma_aw"} <= {*t.signals} for t in fit.problem.trials)
        name = "apparent_wind" if known else "steady_wind"
        why = (
            "the model's wind is held: free it" if winds else f"no wind is in the model: add {name}"
        )
        return (
            f"{WORDS}: what a wind drifts her counts as current, as {why}, and sail a full turn",
        )
    led = _leading(fit, accuracy, trials, _held(fit, winds))
    if led:
        them = f"{' and '.join(led)} of the wind, held at a value"
        free = "free it" if len(led) == 1 else "free them"
        return (f"{WORDS}: {them}, may lead the current off as far as noise does: {free}",)
    said = [f"{t} ({s:.2g} +-{h:.2g} m/s)" for t, s, h in _untold(fit, accuracy, trials, wind)]
    turn = "sail a full turn in the same wind and water"
    return (f"{WORDS} in {', '.join(said)}: {turn}",) if said else ()


def in_speed(fit: Fit, accuracy: Accuracy) -> tuple[str, ...]:
    """The current that a speed over ground tells, where it is more than what nobody knows of it.

    Its ranges are the noise's: what the model lacks leads it off, and no range tells.
    """
    names = [p.name for p in accuracy.parameters]
    own = [names.index(n) for n in current_in_speed.parameters if n in names]
    if not own:
        return ()
    north, east = fit.theta[own]
    drift, half = float(np.hypot(north, east)), _half_range(accuracy, own)
    if drift < max(SURE * half, SLIGHT * fit.model.ship.particulars["U0"]):
        return ()
    to = round(float(np.rad2deg(np.arctan2(east, north)))) % 360
    turned = np.rad2deg(np.arcsin(half / drift))
    return (
        f"the fit reads a current of {drift:.2g} +-{half:.1g} m/s to {to:03d} +-{turned:.0f} deg "
        "out of the speed over ground, as far as noise tells",
    )


def _half_range(accuracy: Accuracy, own: Sequence[int]) -> float:
    """Half of the 95 % range of a current's speed, along where it is known worst [m/s]."""
    spread = accuracy.covariance[np.ix_(own, own)]
    if not np.isfinite(np.diag(spread)).all():
        return np.inf
    freedom = min(accuracy.parameters[i].freedom for i in own)
    return float(student(freedom) * np.sqrt(np.linalg.eigvalsh(spread)[-1]))


def _untold(
    fit: Fit, accuracy: Accuracy, trials: list[str], wind: list[str]
) -> Iterator[tuple[str, float, float]]:
    """Each trial whose current is not told, its speed and half the range of that [m/s]."""
    places = {p.name: i for i, p in enumerate(accuracy.parameters)}
    seen = np.isfinite(np.diag(accuracy.covariance))
    by = [places[n] for n in wind if seen[places[n]]]
    for trial in trials:
        own = [places[f"{n} [{trial}]"] for n in CURRENT]
        speed = float(np.hypot(*fit.theta[own]))
        half = _half_range(accuracy, own)
        drift = float(np.hypot(*_drift(accuracy.covariance, own, by, fit.theta[by])))
        slow = SLOW * float(fit.model.ship.particulars["U0"])
        if not half < max(SHARE * (speed + drift), slow):
            yield trial, speed, half


def _held(fit: Fit, winds: Sequence[Effect]) -> list[Unknown]:
    """The coefficients of the wind that the fit holds at a value, as unknowns."""
    free = {x.column for x in fit.problem.unknowns}
    parameters = {n: p for e in winds for n, p in e.parameters.items() if n not in free}
    return [
        Unknown(
            name=name,
            column=name,
            trial=None,
            start=fit.model.value(name),
            size=abs(p.start),
            low=p.low,
            high=p.high,
            unit=p.unit,
            kind="physical",
        )
        for name, p in parameters.items()
    ]


def _leading(
    fit: Fit, accuracy: Accuracy, trials: Sequence[str], held: Sequence[Unknown]
) -> list[str]:
    """Those of them that lead a current off, each off by as many typical sizes as is likely."""
    if not held:
        return []
    names = [p.name for p in accuracy.parameters]
    own = [names.index(f"{n} [{trial}]") for trial in trials for n in CURRENT]
    errors = np.array([accuracy.parameters[i].standard_error for i in own])
    off = WIDE * np.array([x.size for x in held]) * _moved_by(fit, held)[own]
    return [x.name for x, way in zip(held, off.T, strict=True) if np.any(abs(way) > LED * errors)]


def _moved_by(fit: Fit, held: Sequence[Unknown]) -> Vector:
    """By how much the unknowns move with what is held; (n_theta, n_held)."""
    seen = fit.examined
    problem = seen.problem
    free = [*problem.simulator.equations.free, *(x.name for x in held)]
    model, steps = problem.simulator.model, fit.settings.substeps
    wider = replace(
        problem,
        simulator=prepare(model, free, problem.outputs, substeps=steps),
        unknowns=(*problem.unknowns, *held),
    )
    point = linearise(wider, np.append(seen.theta, [x.start for x in held]))
    assert not isinstance(point, Departure)  # it is where the fit is
    known = len(seen.theta)
    sizes = np.array([x.size for x in problem.unknowns])
    A, by_held = point[1][:, :known] * sizes, point[1][:, known:]
    weighs = [seen.level / x.prior[1] if x.prior else 0.0 for x in problem.unknowns]
    narrow = np.linalg.pinv(with_priors(A, np.array(weighs) * sizes))
    return np.asarray(-sizes[:, None] * (narrow @ (narrow.T @ (A.T @ by_held))))


def _drift(covariance: Vector, own: list[int], by: list[int], wind: Vector) -> Vector:
    """By how much the current would be another were the wind's coefficients zero; (2,)."""
    return np.asarray(
        -covariance[np.ix_(own, by)] @ np.linalg.pinv(covariance[np.ix_(by, by)]) @ wind
    )
