"""S_imin of the ten parameters against an independent implementation and the paper's trends."""

import json

import numpy as np
import pytest
from s175q import AMPLITUDES, MODEL, REFERENCE, SETTINGS, TEN, zigzag

from trialid.accuracy.equations import (
    correlation_ratio,
    minimum_sensitivity,
    relative_sensitivities,
    sensitivity,
    sensitivity_range,
)
from trialid.identification.output_error import linearise
from trialid.identification.problem import pose_problem, replace

TABLE = "zig-zag amplitude, raw relative parameters, yRMS norm, outputs r+phi"
THEIR_NAMES = {
    "Ndelta": "Nd", "Ydelta": "Yd", "Yvav": "Yvv", "Nvav": "Nvv", "Nrar": "Nrr", "Yvar": "Yvr",
    "Nvar": "Nvr",
}  # fmt: skip


def ours(amplitude):
    """The sensitivity matrix A of the ten parameters at the true values."""
    problem = pose_problem([zigzag(amplitude)], MODEL, replace(SETTINGS, nuisance=()))
    _, psi = linearise(problem, problem.start)
    return relative_sensitivities(psi, problem.start)


def theirs():
    """The independent rows, by amplitude."""
    rows = json.loads((REFERENCE / "tables_sens.json").read_text())[TABLE]
    return {row["col"]: row for row in rows}


def test_response_is_that_of_the_independent_implementation():
    reference = np.loadtxt(REFERENCE / "zz10_response_deg.csv", delimiter=",", comments="#")
    trial = zigzag(10)
    r, phi = (np.rad2deg(trial.signals[s][::2]) for s in ("r", "phi"))
    assert np.abs(r - reference[: len(r), 1]).max() < 2e-6  # deg/s, of 0.48
    assert np.abs(phi - reference[: len(phi), 2]).max() < 2e-4  # deg, of 5


@pytest.mark.parametrize("amplitude", AMPLITUDES)
def test_minimum_sensitivities_within_one_percent(amplitude):
    expected = theirs()[amplitude]["Simin"]
    expected = [expected[THEIR_NAMES.get(n, n)] for n in TEN]
    np.testing.assert_allclose(minimum_sensitivity(ours(amplitude)), expected, rtol=0.01)


@pytest.mark.parametrize("amplitude", AMPLITUDES)
def test_ratio_and_single_sensitivities_within_one_percent(amplitude):
    row, A = theirs()[amplitude], ours(amplitude)
    S_min, S_max, R = sensitivity_range(A)
    np.testing.assert_allclose(
        [S_min, S_max, R], [row[k] for k in ("Smin", "Smax", "R")], rtol=0.01
    )
    expected = [row["Si"][THEIR_NAMES.get(n, n)] for n in TEN]
    np.testing.assert_allclose(sensitivity(A), expected, rtol=0.01)
    assert np.all(correlation_ratio(A) >= 1.0)


def test_trends_of_the_papers_table_1():
    """Four of the five linear parameters lose, all five nonlinear ones gain with amplitude."""
    table = np.array([minimum_sensitivity(ours(a)) for a in sorted(AMPLITUDES)])
    linear, nonlinear = table[:, :5], table[:, 5:]
    falling = linear[-1] < linear[0]
    assert falling.sum() == 4
    assert [n for n, down in zip(TEN, falling, strict=False) if not down] == ["Ydelta"]
    assert np.all(np.diff(nonlinear, axis=0) > 0.0)
    weakest = {TEN[5 + i] for i in np.argsort(nonlinear[2])[:3]}
    assert weakest == {"Nvar", "Nvav", "Yvar"}


def test_sensitivity_does_not_depend_on_units():
    """Seconds or minutes, radians or degrees: S_imin and R_i are relative."""
    A = ours(10)
    scaled = relative_sensitivities(A * 57.3, np.full(10, 1.0 / 57.3))
    np.testing.assert_allclose(minimum_sensitivity(scaled), minimum_sensitivity(A), rtol=1e-9)
