"""Sensitivities that come part by part are those of the whole response."""

import tracemalloc
from collections.abc import Callable

import numpy as np
import pytest

from trialid.effects import CATALOGUE
from trialid.ship.model import ShipModel
from trialid.simulation import by_parts
from trialid.simulation.integrate import Response, Simulator, prepare, respond
from trialid.trial import Trial

OUTPUTS = ("u", "v", "p", "r", "phi")
START = {"u": 7.2, "v": 0.1, "p": 0.01, "r": 0.002, "phi": 0.02}


def together(simulator: Simulator, trial: Trial) -> tuple[Response, np.ndarray, int]:
    """The response, its sensitivities put together from their parts, and how many these were."""
    found = np.full((trial.samples, len(OUTPUTS), len(simulator.columns)), np.nan)
    given = [0]

    def take(samples: slice, slopes: np.ndarray) -> None:
        assert samples.start == given[-1]
        given.append(samples.stop)
        found[samples] = slopes

    response, added = by_parts.respond_by_parts(simulator, trial, values(simulator), START, take)
    for c, i, more in added:
        found[:, c, i] += more
    return response, found, len(given) - 1


def values(simulator: Simulator) -> dict[str, float]:
    return {n: simulator.model.value(n) for n in simulator.equations.free}


@pytest.mark.parametrize(
    ("late", "more"),
    [
        ({}, ()),  # 0.7 s and -0.4 s
        ({"tau_r": 0.0, "tau_phi": 0.0}, ()),
        ({"tau_r": 2.6, "tau_phi": -2.9}, ()),
        ({"tau_r": 2.6, "tau_phi": 1.0}, ("clock_drift_phi", "lag_r", "lag_p")),
    ],
)
def test_parts_do_not_show(
    late: dict[str, float],
    more: tuple[str, ...],
    everything: ShipModel,
    lively: Callable[..., Trial],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    model = everything.with_values(late)
    for name in more:
        model = (model + CATALOGUE[name]).with_values(
            dict.fromkeys(CATALOGUE[name].parameters, 0.0)
        )
    trial = lively(samples=100)
    simulator = prepare(model, tuple(model.parameters), OUTPUTS)
    monkeypatch.setattr(by_parts, "NUMBERS", 5 * len(simulator.columns) * 11)
    response, slopes, parts = together(simulator, trial)
    told = respond(simulator, trial, values(simulator), START)
    assert parts > 5
    np.testing.assert_array_equal(response.states, told.states)
    np.testing.assert_array_equal(response.y, told.y)
    np.testing.assert_allclose(slopes, told.S, rtol=1e-13, atol=1e-13)


def test_a_slow_output_comes_whole(everything: ShipModel, lively: Callable[..., Trial]) -> None:
    effect = CATALOGUE["lag_r"]
    model = (everything + effect).with_values(dict.fromkeys(effect.parameters, 0.8))
    trial = lively(samples=100)
    simulator = prepare(model, tuple(model.parameters), OUTPUTS)
    _, slopes, parts = together(simulator, trial)
    assert parts == 1
    np.testing.assert_array_equal(slopes, respond(simulator, trial, values(simulator), START).S)


def test_a_departure_is_told_and_nothing_given_from_there_on(
    everything: ShipModel, lively: Callable[..., Trial], monkeypatch: pytest.MonkeyPatch
) -> None:
    model = everything.with_values({"tau_r": 0.0, "tau_phi": 0.0, "Nr": 0.05})
    simulator = prepare(model, tuple(model.parameters), OUTPUTS)
    trial = lively(samples=100)
    told = respond(simulator, trial, values(simulator), START)
    assert told.departure is not None
    monkeypatch.setattr(by_parts, "NUMBERS", 1)
    response, slopes, _ = together(simulator, trial)
    assert response.departure == told.departure
    assert np.isnan(slopes[int(told.departure.t) :]).all()


def test_the_sensitivities_of_a_long_record_are_never_held_whole(
    everything: ShipModel, lively: Callable[..., Trial], monkeypatch: pytest.MonkeyPatch
) -> None:
    trial = lively(samples=20_000, period=0.1)
    simulator = prepare(everything, tuple(everything.parameters), OUTPUTS)
    monkeypatch.setattr(by_parts, "NUMBERS", 1 << 16)
    given = []
    tracemalloc.start()
    by_parts.respond_by_parts(
        simulator, trial, values(simulator), START, lambda samples, slopes: given.append(samples)
    )
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert given[-1].stop == trial.samples
    assert peak < 0.3 * 8 * trial.samples * len(OUTPUTS) * len(simulator.columns)
