"""A ship stated right whose trial begins wrong: her own start is found before anything else is."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from s175q import GYRO, MODEL, SHIP, zigzag

from trialid.effects import CATALOGUE
from trialid.identification.adequacy import _no_such_inertia
from trialid.identification.arrive import _by_ship
from trialid.identification.one_search import cost_at, search
from trialid.identification.problem import Settings, pose_problem
from trialid.identification.record_starts import MANY, SHORTEST, in_pieces, with_own_starts
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond

FREE = ("Yv", "Yr", "Nv", "Nr", "Ydelta", "Ndelta")
SETTINGS = Settings(FREE, ("r",), nuisance=("initial_state",))
WINDOW = slice(300, 1200)
"""Begins in a turn: the log has no v, so the stated start takes her for going straight ahead."""


def unstable():
    parts = (CATALOGUE["linear_hull"], CATALOGUE["linear_rudder"])
    return ShipModel(SHIP, ("v", "r"), parts).with_values({"Nv": -0.009})


@pytest.fixture(scope="module")
def problem():
    """The truth's own numbers as the stated ones, on her record from the middle of a zig-zag."""
    blank = zigzag(20)
    whole = respond(prepare(unstable(), (), ("r",)), blank, {}, {"u": 7.33}, sensitivities=False)
    noise = GYRO * np.random.default_rng(3).standard_normal(WINDOW.stop - WINDOW.start)
    signals = {"delta": blank.signals["delta"][WINDOW], "r": whole.y[WINDOW, 0] + noise}
    valid = {n: blank.valid[n][WINDOW] for n in signals}
    return pose_problem([replace(blank, signals=signals, valid=valid)], unstable(), SETTINGS)


def cost(problem, theta):
    return cost_at(problem, SETTINGS, theta, 1.0)


def test_the_ship_is_held_and_what_is_the_trials_own_is_found(problem):
    own = with_own_starts(problem)
    of_the_ship = np.array([x.trial is None for x in problem.unknowns])
    assert np.array_equal(own[of_the_ship], problem.start[of_the_ship])
    arrived = search(problem, SETTINGS, problem.start)
    missed = cost(problem, problem.start) - arrived.cost(1.0)
    assert cost(problem, own) - arrived.cost(1.0) < 0.05 * missed


def test_a_search_that_left_the_stated_ship_for_worse_begins_there_again(problem):
    lost = search(problem, SETTINGS, problem.start, max_iterations=1)
    ends, words = _by_ship(problem, SETTINGS, [lost], lambda iteration: None)
    assert ends[0].minimum.converged
    assert ends[0].cost(1.0) < lost.cost(1.0) - 10.0
    assert "the ship as stated" in words[0]


def test_a_search_that_arrived_does_not(problem):
    arrived = search(problem, SETTINGS, problem.start)
    assert _by_ship(problem, SETTINGS, [arrived], lambda iteration: None) == ([], [])


def test_pieces_hold_more_than_a_delay_may_spoil():
    """At 20 Hz a delay within 3 s spoils 63 samples at either end, and no piece had any left."""
    blank = replace(zigzag(20), period=0.05)
    signals = {"delta": blank.signals["delta"], "r": np.sin(0.1 * blank.t)}
    trial = replace(blank, signals=signals, valid={n: blank.valid[n] for n in signals})
    asked = replace(SETTINGS, nuisance=("initial_state", "delay"))
    whole = pose_problem([trial], unstable(), asked)
    cut = in_pieces(whole, asked, MANY, {})
    assert len(cut.trials) > 4
    assert min(int(one.sum()) for one in cut.compared) >= SHORTEST


@pytest.mark.parametrize("share", [0.25, 0.9])
def test_a_ship_with_the_inertia_of_a_longer_one_is_no_fit(share: float) -> None:
    """Of a ferry whose pods were logged the wrong way round it was 1.5e8, and no word said."""
    mass = MODEL.value("m")
    free = SimpleNamespace(unknowns=(SimpleNamespace(name="I_zz"),))
    held = SimpleNamespace(unknowns=())

    def fit(times: float, problem: Any) -> Any:
        model = MODEL.with_values({"I_zz": times * share * mass})
        return SimpleNamespace(model=model, problem=problem)

    assert _no_such_inertia(fit(1.0, free)) is None
    assert _no_such_inertia(fit(1e4, held)) is None  # as stated: the file's, and not the fit's
    found = _no_such_inertia(fit(10.0, free))
    assert found is not None
    assert f"I_zz = {10 * share:.2g} m L^2, and 0.25 with all" in found.reason
