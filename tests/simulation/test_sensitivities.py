"""dy/dtheta of whole simulations against RK4 on dual numbers, which shares no code with it."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from dual import simulate

from trialid.effects import CATALOGUE, from_file
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import Response, prepare, respond
from trialid.trial import Trial

OUTPUTS = ("r", "phi", "u", "v", "psi", "x", "y")
START = {"u": 7.1, "v": 0.2, "p": 0.01, "r": -0.002, "phi": 0.05, "psi": 0.3, "x": 2.0, "y": -1.0}

OWN_EFFECT = '''
from trialid.maths import arctan, clip, cos, exp, sin, sqrt, tanh
from trialid.ship.effect import Force, Measured, Parameter, Rate, effect


@effect(source="made up: every function of trialid.maths", system="SI", states={"lift": None})
def late_lift(u, v, r, phi, delta, lift, L, *, a_l=9e5, T_l=Parameter(3.0, "s"), s_l=0.6, q_l=0.3):
    """Y = a_l lift + ...: a lift that comes late, saturates, and shows in the log of u."""
    across = arctan(v / u) + q_l * r * L / u
    wanted = tanh(delta / s_l) + 0.2 * sin(2.0 * across) * cos(phi)
    drag = sqrt(1.0 + (lift * lift) / (q_l * q_l)) - 1.0
    held = clip(lift - across, 0.25 * s_l)
    return (
        Force(X=-2e4 * drag, Y=a_l * held, N=-80.0 * a_l * lift * exp(-(phi**2)) / (1.0 + abs(r))),
        Rate(lift=(wanted - lift) / T_l),
        Measured(u=0.1 * lift),
    )
'''


OWN_SENSORS = '''
from trialid.ship.effect import Delayed, Lagged, Mass, Measured, Parameter, effect


@effect(source="made up: a rudder that acts late")
def late_rudder(*, tau_delta=Parameter(0.8, "s")):
    """delta acts tau_delta after its record."""
    return Delayed(delta=tau_delta)


@effect(source="made up: a slow gyro on a clock that drifts")
def slow_gyro(t, *, T_gyro=Parameter(0.9, "s"), drift=Parameter(0.02)):
    """r behind two equal low-passes, one in each effect; late by drift t."""
    return Lagged(r=T_gyro), Delayed(r=drift * t)


@effect(source="made up")
def slower_gyro(*, T_slow=Parameter(2.1, "s")):
    """A second low-pass."""
    return Lagged(r=T_slow)


@effect(source="made up: a pendulum above the axis")
def pendulum(u, r, v_dot, p_dot, *, k_v=Parameter(0.11, "s^2/m"), k_p=Parameter(0.4, "s^2")):
    """phi_measured = phi + k_v (dv/dt + u r) - k_p dp/dt."""
    return Measured(phi=k_v * (v_dot + u * r) - k_p * p_dot)


@effect(source="made up: cargo moved")
def cargo(*, dx_G=Parameter(0.01), dI_zz=Parameter(0.0001)):
    """x_G + dx_G and I_zz + dI_zz."""
    return Mass(x_G=dx_G, I_zz=dI_zz)
'''


def variant(name: str, everything: ShipModel, folder: Path) -> ShipModel:
    match name:
        case "recorded rudder":
            return everything
        case "rudder_servo":
            return (everything + CATALOGUE[name]).with_values({"T_delta": 1.7})
        case "rudder_servo_limited":
            model = everything + CATALOGUE[name]
            return model.with_values({"T_servo": 1.2, "rate_max": 0.05})
    file = folder / "own.py"
    if name == "late inputs and slow sensors":
        file.write_text(OWN_SENSORS, encoding="utf-8")
        everything = everything - "delay_r"
        for own in from_file(file).values():
            everything = everything + own
            typical = {n: p.start for n, p in own.parameters.items()}
            everything = everything.with_values(typical)
        return everything
    file.write_text(OWN_EFFECT, encoding="utf-8")
    model = everything + from_file(file)["late_lift"]
    return model.with_values({"a_l": 9e5, "T_l": 3.0, "s_l": 0.6, "q_l": 0.3})


VARIANTS = (
    "recorded rudder", "rudder_servo", "rudder_servo_limited", "a user's own effect",
    "late inputs and slow sensors",
)  # fmt: skip


def run(
    model: ShipModel, trial: Trial, engine: str, substeps: int
) -> tuple[tuple[str, ...], Response]:
    simulator = prepare(model, tuple(model.parameters), OUTPUTS, engine, substeps)
    values = {n: model.value(n) for n in model.parameters}
    return simulator.columns, respond(simulator, trial, values, start(model))


def start(model: ShipModel) -> dict[str, float]:
    return START | {s: 0.1 for s in model.all_states if s not in START}


def relative(a: np.ndarray, b: np.ndarray) -> float:
    """Largest difference in a column over the largest value in it."""
    size = np.abs(b).max(axis=0)
    return float(np.max(np.abs(a - b) / np.where(size == 0.0, 1.0, size)))


@pytest.mark.parametrize("substeps", [1, pytest.param(3, marks=pytest.mark.study(turn="each"))])
@pytest.mark.parametrize("name", VARIANTS)
def test_every_column_is_the_derivative_of_the_rk4_map(
    name: str, substeps: int, everything: ShipModel, lively: Callable[..., Trial], tmp_path: Path
) -> None:
    """All parameters and all initial states are free: masses, centre of gravity, delays, servo."""
    model, trial = variant(name, everything, tmp_path), lively(samples=40)
    columns, compiled = run(model, trial, "compiled", substeps)
    _, plain = run(model, trial, "numpy", substeps)
    theta = {n: model.value(n) for n in model.parameters}
    names, y, dy = simulate(model, trial, theta, start(model), OUTPUTS, substeps)
    order = [names.index(c) for c in columns]
    assert compiled.departure is None
    assert sorted(names) == sorted(columns)
    assert np.all(np.abs(dy).max(axis=(0, 1)) > 0.0), "a column that proves nothing"
    np.testing.assert_allclose(compiled.y, y, rtol=1e-11, atol=1e-13)
    assert relative(compiled.S, dy[:, :, order]) < 1e-9
    assert relative(plain.S, dy[:, :, order]) < 1e-9
    assert relative(compiled.states, plain.states) < 1e-12
    assert relative(compiled.S, plain.S) < 1e-12
