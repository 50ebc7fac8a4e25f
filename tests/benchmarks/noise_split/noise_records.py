"""Records of which the noise is known, in every way that an assumption of a route may fail.

Two true ships: the benchmark's own S175Q with an effect hidden, or nothing, and the cubic S-175,
which a second-order model is fitted to.
"""

import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final, Literal

import numpy as np
from numpy.typing import NDArray

BENCHMARKS: Final = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(BENCHMARKS), str(BENCHMARKS / "growth")]
import hidden_truth as true  # noqa: E402
import other_base  # noqa: E402
from hidden_effects import settings_of  # noqa: E402
from hidden_scenarios import SCENARIOS, guessed  # noqa: E402
from hidden_truth import DEG, OUTPUTS, PERIOD, Manoeuvre, Passage, Scenario, generator  # noqa: E402

from trialid.identification.fit import Fit  # noqa: E402
from trialid.identification.problem import Settings  # noqa: E402
from trialid.trial import Trial  # noqa: E402
from trialid.workflow.fit_model import fit_with_progress  # noqa: E402

Vector = NDArray[np.float64]
HIDDEN: Final = (
    "righting_arm_cubic",
    "yaw_drag_rar",
    "quadratic_roll_damping",
    "sway_drag_vav",
    "heel_drift",
    "rudder_slipstream",
    "odd_heel",
    "odd_rudder",
    "delay_r",
    "static_list",
)
SENSORS: Final = np.array([true.GYRO, true.INCLINOMETER])
SWELL: Final = np.array([0.03, 0.3]) * DEG
ARM: Final = Scenario(
    "righting_arm", "physics", SCENARIOS["righting_arm_cubic"].effects, {"GM3": 8.0}
)
"""A righting arm that stiffens nearly three times as much as that of the benchmark."""

CUBIC: Final = Scenario("cubic", "outside", ship=other_base.TRUTH)


def square(manoeuvre: Manoeuvre, growth: float) -> Vector:
    """A rudder over to alternate sides every minute, each time so much of the first angle more."""
    t = true.clock(manoeuvre)
    times = np.arange(true.APPROACH, manoeuvre.duration, 60.0)
    angles = manoeuvre.angle * DEG * (1.0 + growth * np.arange(len(times)))
    signs = (-1.0) ** np.arange(len(times))
    return true.ramped(
        [(float(s), float(a)) for s, a in zip(times, signs * angles, strict=True)], t
    )


def _zigzags(*angles: tuple[float, float]) -> tuple[Manoeuvre, ...]:
    return tuple(Manoeuvre(f"zigzag-{a:g}-{h:g}", a, h, 0.5 + a) for a, h in angles)


SQUARE: Final = "square"
GROWING: Final = (
    _zigzags((5.0, 5.0), (10.0, 10.0), (20.0, 20.0), (30.0, 30.0)),
    (Manoeuvre(SQUARE, 8.0, None, 0.5), true.TRIAL_SETS["mixed"][3]),
    _zigzags((15.0, 15.0), (16.0, 15.0), (25.0, 20.0)),
)
"""An error of the model that grows with the angle: from trial to trial, from period to period, and
between two runs that are nearly the same."""

Put = Callable[[np.random.Generator, Vector, Vector], Vector]
"""What sensors put on the outputs, (N, 2): from random numbers, times (N,) and the outputs."""


def white(rng: np.random.Generator, t: Vector, y: Vector) -> Vector:
    """What each sensor has for itself."""
    return SENSORS * rng.standard_normal(y.shape)


def swell(rng: np.random.Generator, t: Vector) -> Vector:
    """What sensors see of a sea and the rudder does not; (N, 2)."""
    return SWELL * np.column_stack([true.coloured(rng, len(t), 0.6, PERIOD) for _ in OUTPUTS])


def waves(rng: np.random.Generator, t: Vector, y: Vector) -> Vector:
    """The same sea throughout."""
    return white(rng, t, y) + swell(rng, t)


def rising(rng: np.random.Generator, t: Vector, y: Vector) -> Vector:
    """A sea that is a fifth during the approach, and all there two minutes after it."""
    share = np.interp(t, [true.APPROACH, true.APPROACH + 120.0], [0.2, 1.0])[:, None]
    return white(rng, t, y) + share * swell(rng, t)


