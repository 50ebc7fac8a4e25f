"""Every number of a run stands under the heading of its own: a result in which no two are alike."""

import numpy as np
import pytest

from trialid.design.imo.trial_numbers import Overshoot, TurnMeasure
from trialid.report.tables import run_tables
from trialid.report.tables.rounded_table import Figure
from trialid.result.change_rows import ChangePart, MovedRow, StepRow
from trialid.result.finding_rows import CandidateRow
from trialid.result.fit_rows import (
    AccuracyPart,
    FitPart,
    IntervalPart,
    LeversPart,
    ParameterRow,
    PartsRow,
    SplitPart,
    StabilityPart,
    TrialRow,
)
from trialid.result.imo_rows import ImoPart, MeasureRow
from trialid.result.schema import Result

DEG = float(np.rad2deg(1.0))

OFFSET = ParameterRow(
    name="delta_0",
    value=0.010,
    unit="rad",
    S_i=1.1,
    S_imin=0.7,
    R_i=1.6,
    relative_error=0.09,
    noise_error=0.02,
    undermodelling_error=0.07,
    standard_error=0.001,
    likely=(0.006, 0.013),
    widened_by="heel_yaw",
)
CHANGE = ChangePart(
    effect="yaw_drag_rar",
    eps_rmsn=(0.40, 0.31),
    eps_rmsn_check=(0.42, 0.33),
    noise=(0.12, 0.11),
    undermodelling=(0.38, 0.29),
    by_output={"r": (0.45, 0.36)},
    parameters=(
        MovedRow(name="delta_0", unit="rad", before=0.02, after=0.01, standard_error=0.001),
    ),
)
RUN = Result(
    trials=(TrialRow(name="ten", use="fit", eps_rmsn={"r": 0.17, "phi": 0.18}),),
    fit=FitPart(
        eps_rmsn=0.31,
        eps_rmsn_by_output={"r": 0.32, "phi": 0.34},
        eps_rmsn_check=0.37,
        eps_rmsn_check_by_output={"r": 0.38, "phi": 0.39},
    ),
    split=SplitPart(
        noise=0.11,
        undermodelling=0.29,
        interval=IntervalPart(noise=(0.10, 0.13), undermodelling=(0.27, 0.30)),
        by_output={"r": PartsRow(noise=0.14, undermodelling=0.28)},
    ),
    accuracy=AccuracyPart(
        parameters=(OFFSET,),
        stability=StabilityPart(
            L_r=0.41,
            L_v=0.23,
            margin=0.18,
            standard_error=0.02,
            stable=True,
            roll_coupled=LeversPart(
                L_r=0.31, L_v=0.43, margin=-0.12, standard_error=0.03, stable=False
            ),
        ),
    ),
    missing=(
        CandidateRow(
            rank=1,
            effect="yaw_drag_rar",
            eps_rmsn_predicted=0.30,
            eps_rmsn_refitted=0.28,
            eps_rmsn_check=0.33,
            p_value=0.004,
            visibility=0.61,
        ),
    ),
    imo=ImoPart(
        measures=(
            MeasureRow(
                name="advance", unit="m", value=510.0, interval=(490.0, 530.0), allowed=787.5
            ),
        ),
        overshoots=(Overshoot(trial="ten", t=61.0, rudder=0.17, measured=0.10, predicted=0.13),),
        turns=(
            TurnMeasure(
                trial="circle",
                t=30.0,
                rudder=-0.61,
                name="advance",
                measured=523.0,
                interval=(513.0, 533.0),
                corrected=502.0,
                predicted=501.0,
            ),
        ),
    ),
    history=(
        StepRow(
            step="as written", eps_rmsn=0.31, noise=0.11, undermodelling=0.29, eps_rmsn_check=0.37
        ),
    ),
    before_after=CHANGE,
)


def row(table, place=0):
    """A row of one of the run's tables: heading to cell, numbers as such."""
    made = next(t for t in run_tables.tables(RUN) if t.name == table)
    cells = (c.value if isinstance(c, Figure) else c for c in made.rows[place])
    return dict(zip(made.headings, cells, strict=True))


