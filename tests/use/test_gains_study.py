"""Gains of identified ships steer the true, simulated ones: what of their promises is kept."""

from dataclasses import replace

import numpy as np
import pytest
import s175q
from test_gains import stepped
from typical import spread_of

from trialid.design.following import sailed_ship
from trialid.design.helm import carry_out, vessel
from trialid.design.manoeuvres import zigzag
from trialid.design.steering.gains import heading_gains, rate_gains
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.ship.model import ShipModel
from trialid.ship.particulars import read_ship
from trialid.trial import Trial

DRAWS, FIRST = 35, 7100
RATE = float(np.deg2rad(3.0))
HULL = ("linear_hull", "linear_rudder", "linear_roll")
FREE = ("Yv", "Nv", "Nr", "Ndelta", "GM")
SMALL, NEAR = 0.01, 0.08
"""Share of a step, and of a time, by which a promise may be missed: by the clock of the record."""


def container() -> ShipModel:
    effects = (*HULL, "heel_yaw", "yaw_drag_rar", "sway_drag_vav")
    return ShipModel(s175q.SHIP, ("v", "p", "r", "phi"), tuple(CATALOGUE[n] for n in effects))


def small_boat() -> ShipModel:
    """The same lines 2 m long, at the speed of Froude's law; a quarter of the stability in roll."""
    share = 2.0 / 175.0
    p = dict(s175q.SHIP.particulars)
    p |= {"L": 2.0, "U0": p["U0"] * share**0.5, "nabla": p["nabla"] * share**3}
    ship = replace(s175q.SHIP, particulars=p)
    model = ShipModel(ship, ("v", "p", "r", "phi"), container().effects)
    return model.with_values({"GM": 0.25 * share * model.value("GM") * 4.0, "Nr": -0.0035})


def naval() -> ShipModel:
    ship = read_ship(s175q.ROOT / "sample_data" / "ships" / "naval.toml")
    return ShipModel(ship, ("v", "p", "r", "phi"), tuple(CATALOGUE[n] for n in HULL))


def record(model: ShipModel, angle: float, seed: int) -> Trial:
    """Twenty-five ship lengths of a zig-zag, with the noise of sensors."""
    p = model.ship.particulars
    time = p["L"] / p["U0"]
    boat = vessel(model, time / 48.0, {"u": p["U0"]}, RATE * 24.0 / time)
    a = float(np.deg2rad(angle))
    trial = carry_out(boat, zigzag(a, a), time, 25.0 * time, f"zigzag-{angle:g}").trial
    rng = np.random.default_rng([seed, int(angle)])
    n = trial.samples
    noise = {"r": np.deg2rad(0.05) * 24.0 / time, "phi": np.deg2rad(0.1)}
    signals = {c: trial.signals[c] for c in ("delta", "r", "phi")}
    signals |= {c: signals[c] + s * rng.standard_normal(n) for c, s in noise.items()}
    valid = {c: np.ones(n, dtype=bool) for c in signals}
    return Trial(trial.name, "fit", trial.period, signals, valid)


MISSING = (
    "heel_roll",
    "yaw_cubic_rrr",
    "yaw_drag_vav",
    "sway_drag_var",
    "rudder_cubic",
    "surge_loss",
    "rudder_servo",
    "sway_cubic_vvv",
)
"""What may be missing: a part of the catalogue, for the time it takes."""


def kept(model: ShipModel, seed: int) -> list[tuple[bool, bool]]:
    """Whether overshoot and settling of the true ship are as promised, by either gains."""
    trials = [record(model, angle, seed) for angle in (10.0, 20.0)]
    fit = identify(trials, model, Settings(FREE, ("r", "phi"), nuisance=("initial_state",)))
    spread = spread_of(fit, {n: CATALOGUE[n] for n in MISSING})
    found = []
    for gains in (rate_gains, heading_gains):
        made = gains(sailed_ship(fit), spread)
        overshoot, settling = stepped(model, made.values, 1e-5)
        low, high = made.promise.ranges["overshoot"]
        near = low - SMALL < overshoot < high + SMALL
        low, high = made.promise.ranges["settling"]
        found.append((bool(near), low * (1.0 - NEAR) < settling < high * (1.0 + NEAR)))
    return found


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("ship", [container, small_boat, naval])
def test_a_true_ship_is_steered_as_promised(ship) -> None:
    """Nine of ten times at the least, of 35 records: by rate and heading, overshoot, settling."""
    found = np.array([kept(ship(), seed) for seed in range(FIRST, FIRST + DRAWS)])
    shares = found.mean(axis=0)
    print(f"{ship.__name__}: overshoot, settling {shares.round(2).tolist()} of {DRAWS} records")
    assert shares.min() >= 0.9
