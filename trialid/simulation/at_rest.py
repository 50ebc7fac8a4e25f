"""Every effect must be a number, and have a slope, on a ship that goes straight ahead.

Every trial begins there, or passes through: what divides by the sway speed gives no number then.
"""

import math
from collections.abc import Iterable

from trialid.errors import EffectError
from trialid.ship.effect import Effect, Force, Result
from trialid.ship.model import ShipModel
from trialid.simulation.graph import Graph, Node, gradient, lift
from trialid.simulation.reference import evaluator


def check_at_rest(model: ShipModel) -> None:
    """Nothing, where every effect and its slopes are finite on a straight course.

    Raises
    ------
    EffectError
        One is not, as v / |v| or sqrt(v); the message names it.
    """
    particulars = model.ship.particulars
    straight = {"u": particulars["U0"], "U": particulars["U0"], "n": 1.0, **particulars}
    for effect in model.effects:
        values = {s: straight.get(s, 0.0) for s in effect.signals}
        values |= {n: p.start for n, p in effect.parameters.items()}
        if not all(map(math.isfinite, _with_slopes(effect, values))):
            still = ", ".join(s for s in effect.signals if values[s] == 0.0)
            raise EffectError(
                f"{effect.place} is no number at rest, where {still} is 0, or has no slope there; "
                "write it without dividing by what may be 0, or add a small number"
            )


def _with_slopes(effect: Effect, values: dict[str, float]) -> Iterable[float]:
    graph = Graph()
    symbols = {name: graph.symbol(name, True) for name in values}
    nodes = [lift(graph, x) for part in effect(symbols) for x in _numbers(part)]
    slopes = [d for n in nodes for d in gradient(n, [symbols[s] for s in effect.signals])]
    try:
        found: Iterable[float] = evaluator([*nodes, *slopes], list(values), scalar=True)(
            list(values.values())
        )
    except (ZeroDivisionError, OverflowError):
        return [math.nan]
    return found


def _numbers(part: Result) -> Iterable[Node]:
    return part if isinstance(part, Force) else part.values()
