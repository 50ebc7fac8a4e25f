"""The sample ships and their models, each as its source means it."""

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from trialid.effects import CATALOGUE
from trialid.ship.model import STATES, ShipModel
from trialid.ship.particulars import Ship, read_ship

collect_ignore = ["conftest.py"]
"""Not a doctest module: two conftest files named in one command would collide."""

SHIPS = Path(__file__).parents[2] / "sample_data" / "ships"

SECOND_ORDER = (
    "linear_hull", "centripetal_added_mass", "sway_drag_vav", "sway_drag_var", "yaw_drag_vav",
    "yaw_drag_var", "yaw_drag_rar", "roll_drag_vav", "roll_drag_var", "heel_sway", "heel_yaw",
    "roll_rate_yaw", "linear_roll", "heel_roll", "linear_rudder", "surge_resistance",
    "surge_turning", "surge_rudder", "propeller_thrust",
)  # fmt: skip

CUBIC = (
    "linear_hull", "centripetal_added_mass", "sway_cubic_vvv", "sway_cubic_cross",
    "sway_cubic_rrr", "yaw_cubic_vvv", "yaw_cubic_cross", "yaw_cubic_rrr", "roll_cubic",
    "heel_sway", "heel_yaw", "roll_rate_yaw", "heel_sway_cubic", "heel_roll_cubic",
    "heel_yaw_cubic", "linear_roll", "heel_roll", "surge_resistance", "surge_turning",
    "surge_heel", "propeller_rudder",
)  # fmt: skip

NAVAL = (
    "linear_hull", "sway_drag_vav", "sway_drag_var", "sway_drag_rav", "roll_drag_vav",
    "roll_drag_var", "roll_drag_rav", "yaw_drag_rar", "yaw_drag_rav", "heel_sway", "heel_yaw",
    "heel_roll", "heel_drift", "linear_roll", "still_water_roll_damping",
    "quadratic_roll_damping", "righting_arm_cubic", "linear_rudder",
)  # fmt: skip


@pytest.fixture(scope="session", autouse=True)
def kernels(tmp_path_factory: pytest.TempPathFactory) -> None:
    """Compiled kernels of this run, apart from the user's own."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TRIALID_CACHE", str(tmp_path_factory.mktemp("kernels")))
        yield


def model(file: str, states: tuple[str, ...], effects: tuple[str, ...]) -> ShipModel:
    ship = read_ship(SHIPS / f"{file}.toml")
    return ShipModel(ship, states, tuple(CATALOGUE[n] for n in effects))


@pytest.fixture(scope="session")
def s175q() -> ShipModel:
    return model("s175q", STATES, SECOND_ORDER)


@pytest.fixture(scope="session")
def s175() -> ShipModel:
    return model("s175", STATES, CUBIC)


@pytest.fixture(scope="session")
def naval() -> ShipModel:
    """At recorded speed, because its source gives no propeller."""
    return model("naval", STATES[1:], NAVAL)


@pytest.fixture(scope="session")
def text() -> str:
    """A complete ship file."""
    return (SHIPS / "s175q.toml").read_text(encoding="utf-8")


@pytest.fixture
def edited(text: str, tmp_path: Path) -> Callable[..., Ship]:
    """Read the ship file with lines replaced: `edited(L="nan", m=None)`; None drops a line."""

    def read(_append: str = "", **lines: str | None) -> Ship:
        changed = text
        for key, value in lines.items():
            line = "" if value is None else f"{key} = {value}\n"
            changed, count = re.subn(rf"(?m)^{key} = .*\n", lambda _, line=line: line, changed)
            assert count == 1, key
        file = tmp_path / "ship.toml"
        file.write_text(_append + changed, encoding="utf-8")
        return read_ship(file)

    return read
