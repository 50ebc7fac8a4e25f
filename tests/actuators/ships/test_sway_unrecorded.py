"""A boat of which speed and rate of turn are logged and sway is not: what stands for her sway.

The truth is the Otter with other gains, damping and arms, begun by `trialid start` alone. Seeds
from 9300 up were never looked at while building.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trialid import pipeline_file
from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.search.candidates import candidates_for
from trialid.diagnosis.verdict import Verdict
from trialid.effects.actuators import actuator_effects
from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial
from trialid.workflow.build_model import available, candidates
from trialid.workflow.first_pipeline import starter
from trialid.workflow.run import run

sys.path.append(str(Path(__file__).parents[1]))

import otter
from otter_model import CANDIDATES, SHIP

TRUE = {"sway_in_turns", "gravity_centre_ahead"}
"""What the truth has and the first model has not: sway, x_G of 0.15 m."""
BOATS = {
    "as published": {},
    "stronger": {"AHEAD": 1.6 * otter.AHEAD, "ASTERN": 1.3 * otter.ASTERN},
    "slides little": {"YV": 3.0 * otter.YV},
    "wide": {"ARM": 0.6, "NRR": 0.5 * otter.NRR},
}


def test_it_is_the_sway_of_a_boat_that_nothing_pushes_aside() -> None:
    """Beside sway simulated by masses, damping and the Munk moment: the same motion, two scales."""
    ship = replace(SHIP, mass={**SHIP.mass, "x_G": 0.0})
    known, m, scale = actuator_effects(ship), otter.MASS, 0.5 * otter.RHO * otter.L**3
    ahead, aside = m - otter.XUDOT, m - otter.YVDOT
    pushed = ("thrusters", "still_water_surge", "still_water_yaw_quadratic")
    values = {"k_ahead": 0.01, "k_astern": 0.006, "Xu0": -80.0, "Nrar0": -400.0}
    whole = ("still_water_sway", "munk_moment", "centripetal_added_mass")
    munk = otter.YVDOT - otter.XUDOT
    of_whole = {"Yv0": otter.YV, "Nuv": munk / scale, "Xvrm": -otter.YVDOT / scale}
    of_whole |= {"Yurm": otter.XUDOT / scale, "Kurm": 0.0}
    of_less = {"X_sway": ahead, "N_sway": munk * ahead / aside, "T_sway": -aside / otter.YV}
    t = np.arange(0.0, 60.0, 0.1)
    orders = otter.some_orders(t, 5)
    signals = {"left": orders[:, 0], "right": orders[:, 1]}
    valid = {s: np.ones(len(t), dtype=bool) for s in signals}
    trial = Trial("a", "fit", 0.1, signals, valid)
    motions = []
    for states, more, own in (
        (("u", "v", "r"), whole, of_whole),
        (("u", "r"), ("sway_in_turns",), of_less),
    ):
        effects = tuple({**CANDIDATES, **known}[n] for n in (*pushed, *more))
        made = ShipModel(ship, states, effects).with_values(values | own)
        start = dict.fromkeys(states, 0.0)
        motions.append(respond(prepare(made, (), ("u", "r")), trial, {}, start).y)
    assert np.ptp(motions[0][:, 1]) > 0.5
    np.testing.assert_allclose(motions[1], motions[0], atol=1e-9)


@pytest.mark.parametrize("states", [("u", "v", "r"), ("u", "r")])
def test_it_is_tried_only_where_sway_is_neither_simulated_nor_recorded(states) -> None:
    effects = tuple(CANDIDATES[n] for n in ("thrusters", "still_water_yaw"))
    model = ShipModel(SHIP, states, effects)
    y = np.sin(np.arange(50.0))
    units = {"u": "m/s", "r": "rad/s", "v": "m/s", "left": "rad/s", "right": "rad/s"}
    for recorded in (("u", "r"), ("u", "v", "r")):
        given = dict.fromkeys((*recorded, "left", "right"), y)
        own = dict.fromkeys(("left", "right"), "rad/s")
        asked = {n: units[n] for n in given}
        trial = Trial.from_arrays("a", np.arange(50.0), given, units=asked, own=own)
        able, left_out = candidates_for(model, trial, CANDIDATES)
        assert ("sway_in_turns" in able) is ("v" not in {*states, *recorded})
        assert "yaw_froude_r" not in able
        assert left_out["yaw_froude_r"] == "corrects Nr, which the model does not have"


def log(path: Path, seed: int) -> Path:
    """Revolutions, rate of turn and speed at 5 Hz."""
    t = np.arange(0.0, 90.0, 0.2)
    sailed = otter.sail(t, otter.some_orders(t, seed))
    rng = np.random.default_rng(seed)
    columns = {
        "time_s": t,
        "rpm_port": sailed.revolutions[:, 0] * 60.0 / (2.0 * np.pi),
        "rpm_starboard": sailed.revolutions[:, 1] * 60.0 / (2.0 * np.pi),
        "yaw_rate_degps": np.rad2deg(sailed.r) + 0.1 * rng.standard_normal(len(t)),
        "stw_mps": sailed.u + 0.02 * rng.standard_normal(len(t)),
    }
    table = np.column_stack([*columns.values()])
    np.savetxt(path, table, "%.6f", ",", header=",".join(columns), comments="")
    return path


def named(folder: Path, seed: int) -> list[Verdict]:
    """What the first run says, and each run with what was named before in its model."""
    made = starter(
        [inspect_log(log(folder / "a.csv", seed))], folder / "p.toml", None, Given(length=2.0)
    )
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    pipeline = pipeline_file.load(folder / "p.toml")
    asked = DiagnoseSettings(candidates=candidates(pipeline, available(pipeline)))
    found = diagnose(run(pipeline).findings.before.fit, asked)
    said = [found.verdict]
    while found.verdict.effect is not None and len(said) < 5:
        fit = next(r.fit for r in found.refits if r.candidate.effect.name == found.verdict.effect)
        found = diagnose(fit, asked, grown=True)
        said.append(found.verdict)
    return said


@pytest.mark.study(turn="each")
def test_the_sway_is_named_where_a_term_of_the_yaw_stood_for_it(tmp_path: Path) -> None:
    """Yaw damping that changes with the Froude number was, and left twice the noise."""
    assert named(tmp_path, 701)[0].effect == "sway_in_turns"


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("boat", BOATS)
def test_no_name_is_wrong_and_what_is_missing_is_named(boat, tmp_path, monkeypatch) -> None:
    """Two records; of both the sway is found.

    Of 12 records, seeds 9300 to 9302 of the four boats, none had a wrong name; without
    `sway_in_turns` three of five others had a wrong one.
    """
    for name, value in BOATS[boat].items():
        monkeypatch.setattr(otter, name, value)
    found = [named(tmp_path, seed) for seed in range(9300, 9302)]
    names = [[v.effect for v in said if v.effect is not None] for said in found]
    print(boat, [[(v.kind, v.family) for v in said] for said in found])
    assert {n for one in names for n in one} <= TRUE, [v.sentence for said in found for v in said]
    assert all("sway_in_turns" in one for one in names)
