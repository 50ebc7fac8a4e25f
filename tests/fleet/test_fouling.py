"""Forty voyages simulated, logged, fitted: fouling and a lost metacentric height are found, dated.

The hull's drag grows evenly by a fifth from the first voyage to the last; GM is a tenth less from
the 25th on. Nothing else changes but the sensors' noise.
"""

from datetime import date, timedelta
from pathlib import Path

import pandas as pd
import pytest
from generated_fleet import drawn_ship, one_by_one, template, write_voyage

from trialid.fleet.batch import batch
from trialid.pipeline_file.fleet_file import load_fleet
from trialid.ship.particulars import read_ship

pytest.importorskip("pyarrow")

FREE = '["Yv", "Nv", "Nr", "Ndelta", "Kp", "GM", "Xuu"]'
VOYAGES = 40
FIRST = date(2022, 1, 10)


def when(voyage: int) -> date:
    return FIRST + timedelta(days=30 * voyage)


def sailed(folder: Path, seed: int, drift: float, step: float) -> Path:
    """The fleet file of a ship with all her voyages."""
    ship = drawn_ship(folder, seed)
    stated = read_ship(ship).coefficients
    for k in range(VOYAGES):
        values = {
            "Xuu": stated["Xuu"] * (1.0 + drift * k / (VOYAGES - 1)),
            "GM": stated["GM"] * (1.0 + step * (k >= 24)),
        }
        write_voyage(folder / "logs" / f"{when(k)}", ship, 100 * seed + k, values=values)
    path = template(folder, ship.name, f"logs/{when(0)}", free=FREE)
    text = f'template = "{path.name}"\n[fleet.alpha]\nvoyages = "logs/*"\n'
    (folder / "fleet.toml").write_text(text, encoding="utf-8")
    return folder / "fleet.toml"


@pytest.mark.study(turn=1)
def test_fouling_and_a_step_of_gm_are_dated_within_two_voyages(tmp_path: Path) -> None:
    fleet = sailed(tmp_path, 11, drift=0.2, step=-0.1)
    batch(load_fleet(fleet), tmp_path / "out", one_by_one)
    found = pd.read_parquet(tmp_path / "out" / "changes.parquet")
    print(found.drop(columns=["ship", "unit"]).to_string())
    gm = found[found["parameter"] == "GM"].to_dict("records")
    assert [row["form"] for row in gm] == ["step"]
    assert abs((gm[0]["date"] - when(24)).days) <= 60
    assert gm[0]["relative"] == pytest.approx(-0.1, abs=0.02)
    (drag,) = found[found["parameter"] == "Xuu"].to_dict("records")
    assert drag["form"] == "drift"
    assert abs((drag["date"] - when(1)).days) <= 60
    assert abs(drag["size"]) / abs(read_ship(tmp_path / "ship-11.toml").coefficients["Xuu"]) == (
        pytest.approx(0.2, abs=0.04)
    )
    assert set(found["parameter"]) == {"GM", "Xuu"}
