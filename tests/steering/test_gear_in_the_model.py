"""A steering gear in the model can be the wrong one, or have the wrong numbers."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.verdict import Verdict
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.pipeline_file import load
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial
from trialid.workflow.edit_pipeline import add_to_pipeline

FEW = (
    "rudder_servo_limited",
    "rudder_servo_second_order",
    "rudder_in_drift",
    "lag_phi",
    "drift_with_rudder",
    "rudder_cubic",
    "delay_r",
    "yaw_cubic_rrr",
)
"""Other gears, and what was named in their place."""


def with_gears(gears: Mapping[str, Mapping[str, float]]) -> ShipModel:
    """The test ship with her rudder moved by these, one after the other."""
    model = s175q.MODEL
    for name, values in gears.items():
        model = (model + CATALOGUE[name]).with_values(values)
    return model


def ordered(gears: Mapping[str, Mapping[str, float]], seed: int) -> list[Trial]:
    """Zig-zags of which orders are logged, the rudder moved by gears that nobody announced."""
    rng = np.random.default_rng(seed)
    model = with_gears(gears)
    trials = []
    for amplitude in (5, 10, 20):
        bare = s175q.zigzag(amplitude)
        n = len(bare.signals["delta"])
        signals = {k: x for k, x in bare.signals.items() if k != "delta"}
        signals["delta_order"] = bare.signals["delta"]
        valid = {name: np.ones(n, dtype=bool) for name in signals}
        blank = replace(bare, signals=signals, valid=valid)
        simulator = prepare(model, (), s175q.OUTPUTS)
        y = respond(simulator, blank, {}, {"u": 7.33}, sensitivities=False).y
        moved = {**signals, "r": y[:, 0].copy(), "phi": y[:, 1].copy()}
        trials.append(s175q.with_noise(replace(blank, signals=moved), *s175q.white(rng, n)))
    return trials


def of_the_gear(trials: list[Trial]) -> Verdict:
    """What is said of a model with a gear of one second and no limit, held so."""
    model = (s175q.MODEL + CATALOGUE["rudder_servo"]).with_values({"T_delta": 1.0})
    fit = identify(trials, model, s175q.SETTINGS)
    return diagnose(fit, DiagnoseSettings(candidates={n: CATALOGUE[n] for n in FEW})).verdict


LIMITED = {"rudder_servo_limited": {"T_servo": 1.0, "rate_max": 0.04}}


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", [2051, 2052])
def test_a_play_behind_a_limited_gear_has_its_name(seed: int) -> None:
    """Both gave the rudder's angle once, and a dead band was named in the place of the play."""
    play = {"rudder_backlash": {"b_play": float(np.deg2rad(1.0)), "T_play": 0.5}}
    fit = identify(ordered(LIMITED | play, seed), with_gears(LIMITED), s175q.SETTINGS)
    tried = {n: CATALOGUE[n] for n in (*FEW, "rudder_backlash", "rudder_deadband")}
    found = diagnose(fit, DiagnoseSettings(candidates=tried)).verdict
    assert found.effect == "rudder_backlash"
    assert not fit.model.displaced_by(CATALOGUE["rudder_backlash"])


@pytest.mark.parametrize("gear", [{}, LIMITED])
def test_an_offset_is_added_behind_the_play_whichever_comes_first(gear) -> None:
    play = {"rudder_backlash": {"b_play": 0.02, "T_play": 0.5}}
    offset = {"rudder_offset": {"delta_0": 0.03}}
    blank = ordered({}, 1)[0]
    there, back, without = (
        respond(prepare(with_gears(gear | more), (), ("r",)), blank, {}, {"u": 7.33}).y
        for more in (play | offset, offset | play, play)
    )
    np.testing.assert_array_equal(there, back)
    assert np.ptp(there - without) > 0.1 * np.ptp(without)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize(
    ("gear", "values", "effect", "said"),
    [
        ("rudder_servo", {"T_delta": 1.0}, None, "no effect stands out against the noise"),
        ("rudder_servo", {"T_delta": 2.0}, "T_delta", "T_delta is held at 1; freed, it is 2"),
        (
            "rudder_servo_limited",
            {"T_servo": 1.0, "rate_max": 0.021},
            "rudder_servo_limited",
            "rudder_servo_limited belongs in the place of rudder_servo: with it the error falls",
        ),
    ],
)
def test_the_gear_that_moved_the_rudder_is_named(gear, values, effect, said) -> None:
    """Without gears among what is tried, a force is: drift_with_rudder, lag_phi."""
    found = of_the_gear(ordered({gear: values}, 2041))
    assert found.effect == effect
    assert found.sentence.startswith(said)


