"""The model a user would write of the Otter: masses and sway as published, all else to be found."""

from collections.abc import Mapping
from typing import Final

import numpy as np
import otter
from numpy.typing import NDArray

from trialid.effects import CATALOGUE
from trialid.effects.actuators import actuator_effects
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.ship.actuators import Actuator
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship
from trialid.trial import Trial

Vector = NDArray[np.float64]

PERIOD: Final = 0.1
NOISE: Final = {"u": 0.02, "r": 0.003}
"""Of speed [m/s] and rate of turn [rad/s], white."""
FREE: Final = ("k_ahead", "k_astern", "T_thrusters", "Xu0", "Nr0", "Nrar0")
TRUTH: Final = dict(
    zip(
        FREE,
        (otter.AHEAD, otter.ASTERN, otter.LAG, otter.XU, otter.NR, otter.NRR),
        strict=True,
    )
)
SATURATED, DEAD = 0.65 * otter.N_MAX, 0.05 * otter.N_MAX
"""Revolutions [rad/s] beyond which drives give none, and below which."""
ORDERED: Final = ("left_order", "right_order")

SHIP: Final = Ship(
    name="Otter",
    source="Fossen (2021), PythonVehicleSimulator",
    system="dimensional",
    rudder_positive="starboard",
    particulars={
        "L": otter.L,
        "rho": otter.RHO,
        "g": otter.G,
        "nabla": otter.MASS / otter.RHO,
        "U0": 1.0,
        "T": otter.DRAUGHT,
    },
    mass={
        "m": otter.MASS,
        "x_G": otter.X_G,
        "I_zz": otter.I_Z,
        "Xudot": otter.XUDOT,
        "Yvdot": otter.YVDOT,
        "Nrdot": otter.NRDOT,
    },
    coefficients={},
    actuators=(
        Actuator(name="left", kind="thruster", x=-1.0, y=-otter.ARM),
        Actuator(name="right", kind="thruster", x=-1.0, y=otter.ARM),
    ),
)
OWN: Final = actuator_effects(SHIP, ("left", "right"))
CANDIDATES: Final[dict[str, Effect]] = {**CATALOGUE, **OWN}
MODELLED: Final = (
    "thrusters",
    "thrusters_lag",
    "still_water_surge",
    "still_water_sway",
    "still_water_yaw",
    "still_water_yaw_quadratic",
    "munk_moment",
    "centripetal_added_mass",
    "cross_flow_drag",
)


def model() -> ShipModel:
    """No gain, no lag and no damping in surge and yaw is stated: a fit starts at typical ones."""
    scale = 0.5 * otter.RHO * otter.L**3
    held = {
        "Xvrm": -otter.YVDOT / scale,
        "Yurm": otter.XUDOT / scale,
        "Kurm": 0.0,
        "Nuv": (otter.YVDOT - otter.XUDOT) / scale,
        "Yv0": otter.YV,
        "C_D": otter.C_D,
    }
    effects = tuple(CANDIDATES[name] for name in MODELLED)
    return ShipModel(SHIP, ("u", "v", "r"), effects).with_values(held)


def record(
    seed: int, fault: str = "", side: int = 0, duration: float = 120.0, quadratic: float = 0.0
) -> Trial:
    """What is logged of one trial: both orders, the speed and the rate of turn.

    Parameters
    ----------
    fault
        `weak` (a fifth of its thrust is gone), `half`, `dead`, `stuck`, `reversed`, `late` (0.5 s)
        of the thruster on this side, or both `exchanged`, `saturated` (at 0.65 of full) or with a
        `deadband` (of 0.05); the log shows the orders all the same.
    quadratic
        Xuu [kg/m] in her truth beside the published linear resistance.
    """
    t = np.arange(0.0, duration, PERIOD)
    orders = otter.some_orders(t, seed)
    acting, weak = orders.copy(), [0.0, 0.0]
    weak[side] = {"weak": 0.2, "half": 0.5, "dead": 1.0}.get(fault, 0.0)
    if fault == "reversed":
        acting[:, side] *= -1.0
    elif fault == "stuck":
        acting[:, side] = stuck_at(seed)
    elif fault == "late":
        acting[5:, side], acting[:5, side] = orders[:-5, side], 0.0
    elif fault == "exchanged":
        acting = orders[:, ::-1]
    elif fault == "saturated":
        acting = np.clip(orders, -SATURATED, SATURATED)
    elif fault == "deadband":
        acting = orders - np.clip(orders, -DEAD, DEAD)
    sailed = otter.sail(t, acting, (weak[0], weak[1]), quadratic=quadratic)
    rng = np.random.default_rng([seed, 1])
    noisy = {c: y + NOISE[c] * rng.standard_normal(len(t)) for c, y in _motions(sailed).items()}
    given = dict(zip(ORDERED, orders.T, strict=True)) | noisy
    units = {"u": "m/s", "r": "rad/s"} | dict.fromkeys(ORDERED, "rad/s")
    own = dict.fromkeys(ORDERED, "rad/s")
    return Trial.from_arrays(f"otter {seed}", t, given, units=units, own=own)


def stuck_at(seed: int) -> float:
    """Revolutions [rad/s] that a stuck thruster keeps, ahead or astern, 30 to 90 % of full."""
    rng = np.random.default_rng([seed, 3])
    return float(rng.uniform(0.3, 0.9) * rng.choice([otter.N_MIN, otter.N_MAX]))


def _motions(sailed: otter.Sailed) -> dict[str, Vector]:
    return {"u": sailed.u, "r": sailed.r}


def fitted(trial: Trial, added: Mapping[str, Effect] | None = None) -> Fit:
    """The fit; four steps a sample, because the lag is as long as a sample.

    Parameters
    ----------
    added
        Effects beside those of the model, by the parameter that is sought of each.
    """
    fitted_model, free = model(), FREE
    for name, effect in (added or {}).items():
        fitted_model, free = fitted_model + effect, (*free, name)
    settings = Settings(free=free, outputs=("u", "r"), nuisance=("initial_state",), substeps=4)
    return identify((trial,), fitted_model, settings)
