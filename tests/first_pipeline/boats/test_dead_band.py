"""A dead band of thrusters is tried where orders lie in it, and is a parameter of the ship."""

from pathlib import Path

import numpy as np
import pytest
from made_boat import T, begun, late, log, pushes

from trialid import pipeline_file
from trialid.diagnosis.search.candidates import out_of_reach
from trialid.effects.actuators import actuator_effects
from trialid.ship.particulars import read_ship
from trialid.trial import Trial
from trialid.workflow.run import run

DEAD = 0.08
PERCENT = ("motor_left_pct", "motor_right_pct")


def some_small(seed: int) -> np.ndarray:
    """Orders of which one in three lies below 0.1 of full."""
    made = pushes(seed)
    small = np.repeat(np.random.default_rng(seed).uniform(0.0, 1.0, (len(T) // 60, 2)), 60, axis=0)
    return np.where(small < 0.35, 0.27 * small, made)


def logs(folder: Path, orders) -> list[Path]:
    """Three trials of a boat whose motors do nothing below `DEAD` of full."""
    found = []
    for i in range(3):
        p = orders(i)
        acts = np.sign(p) * np.maximum(np.abs(p) - DEAD, 0.0)
        found.append(log(folder / f"run{i}.csv", acts, 100.0 * p, PERCENT))
    return found


@pytest.mark.study(turn="each")
def test_a_dead_band_that_orders_lie_in_is_named_and_shown(tmp_path: Path) -> None:
    begun(tmp_path, *logs(tmp_path, some_small))
    done = run(pipeline_file.load(tmp_path / "p.toml"))
    assert done.result.verdict.effect == "thrusters_deadband"
    path = tmp_path / "p.toml"
    text = path.read_text(encoding="utf-8").replace(
        '"thrusters", ', '"thrusters", "thrusters_deadband", '
    )
    text = text.replace('free = ["', 'free = ["dead_thrusters", "')
    path.write_text(text, encoding="utf-8")
    done = run(pipeline_file.load(path))
    [found] = [row for row in done.result.physical if row.name == "dead_thrusters"]
    assert found.value == pytest.approx(DEAD, rel=0.15)
    assert not any(row.name == "dead_thrusters" for row in done.result.nuisance)


def test_without_an_order_in_it_none_is_tried(tmp_path: Path) -> None:
    begun(tmp_path, *logs(tmp_path, pushes))
    done = run(pipeline_file.load(tmp_path / "p.toml"))
    assert "below 10% of the largest" in done.result.not_tried["thrusters_deadband"]
    assert done.result.verdict.effect != "thrusters_deadband"


@pytest.mark.parametrize(
    ("first", "tried"),
    [
        (0.05 * (T % 60.0 < 2.0), True),  # 2 s in a minute
        (np.zeros(len(T)), False),
        (0.003 * np.sin(40.0 * T), False),  # a motor at rest, with noise
        (late(0.9 * np.sign(np.sin(0.5 * T))[:, None], 0.3)[:, 0], False),  # turned round
    ],
)
def test_small_orders_for_a_while_are_asked_for(tmp_path: Path, first, tried: bool) -> None:
    begun(tmp_path, *logs(tmp_path, pushes))
    effects = actuator_effects(read_ship(tmp_path / "p_ship.toml"))
    signals = dict(zip(("thruster_port_order", "thruster_starboard"), pushes(1).T, strict=True))
    signals["thruster_port_order"] = np.where(T < 60.0, signals["thruster_port_order"], first)
    trial = Trial("a", "fit", 0.1, signals, {n: np.ones(len(T), bool) for n in signals})
    assert ("thrusters_deadband" not in out_of_reach([trial], effects)) == tried


def test_no_motor_does_nothing_below_a_fifth_of_full(tmp_path: Path) -> None:
    """A boat that held her place had a band of 0.38 named; bands of motors go to 0.1."""
    begun(tmp_path, *logs(tmp_path, pushes))
    band = actuator_effects(read_ship(tmp_path / "p_ship.toml"))["thrusters_deadband"]
    assert band.parameters["dead_thrusters"].high == pytest.approx(0.2)
