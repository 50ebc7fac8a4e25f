"""What the ship's file knows, as priors: it holds what is hardly seen, and yields to a record."""

import re
from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, SHIP, white, with_noise, zigzag

from trialid.accuracy.coloured import with_priors
from trialid.accuracy.parameter_table import prior_shares
from trialid.diagnosis.search.refit import settings_with
from trialid.effects import CATALOGUE
from trialid.errors import ShipError
from trialid.identification.file_of_ship import unlike_file
from trialid.identification.fit import identify
from trialid.identification.ship_priors import ship_priors
from trialid.report.words.beforehand import contradictions, prior_words
from trialid.workflow.notebook.front import diagnose

FREE = ("Nv", "Nr", "Ndelta", "Yv", "Ydelta", "Yvav", "Nvav")
SCATTER = {
    "Yv": 0.3,
    "Yr": 0.3,
    "Nv": 0.45,
    "Nr": 0.35,
    "Ydelta": 0.25,
    "Ndelta": 0.25,
    "Yvav": 0.7,
    "Nvav": 2.0,
}


def begun(off, scatter=SCATTER, model=MODEL):
    """The model with a file that is off by so much, and says how far it may be."""
    numbers = {n: x * off.get(n, 1.0) for n, x in model.ship.coefficients.items()}
    return replace(model, ship=replace(model.ship, coefficients=numbers, uncertainty=scatter))


def fitted(model, seed=1, free=FREE, priors=True, amplitude=10):
    trial = zigzag(amplitude)
    noise = white(np.random.default_rng(seed), trial.samples)
    known = ship_priors(model, free) if priors else {}
    settings = replace(SETTINGS, free=free, priors=known)
    return identify([with_noise(trial, *noise)], model, settings)


# --- what the file says ---------------------------------------------------------------------------


def test_mean_and_deviation_are_the_files():
    found = ship_priors(begun({}), (*FREE, "Kp"))
    assert found["Nr"] == pytest.approx((-0.00247579, 0.35 * 0.00247579))
    assert found["Yv"] == pytest.approx((-0.01189081, 0.3 * 0.01189081))
    assert "Kp" not in found  # the file says nothing of how sure it is


def test_a_start_given_by_hand_is_no_knowledge():
    moved = begun({}).with_values({"Nr": -0.01})
    assert ship_priors(moved, ("Nr",))["Nr"] == pytest.approx((-0.00247579, 0.35 * 0.00247579))


def test_a_default_counts_where_the_file_states_it():
    found = ship_priors(begun({}, {"default": 0.1}), ("Kp",))
    assert found["Kp"] == pytest.approx((-7.5e-6, 7.5e-7))


def test_sides_and_systems_are_this_projects():
    """A file whose rudder counts to port, and one in SI, say the same ship."""
    port = replace(
        SHIP,
        rudder_positive="port",
        uncertainty={"Ndelta": 0.25},
        coefficients={**SHIP.coefficients, "Ndelta": -SHIP.coefficients["Ndelta"]},
    )
    assert ship_priors(replace(MODEL, ship=port), ("Ndelta",))["Ndelta"] == pytest.approx(
        (0.00148048, 0.25 * 0.00148048)
    )
    L, rho = 175.0, 1025.0
    scale = 0.5 * rho * L**4
    dimensional = replace(
        SHIP,
        system="dimensional",
        uncertainty={"Nr": 0.5, "I_zz": 0.2},
        coefficients={"Nr": -0.0025 * scale},
        mass={**SHIP.mass, "I_zz": 0.000456 * scale * L},
    )
    found = ship_priors(replace(MODEL, ship=dimensional), ("Nr", "I_zz"))
    assert found["Nr"] == pytest.approx((-0.0025, 0.00125))
    assert found["I_zz"] == pytest.approx((0.000456, 0.2 * 0.000456))


def test_what_a_number_of_the_file_is_off_by_is_as_sure_as_the_file_calls_it():
    """Of masses stated to 1 % a speed log that read 0.8 made one 28 % off, by name."""
    sure = {"Yvdot": 0.01, "m": 0.02, "GM": 0.5}
    off = [CATALOGUE[n] for n in ("sway_added_mass_error", "displacement_error")]
    model = begun({}, sure) + off[0] + off[1] + CATALOGUE["metacentric_height_error"]
    found = ship_priors(model, ("dYvdot", "dm", "dGM"))
    stated = {n: abs(model.stated(n)) for n in sure}
    assert found == {f"d{n}": (0.0, pytest.approx(x * sure[n])) for n, x in stated.items()}
    added = settings_with(identified(model.ship, priors=True), off)
    assert added.priors["dYvdot"] == found["dYvdot"]
    assert "dYvdot" not in settings_with(identified(model.ship, priors=False), off).priors


def identified(ship, priors):
    """A fit of a short record, as `priors = "ship"` has it or without."""
    settings = replace(SETTINGS, free=("Nv",), nuisance=(), priors_of_ship=priors)
    return identify([zigzag(10)], replace(MODEL, ship=ship), settings)


def test_a_file_that_says_nothing_or_calls_it_exact_is_refused():
    with pytest.raises(ShipError, match=r"\[uncertainty\] says nothing of Nr, so priors"):
        ship_priors(MODEL, ("Nr",))
    with pytest.raises(ShipError, match=r"\[uncertainty\] Nr = 0 calls it exact"):
        ship_priors(begun({}, {"Nr": 0.0}), ("Nr",))


