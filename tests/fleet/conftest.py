"""A fleet of one ship and three voyages, made once."""

import shutil
from pathlib import Path

import pytest
from generated_fleet import drawn_ship, template, write_voyage

FLEET = """
name = "one ship, three voyages"
template = "template-csv.toml"

[fleet.alpha]
file = "ship-3.toml"
voyages = "alpha/*"
"""


@pytest.fixture(scope="session")
def made_fleet(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the fleet, for reading only."""
    folder = tmp_path_factory.mktemp("made")
    ship = drawn_ship(folder, 3)
    for number in (1, 2, 3):
        write_voyage(folder / "alpha" / f"2025-0{number}-10", ship, number)
    template(folder, ship.name, "alpha/2025-01-10")
    (folder / "fleet.toml").write_text(FLEET, encoding="utf-8")
    return folder


@pytest.fixture
def fleet_folder(made_fleet: Path, tmp_path: Path) -> Path:
    """A copy of it to change."""
    return Path(shutil.copytree(made_fleet, tmp_path / "fleet"))
