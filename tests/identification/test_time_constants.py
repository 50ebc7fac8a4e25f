"""A gear is no quicker than half an integration step: below, its answer is not a motion."""

from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.effects import CATALOGUE
from trialid.errors import SimulationError, StepsTooLong
from trialid.identification.fit import identify
from trialid.identification.one_search import no_start
from trialid.identification.problem import FASTEST, pose_problem
from trialid.simulation.integrate import prepare, respond

GEAR = CATALOGUE["rudder_servo_limited"]
FREE = ("T_servo", "rate_max")
TRUE = {"T_servo": 1.0, "rate_max": 0.021}


def ordered(seed, **values):
    """Zig-zags of which orders are logged, in a sea, with a gear of limited rate."""
    rng = np.random.default_rng(seed)
    simulator = prepare((s175q.MODEL + GEAR).with_values(values), (), s175q.OUTPUTS)
    trials = []
    for amplitude in (10, 20):
        bare = s175q.zigzag(amplitude)
        signals = {k: x for k, x in bare.signals.items() if k != "delta"}
        signals["delta_order"] = bare.signals["delta"]
        valid = {name: np.ones(len(x), dtype=bool) for name, x in signals.items()}
        blank = replace(bare, signals=signals, valid=valid)
        r, phi = respond(simulator, blank, {}, {"u": 7.33}, sensitivities=False).y.T
        logged = replace(blank, signals={**signals, "r": r.copy(), "phi": phi.copy()})
        trials.append(s175q.with_noise(logged, *(10.0 * x for x in s175q.waves(rng, len(r)))))
    return trials


def lows(trials, effect, names, **changes):
    model, free = s175q.MODEL + CATALOGUE[effect], (*s175q.TEN, *names)
    problem = pose_problem(trials, model, replace(s175q.SETTINGS, free=free, **changes))
    return [x.low for x in problem.unknowns if x.name in names]


def test_it_is_half_a_step_of_a_gear_and_what_is_stated_where_that_is_stated():
    trials = ordered(1, **TRUE)
    slow, finer = (lows(trials, "rudder_servo_limited", FREE, substeps=k) for k in (1, 2))
    assert slow == [FASTEST * 0.5, GEAR.parameters["rate_max"].low]
    assert finer == [FASTEST * 0.25, GEAR.parameters["rate_max"].low]
    stated = {"T_servo": (0.1, 3.0)}
    assert lows(trials, "rudder_servo_limited", FREE, bounds=stated)[0] == 0.1


def test_a_lag_of_a_sensor_has_no_such_bound():
    """It is not integrated: one of nothing is no lag."""
    trials = [s175q.zigzag(10)]
    assert lows(trials, "lag_r", ("T_r",)) == [0.0]


@pytest.mark.study(turn="each")
@pytest.mark.parametrize(
    "seed", [13, *(pytest.param(s, marks=pytest.mark.study(turn="each")) for s in (12, 16))]
)
def test_the_search_for_a_gear_of_limited_rate_arrives_in_a_sea(seed):
    """Without the bound each ends among kinks, at 0.05 to 0.1 s, or has used up its iterations."""
    trials, settings = ordered(seed, **TRUE), replace(s175q.SETTINGS, free=(*s175q.TEN, *FREE))
    model = s175q.MODEL + GEAR
    fit = identify(trials, model.with_values({"T_servo": 1.0, "rate_max": 0.02}), settings)
    best = identify(trials, model.with_values(TRUE), settings)
    assert fit.converged
    assert fit.V < best.V * (1.0 + 1e-4)
    assert fit.estimates["rate_max"] == pytest.approx(TRUE["rate_max"], rel=0.1)


def test_steps_in_which_a_stated_gear_cannot_be_followed_are_made_finer():
    """Half a second of a gear of 0.05 s: its rudder would be out of all bounds within a sample."""
    quick = (s175q.MODEL + CATALOGUE["rudder_servo"]).with_values({"T_delta": 0.05})
    settings = replace(s175q.SETTINGS, free=("Nr", "Ndelta"))
    trials, told = ordered(2, **TRUE), list[int]()
    fit = identify(trials, quick, settings, finer=told.append)
    assert told[:2] == [2, 4]
    assert fit.converged
    assert fit.problem.simulator.substeps == told[-1]
    with pytest.raises(StepsTooLong, match=r"steps of 0\.5 s are too long for this model"):
        identify(trials, quick, replace(settings, most_substeps=1))


@pytest.mark.parametrize(("T_delta", "kind"), [(0.1, StepsTooLong), (0.9, SimulationError)])
def test_a_gear_quicker_than_a_step_is_told_wherever_a_start_leads(T_delta, kind):
    """A hull that turns ever faster leaves her model in the finest steps, too: of 0.5 s here."""
    gear = (s175q.MODEL + CATALOGUE["rudder_servo"]).with_values({"T_delta": T_delta, "Nr": 0.05})
    settings = replace(s175q.SETTINGS, free=("Nr", "Ndelta"), substeps=1)
    said = no_start(pose_problem(ordered(1, **TRUE), gear, settings))
    assert type(said) is kind