def test_parameters_with_all_that_is_known_of_their_errors():
    found = row("parameters")
    expected = {
        "value": 0.010 * DEG,
        "standard error": 0.001 * DEG,
        "likely from": 0.006 * DEG,
        "likely to": 0.013 * DEG,
        "may be off [%]": 40.0,
        "Eq. 14 [%]": 9.0,
        "from noise [%]": 2.0,
        "from model, at most [%]": 7.0,
        "S_i": 1.1,
        "S_imin": 0.7,
        "R_i": 1.6,
    }
    assert {n: found[n] for n in expected} == pytest.approx(expected)
    assert (found["parameter"], found["unit"]) == ("delta_0", "deg")
    assert found["widened by"] == "heel_yaw"


def test_the_error_and_its_parts_with_their_intervals():
    every, rate = row("error"), row("error", 1)
    expected = {
        "error [%]": 31.0,
        "noise [%]": 11.0,
        "noise from": 10.0,
        "noise to": 13.0,
        "model [%]": 29.0,
        "model from": 27.0,
        "model to": 30.0,
    }
    assert {n: every[n] for n in expected} == pytest.approx(expected)
    assert rate["noise [%]"] == pytest.approx(14.0)
    assert rate["model [%]"] == pytest.approx(28.0)


def test_levers_without_and_with_heel():
    plain, heeled = row("stability"), row("stability", 1)
    assert (plain["L_r"], plain["L_v"], plain["L_r - L_v"]) == (0.41, 0.23, 0.18)
    assert (heeled["L_r"], heeled["L_v"], heeled["L_r - L_v"]) == (0.31, 0.43, -0.12)
    assert (plain["standard error"], heeled["standard error"]) == (0.02, 0.03)
    assert (plain["stable"], heeled["stable"]) == ("yes", "no")


def test_before_stands_before_after():
    pairs = {
        "error, fitted": (40.0, 31.0),
        "error, held out": (42.0, 33.0),
        "noise part": (12.0, 11.0),
        "model part": (38.0, 29.0),
    }
    rows = [row("change", k) for k in range(6)]
    found = {r["quantity"]: (r["before"], r["after"]) for r in rows}
    for name, pair in pairs.items():
        assert found[name] == pytest.approx(pair), name
    assert found["delta_0"] == pytest.approx((0.02 * DEG, 0.01 * DEG))
    assert rows[-1]["standard error"] == pytest.approx(0.001 * DEG)


def test_candidates_foreseen_fitted_and_held_out():
    found = row("missing")
    expected = {
        "rank": 1,
        "error foreseen [%]": 30.0,
        "fitted [%]": 28.0,
        "held out [%]": 33.0,
        "p": 0.004,
        "visible [%]": 61.0,
    }
    assert {n: found[n] for n in expected} == pytest.approx(expected)


def test_a_turning_circle_stands_over_the_ground_and_through_the_water():
    found = row("turns")
    assert found["measured [m]"] == 523.0
    assert found["corrected [m]"] == 502.0
    assert found["model [m]"] == 501.0
    assert found["rudder [deg]"] == pytest.approx(-34.95, abs=0.01)


def test_standard_measures_and_overshoots():
    found = row("imo")
    expected = {"predicted": 510.0, "95 % from": 490.0, "to": 530.0, "allowed": 787.5}
    assert {n: found[n] for n in expected} == expected
    seen = row("overshoots")
    assert seen["rudder [deg]"] == pytest.approx(0.17 * DEG)
    assert seen["measured [deg]"] == pytest.approx(0.10 * DEG)
    assert seen["model [deg]"] == pytest.approx(0.13 * DEG)


def test_trials_and_steps():
    one, fitted, held = (row("validation", k) for k in range(3))
    yaw, roll = (name for name in one if name.endswith("[%]") and "all" not in name)
    assert [one[yaw], one[roll]] == pytest.approx([17.0, 18.0])
    assert [fitted[yaw], fitted["all outputs [%]"]] == pytest.approx([32.0, 31.0])
    assert [held[roll], held["all outputs [%]"]] == pytest.approx([39.0, 37.0])
    step = row("history")
    expected = {"error [%]": 31.0, "noise [%]": 11.0, "model [%]": 29.0, "held out [%]": 37.0}
    assert {n: step[n] for n in expected} == pytest.approx(expected)
