"""Whether the fitted ship is the one of her file, by the coefficients that both give."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.fit import Fit
from trialid.identification.one_search import search
from trialid.identification.output_error import Unknown, ranges
from trialid.identification.trial_score import Score
from trialid.least_squares.fold import triangle
from trialid.simulation.integrate import inputs
from trialid.simulation.reference import evaluator

Vector = NDArray[np.float64]

OFF: Final = 2.0
"""Factor by which a coefficient is another ship's: published sets of one hull differ by 1.3."""

CLEARLY: Final = 3.0
"""Standard errors by which it must be off as well: weakly seen ones are far off by themselves."""

FEWEST: Final = 3
LEAVES: Final = 2.0
"""Times the fit's error that the ship of a file which is not hers leaves at her best. Of 20 fits of
drawn ships by their own files, of a structure that no model here has, the most is 1.3; of 28 by
files of ships at least twice or half as long 23 leave more than 2.0, and 17 more than twice that.
"""
STEERS: Final = "Ndelta"
"""What a missing effect moves least: the yaw acceleration with which she answers her rudder."""
SMALL: Final = float(np.deg2rad(1.0))
"""[rad] Rudder to either side by which what it does is told."""
PLACEHOLDER: Final = "PLACEHOLDER"
"""How the source of a ship file begins that says itself that it is not hers."""


def unlike_file(fit: Fit) -> tuple[dict[str, float], int]:
    """Fitted coefficients clearly unlike the ship file's, over the file's; and how many compare.

    Those whose start the user states differently are not compared, nor is a placeholder. What the
    file says of its own scatter counts: an estimate is not another ship's for being as far off.
    """
    errors = dict(zip((x.name for x in fit.problem.unknowns), _standard_errors(fit), strict=True))
    compared, found = _compared(fit), dict[str, float]()
    for name, (stated, scatter) in compared.items():
        value = fit.value(name)
        clearly = CLEARLY * float(np.hypot(errors[name], scatter))
        if not 1.0 / OFF < value / stated < OFF and abs(value - stated) > clearly:
            found[name] = value / stated
    return found, len(compared)


def _compared(fit: Fit) -> dict[str, tuple[float, float]]:
    """The coefficients that the file gives and the search had, with the file's scatter."""
    model = fit.problem.simulator.model
    if model.ship.source.startswith(PLACEHOLDER):
        return {}
    plain, said = replace(model, values={}), model.ship.uncertainty
    usual = said.get("default", 0.0)
    stated = {x.name: plain.stated(x.name) for x in fit.problem.unknowns if x.kind == "physical"}
    return {
        n: (value, said.get(n, usual) * abs(value))
        for n, value in stated.items()
        if value and model.values.get(n, value) == value
    }


def most_are_unlike(fit: Fit) -> str:
    """That half of what can be compared, and three, are clearly unlike the file's; else empty.

    A quarter would call a ship with one missing effect another, all of them none.
    """
    found, compared = unlike_file(fit)
    if len(found) < FEWEST or 2 * len(found) < compared:
        return ""
    return (
        f"{len(found)} of {compared} fitted coefficients are less than half or more than twice "
        f"the file's ({_listed(found)} times)"
    )


def _listed(found: Mapping[str, float]) -> str:
    return ", ".join(f"{n} {x:.2g}" for n, x in list(found.items())[:4])


def unlike_words(fit: Fit) -> str:
    """What of the fitted ship is not the file's: how she answers her rudder, or most of her.

    The rudder is enough: of a linear model fitted to one zig-zag by her own file, with much of the
    ship not in it, 46 of 194 have most coefficients unlike it and none near it that does as well,
    and five have her rudder so. Of another's file the rudder is, where drift and turning are told
    too badly to be clearly unlike.
    """
    compared = _compared(fit)
    if STEERS not in compared:
        return most_are_unlike(fit)
    low, high = _allowed(*compared[STEERS])
    if low <= fit.value(STEERS) <= high:
        return most_are_unlike(fit)
    others = {n: x for n, x in unlike_file(fit)[0].items() if n != STEERS}
    more = f" ({_listed(others)} times)" if others else ""
    return f"{STEERS} is {fit.value(STEERS) / compared[STEERS][0]:.2g} times the file's{more}"


def left_by_file(fit: Fit) -> float | None:
    """How many times the fit's error the ship of her file leaves; None where hers is the fit's.

    Coefficients unlike the file's do not make her another: where drift and rate of turn go together
    a model that lacks something is fitted by sway coefficients that are not hers, and others do
    nearly as well. So the search is made again with every coefficient kept where it is not unlike,
    and with sensors, clocks and water not unlike the fit's: else a delay of 2 s, or a current of
    2 m/s in a speed over ground, would do for another ship's hull.
    """
    if not unlike_words(fit):
        return None
    left = float(np.sqrt(min(_least(fit, fit.theta), _least(fit, fit.problem.start)) / fit.V))
    return left if left >= LEAVES else None


