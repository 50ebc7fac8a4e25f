"""A sway speed in the logs: an output where it goes outwards in turns, else left to the user."""

import re
from pathlib import Path

import numpy as np
import pytest
from geared_rudder import geared
from numpy.typing import NDArray

from trialid import pipeline_file
from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import Starter, starter
from trialid.workflow.run import run

T = np.arange(0.0, 600.0, 0.5)


def turned(seed: int) -> NDArray[np.float64]:
    """Rudder [deg], yaw rate [deg/s] and sway [m/s] of a ship of 100 m at 6 m/s; (N, 3).

    The rate follows the rudder in 15 s, the sway the rate in 8 s, outwards.
    """
    rng = np.random.default_rng(seed)
    delta = geared(10.0 * np.sign(np.sin(0.05 * T) + 0.3 * np.sin(0.013 * T)))
    r, v = np.zeros(len(T)), np.zeros(len(T))
    for k in range(len(T) - 1):
        r[k + 1] = r[k] + 0.5 * (-0.05 * delta[k] - r[k]) / 15.0
        v[k + 1] = v[k] + 0.5 * (-1.2 * r[k] - v[k]) / 8.0
    noise = rng.standard_normal((2, len(T)))
    return np.column_stack([delta, r + 0.002 * noise[0], v + 0.005 * noise[1]])


def begun(folder: Path, *, rate: float = 1.0, sway: float = 1.0, still: float = 0.0) -> Starter:
    """The pipeline of one log, written; its columns times these, and as much noise in the sway."""
    delta, r, v = turned(0).T
    v = sway * v + still * np.random.default_rng(1).standard_normal(len(v))
    speed = np.full(len(T), 6.0)
    table = np.column_stack([T, delta, rate * r, v, speed])
    heads = "t,rudder_deg,rate of turn [deg/s],sway speed [m/s],stw [m/s]"
    log = folder / "log.csv"
    np.savetxt(log, table, delimiter=",", header=heads, comments="", fmt="%.6g")
    made = starter([inspect_log(log)], folder / "p.toml", None, Given(length=100.0), 6.0)
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    return made


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("rate", [pytest.param(1.0, marks=pytest.mark.study(turn="each")), -1.0])
def test_a_sway_outwards_is_fitted_with_its_coefficients(tmp_path: Path, rate: float) -> None:
    """A rate without a heading is taken to be positive to starboard, so -1 turns the ship round."""
    begun(tmp_path, rate=rate, sway=rate)
    found = pipeline_file.load(tmp_path / "p.toml")
    assert found.identify.outputs == ("r", "v")
    assert {"Yv", "Ydelta"} <= {*found.identify.free}
    done = run(found, lambda words, share: None)
    assert done.findings.before.fit.converged
    assert done.findings.before.fit.eps_by_output["v"] < 0.2


@pytest.mark.parametrize(("side", "taken"), [(-1.0, True), (1.0, False)])
def test_a_rate_that_is_positive_to_port_turns_the_sway_with_it(
    tmp_path: Path, side: float, *, taken: bool
) -> None:
    """The heading tells the rate's side; the sway is positive to starboard, or to port."""
    begun(tmp_path, rate=-1.0, sway=-side)
    log, r = tmp_path / "log.csv", turned(0)[:, 1]
    heading = 40.0 + np.concatenate([[0.0], np.cumsum(0.25 * (r[1:] + r[:-1]))])
    rows = log.read_text(encoding="utf-8").splitlines()
    more = ("heading [deg]", *(f"{x:.6g}" for x in heading))
    wider = [f"{row},{end}" for row, end in zip(rows, more, strict=True)]
    log.write_text("\n".join(wider), encoding="utf-8")
    made = starter([inspect_log(log)], tmp_path / "q.toml", None, Given(length=100.0), 6.0)
    text = made.files[tmp_path / "q.toml"]
    assert 'unit = "deg/s", positive = "port"' in text
    assert ("outwards in turns (correlation" in text) is taken
    assert ('outputs = ["r", "v"]' in text) is taken


