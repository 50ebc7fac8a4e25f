"""Trials of the ship of `sailed_tracks` in a wind that an anemometer on board reads."""

from dataclasses import replace
from functools import cache

import numpy as np
from sailed_tracks import FREE, NOISE, OUTPUTS, SHIP, sailed

from trialid.effects import CATALOGUE
from trialid.effects.track import current
from trialid.identification.problem import Settings
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

TRUTH = {"C_aw": 0.00008, "N_aw": 0.000004, "z_aw": 0.05, "N_2aw": 0.0}
WINDY = (SHIP + CATALOGUE["apparent_wind"] + CATALOGUE["apparent_wind_yaw"]).with_values(TRUTH)
WATERS = {"circle": (0.3, -0.2), "zigzag": (0.0, 0.4)}
AIR = (-9.0, 10.0)
"""m/s to the north and to the east: a wind of 13.5 m/s from the north-west."""
SETTINGS = Settings(
    (*FREE, "C_aw", "N_aw"),
    OUTPUTS,
    weights={"x": 12.0, "y": 12.0, "psi": 12.0},
    nuisance=("initial_state", "current"),
)


def apparent(y: np.ndarray, names: list[str], wind: tuple[float, float]) -> dict[str, np.ndarray]:
    """What an anemometer on board reads of the wind over the ground."""
    psi, north, east = (y[:, names.index(n)] for n in ("psi", "x", "y"))
    air_n = wind[0] - np.gradient(north, 2.0)
    air_e = wind[1] - np.gradient(east, 2.0)
    return {
        "V_aw": np.hypot(air_n, air_e),
        "gamma_aw": np.unwrap(np.arctan2(-air_e, -air_n) - psi),
    }


@cache
def blown(
    name: str, water: tuple[float, float] | None = None, wind: tuple[float, float] = AIR
) -> Trial:
    """A manoeuvre of calm air under the same rudder in the wind; what is read goes with it."""
    water = WATERS[name] if water is None else water
    calm = sailed(name, (0.0, 0.0))  # the current turns no rudder
    inputs = {n: calm.signals[n] for n in ("delta", "n")}
    air = {n: np.zeros(calm.samples) for n in ("V_aw", "gamma_aw")}
    true = (WINDY + current).with_values(dict(zip(("V_cn", "V_ce"), water, strict=True)))
    model = prepare(true, (), OUTPUTS)
    for _ in range(6):  # the apparent wind depends on how she goes, and she on it
        blank = Trial(name, "fit", 2.0, {**inputs, **air}, {})
        y = respond(model, blank, {}, {"psi": 0.7}, sensitivities=False).y
        air = apparent(y, [*OUTPUTS], wind)
    signals = {**inputs, **air, **{c: y[:, i].copy() for i, c in enumerate(OUTPUTS)}}
    return Trial(name, "fit", 2.0, signals, {n: np.ones(len(y), dtype=bool) for n in signals})


def noisy(trial: Trial, rng: np.random.Generator, sensors: float = 1.0, air: float = 1.0) -> Trial:
    """The trial as logged; shares of the usual noise of what sees the ship, and the wind."""
    sizes = {n: sensors * s for n, s in NOISE.items()}
    sizes |= {"V_aw": 0.3 * air, "gamma_aw": np.deg2rad(2.0) * air}
    added = {n: s * rng.standard_normal(trial.samples) for n, s in sizes.items()}
    return replace(trial, signals={n: x + added.get(n, 0.0) for n, x in trial.signals.items()})
