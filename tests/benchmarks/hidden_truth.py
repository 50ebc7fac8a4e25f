"""The true ship of the hidden-effects benchmark: what it is, what it does, what its sensors log.

The truth is the reference ship S175Q with one thing more in it. Everything random comes from seeds
that name the run, so that a run gives the same record whatever ran before it.
"""

import functools
import zlib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray
from scipy.signal import lfilter

from trialid.effects import CATALOGUE
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.ship.particulars import read_ship
from trialid.simulation.integrate import Simulator, prepare, respond
from trialid.trial import Trial

Vector = NDArray[np.float64]
Group = Literal["physics", "sensor", "gear", "outside", "control", "nothing"]
Gear = Callable[[Vector, float], Vector]

ROOT: Final = Path(__file__).resolve().parents[2]
SHIP: Final = read_ship(ROOT / "sample_data" / "ships" / "s175q.toml")
EFFECTS: Final = (
    "linear_hull", "linear_rudder", "linear_roll", "heel_roll", "heel_sway", "heel_yaw",
    "roll_rate_yaw", "sway_drag_vav", "sway_drag_var", "yaw_drag_vav", "yaw_drag_var",
    "yaw_drag_rar", "roll_drag_vav", "roll_drag_var", "centripetal_added_mass",
    "propeller_thrust", "surge_resistance", "surge_turning", "surge_rudder",
)  # fmt: skip
MODEL: Final = ShipModel(
    SHIP, ("u", "v", "p", "r", "phi"), tuple(CATALOGUE[name] for name in EFFECTS)
)
"""What the person who fits knows of the ship, less what a scenario hides."""

FREE: Final = ("Yv", "Ydelta", "Nv", "Nr", "Ndelta", "Kv", "Kdelta", "Kp", "GM")
"""What is fitted: the nine linear parameters of the confusability table."""

START_ERROR: Final = 0.15
"""A free parameter starts up to this share off the truth, as from a regression formula."""

STEP: Final = 0.25  # s, of the true motion
PERIOD: Final = 0.5  # s, of the record
APPROACH: Final = 60.0  # s with the rudder amidships
RUDDER_RATE: Final = np.deg2rad(2.5)  # rad/s
SHAFT: Final = 70.0 * 2.0 * np.pi / 60.0  # rad/s
DEG: Final = np.deg2rad(1.0)
GYRO, INCLINOMETER, COMPASS, LOG = 0.05 * DEG, 0.1 * DEG, 0.1 * DEG, 0.02  # rad/s, rad, rad, m/s
OUTPUTS: Final = ("r", "phi")


@dataclass(frozen=True, eq=False)
class Scenario:
    """One thing hidden in the true ship.

    Attributes
    ----------
    effects, values
        What is added to the truth and is not in the fitted model, at this size (`values` may
        also change the ship's own masses).
    group
        What a right diagnosis may say: a physical effect, a sensor or a gear at fault, something
        the catalogue does not hold, or nothing at all (a control that no record shows, or nothing
        hidden).
    names
        What the catalogue calls it, where that is not the name of `effects`.
    twins
        Names that count as right too: no record separates them from the truth.
    scale
        Signal to the factor its sensor is wrong by.
    gear
        Ordered rudder and step [s] to the true rudder; the record then holds the order alone.
    """

    name: str
    group: Group
    effects: tuple[Effect, ...] = ()
    values: Mapping[str, float] = field(default_factory=dict)
    names: frozenset[str] = frozenset()
    twins: frozenset[str] = frozenset()
    scale: Mapping[str, float] = field(default_factory=dict)
    gear: Gear | None = None
    ship: ShipModel = MODEL  # the true one, before what is hidden is put into her

    @property
    def exact(self) -> frozenset[str]:
        """Its own name."""
        return self.names or frozenset(e.name for e in self.effects)

    @property
    def right(self) -> frozenset[str]:
        """Every name that is right."""
        return self.exact | self.twins

    @property
    def known(self) -> bool:
        """Whether a model with it can be made, so that one can say how plainly it stands."""
        return bool(self.effects or self.values or self.gear)


@dataclass(frozen=True)
class Manoeuvre:
    """A trial as the crew is told to run it: angle and heading [deg], a binary where None."""

    name: str
    angle: float
    heading: float | None
    course: float  # rad, before the manoeuvre
    duration: float = 1200.0  # s
    use: Literal["fit", "check"] = "fit"


TRIAL_SETS: Final[Mapping[str, tuple[Manoeuvre, ...]]] = {
    "mixed": (
        Manoeuvre("zigzag-10", 10.0, 10.0, 0.5),
        Manoeuvre("zigzag-20", 20.0, 20.0, 2.1),
        Manoeuvre("binary", 15.0, None, -1.0),
        Manoeuvre("zigzag-15", 15.0, 15.0, 1.5, 600.0, "check"),
    ),
    "single": (Manoeuvre("zigzag-20", 20.0, 20.0, 0.5),),
}
NOISES: Final = ("white", "waves", "process")