def _least(fit: Fit, start: Vector) -> float:
    """What a search from there leaves near the file: V, with its nuisances held after without."""
    of_file = _as_in_file(fit)
    free = (
        x if x.kind == "physical" else y for x, y in zip(of_file, fit.problem.unknowns, strict=True)
    )
    for unknowns in (tuple(free), of_file):
        _, low, high = ranges(unknowns)
        problem = replace(fit.problem, unknowns=unknowns)
        end = search(problem, fit.settings, np.clip(start, low, high))
        start = end.minimum.theta
    return end.V


def steers_backwards(fit: Fit) -> bool:
    """Whether the rudder as fitted clearly turns her to the other side than in her file.

    Which side is the file's `rudder_positive`, of a placeholder too; a model that lacks something
    may follow a turn by a ship that is unstable and held by her rudder. Of the real turn where this
    was found it is 4.8 standard errors: half of `CLEARLY` finds it too, twice does not. Beside a
    race that grips the rudder the coefficient may be of either sign: of an outboard, whose push is
    turned, it was, and by all that goes by the rudder together she turned as she should.
    """
    names = [x.name for x in fit.problem.unknowns]
    if STEERS not in names:
        return False
    model = fit.problem.simulator.model
    value, stated = fit.value(STEERS), replace(model, values={}).stated(STEERS)
    error = float(_standard_errors(fit)[names.index(STEERS)])
    if value * (stated or 0.0) >= 0.0 or abs(value) <= CLEARLY * error:
        return False
    return value * turned_by_rudder(fit) >= 0.0


def turned_by_rudder(fit: Fit) -> float:
    """Yaw acceleration by a radian of rudder [rad/s^2], on average along the fitted trials.

    Of all forces and of what the water adds: a side force turns her as well where sway and yaw are
    coupled. An outsider's boat, whose Ndelta alone pointed the wrong way, turned as she should.
    """
    fitted = [s for s in fit.scores if s.trial.use == "fit"]
    over = [_turning(fit, i, s, SMALL) - _turning(fit, i, s, -SMALL) for i, s in enumerate(fitted)]
    return float(np.mean([np.nanmean(one) for one in over])) / (2.0 * SMALL)


def _turning(fit: Fit, place: int, score: Score, off: float) -> Vector:
    """Yaw acceleration at each sample of a fitted trial, the rudder off by so much; (N,)."""
    simulator = fit.problem.simulator
    equations = simulator.equations
    values = {**simulator.fixed, **fit.problem.values(fit.theta, place)}
    names = (*equations.states, *equations.inputs)
    moving = np.hstack([score.response.states, inputs(simulator, score.trial, values)])
    moving[:, [n == "delta" for n in names]] += off
    known = [np.full(len(moving), values[n]) for n in equations.parameters]
    acceleration = [equations.f[equations.states.index("r")]]
    run = evaluator(acceleration, (*names, *equations.parameters), scalar=False)
    return np.asarray(run([*moving.T, *known])[0])


def _as_in_file(fit: Fit) -> tuple[Unknown, ...]:
    """The unknowns: coefficients and nuisances within what is not unlike the file's and the fit's.

    How each trial begins is free.
    """
    compared, errors = _compared(fit), CLEARLY * _standard_errors(fit)
    return tuple(
        _between(x, *_allowed(*compared[x.name]))
        if x.name in compared
        else _between(x, value - error, value + error)
        if x.kind == "nuisance" and not x.column.endswith("(0)")
        else x
        for x, value, error in zip(fit.problem.unknowns, fit.theta, errors, strict=True)
    )


def _allowed(stated: float, scatter: float) -> tuple[float, float]:
    """Least and greatest that is not unlike the file's."""
    far = CLEARLY * scatter
    ends = (stated / OFF, stated * OFF, stated - far, stated + far)
    return min(ends), max(ends)


def _between(x: Unknown, low: float, high: float) -> Unknown:
    return replace(x, low=max(x.low, low), high=min(x.high, high))


def _standard_errors(fit: Fit) -> Vector:
    """By the level of the error with its colour, priors counted; (n_theta,)."""
    seen = fit.examined
    held = [seen.level / x.prior[1] if x.prior else 0.0 for x in fit.problem.unknowns]
    rows = np.concatenate([triangle(seen.psi), np.diag(held)])
    sizes = np.maximum(np.linalg.norm(rows, axis=0), 1e-300)
    R = np.linalg.qr(rows / sizes, mode="r")
    return np.asarray(seen.level * np.linalg.norm(np.linalg.pinv(R), axis=1) / sizes)