def test_the_gear_of_a_model_is_among_those_tried() -> None:
    """A model of 5 m whose rudder goes 9 deg/s at most: by Froude's law 1.6 deg/s of 160 m."""
    length, speed = 5.0, 1.25
    small = {"L": length, "nabla": s175q.SHIP.particulars["nabla"] * (length / 175.0) ** 3}
    small |= {"U0": speed}
    ship = replace(s175q.SHIP, particulars={**s175q.SHIP.particulars, **small})
    hull = tuple(CATALOGUE[n] for n in ("linear_hull", "linear_rudder"))
    model = replace(s175q.MODEL, ship=ship, states=("v", "r"), effects=hull)
    swift = {"T_servo": 0.3, "rate_max": float(np.deg2rad(9.0))}
    made = (model + CATALOGUE["rudder_servo_limited"]).with_values(swift)
    rng, trials = np.random.default_rng(9), []
    for angle, half in ((10.0, 11.0), (20.0, 13.0), (15.0, 9.0)):
        order = np.deg2rad(angle) * np.sign(np.sin(np.pi * (0.05 * np.arange(1600) + 0.1) / half))
        signals = {"delta_order": order, "u": np.full(1600, speed), "r": np.zeros(1600)}
        valid = {n: np.ones(1600, dtype=bool) for n in signals}
        blank = Trial(f"{angle:.0f}", "fit", 0.05, signals, valid)
        y = respond(prepare(made, (), ("r",)), blank, {}, {}, sensitivities=False).y[:, 0]
        noisy = y + 0.02 * np.std(y) * rng.standard_normal(1600)
        trials.append(replace(blank, signals={**signals, "r": noisy}))
    fast = (model + CATALOGUE["rudder_servo"]).with_values({"T_delta": 1.0})
    settings = replace(s175q.SETTINGS, free=("Nv", "Nr", "Ndelta"), outputs=("r",))
    tried = {n: CATALOGUE[n] for n in (*FEW, "rudder_backlash")}
    found = diagnose(identify(trials, fast, settings), DiagnoseSettings(candidates=tried))
    assert found.verdict.effect == "rudder_servo_limited"


def test_a_state_has_one_equation() -> None:
    slow = (s175q.MODEL + CATALOGUE["rudder_servo"]).with_values({"T_delta": 2.0})
    limited = CATALOGUE["rudder_servo_limited"]
    assert slow.displaced_by(limited) == ("rudder_servo",)
    assert slow.lost_to(limited) == {"T_delta"}
    changed = slow + limited
    assert changed.effects == (*s175q.MODEL.effects, limited)
    assert changed.values == s175q.MODEL.values
    assert s175q.MODEL.displaced_by(limited) == ()


def test_added_to_a_pipeline_it_takes_the_place_of_the_other(tmp_path) -> None:
    sample = (s175q.ROOT / "pipelines" / "hidden_effect.toml").read_text(encoding="utf-8")
    text = sample.replace("../sample_data", str(s175q.ROOT / "sample_data"))
    text = text.replace('"roll_drag_var",', '"roll_drag_var", "rudder_servo",')
    text = text.replace("[identify]", "[model.values]\nT_delta = 2.0\n\n[identify]")
    path = tmp_path / "ordered.toml"
    path.write_text(text, encoding="utf-8")
    edit = add_to_pipeline(load(path), "rudder_servo_limited")
    assert "rudder_servo" not in edit.after.model.effects
    assert edit.after.model.effects[-1] == "rudder_servo_limited"
    assert edit.taken_out == ("model.values.T_delta = 2.0",)
    assert {"T_servo", "rate_max"} <= {*edit.after.identify.free}
    back = add_to_pipeline(edit.after, "rudder_servo")
    assert "rudder_servo_limited" not in back.after.model.effects
    assert not {"T_servo", "rate_max"} & {*back.after.identify.free}
