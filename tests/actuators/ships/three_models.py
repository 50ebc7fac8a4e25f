"""The models a user would write of `three_ships`, and what comes back of their truths."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np
import three_ships as truth
from numpy.typing import NDArray

from trialid.effects import CATALOGUE
from trialid.effects.actuators import actuator_effects
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.ship.actuators import Actuator, actuator_quantities
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship
from trialid.trial import Trial

Vector = NDArray[np.float64]
PERIOD, DURATION = 1.0, 900.0
NOISE = {"u": 0.03, "v": 0.03, "r": 2e-4}
"""White: speeds [m/s] and rate of turn [rad/s] of a good receiver and gyro."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """One ship: her truth, what is logged of her, the model, and what is sought.

    Attributes
    ----------
    sought
        True values of the free parameters, none of which the model states.
    held
        Values the model is given.
    """

    name: str
    hull: truth.Hull
    push: truth.Push
    signals: Callable[[Vector, int], dict[str, Vector]]
    actuators: tuple[Actuator, ...]
    effects: tuple[str, ...]
    sought: Mapping[str, float]
    held: Mapping[str, float] = field(default_factory=dict)
    outputs: tuple[str, ...] = ("u", "v", "r")
    speed: float = 4.0

    @property
    def ship(self) -> Ship:
        """What the ship file would say."""
        h = self.hull
        Xudot, Yvdot, Nrdot = h.added
        return Ship(
            name=self.name,
            source="three_ships.py",
            system="dimensional",
            rudder_positive="starboard",
            particulars={
                "L": h.L,
                "rho": truth.RHO,
                "g": 9.81,
                "nabla": h.mass / truth.RHO,
                "U0": self.speed,
                "T": h.T,
            },
            mass={
                "m": h.mass,
                "I_zz": h.inertia,
                "Xudot": Xudot,
                "Yvdot": Yvdot,
                "Nrdot": Nrdot,
            },
            coefficients={},
            actuators=self.actuators,
        )

    def model(self) -> ShipModel:
        """None of what is sought is stated."""
        known = {**CATALOGUE, **actuator_effects(self.ship)}
        made = ShipModel(self.ship, ("u", "v", "r"), tuple(known[n] for n in self.effects))
        scale = 0.5 * truth.RHO * self.hull.L**3
        Xudot, Yvdot, _ = self.hull.added
        held = {"Xvrm": -Yvdot / scale, "Yurm": Xudot / scale, "Kurm": 0.0, **self.held}
        if "munk_moment" in self.effects:
            held["Nuv"] = (Yvdot - Xudot) / scale
        return made.with_values(held)

    def record(self, seed: int) -> Trial:
        """What is logged of one trial."""
        t = np.arange(0.0, DURATION, PERIOD)
        given = self.signals(t, seed)
        motion = truth.sail(self.hull, self.push, t, given, self.speed / 2.0)
        rng = np.random.default_rng([seed, 9])
        noisy = {
            c: y + NOISE[c] * rng.standard_normal(len(t))
            for c, y in zip("uvr", motion.T, strict=True)
        }
        own = {n: q.unit for n, q in actuator_quantities(self.actuators).items() if n in given}
        units = {"u": "m/s", "v": "m/s", "r": "rad/s"} | own
        return Trial.from_arrays(f"{self.name} {seed}", t, given | noisy, units=units, own=own)

    def fitted(self, seed: int) -> Fit:
        """The fit of one trial, begun at typical values."""
        asked = Settings(free=(*self.sought,), outputs=self.outputs, nuisance=("initial_state",))
        return identify((self.record(seed),), self.model(), asked)


def _primed(hull: truth.Hull, force: float) -> float:
    return force / (0.5 * truth.RHO * hull.L**2)


SLOW_HULL: Final = (
    "surge_resistance",
    "still_water_surge",
    "still_water_sway",
    "still_water_yaw",
    "cross_flow_drag",
    "centripetal_added_mass",
    "munk_moment",
)
"""Effects of a hull that goes ahead, aside and astern alike."""


def _pod(name: str, x: float, y: float) -> Actuator:
    return Actuator(name=name, kind="azimuth", x=x, y=y, own=name == "pod_4")


FERRY = Case(
    name="ferry",
    hull=truth.FERRY,
    push=truth.pods,
    signals=truth.pod_signals,
    actuators=tuple(_pod(n, *at) for n, at in truth.PODS.items()),
    effects=(
        "azimuths",
        *SLOW_HULL,
    ),
    sought={
        "k_pod_ahead": truth.POD_AHEAD,
        "k_pod_astern": truth.POD_ASTERN,
        "k_pod_ahead_pod_4": truth.POD_AHEAD * truth.OLD_POD,
        "k_pod_astern_pod_4": truth.POD_ASTERN * truth.OLD_POD,
        "Xuu": _primed(truth.FERRY, truth.FERRY.Xuu),
        "Xu0": truth.FERRY.Xu,
        "Yv0": truth.FERRY.Yv,
        "Nr0": truth.FERRY.Nr,
        "C_D": truth.FERRY.C_D,
    },
)
RACES = replace(
    FERRY,
    name="ferry of races",
    push=truth.pods_in_races,
    effects=(*FERRY.effects, "azimuths_strut", "azimuths_race"),
    sought={
        **FERRY.sought,
        **{f"k_strut{own}": truth.STRUT for own in ("", "_pod_4")},
        **{f"k_lost{own}": truth.LOST for own in ("", "_pod_4")},
    },
)
CARGO = Case(
    name="cargo",
    hull=truth.CARGO,
    push=truth.twin_screws,
    signals=truth.twin_signals,
    actuators=(
        *(
            Actuator(name=f"screw_{s}", kind="thruster", x=truth.AFT, y=y)
            for s, y in truth.SCREWS.items()
        ),
        *(
            Actuator(name=f"rudder_{s}", kind="rudder", x=truth.AFT - 4.0, y=y, behind=f"screw_{s}")
            for s, y in truth.SCREWS.items()
        ),
    ),
    effects=(
        "linear_hull",
        "thrusters",
        "thrusters_advance",
        "rudders",
        "rudders_race",
        "surge_resistance",
        "centripetal_added_mass",
    ),
    sought={
        "k_ahead": truth.SCREW_AHEAD,
        "k_astern": truth.SCREW_ASTERN,
        "k_advance": truth.ADVANCE,
        "k_race": truth.RACE,
        "Xuu": _primed(truth.CARGO, truth.CARGO.Xuu),
        "Ndelta": truth.NDELTA,
        "Nv": -0.0037,
        "Nr": -0.0025,
    },
    held={"Yv": -0.0119, "Yr": 0.0029, "Kv": 0.0, "Kr": 0.0, "Ydelta": truth.YDELTA, "Kdelta": 0.0},
    outputs=("u", "r"),
    speed=8.0,
)
SUPPLY = Case(
    name="supply",
    hull=truth.SUPPLY,
    push=truth.bow_and_screws,
    signals=truth.slow_signals,
    actuators=(
        *(Actuator(name=f"main_{s}", kind="thruster", x=-27.0, y=y) for s, y in truth.MAIN.items()),
        Actuator(name="bow", kind="tunnel", x=truth.BOW, y=0.0, direction=np.pi / 2.0),
    ),
    effects=(
        "thrusters",
        "tunnels",
        *SLOW_HULL,
    ),
    sought={
        "k_ahead": truth.MAIN_AHEAD,
        "k_astern": truth.MAIN_ASTERN,
        "k_tunnel": truth.TUNNEL,
        "u_tunnel": truth.FADES,
        "Xuu": _primed(truth.SUPPLY, truth.SUPPLY.Xuu),
        "Xu0": truth.SUPPLY.Xu,
        "Yv0": truth.SUPPLY.Yv,
        "Nr0": truth.SUPPLY.Nr,
        "C_D": truth.SUPPLY.C_D,
    },
    speed=2.0,
)
SUCKED = replace(
    SUPPLY,
    name="supply, sucked",
    push=truth.sucked_bow,
    effects=(*SUPPLY.effects, "tunnels_hull"),
    sought={**SUPPLY.sought, "aY_tunnel": truth.SUCKED},
)
CASES = (FERRY, RACES, CARGO, SUPPLY, SUCKED)
