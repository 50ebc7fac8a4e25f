"""Models that are handed over in the tests, and what the kernel makes of them."""

import shutil
import subprocess
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from s175q import ROOT
from typical import wave

from trialid import effects, pipeline_file
from trialid.design.prediction.seen_range import SeenRange
from trialid.effects import CATALOGUE
from trialid.export.model.fitted_model import FittedModel, FittedParameter
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import domain, prepare, respond
from trialid.simulation.trace import trace
from trialid.trial import Trial
from trialid.workflow.build_model import available, build_model

GCC = shutil.which("gcc") or shutil.which("cc")
STRICT = ["-std=c99", "-g", "-Wall", "-Wextra", "-Werror", "-pedantic", "-Wshadow"]
PIPELINE = pipeline_file.load(ROOT / "pipelines" / "hidden_effect.toml")
SHIPPED = build_model(PIPELINE, available(PIPELINE))
OWN = """\
from trialid.maths import clip, exp, tanh
from trialid.ship.effect import Force, Parameter, effect

@effect(source="the mate")
def squall(v, phi, *, Ysq=-0.002, Nsq=Parameter(0.0004, low=-1.0, high=1.0)):
    "Y = Ysq tanh(9 v) e^(-phi^2), N = Nsq clip(v): what the mate thinks."
    return Force(Y=Ysq * tanh(9.0 * v) * exp(-phi * phi), N=Nsq * clip(v, 0.05))
"""
SAMPLES, PERIOD = 600, 0.5
STEERED = frozenset({"delta", "delta_order"})
TIGHT = 1e-12


@dataclass(frozen=True)
class Case:
    """A model, and what she measures."""

    model: ShipModel
    outputs: tuple[str, ...] = ("r", "phi")


def cases(folder: Path) -> dict[str, Case]:
    """The shipped sample with and without its effect, states and sensors of effects, an own one."""
    (folder / "own.py").write_text(OWN, encoding="utf-8")
    own = effects.from_file(folder / "own.py")["squall"]
    surge = ShipModel(
        SHIPPED.ship,
        ("u", *SHIPPED.states, "psi"),
        (*SHIPPED.effects, *(CATALOGUE[n] for n in ("propeller_thrust", "surge_resistance"))),
    )
    hardened = SHIPPED + CATALOGUE["righting_arm_cubic"]
    return {
        "shipped": Case(SHIPPED),
        "righting_arm_cubic": Case(hardened.with_values({"GM3": 3.2})),
        "a gear with a state": Case(SHIPPED + CATALOGUE["rudder_servo_limited"]),
        "a sensor": Case((SHIPPED + CATALOGUE["bias_r"]).with_values({"b_r": 0.001})),
        "a user's effect": Case(SHIPPED + own),
        "surge and heading": Case(surge, ("u", "psi")),
    }


NAMES = (
    "shipped",
    "righting_arm_cubic",
    "a gear with a state",
    "a sensor",
    "a user's effect",
    "surge and heading",
)


def handed(case: Case) -> FittedModel:
    """The model as an export takes it, its first hull coefficient fitted."""
    model = _with_starts(case.model)
    equations = trace(model, (), case.outputs)
    rows = [
        FittedParameter(name=n, value=model.value(n), unit=model.parameters[n].unit)
        for n in equations.parameters
    ]
    first = next(i for i, row in enumerate(rows) if row.name == "Nr")
    value = rows[first].value
    rows[first] = replace(
        rows[first], likely=(1.2 * value, 0.9 * value), deviation=0.1 * abs(value), fitted=True
    )
    return FittedModel(
        name='a "test"',
        model=model,
        equations=equations,
        parameters=tuple(rows),
        covariance=np.array([[(0.1 * value) ** 2]]),
        seen={"delta": SeenRange(-0.35, 0.35), "r": SeenRange(-0.02, 0.02)},
        words=("a remark",),
        origin={"made_by": "trialid"},
        period=PERIOD,
        verdict="missing",
    )


def _with_starts(model: ShipModel) -> ShipModel:
    starts = {n: p.start for n, p in model.parameters.items() if model.stated(n) is None}
    return model.with_values(starts)


def inputs_of(made: FittedModel) -> np.ndarray:
    """Inputs that never rest, in the order of the equations; (N, n_u)."""
    t = np.arange(SAMPLES) * PERIOD
    delta = 0.3 * np.sign(np.sin(0.05 * t)) + 0.02 * np.sin(0.4 * t)
    known = {"delta": delta, "delta_order": delta, "u": 7.0 + 0.3 * np.sin(0.02 * t)}
    columns = [known[n] if n in known else wave(n, t, 3) for n in made.inputs]
    return np.column_stack(columns)


def by_kernel(made: FittedModel, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Where it starts, states and outputs of the compiled kernel; (n_x,), (N, n_x), (N, n_y)."""
    outputs = tuple(made.equations.outputs)
    simulator = prepare(made.model, (), outputs)
    signals = dict(zip(made.inputs, u.T, strict=True))
    response = respond(simulator, Trial("x", "fit", PERIOD, signals, {}), {}, {}, False)
    assert response.departure is None
    assert made.equations.states == simulator.equations.states
    return response.states[0], response.states, response.y


def sailed_by_kernel(made: FittedModel, rudder: float, steps: int) -> np.ndarray:
    """The state so many steps on, inputs held, from where an FMU begins; (n_x,)."""
    simulator = prepare(made.model, (), tuple(made.equations.outputs))
    starts = made.starts | dict.fromkeys(STEERED & {*made.inputs}, rudder)
    x, u = (np.array([starts[n] for n in names]) for names in (made.equations.states, made.inputs))
    theta = np.array([p.value for p in made.parameters])
    held = np.tile(u, (steps + 1, 1))
    return simulator.engine.simulate(theta, x, held, domain(made.model), PERIOD, 1)[0][-1]


def largest_difference(found: np.ndarray, expected: np.ndarray) -> float:
    """Over all columns, as a share of the largest value of each."""
    sizes = np.max(np.abs(expected), axis=0)
    return float(np.max(np.abs(found - expected) / np.where(sizes > 0.0, sizes, 1.0)))


def run_sanitized(folder: Path, source: str, main: str) -> tuple[int, str]:
    """How the program `main`, which includes `ferry.c`, ended, and what it or the compiler said."""
    (folder / "ferry.c").write_text(source, encoding="utf-8")
    (folder / "main.c").write_text(main, encoding="utf-8")
    for sanitized in (["-fsanitize=address,undefined", "-fno-sanitize-recover"], []):
        command = [GCC, *STRICT, *sanitized, "main.c", "-lm", "-o", "run"]
        told = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if told.returncode == 0:
            break
    if (told.returncode, told.stderr) != (0, ""):
        return told.returncode, told.stderr
    done = subprocess.run([folder / "run"], capture_output=True, text=True, check=False)
    return done.returncode, done.stderr
