"""A held-out trial of a ship that was loaded anew is told by what is other there."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.diagnosis.another_value import follow_with_another_value
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.examine import examine_fit
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.progress import silent
from trialid.result import build
from trialid.trial import LogSource

FREE = ("Nv", "Nr", "Ndelta", "Kv", "Kdelta", "Kp", "GM")
SETTINGS = Settings(FREE, ("r", "phi"), nuisance=("initial_state", "bias"))


def fitted(ahead=1.0, settings=SETTINGS, her=MODEL, **times):
    """Two zig-zags fitted; one held out of a ship with so many times some of her coefficients."""
    other = her.with_values({n: k * her.value(n) for n, k in times.items()})
    made = []
    for angle, ship in ((10, her), (20, her), (5, other)):
        trial = zigzag(angle, ship, use="check" if ship is other else "fit")
        made.append(with_noise(trial, *white(np.random.default_rng(angle), trial.samples)))
    signals = {**made[-1].signals, "delta": ahead * made[-1].signals["delta"]}
    return identify([*made[:-1], replace(made[-1], signals=signals)], her, settings)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize(
    "times",
    [0.4, 1.5, *(pytest.param(x, marks=pytest.mark.study(turn="each")) for x in (0.6, 2.0))],
)
def test_a_ship_with_another_gm_is_told(times):
    fit = fitted(GM=times)
    [said] = follow_with_another_value(fit)
    assert said.startswith("held-out zigzag-5 is followed with GM = ")
    there = float(said.split(" = ")[1].split(" m, ")[0])
    assert there == pytest.approx(times * MODEL.value("GM"), rel=0.05)
    assert f"from {fit.eps_check:.1%} to " in said
    left = float(said.split(" to ")[1].split("%")[0]) / 100.0
    assert left < 1.3 * fit.eps_rmsn


@pytest.mark.study(turn="each")
@pytest.mark.parametrize(
    "times", [0.7, *(pytest.param(x, marks=pytest.mark.study(turn="each")) for x in (0.78, 1.3))]
)
def test_a_ship_that_rolls_for_long_is_told_too(times):
    """Hardly damped and of more GM: a little off, her roll is out of phase within few cycles."""
    light = MODEL.with_values({"Kp": 0.25 * MODEL.value("Kp"), "GM": 1.2})
    [said] = follow_with_another_value(fitted(her=light, GM=times))
    there = float(said.split(" = ")[1].split(" m, ")[0])
    assert there == pytest.approx(times * 1.2, rel=0.05)


@pytest.mark.parametrize("one_log", [True, False])
def test_within_one_log_no_cargo_comes_aboard(one_log):
    """Of the next 30 s of a boat's log it was said that she was loaded otherwise there."""
    fit = fitted(GM=0.6)
    logs = [LogSource(f"{0 if one_log else k}.csv", "0", "csv") for k in range(3)]
    made = zip(fit.scores, logs, strict=True)
    scores = tuple(replace(s, trial=replace(s.trial, logs=(log,))) for s, log in made)
    [said] = follow_with_another_value(replace(fit, scores=scores))
    assert ("loaded otherwise" in said) is not one_log
    assert said.endswith("the model lacks what makes it so")


def test_a_ship_as_she_was_has_nothing_to_tell():
    assert follow_with_another_value(fitted()) == ()


def test_what_no_parameter_mends_is_not_told():
    """The rudder logged the wrong way: with the hull's signs turned round she would follow, too."""
    held = replace(SETTINGS, free=("Kp", "GM"))
    assert follow_with_another_value(fitted(-1.0, held)) == ()


def test_where_the_best_leaves_more_than_half_nothing_is_told():
    """Two coefficients are other, and neither alone mends the trial."""
    fit = fitted(Nr=2.0, Kdelta=0.5)
    assert fit.eps_check > 2.0 * fit.eps_rmsn
    assert follow_with_another_value(fit) == ()


@pytest.mark.parametrize("missing", [True, False])
def test_beside_a_name_nobody_asks(missing):
    """Without damping by the square a smaller zig-zag has other linear damping, too."""
    asked = DiagnoseSettings(candidates={}, coefficients=False)
    done = examine_fit(fitted(GM=0.6), asked, silent)[0]
    remarks = build._fit(done, missing=missing).remarks
    assert any("is followed with GM" in words for words in remarks) is not missing
