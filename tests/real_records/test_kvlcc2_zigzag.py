"""Zig-zags of a tanker model from 5 to 30 degrees: linear yaw is not enough; what is missing."""

import shutil

import numpy as np
import pytest
from basin import PIPELINE, RECORDS, columns, in_basin, in_ship
from real_record import added, stages, with_candidates, with_effects

from trialid import pipeline_file
from trialid.diagnosis.search import backward
from trialid.effects import CATALOGUE
from trialid.ship.effect import Force, Mass, Rate
from trialid.workflow.run import run as run_pipeline

pytestmark = [
    pytest.mark.real_data,
    pytest.mark.skipif(not RECORDS.is_dir(), reason=f"no real records {RECORDS}"),
]

YAW = {
    "yaw_drag_vav", "yaw_drag_var", "yaw_drag_rav", "yaw_drag_rar",
    "yaw_cubic_vvv", "yaw_cubic_cross", "yaw_cubic_rrr", "cross_flow_drag",
}  # fmt: skip
SWAY = {e.replace("yaw", "sway") for e in YAW}
BOTH = {"cross_flow_drag"}
"""Nonlinear damping of sway and yaw in one number."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The pipeline, its ship and the records as CSV, side by side."""
    made = tmp_path_factory.mktemp("kvlcc2")
    in_basin(made)
    return made


def run(linear, *effects):
    """The pipeline with effects, each written `effect: parameters`."""
    pairs = [effect.split(": ") for effect in effects]
    free = [p for _, names in pairs for p in names.split()]
    done = run_pipeline(with_effects(linear, [name for name, _ in pairs], free)).result
    fit = done.fit
    print(f"{effects or 'linear'}: {fit.eps_rmsn:.2%}, held out {fit.eps_rmsn_check:.2%}")
    return done


def yaw_alone(linear):
    """Yaw with the sway speed from the record: no drift of a nearly unstable ship."""
    model = linear.model.model_copy(update={"states": ("r",)})
    free = "Nv", "Nr", "Ndelta", "delta_0"
    identify = linear.identify.model_copy(update={"outputs": ("r",), "free": free})
    return linear.model_copy(update={"model": model, "identify": identify})


def with_recorded_speed(linear):
    u = pipeline_file.SignalSource(channel="u", unit="m/s")
    trials = tuple(t.model_copy(update={"signals": {**t.signals, "u": u}}) for t in linear.trials)
    return linear.model_copy(update={"trials": trials})


@pytest.fixture(scope="module")
def linear(folder):
    return pipeline_file.load(folder / PIPELINE)


@pytest.mark.parametrize("record", sorted(RECORDS.glob("*.dat")), ids=lambda path: path.stem[17:])
def test_what_the_columns_hold(record):
    c = columns(record)
    rate = np.gradient(c["psi"], c["t"])
    assert rate @ c["r"] / (c["r"] @ c["r"]) == pytest.approx(1.0, abs=0.01)
    for speed, place in (("along", "x0"), ("across", "y0")):
        assert np.std(c[speed] - np.gradient(c[place], c["t"])) < 0.001
    _, v = in_ship(c)
    assert np.corrcoef(v, c["r"])[0, 1] < -0.8  # a ship drifts outward
    assert np.corrcoef(c["delta"], np.gradient(c["r"], c["t"]))[0, 1] < -0.7  # positive to port


@pytest.mark.study(turn="each")
def test_the_error_falls_with_nonlinear_yaw_damping(linear):
    """Ours: 22.4 % to 14.7, 14.6 and 13.7 %; held out 22.2 % to 14.7, 14.5 and 13.3 %."""
    before = run(linear).fit
    for effects in (
        ["yaw_drag_rar: Nrar"],
        ["yaw_cubic_rrr: Nrrr"],
        ["yaw_drag_rar: Nrar", "sway_drag_vav: Yvav"],
    ):
        after = run(linear, *effects).fit
        assert after.eps_rmsn < 0.75 * before.eps_rmsn
        assert after.eps_rmsn_check < 0.75 * before.eps_rmsn_check


def test_the_fitted_derivatives_are_near_those_of_captive_tests(linear):
    """Of Yasukawa & Yoshimura (2015), with the nonlinear terms in the model."""
    done = run(linear, "yaw_drag_rar: Nrar", "sway_drag_vav: Yvav")
    value = {p.name: p.value for p in done.accuracy.parameters}
    print({n: round(value[n], 5) for n in ("Yv", "Nv", "Nr", "Ydelta", "Ndelta", "Nrar", "Yvav")})
    assert value["Nv"] == pytest.approx(-0.0089, rel=0.2)
    assert value["Nr"] == pytest.approx(-0.0032, rel=0.2)
    assert value["Nrar"] < 0.0
    assert value["Yvav"] < 0.0


