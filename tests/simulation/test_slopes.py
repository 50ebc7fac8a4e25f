"""Derivatives against differences: of every function, of a low-pass, of a delay in a simulation."""

import numpy as np
import pytest
from s175q import MODEL, zigzag

from trialid import maths
from trialid.effects import CATALOGUE
from trialid.simulation.delay import lag_samples
from trialid.simulation.graph import Graph, gradient
from trialid.simulation.integrate import prepare, respond
from trialid.simulation.reference import evaluator

FUNCTIONS = {
    "sin": maths.sin,
    "cos": maths.cos,
    "sqrt": maths.sqrt,
    "exp": maths.exp,
    "tanh": maths.tanh,
    "arctan": maths.arctan,
    "abs": abs,
    "quotient": lambda x: (x + 1.0) / (x * x),
    "power": lambda x: x**3,
    "difference": lambda x: x * x - 2.0 * x,
    "inverse": lambda x: 3.0 / x,
    "held": lambda x: maths.clip(x, 0.5),
}


@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("at", [0.3, 0.8, 1.7])
def test_the_slope_of_a_function_is_that_of_its_values(name, at):
    graph = Graph()
    x = graph.symbol("x", True)
    node = FUNCTIONS[name](x)
    [slope] = gradient(node, [x])
    value, found = evaluator([node, slope], ["x"], scalar=True)([at])
    there, back = (float(FUNCTIONS[name](at + s * 1e-6)) for s in (1, -1))
    assert value == pytest.approx(float(FUNCTIONS[name](at)))
    assert found == pytest.approx((there - back) / 2e-6, rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("tau", [0.2, 1.0, 7.0])
@pytest.mark.parametrize("period", [0.1, 0.5, 1.0])
def test_the_slope_of_a_low_pass_by_its_time_constant(tau, period):
    y = np.sin(np.arange(300) * period * 0.7) + 0.01 * np.arange(300)
    _, slope = lag_samples(y, tau, period)
    there, back = (lag_samples(y, tau + s * 1e-5, period)[0] for s in (1, -1))
    np.testing.assert_allclose(slope, (there - back) / 2e-5, atol=1e-6)


@pytest.mark.parametrize(
    ("effect", "parameter", "at"),
    [
        ("delay_r", "tau_r", 0.6),
        ("lag_r", "T_r", 1.5),
        ("lag_twice_r", "T_rr", 0.8),
        ("clock_drift_r", "drift_r", 1e-3),
        ("bias_r", "b_r", 1e-3),
    ],
)
def test_what_a_sensor_does_to_a_record_by_its_parameter(effect, parameter, at):
    """At two samples a second, so that a sample is no second."""
    model = MODEL + CATALOGUE[effect]
    simulator = prepare(model, (parameter,), ("r", "phi"))
    trial = zigzag(10)

    def seen(value):
        return respond(simulator, trial, {parameter: value}, {})

    step = 1e-4 * max(at, 1e-2)
    there, back = (seen(at + s * step).y for s in (1, -1))
    found = seen(at).S[:, :, simulator.columns.index(parameter)]
    expected = (there - back) / (2.0 * step)
    assert np.abs(expected[:, 0]).max() > 0.0
    np.testing.assert_allclose(found, expected, atol=2e-4 * np.abs(expected).max())
