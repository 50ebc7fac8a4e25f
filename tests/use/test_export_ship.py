"""The fitted ship file: what is fitted again moves by nothing, and the file says how sure it is."""

import json
import shutil
from dataclasses import fields
from pathlib import Path

import pytest
import s175q
from test_bad_input import trialid_

from trialid.effects import CATALOGUE
from trialid.export.model.fitted_ship import (
    FittedShip,
    _file_factor,
    fitted_ship,
    fitted_ship_text,
)
from trialid.result.fit_rows import AccuracyPart, ParameterRow
from trialid.result.schema import Result
from trialid.ship.actuators import Actuator
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship, read_ship

HUNDREDTH = 0.01


@pytest.fixture
def exported(run_folder: Path, tmp_path: Path) -> Path:
    """The project of the run once more, its ship file the exported one."""
    project = Path(shutil.copytree(run_folder.parents[1], tmp_path / "again"))
    out = ("--out", str(project / "ship.toml"), "--force")
    told = trialid_("export", str(run_folder), "--as", "ship", *out)
    assert told.exit_code == 0, told.stderr
    return project


@pytest.mark.study(turn="each")
def test_fitted_again_nothing_moves(run_folder: Path, exported: Path) -> None:
    """By no more than a hundredth of its standard error, from where the first fit ended."""
    told = trialid_("run", str(exported / "used.toml"), "--quiet", "--out", str(exported / "r"))
    assert told.exit_code == 0, told.stderr
    before, after = (
        {p["name"]: p for p in json.loads(path.read_text("utf-8"))["accuracy"]["parameters"]}
        for path in (run_folder / "result.json", exported / "r" / "result.json")
    )
    assert before.keys() == after.keys()
    for name, row in before.items():
        moved = abs(after[name]["value"] - row["value"])
        assert moved <= HUNDREDTH * row["standard_error"], name
    old = s175q.SHIP.coefficients["Nr"]
    assert read_ship(exported / "ship.toml").coefficients["Nr"] != old


def test_how_sure_it_is_goes_with_it(run_folder: Path, exported: Path) -> None:
    """No number more sure than its likely range; what was not fitted keeps what it had."""
    rows = json.loads((run_folder / "result.json").read_text("utf-8"))["accuracy"]["parameters"]
    ship = read_ship(exported / "ship.toml")
    fitted = [p for p in rows if p["kind"] == "physical"]
    assert {p["name"] for p in fitted} == {"Nr", "Nv", "Ndelta", "GM"}
    for p in fitted:
        far = max(abs(end - p["value"]) for end in p["likely"]) / abs(p["value"])
        assert ship.uncertainty[p["name"]] == pytest.approx(far / 1.96, rel=1e-3)
        assert ship.coefficients[p["name"]] == p["value"]
    assert ship.share_off("Yv") == s175q.SHIP.share_off("Yv")
    assert "zigzag-10.csv, zigzag-20.csv" in ship.source
    assert s175q.SHIP.source in ship.source


def test_a_ship_of_another_system_keeps_it(tmp_path: Path) -> None:
    """Dimensional, her rudder to port: her file has the fitted numbers in her own system."""
    prime = s175q.SHIP
    names = ("linear_hull", "linear_rudder", "linear_roll")
    effects = tuple(CATALOGUE[n] for n in names)
    port = Ship(
        name="port",
        source="made",
        system="dimensional",
        rudder_positive="port",
        particulars=prime.particulars,
        mass={"m": 2.2e7, "I_zz": 3.8e10, "I_xx": 1.5e9, "Nrdot": -3.5e10},
        coefficients={"Ndelta": -9.0e6, "Nr": -2.0e9, "Yv": -1.3e6, "GM": 0.4},
        coefficient_speed=7.0,
    )
    model = ShipModel(port, ("v", "r"), effects)
    fitted = {"Ndelta": 0.0016, "Nr": -0.0026, "GM": 0.33, "Nrdot": -0.0004}
    rows = tuple(
        ParameterRow(name=n, value=x, likely=(0.9 * x, 1.1 * x)) for n, x in fitted.items()
    )
    result = Result(accuracy=AccuracyPart(parameters=rows))
    made = fitted_ship(model.with_values(fitted), result)
    path = tmp_path / "port.toml"
    path.write_text(fitted_ship_text(made, ()), encoding="utf-8")
    back = ShipModel(read_ship(path), ("v", "r"), effects)
    for name, value in fitted.items():
        assert back.value(name) == pytest.approx(value, rel=1e-14), name
    assert back.value("Yv") == model.value("Yv")
    assert read_ship(path).coefficients["Ndelta"] < 0.0
    assert _file_factor(model, "Ndelta") < 0.0


def test_everything_a_ship_file_can_say_is_said_again(tmp_path: Path) -> None:
    """Every field of a ship, none at what is taken where the file is silent."""
    ship = Ship(
        name='a "ferry"',
        source="a book, 2019",
        system="prime",
        rudder_positive="port",
        particulars={"L": 96.5, "rho": 1025.0, "g": 9.81, "nabla": 3560.0, "U0": 8.2, "T": 3.1},
        mass={"m": 0.00792, "I_zz": 0.000456},
        coefficients={"Yv": -0.0119, "a part's own": 1.0 / 3.0},
        coefficient_speed=7.3,
        notes="weighed\nin dock",
        uncertainty={"default": 0.1, "m": 0.0, "Yv": 0.123456789},
        antenna={"x": -12.25, "y": 0.1, "z": -17.0},
        actuators=(
            Actuator(name="port", kind="azimuth", x=-40.0, y=-3.0, direction=0.3, own=True),
            Actuator(name="bow", kind="tunnel", x=41.0, y=0.0, direction=1.6, command="share"),
        ),
    )
    silent = {f.name: f.default_factory() for f in fields(Ship) if callable(f.default_factory)}
    silent |= {f.name: f.default for f in fields(Ship) if f.name not in silent}
    assert all(getattr(ship, name) != default for name, default in silent.items())
    path = tmp_path / "ferry.toml"
    path.write_text(fitted_ship_text(FittedShip(ship, {}), ()), encoding="utf-8")
    assert read_ship(path) == ship


def test_what_the_pipeline_states_of_the_ship_goes_with_her() -> None:
    """A number of her hull that no file had; of a sensor nothing."""
    effects = tuple(CATALOGUE[n] for n in ("linear_hull", "yaw_cubic_rrr", "bias_r"))
    model = ShipModel(s175q.SHIP, ("v", "r"), effects).with_values({"Nrrr": -0.002, "b_r": 0.01})
    made = fitted_ship(model, Result())
    before = s175q.SHIP.coefficients
    assert {*made.ship.coefficients} - {*before} == {"Nrrr"} - {*before}
    assert made.ship.coefficients["Nrrr"] == -0.002
    assert made.words["Nrrr"] == "as the pipeline states it"