# --- what they do ---------------------------------------------------------------------------------


@pytest.mark.study(turn="each")
def test_what_is_hardly_seen_is_held_and_what_is_seen_is_not():
    """A zig-zag of two degrees tells nothing of quadratic drag, and a rudder's moment well."""
    off = {"Yv": 1.15, "Nr": 0.8, "Ydelta": 0.85, "Nvav": 1.5, "Yvav": 0.8}
    truth = {n: MODEL.value(n) for n in FREE}
    apart = {n: [0.0, 0.0] for n in FREE}
    for seed in range(4):
        for k, priors in enumerate((False, True)):
            fit = fitted(begun(off), seed, priors=priors, amplitude=2)
            for n in FREE:
                apart[n][k] += abs(fit.value(n) / truth[n] - 1.0) / 4.0
    print({n: [round(x, 3) for x in both] for n, both in apart.items()})
    assert apart["Nvav"][0] > 5.0
    assert apart["Nvav"][1] < 1.5
    assert max(held for name, (_, held) in apart.items() if name[-2:] != "av") < 0.1
    rows = {r.name: r for r in diagnose(fit, candidates={}).result.physical}
    shares = {n: rows[n].prior_share for n in FREE}
    print(shares)
    assert shares["Nvav"] > 0.9
    assert shares["Ndelta"] < 0.1


def test_its_share_is_what_is_left_of_it():
    """Variance after over variance before, by repeats with the file's own numbers drawn."""
    rng, ends = np.random.default_rng(5), []
    for seed in range(24):
        off = {n: 1.0 + 0.3 * rng.standard_normal() for n in ("Nvav", "Ndelta")}
        fit = fitted(begun(off, {"Nvav": 0.3, "Ndelta": 0.3}), seed, ("Nvav", "Ndelta", "Nr"))
        ends.append([fit.value(n) / MODEL.value(n) - 1.0 for n in ("Nvav", "Ndelta")])
    rows = {r.name: r for r in diagnose(fit, candidates={}).result.physical}
    left = np.var(ends, axis=0) / 0.3**2
    assert rows["Nr"].prior_share is None
    assert rows["Ndelta"].prior_share == pytest.approx(left[1], abs=0.01)
    assert rows["Nvav"].prior_share == pytest.approx(left[0], rel=0.7)
    assert 0.0 < rows["Ndelta"].prior_share < 0.01


def test_shares_of_rows_that_say_nothing_all_and_half():
    A = np.array([[0.0, 0.0, 0.0], [0.0, 1e3, 0.0], [0.0, 0.0, 2.0]])
    held = np.array([2.0, 2.0, 2.0])
    assert prior_shares(A, held) == pytest.approx([1.0, 4e-6, 0.5], rel=1e-4)
    assert prior_shares(A, None) is None
    assert with_priors(A, held).shape == (3, 3)


def test_a_share_is_told_and_a_contradiction_too():
    """The file's Nr is half of the truth, and it is sure: the record says otherwise, aloud."""
    wrong = begun({"Nr": 0.5}, {**SCATTER, "Nr": 0.1})
    fit = fitted(wrong, free=("Nv", "Nr", "Ndelta", "Nvav"), amplitude=20)
    found = diagnose(fit, candidates={}).result
    words = prior_words(found.physical)
    assert words.startswith("The record contradicts what was known of Nr: -0.00")
    assert re.search(r"Known beforehand, as a share of what is known now: Nr [0-9.]+", words)
    assert "contradicts what was known of Nr: -0.00" in words
    [row] = [r for r in found.physical if r.name == "Nr"]
    assert row.off_prior < -3.0
    assert row.prior == pytest.approx((-0.00123790, 0.00012379), rel=1e-4)
    right = diagnose(fitted(begun({}), free=("Nv", "Nr", "Ndelta")), candidates={}).result
    assert contradictions(right.physical) == []
    assert "Known beforehand" in prior_words(right.physical)


def test_without_priors_nothing_is_said_of_them():
    found = diagnose(fitted(begun({}), priors=False, free=("Nr", "Ndelta")), candidates={}).result
    assert prior_words(found.physical) == ""
    assert all(r.prior is None and r.prior_share is None for r in found.physical)


@pytest.mark.study(turn=3)
def test_priors_that_are_drawn_about_the_truth_are_seldom_contradicted():
    """Ten files from which ships scatter as they say: no word against any."""
    rng, said = np.random.default_rng(11), 0
    for seed in range(10):
        off = {n: 1.0 / (1.0 + SCATTER[n] * rng.standard_normal()) for n in ("Nv", "Nr", "Ndelta")}
        fit = fitted(begun(off), seed, ("Nv", "Nr", "Ndelta"))
        said += len(contradictions(diagnose(fit, candidates={}).result.physical))
    assert said == 0


def test_an_estimate_is_not_another_ships_for_scattering_as_it_says():
    """Coefficients a third of the file's: another ship's, unless the file allows for it."""
    off = dict.fromkeys(("Nv", "Nr", "Ndelta"), 3.0)
    free = ("Nv", "Nr", "Ndelta")
    sure, unsure = (begun(off, dict.fromkeys(free, s)) for s in (0.05, 0.45))
    assert len(unlike_file(fitted(sure, priors=False, free=free))[0]) == 3
    assert unlike_file(fitted(unsure, priors=False, free=free))[0] == {}
