"""A rate, a rudder, a speed or a length in another unit is told by how she turns."""

from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.diagnosis.records.in_doubt import in_doubt, settle
from trialid.diagnosis.records.unit_in_doubt import unit_in_doubt
from trialid.diagnosis.verdict import Verdict
from trialid.identification.fit import Fit, identify
from trialid.names.wording import number
from trialid.trial import Trial

NAMED = Verdict("missing", "rudder_cubic", ("rudder_cubic",), "rudder_cubic is missing")
SETTINGS = replace(s175q.SETTINGS, free=("Nr",))
ANGLES = (5, 10, 20)


def with_speed(trial: Trial, speed: float) -> Trial:
    """The trial with a record of her speed."""
    u = np.full(trial.samples, speed)
    valid = {**trial.valid, "u": np.ones(trial.samples, dtype=bool)}
    return replace(trial, signals={**trial.signals, "u": u}, valid=valid)


@pytest.fixture(scope="module")
def sound() -> Fit:
    trials = [with_speed(s175q.zigzag(angle), 7.33) for angle in ANGLES]
    return identify(trials, s175q.MODEL, SETTINGS)


def changed(fit: Fit, name: str, by: float, only: str = "") -> Fit:
    """The same with a signal too large by a factor, in one trial or in all of them."""

    def other(trial: Trial) -> Trial:
        if only not in ("", trial.name):
            return trial
        return replace(trial, signals={**trial.signals, name: by * trial.signals[name]})

    return replace(fit, scores=tuple(replace(s, trial=other(s.trial)) for s in fit.scores))


def test_a_sound_record_is_not_in_doubt(sound: Fit) -> None:
    assert unit_in_doubt(sound) is None
    assert settle(sound, NAMED) is NAMED
    assert unit_in_doubt(changed(sound, "u", 1.3)) is None


@pytest.mark.parametrize(
    ("name", "by", "said"),
    [
        ("r", 1.0 / 60.0, "lengths, where ships have 2 to 20: a rate of turn in deg/s"),
        ("r", 60.0, "as no ship does: a rate of turn in deg/min that is called deg/s"),
        ("delta", np.pi / 180.0, "a rudder in rad that is called deg 57 times too small"),
    ],
)
def test_no_ship_turns_so(sound: Fit, name: str, by: float, said: str) -> None:
    doubt = unit_in_doubt(changed(sound, name, by))
    assert doubt is not None
    assert doubt.startswith("she turns ")
    assert " by r L/U = " in doubt
    assert said in doubt
    found = settle(changed(sound, name, by), NAMED)
    assert (found.kind, found.effect, found.doubts) == ("cannot tell", None, (doubt,))
    failed = Verdict("no fit", None, (), "no fit: the search did not converge")
    told = settle(changed(sound, name, by), failed).sentence
    assert told == f"no fit: {doubt}; the search did not converge"


def test_of_one_trial_it_is_told_in_which(sound: Fit) -> None:
    doubt = unit_in_doubt(changed(sound, "r", 60.0, "zigzag-10"))
    assert doubt is not None
    assert doubt.startswith("she turns in zigzag-10 by r L/U = ")


@pytest.mark.parametrize(
    ("by", "called"),
    [
        (1.944, "one in kn that is called m/s"),
        (1.0 / 1.852, "one in kn that is called km/h"),
        (3.6, "one in km/h that is called m/s"),
    ],
)
def test_a_speed_in_another_unit_in_one_trial_is_told(sound: Fit, by: float, called: str) -> None:
    doubt = unit_in_doubt(changed(sound, "u", by, "zigzag-10"))
    assert doubt is not None
    assert doubt.startswith(f"the speed in zigzag-10 is {number(by, 3)} times that in the others")
    assert doubt.endswith(f"it is as {called}")
    assert in_doubt(changed(sound, "u", by, "zigzag-10"))


def test_a_run_that_is_as_much_faster_turns_as_much_faster(sound: Fit) -> None:
    faster = changed(changed(sound, "u", 1.944, "zigzag-20"), "r", 1.944, "zigzag-20")
    assert unit_in_doubt(faster) is None
    assert unit_in_doubt(changed(sound, "u", 1.5, "zigzag-20")) is None


def test_a_trial_that_ends_at_rest_is_by_her_speed_on_the_approach(sound: Fit) -> None:
    def stopped(trial: Trial) -> Trial:
        u = np.where(np.arange(trial.samples) < 0.3 * trial.samples, 7.33, 0.05)
        return replace(trial, signals={**trial.signals, "u": u})

    scores = tuple(replace(s, trial=stopped(s.trial)) for s in sound.scores)
    assert unit_in_doubt(replace(sound, scores=scores)) is None


DEG = np.deg2rad(1.0)


@pytest.mark.parametrize(
    ("rudder", "steady", "swell"),
    [(1.5, 0.0, 0.0), (0.0, 0.3, 0.0), (0.0, 0.0, 0.5)],
    ids=["a decay, her rudder a little over", "she drifts round", "a swell, amidships"],
)
def test_a_ship_that_nobody_steers_denies_no_unit(sound: Fit, rudder, steady, swell) -> None:
    """The rate [deg/s] has nothing to do with the rudder [deg], whatever the share of both."""
    rng, first = np.random.default_rng(1), sound.scores[0]
    t = first.trial.t
    delta = rudder + 0.05 * rng.standard_normal(len(t))
    r = steady + swell * np.sin(0.8 * t) + 0.002 * rng.standard_normal(len(t))
    signals = {**first.trial.signals, "delta": DEG * delta, "r": DEG * r}
    unsteered = replace(first, trial=replace(first.trial, signals=signals))
    assert unit_in_doubt(replace(sound, scores=(unsteered, *sound.scores[1:]))) is None


def test_a_helm_that_keeps_her_course_in_a_swell_denies_no_unit(sound: Fit) -> None:
    """It is over by her heading, which a swell turns by little and often."""
    first = sound.scores[0]
    psi = 0.6 * np.sin(0.8 * first.trial.t)
    signals = {**first.trial.signals, "delta": -DEG * psi, "r": np.gradient(DEG * psi, 0.5)}
    kept = replace(first, trial=replace(first.trial, signals=signals))
    assert unit_in_doubt(replace(sound, scores=(kept, *sound.scores[1:]))) is None
