"""Expression graph: folding, sharing, and what it refuses."""

import math

import numpy as np
import pytest

from trialid.errors import EffectError
from trialid.ship.effect import Force, Rate, effect
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship
from trialid.simulation.graph import Graph, gradient, order
from trialid.simulation.reference import evaluator
from trialid.simulation.trace import trace


def test_equal_expressions_are_one_node() -> None:
    graph = Graph()
    a, b = graph.symbol("a", True), graph.symbol("b", False)
    assert a * b + a is a + b * a
    assert (a * b).moving
    assert not (b * b).moving


def test_zeros_and_ones_vanish() -> None:
    graph = Graph()
    a = graph.symbol("a", True)
    assert a + 0.0 is a
    assert 1.0 * a is a
    assert a / 1.0 is a
    assert (0.0 * a).is_constant(0.0)
    assert (a - a).is_constant(0.0)
    assert (0.0 / a).is_constant(0.0)
    assert graph.constant(4.0).sqrt().is_constant(2.0)


def test_derivative_of_everything_at_once() -> None:
    """d/da and d/db of a^3 b / (1 + b^2), by hand."""
    graph = Graph()
    a, b = graph.symbol("a", True), graph.symbol("b", True)
    slopes = gradient(a**3 * b / (1.0 + b * b), [a, b])
    x, y = 1.7, -0.6
    run = evaluator(slopes, ("a", "b"), scalar=True)
    by_hand = (3 * x * x * y / (1 + y * y), x**3 * (1 - y * y) / (1 + y * y) ** 2)
    assert run([x, y]) == pytest.approx(by_hand, rel=1e-14)


def test_a_shared_part_is_differentiated_once() -> None:
    """Reverse mode: 20 nested squares have a gradient as long as themselves, not 2^20."""
    graph = Graph()
    a = graph.symbol("a", True)
    nested = a
    for _ in range(20):
        nested = nested * nested
    assert len(order(gradient(nested, [a]))) < 100


def made(ship: Ship, function: object) -> ShipModel:
    return ShipModel(ship, ("v", "r"), (function,), {})


def branch(v):
    """A branch on a signal."""
    return Force(Y=v if v > 0.0 else 2.0 * v)


def smaller(v):
    """Python's min."""
    return Force(Y=min(v, 0.1))


def numpy_sine(v):
    """NumPy instead of trialid.maths."""
    return Force(Y=np.sin(v))


def plain_sine(v):
    """The standard library instead of trialid.maths."""
    return Force(Y=math.sin(v))


def truth(v):
    """A signal as a condition."""
    return Force(Y=1.0 if v else 0.0)


def root(v):
    """A power that is not whole."""
    return Force(Y=v**0.5)


@pytest.mark.parametrize("function", [plain_sine, truth, root, branch, smaller, numpy_sine])
def test_what_cannot_be_differentiated_is_refused(function: object, s175q: Ship) -> None:
    with pytest.raises(EffectError, match=r"maths|whole powers"):
        trace(made(s175q, effect(source="test")(function)), (), ("v",))


def test_a_signal_in_numpy_arithmetic_stays_a_signal(s175q: Ship) -> None:
    def scaled(v):
        """NumPy scalars and arrays of one are numbers too."""
        return Force(Y=np.float64(2.0) * v - v / np.float64(3.0))

    model = made(s175q, effect(source="test")(scaled))
    assert trace(model, (), ("v",)).states == ("v", "r")


def test_a_primed_effect_cannot_have_a_state_of_its_own() -> None:
    """Its rate would be SI and its signals primed: two systems in one function."""
    with pytest.raises(EffectError, match=r"'late'.*SI"):

        @effect(source="test", states={"lift": None})
        def late(delta, lift, *, a=-0.003):
            """Y = a lift, lift follows delta."""
            return Force(Y=a * lift), Rate(lift=delta - lift)


def test_a_rate_of_an_undeclared_state_is_refused() -> None:
    with pytest.raises(EffectError, match="delta"):

        @effect(source="test")
        def forgotten(delta_order, delta):
            """The rudder follows, but states={...} is missing."""
            return Rate(delta=delta_order - delta)
