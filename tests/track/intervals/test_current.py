"""The current of a trial from her track: found, covered, told from wind or said not to be."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL
from sailed_tracks import CURRENTS, FREE, SETTINGS, SHIP, accuracy, noisy, sailed, trials
from sailed_wind import WINDY
from scipy.stats import t as student
from wind_and_current import MODELS, one, record, weather

from trialid.design.wind_and_current import WORDS, cannot_tell
from trialid.diagnosis.prediction_band import prediction_band
from trialid.effects.track import CURRENT
from trialid.errors import NotIdentifiable
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.identification.trial_score import of_trial
from trialid.threads import one_thread

SEEDS = 200
READ = MODELS["read"]
BY_NOISE = {"x": 12.0, "y": 12.0, "psi": 12.0}
"""About what their noise deserves beside the rate of turn's."""


def test_each_trial_has_its_own_current() -> None:
    fit = identify(trials(0), SHIP, SETTINGS)
    rows = {p.name: p for p in accuracy(fit).parameters}
    for name, water in CURRENTS.items():
        for column, truth in zip(CURRENT, water, strict=True):
            row = rows[f"{column} [{name}]"]
            assert abs(row.value - truth) < 4.0 * row.standard_error < 0.1
    assert max(fit.eps_by_output[c] for c in ("x", "y")) < 0.01  # ship lengths; 1 m is 0.006


def test_a_current_is_no_matter_of_the_ship() -> None:
    """The same noise in still water: the same ship, and the current is less by what was added."""
    drifting, still = (identify(trials(1, calm), SHIP, SETTINGS) for calm in (False, True))
    np.testing.assert_allclose(drifting.theta[:5], still.theta[:5], rtol=0.01)
    for name, water in CURRENTS.items():
        for column, truth in zip(CURRENT, water, strict=True):
            less = drifting.value(f"{column} [{name}]") - still.value(f"{column} [{name}]")
            assert less == pytest.approx(truth, abs=0.002)


def test_a_trial_to_check_finds_its_own_current() -> None:
    """That of the fitted trial is another day's: 1.1 m/s off for 500 s."""
    rng = np.random.default_rng(5)
    check = noisy(sailed("zigzag", CURRENTS["zigzag"], "check"), rng)
    fit = identify([trials(0)[0], check], SHIP, SETTINGS)
    values, _ = of_trial(fit, check)
    assert values["V_ce"] == pytest.approx(CURRENTS["zigzag"][1], abs=0.08)
    assert fit.eps_check_by_output["y"] < 0.05


def test_the_band_of_a_trial_not_fitted_is_that_of_a_trial_with_a_current_of_its_own() -> None:
    """1 m of noise, and little by the parameters; by the other's current it was 250 m."""
    fit = identify(trials(0), SHIP, replace(SETTINGS, weights=BY_NOISE))
    band = prediction_band(fit)
    assert 1.8 < band["x"] < 3.0
    assert 1.8 < band["y"] < 3.0


def test_a_current_without_a_track_is_refused() -> None:
    blind = Settings(FREE, ("r",), nuisance=("current",))
    with pytest.raises(NotIdentifiable, match="shows only over the ground"):
        identify(trials(0), MODEL, blind)


@pytest.mark.study(turn=2)
@one_thread
def test_currents_lie_within_their_intervals_and_the_ship_is_as_good_as_without() -> None:
    inside, with_current, without = [], [], []
    settings = replace(SETTINGS, weights=BY_NOISE)
    calm = replace(settings, nuisance=("initial_state",))
    for seed in range(SEEDS):
        rows = {p.name: p for p in accuracy(identify(trials(seed), SHIP, SETTINGS)).parameters}
        for name, water in CURRENTS.items():
            for column, truth in zip(CURRENT, water, strict=True):
                row = rows[f"{column} [{name}]"]
                reach = student.ppf(0.975, row.freedom) * row.standard_error
                inside.append(abs(row.value - truth) < reach)
        with_current.append(identify(trials(seed), SHIP, settings).theta[:5])
        without.append(identify(trials(seed, True), SHIP, calm).theta[:5])
    truth = np.array([SHIP.value(n) for n in FREE])
    pair = [np.array(x) / truth - 1.0 for x in (with_current, without)]
    errors = [np.sqrt(np.mean(x**2, axis=0)) for x in pair]
    print(f"current within 95 %: {np.mean(inside):.3f} of {len(inside)}; rms errors {errors}")
    assert 0.93 <= np.mean(inside) <= 0.97
    assert np.all(errors[0] < 1.25 * errors[1])


def test_a_full_turn_tells_and_a_small_zigzag_in_little_current_does_not() -> None:
    """The weather of this seed: a current of 0.15 m/s, a wind of 9.3 m/s."""
    seed = 306
    turn, zigzag = (record(name, seed, *READ) for name in ("circle", "small zigzag"))
    assert cannot_tell(turn, accuracy(turn)) == ()
    [said] = cannot_tell(zigzag, accuracy(zigzag))
    assert said.startswith(f"{WORDS} in small zigzag (")
    assert said.endswith("sail a full turn in the same wind and water")


def test_without_a_wind_in_the_model_what_it_drifts_her_is_said_to_count_as_current() -> None:
    fit = identify(trials(0), SHIP, SETTINGS)
    [said] = cannot_tell(fit, accuracy(fit))
    assert said.startswith(WORDS)
    assert "add steady_wind" in said
    blind = replace(SETTINGS, nuisance=("initial_state",))
    fit = identify(trials(0, True), SHIP, blind)
    assert cannot_tell(fit, accuracy(fit)) == ()


def test_a_wind_that_is_held_is_said_to_be() -> None:
    fit = record("circle", 306, WINDY, ())
    [said] = cannot_tell(fit, accuracy(fit))
    assert "the model's wind is held: free it" in said


def test_a_held_coefficient_that_leads_the_current_off_is_named() -> None:
    """Where the wind grips is held, by mistake on the other side; its range does not know."""
    seed, (unread, free) = 7321, MODELS["unread"]
    held = record("circle", seed, unread.with_values({"k_wind": 0.0}), ("F_N", "F_E"))
    rows = {p.name: p for p in accuracy(held).parameters}
    off = [
        abs(rows[f"{n} [circle]"].value - x) for n, x in zip(CURRENT, weather(seed)[0], strict=True)
    ]
    assert max(off) > 3.0 * rows["V_cn [circle]"].standard_error  # what it is about
    [said] = cannot_tell(held, accuracy(held))
    assert said.startswith(f"{WORDS}: x_wind and k_wind of the wind, held at a value, ")
    assert said.endswith("free them")
    told = record("circle", seed, unread, free)
    assert not any("held at a value" in x for x in cannot_tell(told, accuracy(told)))


@pytest.mark.study(turn=1)
@one_thread
def test_a_full_turn_tells_and_what_is_told_is_right() -> None:
    for name, least in (("circle", 0.8), ("zigzag", 0.0)):
        found = [one(name, seed, *READ) for seed in range(40)]
        told = [x for x in found if x.told]
        right = np.mean([h for x in told for h in x.holds])
        print(f"{name}: told {len(told)} of {len(found)}, right {right:.3f}")
        assert len(told) >= least * len(found)
        assert right >= 0.93