@pytest.mark.study(turn="each")
def test_scaling_by_the_recorded_speed_makes_it_worse(linear):
    """Ours: 7.9 % with the speed stated, 12.0 % with the speed read; held out 9.2 and 9.9 %."""
    stated = run(yaw_alone(linear)).fit
    read = run(yaw_alone(with_recorded_speed(linear))).fit
    assert stated.eps_rmsn < 0.8 * read.eps_rmsn
    assert stated.eps_rmsn_check < read.eps_rmsn_check


@pytest.mark.study(turn="each")
def test_nonlinear_yaw_damping_is_named_and_holds_on_the_other_runs(linear):
    """Ours: C_D, 7.9 to 6.3 %, held out 9.2 to 6.7 %; Nrrr does 6.3 and 7.2 %.

    The blocks left out cannot tell it from the speed that a ship loses in a turn, which is so, nor
    from what the hull remembers.
    """
    done = run_pipeline(with_candidates(yaw_alone(linear), "all")).result
    print(done.verdict.sentence)
    assert done.verdict.kind == "missing"
    assert done.verdict.effect in YAW | BOTH
    assert set(done.verdict.family) <= YAW | BOTH | {"surge_loss", "yaw_memory"}
    named = next(m for m in done.missing if m.effect == done.verdict.effect)
    assert named.eps_rmsn_refitted < 0.9 * done.fit.eps_rmsn
    assert named.eps_rmsn_check < 0.9 * done.fit.eps_rmsn_check


@pytest.mark.study(turn="each")
def test_it_is_named_in_sway_and_yaw_together(linear):
    done = run_pipeline(with_candidates(linear, "all")).result
    print(done.verdict.sentence)
    assert done.verdict.kind == "missing"
    assert done.verdict.effect in YAW | BOTH
    slow = ("lag_", "delay_", "clock_", "bias_", "scale_")
    assert [n for n in done.verdict.family if n.startswith(slow)] == []


def _forces(names):
    """Whether all of them push the ship, none a sensor or a clock."""
    return all({Force, Rate, Mass} & set(CATALOGUE[n].forms) for n in names)


@pytest.fixture(scope="module")
def done(folder, tmp_path_factory):
    """The stages of the loop."""
    copy = shutil.copytree(folder, tmp_path_factory.mktemp("loop") / "kvlcc2")
    return stages(copy / PIPELINE, {'candidates = "none"': 'candidates = "all"'})


@pytest.mark.study(turn=10)
def test_the_loop_names_what_pushes_the_ship(done):
    """Each step lowers the held-out error, 21.0 to 5.7 % by five effects; what is left is said."""
    first, *_ = names = added(done)
    assert first in YAW | SWAY | BOTH
    assert set(names) & (YAW | BOTH)
    said = [s.run.result.verdict.effect for s in done if s.run.result.verdict.effect]
    assert _forces(said)
    assert _forces(backward.worth_naming(done[-1].worths))
    held_out = [s.run.result.fit.eps_rmsn_check for s in done if s.kept]
    assert held_out == sorted(held_out, reverse=True)
    told = done[-1].run.result.split.interval
    if told is None or told.undermodelling[0] > 0.0:
        assert done[-1].run.result.verdict.kind != "nothing missing"


@pytest.mark.study(turn=10)
def test_the_loop_more_than_halves_the_held_out_error(done):
    """The speed is stated, not read, so what it loses in a turn (`surge_loss`) is missing."""
    before, after = (s.run.result.fit.eps_rmsn_check for s in (done[0], done[-1]))
    assert after < 0.5 * before


@pytest.mark.study(turn="each")
def test_a_lag_is_not_named_where_a_force_takes_far_more_off(linear):
    """After the drag, a lag of the gyro is likeliest by whitened residuals: 13.86 to 13.82 %."""
    drag = with_candidates(with_effects(linear, ["cross_flow_drag"], ["C_D"]), "all")
    done = run_pipeline(drag).result
    print(done.verdict.sentence)
    assert done.verdict.kind == "cannot tell"  # of two forces
    assert done.verdict.family[0] == "surge_loss"
    assert _forces(done.verdict.family)
    named = next(m for m in done.missing if m.effect == done.verdict.family[0])
    assert named.eps_rmsn_refitted < 0.95 * done.fit.eps_rmsn
    lag = next(m for m in done.missing if m.effect == "lag_r")
    assert lag.left_out_ratio > 0.95 > named.left_out_ratio
