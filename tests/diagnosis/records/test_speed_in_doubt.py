"""A log of the speed that is dead in one trial, or in another unit in all, is told by itself."""

from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.diagnosis.records.in_doubt import in_doubt, settle
from trialid.diagnosis.records.speed_in_doubt import speed_in_doubt
from trialid.diagnosis.verdict import Verdict
from trialid.identification.fit import Fit, identify
from trialid.ship.actuators import Actuator

NAMED = Verdict("missing", "rudder_stall", ("rudder_stall",), "rudder_stall is missing")
ANGLES = (5, 10, 20)
U0 = s175q.SHIP.particulars["U0"]


def speeds(fit: Fit, made) -> Fit:
    """The same with what a log says of her speed in each trial, by its name and turns."""

    def logged(trial):
        u = made(trial.name, trial.signals["r"])
        valid = {**trial.valid, "u": np.ones(trial.samples, dtype=bool)}
        return replace(trial, signals={**trial.signals, "u": u}, valid=valid)

    return replace(fit, scores=tuple(replace(s, trial=logged(s.trial)) for s in fit.scores))


def falling(name, r):
    """She loses speed as she turns."""
    return U0 * (1.0 - 20.0 * np.abs(r))


def coarse(name, r):
    """The same in steps of a tenth of a knot."""
    step = 0.0514
    return step * np.round(falling(name, r) / step)


@pytest.fixture(scope="module")
def fit() -> Fit:
    free = replace(s175q.SETTINGS, free=("Nr",))
    return identify([s175q.zigzag(angle) for angle in ANGLES], s175q.MODEL, free)


@pytest.mark.parametrize("made", [falling, coarse])
def test_a_log_that_is_dead_in_one_trial_is_told(fit, made):
    assert speed_in_doubt(speeds(fit, made)) is None
    dead = speeds(fit, lambda name, r: made(name, 0.0 * r if name == "zigzag-20" else r))
    doubt = speed_in_doubt(dead)
    assert doubt is not None
    assert " throughout zigzag-20, and moves by " in doubt
    assert in_doubt(dead)
    found = settle(dead, NAMED)
    assert (found.kind, found.effect, found.doubts) == ("cannot tell", None, (doubt,))


def test_one_that_stands_where_she_turns_least_may_be_alive(fit):
    assert speed_in_doubt(speeds(fit, lambda n, r: coarse(n, (n != "zigzag-5") * r))) is None


def test_a_speed_that_is_the_same_in_all_trials_is_as_it_was_simulated(fit):
    assert speed_in_doubt(speeds(fit, lambda n, r: np.full(len(r), U0))) is None


@pytest.mark.parametrize(("kind", "told"), [("thruster", False), ("rudder", True)])
def test_a_boat_with_drives_sails_as_they_are_told(fit, kind, told) -> None:
    """Her U0 is no speed of hers; a ship of two rudders has one."""
    one = Actuator(name="left", kind=kind, x=0.0, y=0.4)
    ship = replace(fit.model.ship, actuators=(one,))
    driven = replace(fit, model=replace(fit.model, ship=ship))
    doubt = speed_in_doubt(speeds(driven, lambda n, r: 1.944 * falling(n, r)))
    assert (doubt is not None) == told


@pytest.mark.parametrize(
    ("by", "said"),
    [
        (1.944, "or the log is in kn and called m/s"),
        (1.852, "in km/h and called kn"),
        (3.6, "or the log is in km/h and called m/s"),
        (1.0, None),
        (1.5, None),
        (1.0 / 1.944, None),
    ],
)
def test_a_speed_in_another_unit_in_all_trials_is_told(fit, by, said):
    """Half of what her file says she may sail at, twice of it not; 1.5 times is remarked alone."""
    doubt = speed_in_doubt(speeds(fit, lambda n, r: by * falling(n, r)))
    assert (doubt is None) == (said is None)
    assert said is None or said in doubt
