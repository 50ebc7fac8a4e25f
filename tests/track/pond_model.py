"""The 3 m Esso Osaka on a pond: her records, and a model of what is published and of her trials.

The ship is what `trialid ship` makes of her particulars, each coefficient held by the scatter of
its formula: all third-order terms of the hull, a rudder whose race goes by the revolutions, which
differ from trial to trial, m_y v r in surge, and wind by the areas above water. Nothing of the
turning tests was fitted, but they are no unseen check of the structure: an earlier one, whose race
knew one approach speed, left them 10 to 34 % too wide, and what they and the zig-zags share of
their accelerations showed why. Among six hulls and rudders tried then this one leaves least of the
fitted records.
"""

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np

from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.identification.ship_priors import ship_priors
from trialid.ship.estimate.all_numbers import ship_from_particulars
from trialid.ship.model import ShipModel
from trialid.trial import Trial

ESSO = Path(__file__).parents[3] / "shared" / "data" / "esso_osaka"
LENGTH = 3.0
HELD = ("13_22_52", "13_29_19")
"""Zig-zags at two other revolutions than most, held out with all turning tests."""
PARTS = 5
"""Of the random test, 684 s long, so that each is as long as a zig-zag."""

SHIP = ship_from_particulars(
    length=LENGTH,
    beam=0.489,
    draught=0.201,
    block=0.83,
    speed=0.4,
    rudder_area=0.0106,
    propeller_diameter=0.084,
    x_G=0.094,
    rho=1000.0,
    name="Esso Osaka, 3 m",
)
EFFECTS = (
    *("linear_hull", "centripetal_added_mass", "sway_cubic_vvv", "sway_cubic_cross"),
    *("sway_cubic_rrr", "yaw_cubic_vvv", "yaw_cubic_cross", "yaw_cubic_rrr", "rudder_race_shaft"),
    *("surge_resistance", "surge_turning", "surge_rudder", "propeller_thrust", "propeller_astern"),
    *("apparent_wind", "apparent_wind_yaw", "apparent_wind_ahead"),
)
FREE = (
    *("Yv", "Yr", "Nv", "Nr", "Yvvv", "Yvvr", "Yvrr", "Yrrr", "Nvvv", "Nvvr", "Nvrr", "Nrrr"),
    *("N_un", "N_nn", "Xuu", "Xvr", "Xdd", "KT0", "KT1", "w_P", "t_P", "X_ast", "N_ast"),
    *("C_aw", "C_ax", "N_aw", "N_2aw"),
)
NONE = dict.fromkeys(("Kv", "Kr", "z_race", "z_aw", "tau_P"), 0.0)
"""No roll was recorded; the wake is not told apart by drift."""

AIR, SIDE, FRONT = 1.225 / 1000.0, 0.520 / LENGTH**2, 0.135 / LENGTH**2
WIND = {
    "C_aw": (0.8 * AIR * SIDE, 0.2 * AIR * SIDE),
    "C_ax": (0.65 * AIR * FRONT, 0.2 * AIR * FRONT),
    "N_aw": (0.0, 0.08 * AIR * SIDE),
    "N_2aw": (-0.08 * AIR * SIDE, 0.04 * AIR * SIDE),
}
"""Coefficients of 0.8 across and 0.65 ahead on the areas stated, a lever of up to 0.08 L or so that
moves by 0.18 L a radian with the wind's angle, of which sin(2 gamma) takes 0.1 (Blendermann 1994:
tankers), each give or take what ships of a kind differ by."""
OUTPUTS = ("u", "v", "r", "psi", "x", "y")


def record(path: Path) -> Trial:
    """A run at 2 Hz from where it is under way; without the rows of commas at its end."""
    lines = [x for x in path.read_text(encoding="utf-8").splitlines()[1:] if x.strip(",")]
    table = np.array([[float(x) for x in line.split(",")[:11]] for line in lines])[::5]
    names = ("t", "x", "u", "y", "v", "psi", "r", "n", "delta", "V_aw", "gamma_aw")
    signals = dict(zip(names, table.T, strict=True))
    del signals["t"]
    for angle in ("psi", "gamma_aw"):
        signals[angle] = np.unwrap(signals[angle])
    signals["n"] = signals["n"] * 2.0 * np.pi
    begin = int(np.argmax(signals["u"] > 0.15)) if "zigzag" in path.stem else 0
    signals = {n: x[begin:].copy() for n, x in signals.items()}
    valid = {n: np.ones(len(x), dtype=bool) for n, x in signals.items()}
    held = "turn" in path.stem or any(name in path.stem for name in HELD)
    return Trial(path.stem, "check" if held else "fit", 0.5, signals, valid)


def records() -> list[Trial]:
    """All runs, the random test in parts."""
    found = []
    for trial in (record(p) for p in sorted(ESSO.glob("*.csv"))):
        found += parts(trial) if "random" in trial.name else [trial]
    return found


def parts(trial: Trial) -> list[Trial]:
    """A long run in parts, each with a start of its own."""
    edges = np.linspace(0, trial.samples, PARTS + 1).astype(int).tolist()
    return [
        replace(
            trial,
            name=f"{trial.name} {i}",
            signals={n: x[a:b].copy() for n, x in trial.signals.items()},
            valid={n: x[a:b].copy() for n, x in trial.valid.items()},
        )
        for i, (a, b) in enumerate(pairwise(edges))
    ]


def fitted() -> Fit:
    """Fitted to five zig-zags and the random test, all motions simulated, revolutions and wind in.

    All else is held out.
    """
    model = ShipModel(SHIP, OUTPUTS, tuple(CATALOGUE[e] for e in EFFECTS))
    model = model.with_values({n: x for n, x in NONE.items() if n in model.parameters})
    priors = {**ship_priors(model, FREE), **WIND}
    settings = Settings(FREE, OUTPUTS, nuisance=("initial_state",), priors=priors)
    return identify(records(), model, settings)
