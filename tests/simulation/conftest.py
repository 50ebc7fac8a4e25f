"""A ship with everything in it, a lively trial, and a kernel cache of the test run's own."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typical import wave

from trialid.effects import CATALOGUE
from trialid.names.quantities import SIGNALS
from trialid.ship.model import STATES, ShipModel
from trialid.ship.particulars import Ship, read_ship
from trialid.trial import Trial

collect_ignore = ["conftest.py"]
"""Not a doctest module: two conftest files named in one command would collide."""

SHIPS = Path(__file__).parents[2] / "sample_data" / "ships"

EVERYTHING = (
    "linear_hull", "centripetal_added_mass", "sway_drag_vav", "sway_drag_var", "yaw_drag_rav",
    "yaw_drag_rar", "roll_drag_vav", "heel_drift", "heel_yaw_cubic", "linear_roll",
    "still_water_roll_damping", "quadratic_roll_damping", "righting_arm_cubic", "static_list",
    "surge_resistance", "surge_turning", "propeller_rudder", "rudder_offset",
    "bias_r", "bias_phi", "delay_r", "delay_phi", "gyro_cross_axis",
)  # fmt: skip

OFF_CENTRE = {
    "x_G": -0.012, "z_G": -0.007, "Ypdot": 0.00022, "Npdot": 0.00001, "Krdot": -0.00002,
    "Yrdot": -0.00035, "Nvdot": -0.0003,
}  # fmt: skip
"""Every entry of the mass matrix nonzero, and no pair of them equal."""


@pytest.fixture(scope="session", autouse=True)
def kernels(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    """Compiled kernels of this run, so that no test is helped or harmed by an earlier one."""
    folder = tmp_path_factory.mktemp("kernels")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("TRIALID_CACHE", str(folder))
        yield folder


@pytest.fixture(scope="session")
def s175q() -> Ship:
    return read_ship(SHIPS / "s175q.toml")


@pytest.fixture(scope="session")
def everything(s175q: Ship) -> ShipModel:
    """Four degrees of freedom, nonlinear terms, a mass matrix that heel changes, sensors."""
    ship = replace(s175q, mass={**s175q.mass, **OFF_CENTRE})
    effects = tuple(CATALOGUE[n] for n in EVERYTHING)
    typical = {
        n: p.start for e in effects for n, p in e.parameters.items() if n not in ship.coefficients
    }
    typical |= {"tau_r": 0.7, "tau_phi": -0.4, "delta_0": 0.03, "Kpap": -0.0005}
    return ShipModel(ship, STATES, effects, typical)


@pytest.fixture(scope="session")
def lively() -> Callable[..., Trial]:
    """A trial whose every signal moves all the time."""

    def make(samples: int = 25, period: float = 1.0, seed: int = 1) -> Trial:
        t = np.arange(samples) * period
        signals = {name: wave(name, t, seed) for name in SIGNALS if name != "u"}
        signals["u"] = 7.3 + 0.1 * np.cos(0.07 * t)
        signals["n"] = 10.0 + 2.0 * np.sin(0.13 * t)  # where a shaft stops, thrust has a kink
        return Trial("lively", "fit", period, signals, {})

    return make
