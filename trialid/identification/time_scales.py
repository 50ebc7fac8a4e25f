"""How slow a fitted ship's slowest motion is, from her equations on a straight course."""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.fit import Fit
from trialid.identification.nuisance.priors import speed
from trialid.names.quantities import POSITION
from trialid.simulation.integrate import arguments

Vector = NDArray[np.float64]

LONGEST: Final = 3.0
"""Ship lengths sailed beyond which no time scale is asked for: a ship that is hardly stable on a
straight course never settles by herself, but a manoeuvre shows her damping all the same."""

NEUTRAL: Final = ("psi", *POSITION)
"""States that nothing brings back: no motion of their own."""

NUDGE: Final = 1e-5
STRAIGHT: Final = ("v", "p", "r", "phi", "psi", "delta", "delta_order")


@dataclass(frozen=True)
class Motion:
    """A motion of the ship's own: seconds until it has fallen to 1/e, or for half a swing."""

    seconds: float
    words: str


def longest_by_its_clock(fit: Fit) -> tuple[float, Motion] | None:
    """How long the fitted trial lasts [s] that holds its slowest motion most often, and that one.

    Each trial has a clock of its own: of a turning circle, which halves her speed, all takes twice
    as long as of a zig-zag.
    """
    each = [(t.duration, slowest_motion(fit, i)) for i, t in enumerate(fit.problem.trials)]
    known = [(lasts, slow) for lasts, slow in each if slow is not None]
    return max(known, key=lambda one: one[0] / one[1].seconds, default=None)


def slowest_motion(fit: Fit, place: int) -> Motion | None:
    """The slowest motion of the fitted ship at the speed of the fitted trial at this place.

    None where nothing is simulated or nothing settles.
    """
    model, trial = fit.model, fit.problem.trials[place]
    step = _one_sample(fit, place)
    if step is None:
        return None
    with np.errstate(divide="ignore"):
        rates = np.log(np.linalg.eigvals(step).astype(complex)) / trial.period
    rates = rates[np.isfinite(rates) & (np.abs(rates) > 1e-9)]
    longest = LONGEST * model.ship.particulars["L"] / speed(model, trial)
    motions = [_motion(rate, longest) for rate in rates]
    return max(motions, key=lambda m: m.seconds, default=None)


def _motion(rate: complex, longest: float) -> Motion:
    if abs(rate.imag) > abs(rate.real):
        half = float(np.pi / abs(rate))
        return Motion(min(half, longest), "half a swing of the slowest oscillation")
    lag = float(1.0 / abs(rate))
    if lag > longest:
        return Motion(longest, f"sailing {LONGEST:g} ship lengths")
    return Motion(lag, "the slowest motion of the fitted ship")


def _one_sample(fit: Fit, place: int) -> Vector | None:
    """Derivative of the states after one sample by those before, near a straight course; (n, n)."""
    simulator, trial = fit.problem.simulator, fit.problem.trials[place]
    states = simulator.equations.states
    moving = [i for i, s in enumerate(states) if s not in NEUTRAL]
    if not moving:
        return None
    theta, x0, u, limit = arguments(simulator, trial, fit.problem.values(fit.theta, place), {})
    straight = np.array([0.0 if s in STRAIGHT else x for s, x in zip(states, x0, strict=True)])
    steady = np.median(u, axis=0)
    steady[[i for i, n in enumerate(simulator.equations.inputs) if n in STRAIGHT]] = 0.0
    inputs = np.tile(steady, (2, 1))
    ends = []
    for i in (None, *moving):
        begin = straight.copy()
        if i is not None:
            begin[i] += NUDGE
        X, left = simulator.engine.simulate(
            theta, begin, inputs, limit, trial.period, simulator.substeps
        )
        if left or not np.isfinite(X).all():
            return None
        ends.append(X[1][moving])
    return np.asarray((np.array(ends[1:]) - ends[0]).T / NUDGE)
