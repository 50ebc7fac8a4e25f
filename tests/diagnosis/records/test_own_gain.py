"""One trial whose log reads by another factor: that is said, and no force has its name."""

from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.diagnosis.records import own_gain
from trialid.diagnosis.records.contradicting_trial import settle_held_out, settle_trials
from trialid.diagnosis.records.further import left_of_each, stands_out
from trialid.diagnosis.records.own_gain import (
    Factor,
    OwnGain,
    gain_in_doubt,
    held_gain_in_doubt,
    left_of,
    own_gains,
)
from trialid.diagnosis.verdict import Verdict
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify

NAMED = Verdict("missing", "rudder_stall", ("rudder_stall",), "rudder_stall is missing")
SETTINGS = replace(s175q.SETTINGS, free=("Nv", "Nr", "Ndelta", "Yv", "Kdelta"))
CUBIC = CATALOGUE["rudder_cubic"]
STALLS = (s175q.MODEL + CUBIC).with_values({"Yddd": 0.0, "Nddd": -s175q.MODEL.value("Ndelta")})
CALM = dict.fromkeys(CATALOGUE["steady_wind"].parameters, 0.0)


def fitted(signal="", by=1.0, *, model=s175q.MODEL, of="zigzag-10", held="zigzag-5", n=4) -> Fit:
    """Zig-zags of 20, 10, 5 and 2 deg; in one of them a log reads what is true times a factor."""
    rng, made = np.random.default_rng(23), []
    for angle in (20, 10, 5, 2)[:n]:
        trial = s175q.zigzag(angle, model)
        trial = s175q.with_noise(trial, *(0.3 * x for x in s175q.white(rng, trial.samples)))
        trial = replace(trial, use="check" if trial.name == held else "fit")
        [made_so] = Factor(of, signal, by).taken([trial]) if signal else [trial]
        made.append(made_so)
    return identify(made, s175q.MODEL, SETTINGS)


@pytest.fixture(scope="module")
def indicator() -> Fit:
    """Of 10 deg the rudder's indicator shows 11.5."""
    return fitted("delta", 1.15)


@pytest.fixture(scope="module")
def as_it_is() -> Fit:
    return fitted()


@pytest.mark.parametrize(("signal", "by"), [("delta", 0.9), ("r", 1.1), ("phi", 1.2)])
def test_the_trial_and_its_sensor_are_found_with_the_factor_that_mends_it(signal, by) -> None:
    best = own_gains(fitted(signal, by))[0].factor
    assert (best.trial, best.signal) == ("zigzag-10", signal)
    assert best.by == pytest.approx(1.0 / by, rel=0.02)


def test_nothing_is_named_before_it_is_settled(indicator: Fit) -> None:
    """A stranger's speed log, 12 % high in one run, was called a rudder that stalls."""
    said = settle_trials(indicator, NAMED, None)
    assert (said.kind, said.effect, said.family) == ("cannot tell", None, ())
    assert said.doubts[0].startswith(
        "zigzag-10 reads otherwise than the others: with its delta times 0.87 the error falls from"
    )
    assert said.doubts[0].count("on held-out trials from") == 1
    assert said.sentence.endswith("until that is settled no effect is named")


def test_the_error_falls_once_the_trial_has_that_gain(indicator: Fit, as_it_is: Fit) -> None:
    """To that of a record that was never wrong."""
    [best, *_] = own_gains(indicator)
    mended = identify(best.factor.taken(indicator.trials), s175q.MODEL, SETTINGS)
    assert indicator.eps_rmsn > 1.4 * as_it_is.eps_rmsn
    assert mended.eps_rmsn == pytest.approx(as_it_is.eps_rmsn, rel=0.02)
    assert mended.eps_check == pytest.approx(as_it_is.eps_check, rel=0.05)
    assert gain_in_doubt(mended) is None


def test_of_records_that_read_alike_nothing_is_said(as_it_is: Fit) -> None:
    assert own_gains(as_it_is) == []
    assert gain_in_doubt(as_it_is) is None
    assert settle_held_out(as_it_is, NAMED, None) is NAMED
    assert settle_trials(as_it_is, NAMED, None) is NAMED


def test_a_force_at_large_angles_is_no_gain_of_the_one_trial_that_has_them(monkeypatch) -> None:
    """Most of it is in the 20 deg, which no other trial has: there a factor does as much."""
    fit = fitted(model=STALLS)
    assert own_gains(fit) == []
    monkeypatch.setattr(own_gain, "is_no_further", lambda fit, name: True)
    assert own_gains(fit)[0].factor.trial == "zigzag-20"


@pytest.mark.study(turn="each")
def test_an_effect_that_leaves_as_little_keeps_its_name(indicator: Fit) -> None:
    as_much = own_gains(indicator)[0].fit  # as if an effect had taken it off
    assert gain_in_doubt(indicator, [indicator]) is not None
    assert gain_in_doubt(indicator, [indicator, as_much]) is None
    assert settle_trials(indicator, NAMED, None, [indicator, as_much]).kind == "missing"
    held = [
        replace(s, eps_rmsn={c: 9.0 * e for c, e in s.eps_rmsn.items()})
        for s in as_much.scores
        if s.trial.use == "check"
    ]
    others = [s for s in as_much.scores if s.trial.use == "fit"]
    denied = replace(as_much, scores=(*others, *held))
    assert gain_in_doubt(indicator, [denied]) is not None
    family = replace(NAMED, effect=None, kind="cannot tell")
    assert settle_trials(indicator, family, None, [as_much]).family == NAMED.family


