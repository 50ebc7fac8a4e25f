"""Drives that jump as no motor does are orders; a gain astern is that of any fitted trial."""

from pathlib import Path

import numpy as np
import pytest
from made_boat import T, begun, late, log, pushes, text_of

from trialid import pipeline_file
from trialid.workflow.first_pipeline.read_as_order import stays
from trialid.workflow.run import run

PERCENT = ("motor_left_pct", "motor_right_pct")
NOISE = 0.002 * np.random.default_rng(3).standard_normal((len(T), 2))


def test_a_gain_astern_is_free_where_one_trial_goes_astern(tmp_path: Path) -> None:
    logs = []
    for i, astern in enumerate((0.0, 0.0, 0.6, 0.0)):
        p = pushes(i, astern=astern)
        logs.append(log(tmp_path / f"run{i}.csv", p, 100.0 * p, PERCENT))
    text = text_of(tmp_path, *logs)
    assert '"k_ahead", "k_astern", "Xu0", "Xuu"' in text
    assert "astern: nothing" not in text
    text = text_of(tmp_path, logs[0], logs[1], logs[3])
    assert "# no fitted trial goes astern: nothing tells it" in text
    assert '"k_ahead", "Xu0"' in text


def test_pulses_go_astern_below_those_at_rest(tmp_path: Path) -> None:
    for i, astern in enumerate((0.5, 0.0)):
        p = pushes(i, astern=astern)
        made = log(tmp_path / f"run{i}.csv", p, 1500.0 + 400.0 * p, ("pwm_left", "pwm_right"))
        assert ('"k_ahead", "k_astern"' in text_of(tmp_path, made)) == bool(astern)


@pytest.mark.parametrize("often", [1.0, 4.0])
def test_a_gain_starts_by_the_revolutions_of_her_log_where_those_are_unusual(tmp_path, often):
    """A catamaran at 1900 rpm left for 35 m/s in two seconds by the gain of a usual screw."""
    p, usual = pushes(1), 1100.0  # rpm of a boat of 2 m
    made = log(tmp_path / "run.csv", p, often * usual * p, ("rpm_left", "rpm_right"))
    text = text_of(tmp_path, made)
    assert ("her gain starts where the most of her log drives her" in text) == (often > 1.0)
    done = run(pipeline_file.load(tmp_path / "p.toml"), lambda words, share=None: None)
    assert done.result.fit.converged


@pytest.mark.parametrize("names", [PERCENT, ("/left/thrust", "/right/thrust")])
def test_a_drive_that_jumps_is_read_as_its_order(tmp_path: Path, names) -> None:
    p = pushes(1)
    text = text_of(tmp_path, log(tmp_path / "run.csv", late(p, 0.5), 100.0 * p, names))
    assert "thruster_port_order " in text
    assert "% of its largest within 0.1 s, which no motor does: read as its order" in text


@pytest.mark.parametrize("lag", [0.1, 0.3, 1.0])
def test_what_a_motor_makes_of_its_orders_stays_feedback(tmp_path: Path, lag: float) -> None:
    made = late(pushes(1), lag)
    for noise in (0.0, NOISE):
        logged = 1200.0 * (made + noise)
        text = text_of(tmp_path, log(tmp_path / "run.csv", made, logged, ("rpm_left", "rpm_right")))
        assert 'thruster_port      = { channel = "rpm_left"' in text
        assert "_order" not in text


def test_an_order_by_its_name_needs_no_jump(tmp_path: Path) -> None:
    made = late(pushes(1), 1.0)
    text = text_of(tmp_path, log(tmp_path / "run.csv", made, made, ("cmd_left", "cmd_right")))
    assert "an order by its name (cmd): read as its order" in text


def test_what_is_sampled_and_held_is_no_jump() -> None:
    """Telemetry of an ESC once a second: a motor's way to its order is in two of its steps."""
    seen = np.repeat(late(pushes(1), 0.5)[::10, 0], 10)
    assert stays(T, pushes(1)[:, 0], 2.0).sum() >= 10
    assert stays(T, seen, 2.0).sum() <= 6


@pytest.mark.study(turn="each")
def test_the_lag_has_a_name_and_no_sensor_is_late(tmp_path: Path) -> None:
    logs = []
    for i in range(3):
        p = pushes(i)
        logs.append(log(tmp_path / f"run{i}.csv", late(p, 0.6), 100.0 * p, PERCENT))
    begun(tmp_path, *logs)
    done = run(pipeline_file.load(tmp_path / "p.toml"))
    assert done.result.verdict.effect == "thrusters_lag"
