"""What each actuator is told, with its unit: in the series, the report, the workbench, a replay."""

import base64
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from boats import SHIP

from trialid.design.prediction.seen_range import SeenRange, beyond_words
from trialid.replay.view import draw
from trialid.report.files.overlay import tracks_of
from trialid.report.pictures.input_course import input_courses
from trialid.report.pictures.panels import input_panels
from trialid.result.series import TrialSeries, read_csv, write_csv
from trialid.ship.model import ShipModel

GIVEN = {
    "left": ("rad/s", 10.0, "rpm", 95.493),
    "pod": ("1", -0.5, "1", -0.5),
    "jet": ("N", 40.0, "N", 40.0),
    "pod_angle": ("rad", 0.5, "deg", 28.648),
    "n": ("rad/s", 8.0, "rpm", 76.394),
}
"""Unit and value in SI, as they are shown."""


def series() -> TrialSeries:
    return TrialSeries(
        name="a",
        use="fit",
        t=np.arange(3.0),
        inputs={n: np.full(3, value) for n, (_, value, _, _) in GIVEN.items()},
        outputs=(),
        units=ShipModel(SHIP, ("u", "r")).own_units,
    )


def test_units_go_through_the_file(tmp_path: Path) -> None:
    write_csv(tmp_path / "series.csv", [series()])
    head = (tmp_path / "series.csv").read_text(encoding="utf-8").partition("\n")[0]
    assert head == "trial,use,t_s,left_radps,pod_1,jet_N,pod_angle_rad,n_radps"
    [again] = read_csv(tmp_path / "series.csv")
    for name, (unit, value, shown, _) in GIVEN.items():
        assert again.inputs[name].tolist() == [value] * 3
        assert (again.quantity(name).unit, again.quantity(name).shown) == (unit, shown)


def test_a_panel_has_the_unit_of_its_actuator() -> None:
    panels = dict(zip(GIVEN, input_panels(series()), strict=True))
    for name, (_, _, shown, value) in GIVEN.items():
        assert panels[name]["unit"] == shown
        [line] = panels[name]["lines"]
        drawn = np.frombuffer(base64.b64decode(line["data"]), "<f4")
        assert drawn == pytest.approx([value] * 3, rel=1e-4)
    assert any("left [rpm]" in text for text in input_courses(series()))


def test_what_is_beyond_the_trials_is_told_in_the_unit_of_its_actuator() -> None:
    seen = {"left": SeenRange(0.0, 10.0), "pod": SeenRange(-0.5, 0.5), "u": SeenRange(0.0, 2.0)}
    asked = {"left": np.array([20.0]), "pod": np.array([0.5]), "u": np.array([3.0])}
    said = beyond_words(SHIP, seen, asked)
    assert "left 191 rpm (there 0 rpm to 95.49 rpm)" in said
    assert "3.00 m/s (there 0 m/s to 2.00 m/s)" in said
    assert "pod" not in said


def test_a_recording_names_the_unit() -> None:
    inputs = next(iter(tracks_of(series(), "a", {})))
    assert {*inputs.fields} == {"left_radps", "pod", "jet_N", "pod_angle_rad", "shaft_speed_radps"}


def test_a_replay_shows_what_each_is_told() -> None:
    from rich.console import Console

    trial = SimpleNamespace(
        name="a",
        period=1.0,
        duration=2.0,
        signals={n: np.full(3, value) for n, (_, value, _, _) in GIVEN.items()},
    )
    equations = SimpleNamespace(inputs=("left", "pod", "n"))
    problem = SimpleNamespace(outputs=(), simulator=SimpleNamespace(equations=equations))
    playback = SimpleNamespace(
        at=2,
        trial=trial,
        bands=SimpleNamespace(of=()),
        residual=np.zeros((3, 0)),
        prediction_band={},
        fit=SimpleNamespace(model=SimpleNamespace(ship=SHIP), problem=problem),
        growing=False,
        doing=lambda place: "turning to port",
        events=list,
    )
    console = Console(width=80, record=True)
    with console.capture() as seen:
        console.print(draw(playback, SimpleNamespace(running=False, speed=1.0)))
    assert "left 95.49 rpm, pod -50 %" in seen.get()