def generator(seed: int, *names: str) -> np.random.Generator:
    """Random numbers of a run by its seed and by what it is."""
    return np.random.default_rng([seed, *(zlib.crc32(name.encode()) for name in names)])


def without(scenario: Scenario) -> ShipModel:
    """The true ship less what the scenario hides."""
    model = scenario.ship
    for effect in scenario.effects:
        if effect.name in {e.name for e in model.effects}:
            model = model - effect.name
    return model


def restored(scenario: Scenario, model: ShipModel) -> ShipModel:
    """A model with what is hidden put back at its true size."""
    for effect in scenario.effects:
        model = model + effect
    return model.with_values(scenario.values)


@functools.cache
def _truth(scenario: Scenario) -> Simulator:
    """The true ship, ready to run."""
    states = tuple(dict.fromkeys((*scenario.ship.states, "psi")))
    model = replace(without(scenario), states=states) + CATALOGUE["outer_force"]
    return prepare(restored(scenario, model.with_values({"scale_ext": 1.0})), (), OUTPUTS)


def record(
    scenario: Scenario, noise: str, trial_set: str, seed: int, rudder: bool = False
) -> tuple[Trial, ...]:
    """Every trial of a set as logged; with `rudder` the true rudder even where only orders are."""
    made = []
    for manoeuvre in TRIAL_SETS[trial_set]:
        rng = generator(seed, scenario.name, noise, trial_set, manoeuvre.name)
        sail = sailor(scenario, manoeuvre, disturbance(noise, manoeuvre, rng))
        steered = manoeuvre.heading is not None
        passage = zigzag(manoeuvre, sail) if steered else sail(binary(manoeuvre, rng))
        made.append(_logged(scenario, passage, manoeuvre, noise, rng))
        if scenario.gear is not None and not rudder:
            made[-1] = _ordered(made[-1], passage)
    return tuple(made)


@dataclass(frozen=True)
class Passage:
    """What happened: the order, the measured outputs without noise, and the true states."""

    order: Vector
    delta: Vector
    y: Vector
    states: Mapping[str, Vector]


def sailor(
    scenario: Scenario, manoeuvre: Manoeuvre, forces: Mapping[str, Vector]
) -> Callable[[Vector], Passage]:
    """From an order (N,) [rad] to the passage of the true ship in this weather."""

    def sail(order: Vector) -> Passage:
        delta = order if scenario.gear is None else scenario.gear(order, STEP)
        signals = {"delta": delta, "n": np.full(len(delta), SHAFT), **forces}
        trial = Trial(manoeuvre.name, "fit", STEP, signals, {})
        start = {"u": SHIP.particulars["U0"], "psi": manoeuvre.course}
        response = respond(_truth(scenario), trial, {}, start, sensitivities=False)
        if response.departure is not None:
            raise RuntimeError(f"{scenario.name}: {response.departure}")
        states = dict(zip(_truth(scenario).model.all_states, response.states.T, strict=True))
        return Passage(order, delta, response.y, states)

    return sail


def clock(manoeuvre: Manoeuvre) -> Vector:
    """Times of the true motion [s]."""
    return np.arange(round(manoeuvre.duration / STEP) + 1) * STEP


def ramped(orders: Sequence[tuple[float, float]], t: Vector) -> Vector:
    """Rudder that follows orders (time [s], angle [rad]) at a steady rate."""
    delta, angle, began = np.zeros(len(t)), 0.0, 0
    for i, (start, order) in enumerate(orders):
        first = int(np.searchsorted(t, start - 1e-9))
        last = int(np.searchsorted(t, orders[i + 1][0] - 1e-9)) if i + 1 < len(orders) else len(t)
        delta[began:first] = angle
        path = np.minimum(RUDDER_RATE * (t[first:last] - start), abs(order - angle))
        delta[first:last] = angle + np.sign(order - angle) * path
        angle, began = float(delta[last - 1]), last
    return delta


def zigzag(manoeuvre: Manoeuvre, sail: Callable[[Vector], Passage]) -> Passage:
    """The rudder reverses where the heading reaches its angle, one reversal after the other."""
    assert manoeuvre.heading is not None
    t, angle = clock(manoeuvre), manoeuvre.angle * DEG
    orders, sign = [(APPROACH, angle)], 1.0
    while True:
        passage = sail(ramped(orders, t))
        psi = passage.states["psi"] - passage.states["psi"][round(APPROACH / STEP)]
        reached = (sign * psi >= manoeuvre.heading * DEG) & (t > orders[-1][0] + 2.0)
        if not reached.any():
            return passage
        sign = -sign
        # the helmsman acts on a sample of the record
        orders.append((float(np.ceil(t[np.argmax(reached)] / PERIOD) * PERIOD), sign * angle))


def binary(manoeuvre: Manoeuvre, rng: np.random.Generator) -> Vector:
    """Steps of 5, 10 or 15 deg to alternate sides, held for 10 to 60 s."""
    t, at, sign = clock(manoeuvre), APPROACH, float(rng.choice([-1.0, 1.0]))
    orders = []
    while at < manoeuvre.duration:
        orders.append((at, sign * float(rng.choice([5.0, 10.0, manoeuvre.angle])) * DEG))
        at += PERIOD * round(rng.uniform(10.0, 60.0) / PERIOD)
        sign = -sign
    return ramped(orders, t)