def counts(rng: np.random.Generator, t: Vector, y: Vector) -> Vector:
    """Sensors that count: in steps of 0.3 to 1 of their noise, or 0.1 to 1 of the motion."""
    coarse = rng.random() < 0.5
    noise = white(rng, t, y) * (0.2 if coarse else 1.0)
    step = y.std(axis=0) * rng.uniform(0.1, 1.0) if coarse else SENSORS * rng.uniform(0.3, 1.0)
    return np.asarray(np.round((y + noise) / step) * step - y)


def outliers(rng: np.random.Generator, t: Vector, y: Vector) -> Vector:
    """One sample in a hundred 10 to 30 times the noise away."""
    far = rng.uniform(10.0, 30.0, y.shape) * rng.choice([-1.0, 1.0], y.shape)
    return white(rng, t, y) + SENSORS * far * (rng.random(y.shape) < 0.01)


@dataclass(frozen=True)
class Case:
    """One way in which an assumption of a route may fail."""

    put: Put
    grows: bool = False
    weather: str = "none"
    loss: Literal["squares", "huber"] = "squares"


CASES: Final[Mapping[str, Case]] = {
    "white": Case(white),
    "waves": Case(waves),
    "grows": Case(white, grows=True),
    "grows, waves": Case(waves, grows=True),
    "rising sea": Case(rising),
    "counts": Case(counts),
    "outliers": Case(outliers),
    "outliers, huber": Case(outliers, loss="huber"),
    "gusts": Case(waves, weather="process"),
}


def scenario_of(case: Case, seed: int) -> Scenario:
    """What is hidden: in one record of four nothing, in one of four the ship is another."""
    rng = generator(seed, "what")
    if seed % 4 == 3:
        return CUBIC
    if case.grows:
        return ARM
    return SCENARIOS["nothing" if seed % 4 == 0 else str(rng.choice(HIDDEN))]


def sailed(case: Case, scenario: Scenario, m: Manoeuvre, seed: int) -> tuple[Passage, Vector]:
    """The manoeuvre in its weather, and the outputs (N, 2) of the same rudder in a calm."""
    rng = generator(seed, m.name, "sea")
    forces = true.disturbance(case.weather, m, rng)
    sail = true.sailor(scenario, m, forces)
    if m.heading is not None:
        passage = true.zigzag(m, sail)
    else:
        passage = sail(square(m, 0.03) if m.name == SQUARE else true.binary(m, rng))
    if case.weather == "none":
        return passage, passage.y
    calm = true.sailor(scenario, m, true.disturbance("none", m, rng))
    return passage, calm(passage.delta).y


def recorded(
    case: Case, scenario: Scenario, seed: int
) -> tuple[tuple[Trial, ...], dict[str, Vector]]:
    """Trials as logged, and the outputs without noise by trial; (N, 2)."""
    size = float(np.exp(generator(seed, "size").uniform(np.log(0.3), 0.0)))
    chosen = GROWING[seed % 3] if case.grows else true.TRIAL_SETS["mixed"]
    made, clean, each = [], {}, round(PERIOD / true.STEP)
    for m in chosen:
        passage, calm = sailed(case, scenario, m, seed)
        y, clean[m.name] = passage.y[::each], calm[::each]
        rng, n = generator(seed, m.name, "sensors"), len(y)
        # the noise is smaller where its size is, and so is the motion that a count is a share of
        seen = np.add(y, size * case.put(rng, np.arange(n) * PERIOD, y / size))
        signals = {
            "delta": passage.delta[::each].copy(),
            "n": np.full(n, true.SHAFT),
            "u": passage.states["u"][::each] + true.LOG * rng.standard_normal(n),
            "psi": passage.states["psi"][::each] + true.COMPASS * rng.standard_normal(n),
            **dict(zip(OUTPUTS, seen.T.copy(), strict=True)),
        }
        valid = {c: np.ones(n, dtype=bool) for c in signals}
        made.append(Trial(m.name, m.use, PERIOD, signals, valid))
    return tuple(made), clean


def fitted(case: Case, scenario: Scenario, seed: int, trials: tuple[Trial, ...]) -> Fit:
    """The model that lacks what is hidden."""
    if scenario is CUBIC:
        model = other_base.BASE
        settings = Settings(other_base.FREE, OUTPUTS, nuisance=("initial_state",))
    else:
        model = guessed(scenario, seed)
        settings = settings_of(model)
    settings = replace(settings, loss=case.loss)
    return fit_with_progress(trials, model, settings, lambda words, share: None)
