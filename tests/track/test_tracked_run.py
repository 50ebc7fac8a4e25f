"""A log with latitudes through the whole of a run: the plane, the current, the turning circle."""

from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from s175q import EFFECTS, ROOT
from sailed_tracks import CURRENTS, noisy, sailed

from trialid.alignment.track.position import FLATTENING, RADIUS
from trialid.design.wind_and_current import WORDS
from trialid.pipeline_file import load
from trialid.progress import silent
from trialid.report.pages.folder import Finished
from trialid.report.pages.imo_form import form
from trialid.report.terminal.summary import summary
from trialid.result.schema import Result
from trialid.trial import Trial
from trialid.workflow.run import run

pytestmark = pytest.mark.study(turn=1)
LAT = 56.0
COLUMNS = {"delta": "rudder [deg]", "r": "rate [deg/s]", "psi": "heading [deg]", "n": "rpm [rad/s]"}
PIPELINE = """
name = "tracked"
ship = "ship.toml"
imo = true
[[trial]]
name = "circle"
logs = ["circle.csv"]
[[trial]]
name = "zigzag"
logs = ["zigzag.csv"]
[signals]
delta = { channel = "rudder", positive = "starboard" }
r = { channel = "rate" }
psi = { channel = "heading" }
n = { channel = "rpm" }
lat = { channel = "latitude" }
lon = { channel = "longitude" }
[align]
period = 2.0
[model]
states = ["u", "v", "p", "r", "phi", "psi", "x", "y"]
effects = EFFECTS
[identify]
free = ["Nv", "Nr", "Ndelta", "Yv", "Ydelta"]
outputs = ["r", "psi", "x", "y"]
nuisance = ["initial_state", "current"]
weights = { psi = 12, x = 12, y = 12 }
[diagnose]
candidates = ["yaw_drag_rav"]
"""


def write_log(file: Path, trial: Trial) -> None:
    """The trial as a table, its positions across the date line, by the radii of curvature."""
    e2, phi = FLATTENING * (2.0 - FLATTENING), np.deg2rad(LAT)
    w = np.sqrt(1.0 - e2 * np.sin(phi) ** 2)
    lat = LAT + np.rad2deg(trial.signals["x"] * w**3 / (RADIUS * (1.0 - e2)))
    lon = 179.999 + np.rad2deg(trial.signals["y"] * w / (RADIUS * np.cos(phi)))
    angles = {n: np.rad2deg(trial.signals[n]) for n in ("delta", "r", "psi")}
    columns = [trial.t, *angles.values(), trial.signals["n"], lat, (lon + 180.0) % 360.0 - 180.0]
    head = ",".join(["t [s]", *COLUMNS.values(), "latitude [deg]", "longitude [deg]"])
    rows = [",".join(f"{x:.9f}" for x in row) for row in np.column_stack(columns)]
    file.write_text("\n".join([head, *rows]) + "\n", encoding="utf-8")


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Result:
    folder = tmp_path_factory.mktemp("tracked")
    rng = np.random.default_rng(4)
    for name, water in CURRENTS.items():
        write_log(folder / f"{name}.csv", noisy(sailed(name, water), rng))
    ship = (ROOT / "sample_data" / "ships" / "s175q.toml").read_text(encoding="utf-8")
    (folder / "ship.toml").write_text(ship, encoding="utf-8")
    effects = ", ".join(f'"{e}"' for e in EFFECTS)
    file = folder / "tracked.toml"
    file.write_text(PIPELINE.replace("EFFECTS", f"[{effects}]"), encoding="utf-8")
    return run(load(file), silent).result


def test_that_wind_and_current_are_not_told_apart_is_said_wherever_the_current_is(
    result: Result,
) -> None:
    """Her model has no wind in it."""
    console = Console(width=80, record=True, file=StringIO())
    console.print(summary(result))
    for page in (form(Finished("run", result, (), ())), console.export_text()):
        assert WORDS in " ".join(page.split())


def test_it_fits_to_the_noise_of_the_receiver(result: Result) -> None:
    for name in ("x", "y"):
        assert result.fit.eps_rmsn_by_output[name] == pytest.approx(1.0 / 175.0, rel=0.1)


def test_one_number_for_one_ship(result: Result) -> None:
    """Measured through the water, the model under the same rudder, and her standard measures."""
    assert result.imo is not None
    standard = {m.name: m.value for m in result.imo.measures}
    rows = {row.name: row for row in result.imo.turns}
    assert [*rows] == ["advance", "transfer", "tactical diameter"]
    for name in ("advance", "tactical diameter"):
        row = rows[name]
        assert row.corrected_interval is not None
        low, high = row.corrected_interval
        assert standard[name] == pytest.approx(row.corrected, abs=0.75 * (high - low))  # 3 errors
        assert row.predicted == pytest.approx(standard[name], rel=0.005)
    assert rows["tactical diameter"].measured < 520.0  # over the ground: the current shortens it


def test_an_overshoot_is_told_once(result: Result) -> None:
    """By the recorded heading, not by the integral of the rate as well."""
    assert result.imo is not None
    assert result.imo.overshoots == ()
    assert [row.name for row in result.imo.measured] == [
        f"{ordinal} overshoot" for ordinal in ("first", "second", "third")
    ]
    assert [row.kind for row in result.imo.manoeuvres] == ["turning circle", "zig-zag"]
    for row in result.imo.measured:
        assert row.predicted is not None
        assert row.interval[0] < row.predicted < row.interval[1]
