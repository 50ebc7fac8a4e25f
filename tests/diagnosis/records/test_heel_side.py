"""A roll sensor of the wrong side: before its side is settled no effect has a name."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.diagnosis.records.heel_side import leans_to, side_in_doubt
from trialid.diagnosis.records.in_doubt import settle
from trialid.diagnosis.verdict import Verdict
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.trial import Trial
from trialid.workflow.notebook.front import diagnose

FREE = ("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM")
SETTINGS = Settings(FREE, ("r", "phi"), nuisance=("initial_state", "bias"))
PLAIN = replace(MODEL, effects=tuple(e for e in MODEL.effects if e.name != "roll_drag_vav"))


def sailed(side=1.0, sided=frozenset()):
    made = []
    for angle, use in ((10, "fit"), (20, "fit"), (5, "check")):
        trial = zigzag(angle, use=use)
        trial = with_noise(trial, *white(np.random.default_rng(70 + angle), trial.samples))
        signals = {**trial.signals, "phi": side * trial.signals["phi"]}
        made.append(replace(trial, signals=signals, sided=sided))
    return made


def of_trials(fit, trials):
    made = zip(fit.scores, trials, strict=True)
    return replace(fit, scores=tuple(replace(score, trial=trial) for score, trial in made))


@pytest.fixture(scope="module")
def wrong():
    return identify(sailed(-1.0), PLAIN, SETTINGS)


@pytest.mark.study(turn="each")
def test_the_side_comes_first_and_nothing_is_named(wrong):
    found = diagnose(wrong)
    assert found.verdict.effect is None
    assert found.verdict.kind in {"cannot tell", "no fit"}
    assert 'write positive = "port" for phi' in found.verdict.sentence


@pytest.mark.study(turn="each")
def test_both_readings_are_named_where_the_side_of_her_turns_is_nobodys_word(wrong):
    """With z up all but the roll count to port, and the mirror of a ship sails as well."""
    said = diagnose(wrong).verdict.sentence
    assert "phi alone counts to port" in said
    assert "or delta, r all do, as with z up" in said
    assert "else starboard is port in all predictions" in said
    stated = of_trials(wrong, sailed(-1.0, frozenset({"r"})))
    said = settle(stated, Verdict("missing", "yaw_cubic_rrr", ("yaw_cubic_rrr",), "it is"))
    assert "phi alone counts to port" in said.sentence
    assert "z up" not in said.sentence


def test_a_fit_that_fails_says_it_too(wrong):
    no_fit = settle(wrong, Verdict("no fit", None, (), "no fit: another ship"))
    assert no_fit.kind == "no fit"
    assert no_fit.sentence.startswith("no fit: she heels into her turns in zigzag-")
    assert no_fit.sentence.endswith("; another ship")


@pytest.mark.parametrize("kind", ["missing", "not in catalogue", "cannot tell"])
def test_what_would_be_named_is_not(wrong, kind):
    found = settle(wrong, Verdict(kind, "yaw_cubic_rrr", ("yaw_cubic_rrr",), "it is"))
    assert (found.kind, found.effect, found.family) == ("cannot tell", None, ())
    assert found.sentence.startswith("she heels into her turns")


@pytest.mark.parametrize(("known", "told"), [(0.1, True), (20.0, False), (None, False)])
def test_where_nothing_is_missing_her_file_says_whether_it_matters(wrong, known, told):
    """An outsider's roll of the wrong side was `nothing missing`, Kdelta 18.7 deviations off."""
    value = MODEL.value("Kr")
    prior = None if known is None else (value, known * abs(value))
    problem = replace(
        wrong.problem,
        unknowns=tuple(
            replace(x, prior=prior) if x.name == "Kr" else x for x in wrong.problem.unknowns
        ),
    )
    nothing = Verdict("nothing missing", None, (), "no effect stands out")
    found = settle(replace(wrong, problem=problem), nothing)
    assert (found.kind == "cannot tell") is told
    assert found.sentence.startswith("she heels into her turns") is told
    right = identify(sailed(), PLAIN, SETTINGS)
    assert settle(replace(right, problem=problem), nothing) is nothing


def test_healthy_ships_and_stated_sides_have_their_verdict(wrong):
    named = Verdict("missing", "yaw_cubic_rrr", ("yaw_cubic_rrr",), "it is")
    stated = sailed(-1.0, frozenset({"phi"}))
    fits = [
        identify(sailed(), PLAIN, SETTINGS),
        of_trials(wrong, stated),
        of_trials(wrong, sailed()),
    ]
    for fit in fits:
        assert leans_to(fit)[0] == ()
        assert side_in_doubt(fit) is None
        assert settle(fit, named) is named


def test_a_side_is_stated_with_the_signal():
    t = np.arange(200) * 0.5
    signals = {"phi": np.sin(t), "r": np.cos(t)}
    made = Trial.from_arrays(
        "a", t, signals, units={"phi": "deg", "r": "deg/s"}, positive={"phi": "port"}
    )
    assert made.sided == {"phi"}


def test_a_roll_of_the_wrong_side_is_told_through_the_roll_of_a_swell(wrong):
    """Of a boat 0.45 to 0.69 of it was in step with her turns, and `rudder_stall` had the name."""
    rng, trials = np.random.default_rng(4110), []
    for trial in sailed(-1.0):
        swell = np.convolve(rng.normal(size=trial.samples + 40), np.sin(np.arange(41) / 3), "valid")
        scale = 1.2 * np.std(trial.signals["phi"]) / np.std(swell)
        phi = trial.signals["phi"] + scale * swell
        trials.append(replace(trial, signals={**trial.signals, "phi": phi}))
    lean = [np.corrcoef(t.signals["phi"], t.signals["r"])[0, 1] for t in trials]
    assert 0.4 < min(lean) < max(lean) < 0.7
    assert leans_to(of_trials(wrong, trials)) == (("zigzag-10", "zigzag-20"), ())


def test_a_rate_that_was_turned_round_in_one_trial_is_told_by_the_roll(wrong):
    """Of one zig-zag of four it was, without a heading, and `rudder_stall` had the name."""
    trials = sailed()
    signals = {**trials[1].signals, "r": -trials[1].signals["r"]}
    fit = of_trials(wrong, [trials[0], replace(trials[1], signals=signals), trials[2]])
    assert leans_to(fit)[0] == ("zigzag-20",)
    found = settle(fit, Verdict("missing", "rudder_stall", ("rudder_stall",), "it is"))
    assert found.effect is None
    assert "into her turns in zigzag-20 and out of them in zigzag-10" in found.sentence


@pytest.mark.parametrize("logged", [True, False])
def test_gusts_that_were_logged_are_not_her_turns(wrong, logged):
    """A yacht of an outsider heeled 1.3 deg out of her turns, by 0.88 into them with her gusts."""
    rng, trials = np.random.default_rng(4111), []
    for trial in sailed():
        r, phi = trial.signals["r"], trial.signals["phi"]
        push = r / np.std(r) + 0.5 * rng.normal(size=trial.samples)
        wind = {"V_aw": 10.0 * np.sqrt(np.abs(push)), "gamma_aw": np.copysign(0.5 * np.pi, push)}
        signals = {**trial.signals, "phi": phi + 2.0 * np.std(phi) * push}
        trials.append(replace(trial, signals=signals | wind if logged else signals))
    inward, outward = leans_to(of_trials(wrong, trials))
    assert (inward == ()) is logged
    assert ("zigzag-20" in outward) is logged
