"""Traces of effects that are not linear at their null: values are tried, differences taken."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from itertools import product

import numpy as np
from numpy.typing import NDArray

from trialid.identification.fit import Fit
from trialid.identification.output_error import Problem, respond_all, row_scale, stretches
from trialid.ship.effect import Effect, Rate
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import Departure, Response, Simulator, prepare, respond
from trialid.trial import Trial

Vector = NDArray[np.float64]


def combinations(effect: Effect) -> Iterator[dict[str, float]]:
    """Every combination of the values to try; what only shapes the effect stays typical."""
    names = list(effect.parameters)
    grids = [p.scan or (p.start,) for p in effect.parameters.values()]
    for values in product(*grids):
        yield dict(zip(names, values, strict=True))


def secants(
    fit: Fit, base: ShipModel, effect: Effect
) -> Iterator[tuple[Mapping[str, float], Vector]]:
    """Each combination of values, and the normed difference that the effect then makes; (M,)."""
    problem = fit.problem
    plain = respond_all(problem, fit.theta, sensitivities=False)
    lost = base.lost_to(effect)
    theta = fit.theta[[x.column not in lost for x in problem.unknowns]]
    for values, changed in _changed(problem, base, effect):
        responses = respond_all(changed, theta, sensitivities=False)
        if not (isinstance(plain, Departure) or isinstance(responses, Departure)):
            yield values, _difference(problem, plain, responses)


def _difference(problem: Problem, plain: list[Response], changed: list[Response]) -> Vector:
    scale = row_scale(problem)
    return np.concatenate([
        s.taken(changed[s.trial].y[:, s.output] - plain[s.trial].y[:, s.output])
        * scale[s.output]
        for s in stretches(problem)
    ])  # fmt: skip


def _changed(
    problem: Problem, base: ShipModel, effect: Effect
) -> Iterator[tuple[Mapping[str, float], Problem]]:
    """The problem with the effect at work, for each combination of values."""
    if effect.forms == (Rate,) and "delta" in effect.states and not base.displaced_by(effect):
        gear = prepare(ShipModel(base.ship, (), (effect,)), tuple(effect.parameters), ("delta",))
        for values in combinations(effect):
            trials = tuple(_steered(gear, values, t) for t in problem.trials)
            yield values, replace(problem, trials=trials)
        return
    model, simulator = base + effect, problem.simulator
    lost = base.lost_to(effect)
    free = tuple(n for n in simulator.equations.free if n not in lost)
    unknowns = tuple(x for x in problem.unknowns if x.column not in lost)
    typical = {n: p.start for n, p in effect.parameters.items()}  # a zero would be folded away
    made = prepare(model.with_values(typical), free, problem.outputs, "compiled",
                   simulator.substeps)  # fmt: skip
    for values in combinations(effect):
        fixed = replace(made, model=model.with_values(values))
        yield values, replace(problem, simulator=fixed, unknowns=unknowns)


def _steered(gear: Simulator, values: Mapping[str, float], trial: Trial) -> Trial:
    """The trial with the rudder as the gear would have moved it: the ship need not be compiled."""
    delta = respond(gear, trial, values, {}, sensitivities=False).y[:, 0]
    return replace(trial, signals={**trial.signals, "delta": delta})
