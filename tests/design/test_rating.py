import json

import numpy as np
import pytest
from s175q import EFFECTS as ALL
from s175q import GYRO, INCLINOMETER, MODEL, OUTPUTS, REFERENCE, SHIP, TEN, with_noise, zigzag
from waters import GOAL, NOISE, VESSEL, D

from trialid.design import manoeuvres
from trialid.design.helm import carry_out
from trialid.design.rating import Noise, goal, rate
from trialid.design.triangles import whiten_sensitivities
from trialid.effects import CATALOGUE
from trialid.errors import DesignError
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.ship.model import ShipModel

THEIRS = {
    "Ndelta": "Nd", "Ydelta": "Yd", "Yvav": "Yvv", "Nvav": "Nvv", "Nrar": "Nrr", "Yvar": "Yvr",
    "Nvar": "Nvr",
}  # fmt: skip
FACTORS = {"Nvav": 10.0, "Nrar": 10.0, "Yvar": 500.0, "Nvar": 50.0}
"""What the paper's Table 1 multiplies its parameters with."""
EARLY = (
    "zig-zag amplitude, raw relative parameters, yRMS norm, outputs r+phi",
    "zig-zag amplitude, with seed factors (1..1,10,10,500,50) as parameter scaling",
)


def published(key):
    table = json.loads((REFERENCE / "tables_sens.json").read_text())[EARLY[key]]
    return {row["col"]: row for row in table}


@pytest.mark.parametrize("amplitude", [2, 5, 10, 20])
def test_the_numbers_of_an_independent_implementation(amplitude):
    bare = goal(MODEL, Settings(TEN, OUTPUTS), NOISE)
    scaled = goal(MODEL, Settings(TEN, OUTPUTS), NOISE, scale=FACTORS)
    trial = zigzag(amplitude)
    found, theirs = rate(bare, [trial]), published(0)[amplitude]
    for row in found.parameters:
        name = THEIRS.get(row.name, row.name)
        assert row.S_imin == pytest.approx(theirs["Simin"][name], rel=0.01)
        assert row.S_i == pytest.approx(theirs["Si"][name], rel=0.01)
        assert row.R_i == pytest.approx(row.S_i / row.S_imin)
    assert [found.S_min, found.S_max, found.R] == pytest.approx(
        [theirs[k] for k in ("Smin", "Smax", "R")], rel=0.01
    )
    other = published(1)[amplitude]
    found = rate(scaled, [trial])
    assert pytest.approx(other["R"], rel=0.01) == found.R


@pytest.mark.study(turn=1)
def test_expected_errors_are_those_of_many_fits():
    """Sixty noisy records fitted: the scatter of each parameter is what was expected."""
    free = ("Nv", "Nr", "Ndelta", "Yv", "Ydelta")
    asked = goal(MODEL, Settings(free, OUTPUTS, nuisance=("initial_state",)), NOISE)
    trial, rng = zigzag(10), np.random.default_rng(8)
    rating = rate(asked, [trial])
    found = []
    for _ in range(60):
        noise = (s * rng.standard_normal(trial.samples) for s in (GYRO, INCLINOMETER))
        fit = identify([with_noise(trial, *noise)], MODEL, asked.settings)
        found.append([fit.value(n) / rating.of(n).reference for n in free])
    expected = np.array([rating.of(n).noise_error for n in free])
    np.testing.assert_allclose(np.std(found, axis=0), expected, rtol=0.3)
    assert 0.85 < np.mean(np.std(found, axis=0) / expected) < 1.15


def test_noise_with_a_memory_costs_more():
    """Noise that forgets in 20 s leaves about as many values as there are 40 s."""
    trial = zigzag(10)
    slow = {c: Noise(n.sigma, 20.0) for c, n in NOISE.items()}
    kept = goal(MODEL, GOAL.settings, slow)
    ratio = rate(kept, [trial]).of("Nr").noise_error / rate(GOAL, [trial]).of("Nr").noise_error
    assert 4.0 < ratio < 9.5


def test_a_remainder_of_the_full_model_moves_the_parameters_as_a_fit_does():
    small = ShipModel(SHIP, MODEL.states, tuple(CATALOGUE[e] for e in ALL if e != "yaw_drag_rar"))
    free = ("Nv", "Nr", "Ndelta")
    asked = goal(small, Settings(free, OUTPUTS), NOISE)
    passage = carry_out(VESSEL, manoeuvres.zigzag(5 * D, 5 * D), 20.0, 600.0)
    rating = rate(asked, [passage.trial])
    assert rating.undermodelling > 0.01
    fit = identify([passage.trial], small, asked.settings)
    for name in free:
        row = rating.of(name)
        assert row.bias == pytest.approx((fit.value(name) - row.value) / row.reference, abs=0.03)
        assert abs(row.bias) <= row.bound
    assert max(abs(rating.of(n).bias) for n in free) > 0.02


