"""A boat's thrusters are put under orders by their own names, in a table and in Python."""

from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from made_boat import PERIOD, T, begun, log, pushes, sailed

import trialid
from trialid.cli.main import commands
from trialid.errors import TrialidError

NAMES = ("thruster_port", "thruster_starboard")


@pytest.fixture(scope="module")
def finished(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("boat")
    logs = []
    for i in range(3):
        p = pushes(i)
        logs.append(
            log(folder / f"run{i}.csv", p, 100.0 * p, ("motor_left_pct", "motor_right_pct"))
        )
    begun(folder, *logs)
    return folder / "p.toml"


def told(folder: Path, unit: str, scale: float, ending: str = "") -> str:
    """What `simulate` says of a table of orders; the series beside it."""
    heads = ",".join(["t[s]", *(f"{name}{ending}{unit}" for name in NAMES)])
    rows = np.column_stack([T, scale * pushes(9)])
    np.savetxt(folder / "orders.csv", rows, delimiter=",", header=heads, comments="", fmt="%.6g")
    asked = ["simulate", "runs/p", "orders.csv", "--out", "made.csv", "--force", "--anyway"]
    done = CliRunner().invoke(commands, asked)
    return done.stdout + done.stderr


@pytest.mark.study(turn="each")
def test_orders_of_thrusters_are_read_in_their_units(finished: Path, monkeypatch) -> None:
    monkeypatch.chdir(finished.parent)
    run = trialid.run(finished)
    assert CliRunner().invoke(commands, ["run", "p.toml", "--quiet"]).exit_code == 0
    given = dict(zip(NAMES, pushes(9).T, strict=True))
    frame = run.simulate(**given, period=PERIOD, anyway=True)
    true = sailed(pushes(9))["u"]
    np.testing.assert_allclose(frame["u"].to_numpy()[600:], true[600 : len(frame)], atol=0.15)
    for unit, scale, ending in (("[1]", 1.0, ""), ("[%]", 100.0, ""), ("[1]", 1.0, "_order")):
        said = told(Path(), unit, scale, ending)
        assert "passed over" not in said
        assert "Not read by the model" not in said
        made = np.genfromtxt("made.csv", delimiter=",", names=True, deletechars="")
        column = next(n for n in made.dtype.names if n.startswith("u[") or n == "u")
        np.testing.assert_allclose(made[column][-100:], frame["u"].to_numpy()[-100:], rtol=1e-3)
    assert "unit 'rpm' cannot become '1'" in told(Path(), "[rpm]", 1.0)
    assert "write its header as thruster_port[1]" in told(Path(), "", 1.0)
    with pytest.raises(TrialidError, match="did you mean 'thruster_port'"):
        run.simulate(thruster_prt=given["thruster_port"], period=PERIOD, anyway=True)
