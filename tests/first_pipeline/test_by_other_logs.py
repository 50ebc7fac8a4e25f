"""A turn does not tell the side of its rudder; zig-zags of the same recorder do."""

from pathlib import Path

import numpy as np
import pytest
from geared_rudder import geared

from trialid.inspection import Inspection, inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import Starter, starter
from trialid.workflow.first_pipeline.by_other_logs import with_units

T = np.arange(0.0, 600.0, 0.5)
ZIGZAG = 10.0 * np.sign(np.sin(0.05 * T) + 0.3 * np.sin(0.013 * T))
TURN = np.full(len(T), 20.0)


def log(path: Path, orders: np.ndarray, gain: float, name: str = "rudder_deg") -> Path:
    """The log of a ship that turns by so much for each degree of her rudder."""
    delta, r = geared(orders), np.zeros(len(T))
    for k in range(len(T) - 1):
        r[k + 1] = r[k] + 0.5 * (gain * delta[k] - r[k]) / 15.0
    table = np.column_stack([T, delta, r, np.cumsum(r) * 0.5, np.full(len(T), 6.0)])
    heads = f"t,{name},rot [deg/s],heading [deg],stw [m/s]"
    np.savetxt(path, table, delimiter=",", header=heads, comments="", fmt="%.6g")
    return path


def begun(folder: Path, *logs: Path) -> Starter:
    return starter(
        [inspect_log(one) for one in logs], folder / "p.toml", None, Given(length=100.0), 6.0
    )


@pytest.mark.parametrize(("gain", "side"), [(0.05, "starboard"), (-0.05, "port")])
def test_a_turn_takes_the_side_of_the_zigzags_beside_it(
    tmp_path: Path, gain: float, side: str
) -> None:
    """Whether she turns towards it or away is then measured, not assumed."""
    logs = [log(tmp_path / f"z{i}.csv", ZIGZAG, gain) for i in range(2)]
    made = begun(tmp_path, *logs, log(tmp_path / "turn.csv", TURN, gain))
    assert made.to_fill == ()
    text = made.files[tmp_path / "p.toml"]
    assert text.count(f'positive = "{side}"') == 3
    assert "side as in z0.csv, of the same name" in text


def in_radians(path: Path, orders: np.ndarray, first: float) -> Path:
    """A log of no units at all, as simulations are saved, whose heading goes round at pi."""
    table = np.loadtxt(log(path, orders, 0.05), delimiter=",", skiprows=1)
    table[:, 1:4] = np.deg2rad(table[:, 1:4])
    table[:, 3] = (table[:, 3] + first + np.pi) % (2.0 * np.pi) - np.pi
    np.savetxt(path, table, delimiter=",", header="t,delta,r,psi,u", comments="", fmt="%.6g")
    return path


def test_a_heading_in_radians_that_never_goes_round_is_told_by_one_that_does(
    tmp_path: Path,
) -> None:
    """Alone its numbers may be degrees; beside a turn they are not, nor is the rate."""
    still = in_radians(tmp_path / "z.csv", ZIGZAG, 0.1)
    round_about = in_radians(tmp_path / "turn.csv", TURN, 0.1)
    surveys = [inspect_log(one) for one in (still, round_about)]
    assert [units_of(some) for some in ([surveys[0]], surveys)] == [[None], ["rad", "rad"]]
    text = begun(tmp_path, still, round_about).files[tmp_path / "p.toml"]
    assert text.count('\npsi   = { channel = "psi", unit = "rad" }') == 2
    assert text.count('\nr     = { channel = "r", unit = "rad/s" }') == 2
    assert text.count("unit by the slope of psi") == 2


def units_of(surveys: list[Inspection]) -> list[str | None]:
    return [one.channels["psi"].unit_by_size for one in with_units(surveys)]


def test_two_logs_that_disagree_settle_no_third(tmp_path: Path) -> None:
    """A recorder that was set to degrees once keeps what each log's own numbers say."""
    still = in_radians(tmp_path / "z.csv", ZIGZAG, 0.1)
    round_about = in_radians(tmp_path / "turn.csv", TURN, 0.1)
    degrees = tmp_path / "degrees.csv"
    table = np.loadtxt(round_about, delimiter=",", skiprows=1)
    table[:, 1:4] = np.rad2deg(table[:, 1:4])
    np.savetxt(degrees, table, delimiter=",", header="t,delta,r,psi,u", comments="", fmt="%.6g")
    surveys = [inspect_log(one) for one in (still, round_about, degrees)]
    assert units_of(surveys) == [None, "rad", "deg"]
    text = begun(tmp_path, still, round_about, degrees).files[tmp_path / "p.toml"]
    units = [line.split('unit = "')[1][:3] for line in text.splitlines() if '"psi", unit' in line]
    assert units == ["rad", "rad", "deg"]  # the third by how fast she turns