@pytest.mark.parametrize(
    ("how", "why"),
    [
        ({"sway": -1.0}, "it goes inwards in turns (correlation with the rate of turn +0."),
        ({"sway": 0.1, "still": 0.1}, "whether it goes outwards in turns does not show"),
    ],
)
def test_a_sway_of_which_that_does_not_show_is_left_to_the_user(
    tmp_path: Path, how: dict[str, float], why: str
) -> None:
    begun(tmp_path, **how)
    text = (tmp_path / "p.toml").read_text(encoding="utf-8")
    assert f"# left to you: v; {why}" in text
    assert '# v = { channel = "sway speed", unit = "m/s" }' in text
    found = pipeline_file.load(tmp_path / "p.toml")
    assert found.identify.outputs == ("r",)
    assert not {"Yv", "Ydelta"} & {*found.identify.free}


def test_a_sway_without_a_unit_is_left_to_the_user(tmp_path: Path) -> None:
    """Nothing else is asked for by the pipeline, which runs as it is."""
    begun(tmp_path)
    log = tmp_path / "log.csv"
    log.write_text(log.read_text(encoding="utf-8").replace("sway speed [m/s]", "sway speed"))
    made = starter([inspect_log(log)], tmp_path / "q.toml", None, Given(length=100.0), 6.0)
    assert not made.to_fill
    assert "# left to you: v; the log states no unit" in made.files[tmp_path / "q.toml"]


def with_more(folder: Path, columns: tuple[str, ...], values: tuple[float, ...]) -> str:
    """The pipeline of the log with these columns beside its own, each about its value; its text."""
    begun(folder)
    log, wave = folder / "log.csv", np.sin(0.1 * T)
    rows = log.read_text(encoding="utf-8").splitlines()
    given = (",".join(f"{value + 5 * x:.4g}" for value in values) for x in wave)
    wider = [f"{row},{end}" for row, end in zip(rows, (",".join(columns), *given), strict=True)]
    log.write_text("\n".join(wider), encoding="utf-8")
    made = starter([inspect_log(log)], folder / "q.toml", None, Given(length=100.0), 6.0)
    for path, words in made.files.items():
        path.write_text(re.sub(r"(?m)^# (psi|V_aw) =", r"\1 =", words), encoding="utf-8")
    return made.files[folder / "q.toml"]


def test_wind_and_shaft_are_read_and_the_heading_stands_there_commented_out(tmp_path: Path) -> None:
    """A heading that a rate of turn does not go by, as here, is the user's to say too."""
    heads = ("n [rpm]", "heading [deg]", "wind speed relative [m/s]", "wind dir relative [deg]")
    text = with_more(tmp_path, heads, (60.0, 100.0, 8.0, 40.0))
    assert re.search(r'(?m)^n +=.*"n", unit = "rpm"', text)
    assert "# left to you: psi; with it the run seeks a steady wind and a current" in text
    assert re.search(r'(?m)^V_aw +=.*"wind speed relative", unit = "m/s"', text)
    assert "# gamma_aw: by its name, CAREFUL: where the wind comes from" in text
    signals = pipeline_file.load(tmp_path / "q.toml").trials[0].signals
    assert {"n", "psi", "V_aw", "gamma_aw"} <= {*signals}


def test_a_wind_angle_without_a_unit_is_read_where_only_degrees_go_so_far(tmp_path: Path) -> None:
    heads = ("wind speed relative [m/s]", "wind dir relative")
    text = with_more(tmp_path, heads, (8.0, 40.0))
    assert re.search(r'(?m)^gamma_aw +=.*"wind dir relative", unit = "deg"', text)
    text = with_more(tmp_path, heads, (8.0, 0.5))
    assert "# left to you: V_aw; the wind's speed and its angle are read together" in text
    assert "# left to you: gamma_aw; the wind's speed" in text


def test_half_a_wind_is_left_to_the_user(tmp_path: Path) -> None:
    text = with_more(tmp_path, ("apparent wind speed [m/s]",), (8.0,))
    assert "# left to you: V_aw; the wind's speed and its angle are read together" in text
    assert '# V_aw = { channel = "apparent wind speed", unit = "m/s" }' in text


def test_a_log_without_a_sway_says_nothing_of_it(tmp_path: Path) -> None:
    begun(tmp_path)
    log = tmp_path / "log.csv"
    rows = [line.split(",") for line in log.read_text(encoding="utf-8").splitlines()]
    rest = "\n".join(",".join((*row[:3], *row[4:])) for row in rows)
    log.write_text(rest, encoding="utf-8")
    made = starter([inspect_log(log)], tmp_path / "q.toml", None, Given(length=100.0), 6.0)
    assert "left to you" not in made.files[tmp_path / "q.toml"]
    assert 'outputs = ["r"]' in made.files[tmp_path / "q.toml"]
