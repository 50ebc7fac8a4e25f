"""Motors that are logged late turn a boat the other way: a clock is doubted, and not her sides."""

from pathlib import Path

import numpy as np
import pytest
from made_boat import PERIOD, T, begun, log, pushes, sailed

from trialid.alignment.agreement.signs import late_cause

NAMES = ("rpm_port [1]", "rpm_starboard [1]")


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("late", [0.0, 0.5, 1.5, 2.5])
def test_the_delay_of_the_motors_log_and_the_side(late: float, side: float) -> None:
    for seed in range(60, 72):
        acts = pushes(seed)
        left, right = (acts**2).T
        r = sailed(acts)["r"] + 0.01 * np.random.default_rng(seed).standard_normal(len(T))
        logged = np.roll(side * (left - right), round(late / PERIOD))
        lag, strength = late_cause(logged, r, np.ones(len(T), dtype=bool), PERIOD)
        assert np.sign(strength) == side
        assert lag == pytest.approx(-late, abs=0.5)


@pytest.mark.parametrize("samples", [0, 3, 30, 120])
def test_a_short_record_tells_what_it_can(samples: int) -> None:
    """Three seconds and twelve: less than the clocks that are sought lie apart."""
    acts = pushes(60)[:samples]
    r = np.sin(np.arange(samples))
    lag, strength = late_cause(acts[:, 0], r, np.ones(samples, dtype=bool), PERIOD)
    assert abs(lag) <= 0.5 * samples * PERIOD
    assert abs(strength) <= 1.0


@pytest.mark.parametrize(("late", "exchanged"), [(3.0, False), (0.0, True)])
def test_a_clock_or_the_sides(tmp_path: Path, late: float, exchanged: bool) -> None:
    acts = pushes(8)
    logged = np.roll(acts, round(late / PERIOD), axis=0)
    made = begun(
        tmp_path, log(tmp_path / "boat.csv", acts, logged[:, ::-1] if exchanged else logged, NAMES)
    )
    [said, *_] = [one for one in made.to_fill if "towards the stronger one" in one]
    assert ("the thrusters are logged late" in said) is not exchanged
    assert ("are exchanged, or the side of r is wrong" in said) is exchanged


@pytest.mark.parametrize(("late", "told"), [(8.0, True), (0.0, False)])
def test_a_heading_of_another_clock_is_said_and_left(
    tmp_path: Path, late: float, told: bool
) -> None:
    acts = pushes(9)
    path = log(tmp_path / "boat.csv", acts, acts, NAMES)
    heading = np.rad2deg(sailed(acts)["psi"]) % 360.0
    moved = np.concatenate([np.full(round(late / PERIOD), heading[0]), heading])[: len(T)]
    rows = path.read_text(encoding="utf-8").splitlines()
    told_too = [f"{row},{x:.2f}" for row, x in zip(rows[1:], moved, strict=True)]
    path.write_text("\n".join([f"{rows[0]},heading_deg", *told_too]), encoding="utf-8")
    made = begun(tmp_path, path)
    text = next(iter(made.trials)).signals
    [rate] = [one for one in text if one.quantity == "r"]
    assert ("two clocks are apart; `delay = 8` in psi" in rate.why) is told
    assert ("psi" in {one.quantity for one in text}) is not told