def test_the_partner_is_the_parameter_whose_error_goes_along():
    rating = rate(GOAL, [zigzag(10)])
    assert rating.of("Yvar").partner == "Nrar"
    assert rating.of("Nrar").partner == "Yvar"
    assert rating.of("Nrar").likeness == pytest.approx(rating.of("Yvar").likeness)
    assert all(abs(p.likeness) <= 1.0 for p in rating.parameters)


def test_twice_the_record_halves_the_variance():
    once, twice = (
        rate(goal(MODEL, Settings(TEN, OUTPUTS), NOISE), [zigzag(10)] * n) for n in (1, 2)
    )
    for one, two in zip(once.parameters, twice.parameters, strict=True):
        assert two.noise_error == pytest.approx(one.noise_error / np.sqrt(2), rel=1e-6)
        assert two.S_imin == pytest.approx(one.S_imin, rel=1e-6)


def test_a_parameter_the_outputs_cannot_see_has_no_error_bar():
    with_bias = MODEL + CATALOGUE["bias_phi"]
    [blind] = CATALOGUE["bias_phi"].parameters
    rating = rate(goal(with_bias, Settings(("Nr", blind), ("r",)), NOISE), [zigzag(10)])
    assert rating.of(blind).S_imin == 0.0
    assert rating.of(blind).noise_error == np.inf
    assert np.isfinite(rating.of("Nr").noise_error)


def test_in_standard_deviations_of_the_noise():
    """Outputs weighed by their noise: the covariance is the inverse of A^T A."""
    alike = {c: Noise(float(s)) for c, s in zip(OUTPUTS, (0.01, 0.01), strict=True)}
    asked = goal(MODEL, Settings(("Nr", "Kp"), OUTPUTS), alike)
    A, names = whiten_sensitivities(asked, [zigzag(10)])
    assert names == ["Nr", "Kp"]
    errors = np.sqrt(np.diag(np.linalg.inv(A.T @ A)))
    rating = rate(asked, [zigzag(10)])
    assert np.all(errors <= [p.noise_error * (1 + 1e-9) for p in rating.parameters])


def test_noise_with_a_memory_is_made_white_first():
    """The inverse of A^T A is then the best any fit could do: never worse than the sandwich."""
    slow = {c: Noise(n.sigma, 20.0) for c, n in NOISE.items()}
    asked = goal(MODEL, Settings(("Nr", "Kp"), OUTPUTS), slow)
    white = goal(MODEL, Settings(("Nr", "Kp"), OUTPUTS), NOISE)
    errors, before = (
        np.sqrt(np.diag(np.linalg.inv(A.T @ A)))
        for A, _ in (whiten_sensitivities(g, [zigzag(10)]) for g in (asked, white))
    )
    rating = rate(asked, [zigzag(10)])
    assert np.all(errors <= [p.noise_error * (1 + 1e-9) for p in rating.parameters])
    assert np.all(errors[0] > 2 * before[0])


def test_an_output_without_noise_and_a_wish_that_is_not_free():
    with pytest.raises(DesignError, match="no noise is stated for output 'phi'"):
        goal(MODEL, GOAL.settings, {"r": NOISE["r"]})
    with pytest.raises(DesignError, match="'Kp' is wanted and not free"):
        goal(MODEL, GOAL.settings, NOISE, wanted=["Kp"])


def test_twice_the_noise_is_an_ellipsoid_twice_as_long_in_each_of_its_axes():
    free = ("Nv", "Nr", "Ndelta")
    trial = zigzag(10)
    levels = [{c: Noise(k * n.sigma) for c, n in NOISE.items()} for k in (1.0, 2.0)]
    quiet, loud = (rate(goal(MODEL, Settings(free, OUTPUTS), noise), [trial]) for noise in levels)
    assert loud.log_volume - quiet.log_volume == pytest.approx(3.0 * np.log(2.0))
    assert loud.noise == pytest.approx(2.0 * quiet.noise)
    errors = [np.log(p.noise_error) for p in quiet.parameters]
    assert quiet.log_volume < sum(errors)  # as large only where nothing goes together


def test_what_is_wanted_alone_is_seen_as_far_as_the_others_leave_it():
    """Eq. 10 by Eq. 11: of a single parameter S_min and S_max are its S_imin."""
    asked = goal(MODEL, Settings(("Nv", "Nr", "Ndelta", "Yv"), OUTPUTS), NOISE, ("Nr",))
    found = rate(asked, [zigzag(10)])
    row = found.of("Nr")
    assert found.S_min == pytest.approx(row.S_imin)
    assert found.S_max == pytest.approx(row.S_imin)
    assert row.S_imin < 0.9 * row.S_i


def test_the_error_to_expect_is_of_noise_and_of_what_the_model_lacks():
    """As in a right triangle: neither knows of the other."""
    truth = MODEL + CATALOGUE["yaw_cubic_rrr"]
    trial = zigzag(10, truth.with_values({"Nrrr": -0.02}))
    for row in rate(goal(MODEL, Settings(("Nv", "Nr"), OUTPUTS), NOISE), [trial]).parameters:
        assert row.bias != 0.0
        assert row.error**2 == pytest.approx(row.noise_error**2 + row.bias**2)
