"""Whether a ship is stable on her course: told by a likely range, not by noise alone."""

import pytest
from s175q import MODEL
from test_usual_forces import begun, drawn, sailed

from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.examine import examine_fit
from trialid.progress import silent
from trialid.result.stability_part import stability_part
from trialid.ship.stability import PARTS, Stability, stability


def told(seed):
    """What a linear model of a drawn ship tells, and her true margin."""
    ship = drawn(seed)
    values = {n: ship.coefficients[n] for n in (*PARTS, "Yurm")}
    hers = stability(values | {"m": MODEL.value("m"), "x_G": MODEL.value("x_G")})
    found, _ = examine_fit(begun(sailed(ship, seed)), DiagnoseSettings(), silent)
    return stability_part(found), hers.margin


@pytest.mark.study(turn="each")
def test_an_unstable_ship_is_not_called_stable_by_a_model_without_her_cubes():
    """Fitted to zig-zags that her other forces end: 20 standard errors on the wrong side."""
    said, hers = told(23)
    assert hers < -0.01
    assert Stability(said.L_r, said.L_v, said.margin, said.standard_error).stable
    assert said.margin > 15.0 * said.standard_error
    assert said.stable is None
    assert said.likely[0] < hers < said.likely[1]
    assert said.roll_coupled.stable is None


@pytest.mark.study(turn=12)
def test_no_ship_is_told_to_be_what_she_is_not():
    """Of 15, eight of them unstable, six are told and none wrongly; by noise alone eight were."""
    known = [told(seed) for seed in (*range(20, 29), 31, 34, 50, 53, 56, 59)]
    hers = [margin > 0.0 for _, margin in known]
    by_noise = [Stability(0.0, 0.0, said.margin, said.standard_error).stable for said, _ in known]
    said = [one.stable for one, _ in known]
    wrong = sum(a is not None and a != b for a, b in zip(said, hers, strict=True))
    wrong_by_noise = sum(a is not None and a != b for a, b in zip(by_noise, hers, strict=True))
    print(f"{said}; wrong {wrong}, by noise alone {wrong_by_noise}")
    assert wrong == 0
    assert wrong_by_noise >= 6
    assert sum(a is not None for a in said) >= 5