@pytest.mark.parametrize("unit", ["rad", "deg"])
def test_a_heading_that_goes_on_is_told_by_how_fast_she_turns(tmp_path: Path, unit: str) -> None:
    """A simulation's begins at zero and passes 2 pi, or 20, without a jump."""
    for orders in (ZIGZAG, TURN):
        path = in_radians(tmp_path / "s.csv", orders, 0.0)
        table = np.loadtxt(path, delimiter=",", skiprows=1)
        table[:, 3] = np.unwrap(table[:, 3])
        table[:, 1:4] *= 1.0 if unit == "rad" else np.rad2deg(1.0)
        np.savetxt(path, table, delimiter=",", header="t,delta,r,psi,u", comments="", fmt="%.6g")
        assert inspect_log(path).channels["psi"].unit_by_size is None
        text = begun(tmp_path, path).files[tmp_path / "p.toml"]
        assert f'psi   = {{ channel = "psi", unit = "{unit}" }}' in text
        assert f'r     = {{ channel = "r", unit = "{unit}/s" }}' in text
        assert f'delta = {{ channel = "delta", unit = "{unit}"' in text


def bridge_log(path: Path, orders: np.ndarray, side: float) -> Path:
    """NMEA 0183 sentences of a ship whose rudder sensor counts so to starboard."""
    table = np.loadtxt(log(path.with_suffix(".csv"), orders, 0.05), delimiter=",", skiprows=1)
    lines = []
    for t, delta, r, psi, _ in table:
        stamp = f"2026-03-02T10:{int(t) // 60:02d}:{t % 60.0:06.3f}Z"
        for words in (
            f"TIROT,{r * 60.0:.1f},A",
            f"HEHDT,{psi % 360.0:.1f},T",
            f"IIRSA,{side * delta:.1f},A,,",
            "VDVHW,,T,,M,11.7,N,21.6,K",
        ):
            sum_of = 0
            for letter in words:
                sum_of ^= ord(letter)
            lines.append(f"{stamp} ${words}*{sum_of:02X}")
    path.write_text("\r\n".join(lines) + "\r\n", encoding="ascii")
    return path


@pytest.mark.parametrize(("side", "told"), [(1.0, "starboard"), (-1.0, "port")])
def test_what_zigzags_show_comes_before_what_a_format_says(
    tmp_path: Path, side: float, told: str
) -> None:
    """A rudder sensor that was built in the wrong way round is so in the turn, too."""
    zigzag = bridge_log(tmp_path / "zigzag.log", ZIGZAG, side)
    made = begun(tmp_path, zigzag, bridge_log(tmp_path / "turn.log", TURN, side))
    text = made.files[tmp_path / "p.toml"]
    assert text.count(f'positive = "{told}"') == 2
    assert "side as in zigzag.log, of the same name" in text
    assert "CAREFUL: side" not in text


@pytest.mark.parametrize(
    ("gains", "name"),
    [
        ((0.05, -0.05), "rudder_deg"),  # the zig-zags contradict each other
        ((0.05, 0.05), "helm_rudder_deg"),  # the turn's channel is another
    ],
)
def test_what_no_other_log_shows_is_left_to_the_user(
    tmp_path: Path, gains: tuple[float, ...], name: str
) -> None:
    logs = [log(tmp_path / f"z{i}.csv", ZIGZAG, gain) for i, gain in enumerate(gains)]
    made = begun(tmp_path, *logs, log(tmp_path / "turn.csv", TURN, 0.05, name))
    assert [words.partition(",")[0] for words in made.to_fill] == ["turn.csv: delta"]


@pytest.mark.parametrize("heading", [True, False])
def test_a_rudder_of_another_side_than_in_the_other_logs_is_told(
    tmp_path: Path, heading: bool
) -> None:
    """A heading says that her rate was right; without one either may have been turned round."""
    logs = [log(tmp_path / f"z{i}.csv", ZIGZAG, 0.05) for i in range(3)]
    table = np.loadtxt(logs[2], delimiter=",", skiprows=1)
    table[:, 1 if heading else 2] *= -1.0
    kept = [0, 1, 2, 3, 4] if heading else [0, 1, 2, 4]
    heads = np.array(["t", "rudder_deg", "rot [deg/s]", "heading [deg]", "stw [m/s]"])
    for i, one in enumerate(logs):
        rows = table if i == 2 else np.loadtxt(one, delimiter=",", skiprows=1)
        np.savetxt(one, rows[:, kept], delimiter=",", header=",".join(heads[kept]), comments="")
    made = begun(tmp_path, *logs)
    text = made.files[tmp_path / "p.toml"]
    said = "by the motion port, and of the same name starboard in z0.csv"
    assert text.count(said) == 1
    assert text.count('positive = "starboard"') == 2
    if heading:
        assert made.to_fill == ()
        assert f"CAREFUL: {said}" in text
        assert text.count('positive = "port"') == 1
    else:
        assert len(made.to_fill) == 1
        assert "or rot counts the other way here" in made.to_fill[0]
        assert text.count('positive = "?"') == 1