def test_a_hair_is_no_other_calibration(as_it_is: Fit) -> None:
    """However closely the model follows: of a factor of 1.01 and half the error nothing is said."""
    [half] = [replace(as_it_is, residual=0.7 * as_it_is.residual)]
    less = tuple(
        replace(s, eps_rmsn={c: 0.7 * e for c, e in s.eps_rmsn.items()}) for s in as_it_is.scores
    )
    half = replace(half, scores=less)
    told = [OwnGain(Factor("zigzag-10", "r", by), as_it_is, half) for by in (1.01, 1.05)]
    assert [one.falls for one in told] == [False, True]


def test_what_does_not_move_the_ship_or_carries_no_fit_is_not_asked(indicator: Fit) -> None:
    still = replace(indicator, model=replace(indicator.model, states=()))
    assert own_gains(still) == []
    assert own_gains(replace(indicator, converged=False)) == []


def test_a_trial_held_out_of_which_nothing_is_compared_hides_no_other() -> None:
    fit = fitted("delta", 1.3, held="zigzag-10")
    held = next(s for s in fit.scores if s.trial.use == "check")
    blank = replace(held, trial=replace(held.trial, name="a blank"), eps_rmsn={}, counts={})
    more = replace(fit, scores=(*fit.scores[:1], blank, *fit.scores[1:]))
    assert left_of_each(more)["a blank"] == 0.0
    assert stands_out(more, "zigzag-10")
    assert left_of(more, fit, None, "check") == pytest.approx(1.0)


@pytest.mark.study(turn="each")
def test_a_trial_held_out_is_told_too() -> None:
    """As the others have it she is foretold badly, and with that factor as well as they are."""
    fit = fitted("delta", 1.3, held="zigzag-10")
    said = held_gain_in_doubt(fit, "zigzag-10")
    assert said is not None
    assert said.startswith("zigzag-10 reads otherwise than the others: fitted beside them with its")
    assert " delta times 0.768 " in said
    settled = settle_held_out(fit, Verdict("nothing missing", None, (), "nothing"), None)
    assert (settled.kind, settled.doubts) == ("cannot tell", (said,))
    for kept in (NAMED, Verdict("not in catalogue", None, (), "a gap")):
        beside = settle_held_out(fit, kept, None)
        assert beside == replace(kept, sentence=f"{kept.sentence}; {said}")


def test_the_one_held_out_is_not_told_where_a_fitted_one_is_off(indicator: Fit) -> None:
    said = held_gain_in_doubt(indicator, "zigzag-5")
    assert said is not None
    assert said.startswith(
        "zigzag-10 reads otherwise than the others: with zigzag-5 fitted too and"
    )
    assert " delta times 0.87 " in said


def test_of_two_trials_nobody_knows_which_reads_wrong() -> None:
    assert own_gains(fitted("delta", 1.15, held="", n=2)) == []


def test_what_is_left_of_a_log_that_was_multiplied_counts_as_it_was_recorded(as_it_is: Fit) -> None:
    """Else the smallest factor would leave least."""
    factor = Factor("zigzag-10", "r", 0.5)
    half = identify(factor.taken(as_it_is.trials), s175q.MODEL, SETTINGS)
    fitted_scores = [s for s in as_it_is.scores if s.trial.use == "fit"]
    score = next(s for s in half.scores if s.trial.name == "zigzag-10")
    size = half.problem.y_rms[0] / as_it_is.problem.y_rms[0]
    all_r = sum(s.counts["r"] for s in fitted_scores)
    own = score.counts["r"] / all_r * (score.eps_rmsn["r"] * size) ** 2
    plain, as_recorded = (left_of(as_it_is, half, f) for f in (None, factor))
    whole = left_of(as_it_is, as_it_is)
    assert whole == 1.0
    assert as_recorded > plain
    square = sum(
        sum(s.counts[c] * s.eps_rmsn[c] ** 2 for s in fitted_scores)
        / sum(s.counts[c] for s in fitted_scores)
        for c in ("r", "phi")
    )
    assert (as_recorded - plain) * square == pytest.approx(3.0 * own, rel=1e-6)


def test_a_heading_has_no_factor(as_it_is: Fit) -> None:
    """Nor has any other direction: where its zero lies is no part of the ship."""
    model = (s175q.MODEL + CATALOGUE["steady_wind"]).with_values(CALM)
    trials = [
        replace(t, signals={**t.signals, "psi": np.cumsum(t.signals["r"]) * t.period})
        for t in as_it_is.trials
    ]
    fit = identify(trials, model, SETTINGS)
    assert "psi" in fit.problem.simulator.equations.inputs
    assert {f.signal for f in own_gain._factors(fit)} == {"delta", "n", "r", "phi"}