def disturbance(noise: str, manoeuvre: Manoeuvre, rng: np.random.Generator) -> Mapping[str, Vector]:
    """Forces of wind and sea [N, N m] that the fitted model does not see."""
    n = len(clock(manoeuvre))
    forces = dict.fromkeys(("X_ext", "Y_ext", "K_ext", "N_ext"), np.zeros(n))
    if noise != "process":
        return forces
    L, rho, U = (SHIP.particulars[k] for k in ("L", "rho", "U0"))
    moment = 2e-6 * 0.5 * rho * L**3 * U**2
    forces["K_ext"] = moment * coloured(rng, n, 0.55, STEP)
    forces["N_ext"] = moment * gusts(rng, n, 40.0, STEP)
    return forces


def coloured(rng: np.random.Generator, n: int, frequency: float, period: float) -> Vector:
    """Unit-variance noise in a narrow band about a frequency [rad/s]: a sea."""
    pole = np.exp((-0.1 + 1j * np.sqrt(0.99)) * frequency * period)
    lead = round(600.0 / period)
    e = lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], rng.standard_normal(n + lead))
    a1, a2 = 2.0 * pole.real, -(abs(pole) ** 2)
    variance = (1.0 - a2) / ((1.0 + a2) * ((1.0 - a2) ** 2 - a1**2))
    return np.asarray(e[lead:] / np.sqrt(variance))


def gusts(rng: np.random.Generator, n: int, memory: float, period: float) -> Vector:
    """Unit-variance noise that forgets in `memory` seconds."""
    keep, lead = np.exp(-period / memory), round(20.0 * memory / period)
    e = lfilter([np.sqrt(1.0 - keep**2)], [1.0, -keep], rng.standard_normal(n + lead))
    return np.asarray(e[lead:])


def _logged(
    scenario: Scenario,
    passage: Passage,
    manoeuvre: Manoeuvre,
    noise: str,
    rng: np.random.Generator,
) -> Trial:
    """What the sensors log of a passage."""
    each = round(PERIOD / STEP)
    y, n = passage.y[::each], len(passage.y[::each])
    signals = {
        "delta": passage.delta[::each].copy(),
        "n": np.full(n, SHAFT),
        "u": passage.states["u"][::each] + LOG * rng.standard_normal(n),
        "psi": passage.states["psi"][::each] + COMPASS * rng.standard_normal(n),
    }
    white, wave = {"r": GYRO, "phi": INCLINOMETER}, {"r": 0.03 * DEG, "phi": 0.3 * DEG}
    for i, c in enumerate(OUTPUTS):
        signals[c] = y[:, i] + white[c] * rng.standard_normal(n)
        if noise != "white":
            signals[c] = signals[c] + wave[c] * coloured(rng, n, 0.6, PERIOD)
    signals = {c: x * scenario.scale.get(c, 1.0) for c, x in signals.items()}
    valid = {c: np.ones(n, dtype=bool) for c in signals}
    return Trial(manoeuvre.name, manoeuvre.use, PERIOD, signals, valid)


def _ordered(trial: Trial, passage: Passage) -> Trial:
    """The same record with the rudder's order in place of its angle."""
    order = {"delta_order": passage.order[:: round(PERIOD / STEP)].copy()}
    signals = {n: x for n, x in trial.signals.items() if n != "delta"} | order
    valid = {n: np.ones(trial.samples, dtype=bool) for n in signals}
    return Trial(trial.name, trial.use, PERIOD, signals, valid)


def servo(T: float) -> Gear:
    """A rudder that follows its order with time constant T [s]."""

    def follow(order: Vector, step: float) -> Vector:
        keep = np.exp(-step / T)
        return np.asarray(lfilter([0.5 - 0.5 * keep] * 2, [1.0, -keep], order))

    return follow


def limited(T: float, rate: float) -> Gear:
    """The same with a pump that moves the rudder no faster than `rate` [rad/s]."""

    def follow(order: Vector, step: float) -> Vector:
        most, share, delta = rate * step, 1.0 - np.exp(-step / T), np.zeros(len(order))
        for k in range(1, len(order)):
            move = (order[k - 1] - delta[k - 1]) * share
            delta[k] = delta[k - 1] + min(max(move, -most), most)
        return delta

    return follow


def backlash(width: float) -> Gear:
    """A rudder with play: it moves when the order has taken up `width` [rad]."""

    def follow(order: Vector, step: float) -> Vector:
        half, delta = 0.5 * width, np.zeros(len(order))
        for k in range(1, len(order)):
            delta[k] = min(max(delta[k - 1], order[k] - half), order[k] + half)
        return delta

    return follow


def deadband(half: float) -> Gear:
    """A gear that does not answer orders below `half` [rad], and larger ones by so much less."""
    return lambda order, step: order - np.clip(order, -half, half)
