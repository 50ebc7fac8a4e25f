"""What goes into a result: shares where shares are said, and levers against the equations."""

from types import SimpleNamespace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, zigzag

from trialid.accuracy.likely import Averaged
from trialid.accuracy.parameter_table import Accuracy, ParameterAccuracy
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.examine import examine_fit
from trialid.diagnosis.noise.error_parts import Split
from trialid.identification.fit import identify
from trialid.identification.problem import replace
from trialid.progress import silent
from trialid.result import build
from trialid.result.accuracy_part import accuracy_part
from trialid.ship.motion import motion

GM = ParameterAccuracy(
    name="GM",
    kind="physical",
    unit="m",
    value=-0.40,
    reference=-0.50,
    S_i=1.1,
    S_imin=0.7,
    R_i=1.6,
    noise_error=0.02,
    undermodelling_error=0.05,
    standard_error=0.03,
    white_error=0.01,
    n_effective=120.0,
    likely=(-0.5, -0.3),
    widened_by="heel_yaw",
)


def done_with(model, *rows, variance=0.0, others=()):
    """A fit of this model, which knows its parameters exactly; what follows from them not."""
    problem = SimpleNamespace(weights=np.ones(2), outputs=("r", "phi"), unknowns=())
    fit = SimpleNamespace(model=model, problem=problem, settings=SimpleNamespace(norm="mean"))
    size = len(rows)
    accuracy = Accuracy(
        parameters=rows,
        S_min=1.0,
        S_max=2.0,
        R=2.0,
        n_effective=100.0,
        weak=(),
        covariance=np.zeros((size, size)),
    )
    known = Averaged(np.zeros((1, 1)), np.array([[variance]]), ("",))
    reduced = SimpleNamespace(moves=np.zeros((size, 1)))
    standing = SimpleNamespace(known=reduced, average=lambda slopes: known)
    doubts = SimpleNamespace(standing=standing, held=())
    kept = {"accuracy": accuracy, "own_accuracy": accuracy, "doubts": doubts}
    return SimpleNamespace(fit=fit, others=others, **kept)


def part(model, *rows):
    """The accuracy part of such a fit, nothing missing from it."""
    return accuracy_part(done_with(model, *rows))


def test_both_parts_of_eq_14_are_shares_and_other_errors_in_the_unit():
    (row,) = part(SimpleNamespace(parameters={}), GM).parameters
    assert row.noise_error == pytest.approx(0.04)
    assert row.undermodelling_error == pytest.approx(0.10)
    assert row.relative_error == pytest.approx(0.14)
    assert (row.standard_error, row.white_error) == (0.03, 0.01)
    assert (row.value, row.likely) == (-0.40, (-0.5, -0.3))


def slopes():
    """Slopes of sway force, heel moment and yaw moment by v, r and phi on a straight course."""
    u = MODEL.ship.particulars["U0"]
    theta = {n: MODEL.value(n) for n in MODEL.parameters}

    def right(v, r, phi):
        states = {"u": u, "v": v, "p": 0.0, "r": r, "phi": phi}
        force = motion(MODEL, states, {"delta": 0.0, "n": 0.0}, theta).balance.force
        return np.array([force["v"], force["p"], force["r"]])

    found = []
    for i, step in enumerate((1e-6, 1e-9, 1e-8)):
        off = step * (np.arange(3) == i)
        found.append((right(*off) - right(*-off)) / (2.0 * step))
    return np.array(found).T


def test_levers_are_those_of_the_equations_of_motion():
    """Eq. 15 by the slopes of Eq. 1: the centrifugal force is in them already."""
    F, L = slopes(), MODEL.ship.particulars["L"]
    found = part(MODEL).stability
    assert found.L_v == pytest.approx(F[2, 0] / F[0, 0] / L, rel=1e-5)
    assert found.L_r == pytest.approx(F[2, 1] / F[0, 1] / L, rel=1e-5)
    assert found.stable
    assert found.likely == pytest.approx((found.margin, found.margin))
    # in a slow turn she leans until the heel moment is gone
    heel = -F[1, :2] / F[1, 2]
    G = F[:, :2] + np.outer(F[:, 2], heel)
    assert found.roll_coupled.L_v == pytest.approx(G[2, 0] / G[0, 0] / L, rel=1e-4)
    assert found.roll_coupled.L_r == pytest.approx(G[2, 1] / G[0, 1] / L, rel=1e-4)
    assert found.roll_coupled.margin == pytest.approx(
        found.roll_coupled.L_r - found.roll_coupled.L_v
    )


@pytest.mark.parametrize("upright", [{"GM": 0.0, "Kphi": 0.0}, {"GM": -0.2}])
def test_what_does_not_stand_upright_has_no_heel_of_a_slow_turn(upright):
    """Of a yacht that heels all the while GM ended at zero, and the run in a traceback."""
    found = part(MODEL.with_values(upright)).stability
    assert found.roll_coupled is None
    assert found.margin == part(MODEL).stability.margin


def test_a_margin_is_likely_where_other_models_say_that_it_may_be():
    unsure = done_with(MODEL, variance=0.2**2)
    without_hull = done_with(MODEL - "linear_hull")
    said = accuracy_part(done_with(MODEL, others=(("x", unsure), ("y", without_hull)))).stability
    margin = part(MODEL).stability.margin
    assert said.margin == margin
    assert said.likely == pytest.approx((margin - 1.96 * 0.2, margin + 1.96 * 0.2), rel=1e-3)
    assert said.stable is None
    assert said.roll_coupled.stable is None


def test_where_nobody_knows_how_far_a_margin_is_off_noise_tells_no_stability():
    said = accuracy_part(done_with(MODEL, variance=np.inf)).stability
    assert said.likely is None
    assert said.standard_error == 0.0
    assert said.stable is None


def test_noise_stays_noise_output_by_output():
    split = Split(
        "quiet stretch",
        "",
        noise=0.2,
        undermodelling=0.3,
        noise_interval=(0.1, 0.25),
        undermodelling_interval=(0.28, 0.33),
        by_output={"r": (0.21, 0.32)},
    )
    made = build._split(split, (split,))
    assert (made.noise, made.undermodelling) == (0.2, 0.3)
    assert (made.of("r").noise, made.of("r").undermodelling) == (0.21, 0.32)
    assert (made.ends("noise"), made.ends("undermodelling")) == ((0.1, 0.25), (0.28, 0.33))
    assert made.routes[0].available


def test_a_search_ends_at_the_error_of_the_fit():
    few = replace(SETTINGS, free=("Nr", "Kp"), nuisance=())
    fit = identify([zigzag(10), zigzag(20)], MODEL.with_values({"Nv": -0.0045}), few)
    done, _ = examine_fit(fit, DiagnoseSettings(), silent)
    made = build._fit(done, missing=True)
    assert made.band == done.band
    assert min(made.band.values()) > 0.0
    assert made.iterations[-1].eps_rmsn == pytest.approx(fit.eps_rmsn, rel=1e-6)
    assert made.iterations[0].eps_rmsn > made.iterations[-1].eps_rmsn
    assert made.eps_rmsn == fit.eps_rmsn
