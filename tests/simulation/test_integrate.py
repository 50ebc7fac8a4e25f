"""Eq. 2 as a numerical method: its order, an independent integrator, and where it gives up."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from trialid.effects import CATALOGUE
from trialid.errors import EffectError, NotIdentifiable
from trialid.ship.model import ShipModel
from trialid.ship.motion import derivatives
from trialid.ship.particulars import Ship
from trialid.simulation.integrate import Departure, domain, guess, prepare, respond
from trialid.trial import Trial

ENGINES = ("compiled", "numpy")


@pytest.fixture
def steered(s175q: Ship) -> ShipModel:
    names = ("linear_hull", "linear_rudder", "linear_roll", "heel_yaw")
    return ShipModel(s175q, ("v", "p", "r", "phi"), tuple(CATALOGUE[n] for n in names))


@pytest.fixture
def unstable(steered: ShipModel) -> ShipModel:
    """Yaw damping of the wrong sign: it spins up."""
    return steered.with_values({"Nr": 0.05})


@pytest.fixture
def smooth(everything: ShipModel) -> ShipModel:
    """Without the modulus terms, at whose kinks every integrator loses its order."""
    for effect in everything.effects:
        if any(mark in effect.name for mark in ("drag", "drift", "quadratic")):
            everything = everything - effect.name
    return everything


def constant(samples: int, period: float = 0.5, **signals: float) -> Trial:
    return Trial(
        "still", "fit", period, {n: np.full(samples, x) for n, x in signals.items()}, {}
    )  # fmt: skip


def free_values(model: ShipModel, names: tuple[str, ...]) -> dict[str, float]:
    return {n: model.value(n) for n in names}


def test_fourth_order(smooth: ShipModel, lively: Callable[..., Trial]) -> None:
    """Halving the step inside a sample divides the error by 16; the input stays linear there."""
    trial = lively(samples=21, period=4.0)

    def last(substeps: int) -> np.ndarray:
        simulator = prepare(smooth, (), ("u",), substeps=substeps)
        return respond(simulator, trial, {}, {}, sensitivities=False).states[-1]

    best = last(256)
    errors = [np.abs(last(n) - best).max() for n in (4, 8, 16)]
    assert 12.0 < errors[0] / errors[1] < 20.0
    assert 12.0 < errors[1] / errors[2] < 20.0


def test_substeps_are_a_finer_grid(everything: ShipModel, lively: Callable[..., Trial]) -> None:
    coarse = lively(samples=12, period=1.6)
    fine_t = np.arange(11 * 16 + 1) * 0.1
    signals = {n: np.interp(fine_t, coarse.t, y) for n, y in coarse.signals.items()}
    fine = Trial("fine", "fit", 0.1, signals, {})
    one = respond(prepare(everything, (), ("r",), substeps=16), coarse, {}, {}, False).states
    many = respond(prepare(everything, (), ("r",)), fine, {}, {}, False).states[::16]
    np.testing.assert_allclose(one, many, rtol=1e-11, atol=1e-13)


def test_scipy_arrives_at_the_same_place(smooth: ShipModel, lively: Callable[..., Trial]) -> None:
    model, trial = smooth, lively(samples=41, period=0.5)
    theta = {n: model.value(n) for n in model.parameters}
    answer = respond(prepare(model, (), ("r",), substeps=20), trial, {}, {}, sensitivities=False)
    start = [guess(model, trial, s) for s in model.all_states]

    def slope(t: float, x: np.ndarray) -> list[float]:
        states = dict(zip(model.all_states, x, strict=True))
        now = {s: np.interp(t, trial.t, trial.signals[s]) for s in model.recorded}
        return list(derivatives(model, states, now, theta).values())

    x = np.array(start)
    for k in range(trial.samples - 1):
        span = (trial.t[k], trial.t[k + 1])
        x = solve_ivp(slope, span, x, method="DOP853", rtol=1e-11, atol=1e-13).y[:, -1]
    np.testing.assert_allclose(answer.states[-1], x, rtol=1e-8, atol=1e-10)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_departure_has_its_time_and_leaves_nothing_behind(
    engine: str, unstable: ShipModel
) -> None:
    simulator = prepare(unstable, ("Nv", "Yv"), ("r", "phi"), engine)
    trial = constant(400, u=7.3, delta=0.1)
    answer = respond(simulator, trial, free_values(unstable, ("Nv", "Yv")), {})
    k = round(answer.departure.t / trial.period)
    limit = domain(unstable)
    assert np.all(np.abs(answer.states[:k]) < limit)
    assert np.any(~(np.abs(answer.states[k]) < limit))
    assert np.all(np.isfinite(answer.y[: k + 1]))
    assert np.all(np.isfinite(answer.S[:k]))
    assert np.all(np.isnan(answer.states[k + 1 :]))
    assert np.all(np.isnan(answer.y[k + 1 :]))
    assert np.all(np.isnan(answer.S[k + 1 :][:, :, : len(simulator.columns)]).any(axis=(1, 2)))
    quiet = respond(simulator, trial, free_values(unstable, ("Nv", "Yv")), {}, sensitivities=False)
    assert (quiet.departure.state, quiet.departure.t) == (
        answer.departure.state,
        answer.departure.t,
    )
    # the two kernels are compiled apart and may differ in the last bit, which a blow-up enlarges
    assert quiet.departure.value == pytest.approx(answer.departure.value, rel=1e-9)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_departure_names_the_state_that_left(engine: str, unstable: ShipModel) -> None:
    """0.71 rad/s is the bound on r, 83 m/s that on v: at 1.5 rad/s and -7.5 m/s it was r."""
    trial = constant(400, u=7.3, delta=0.1)
    answer = respond(prepare(unstable, (), ("r",), engine), trial, {}, {}, sensitivities=False)
    k = round(answer.departure.t / trial.period)
    over = np.abs(answer.states[k]) / domain(unstable)
    assert answer.departure.state == unstable.all_states[int(np.argmax(over))]


@pytest.mark.parametrize("engine", ENGINES)
@pytest.mark.parametrize("bad", ["parameter", "start", "input"])
def test_nan_is_found_at_once(engine: str, bad: str, steered: ShipModel) -> None:
    trial = constant(8, u=7.3, delta=0.1)
    values, start, first = {"Nv": steered.value("Nv")}, {}, 1
    if bad == "parameter":
        values["Nv"] = np.nan
    elif bad == "start":
        start["v"] = np.nan
    else:
        rudder = np.full(8, 0.1)
        rudder[5], first = np.nan, 5
        trial = replace(trial, signals={**trial.signals, "delta": rudder})
    answer = respond(prepare(steered, ("Nv",), ("r", "phi"), engine), trial, values, start)
    assert answer.departure.t == first * trial.period
    assert "not a number" in str(answer.departure)
    assert np.all(np.isnan(answer.y[first:]))


@pytest.mark.parametrize("engine", ENGINES)
def test_an_explosion_makes_no_noise(engine: str, steered: ShipModel) -> None:
    """Numbers beyond 1e300 on the way out: no warning, no exception, a departure."""
    more = (CATALOGUE["sway_cubic_vvv"], CATALOGUE["yaw_cubic_rrr"])
    wild = replace(steered, effects=(*steered.effects, *more))
    wild = wild.with_values({"Yvvv": 50.0, "Nrrr": 50.0})
    simulator = prepare(wild, ("Yvvv",), ("r", "U", "phi"), engine)
    trial = constant(9, period=20.0, u=7.3, delta=0.3)
    answer = respond(simulator, trial, {"Yvvv": 50.0}, {"v": 9.0, "r": 0.5})
    assert answer.departure is not None


def test_the_domain_is_far_from_any_ship(s175q: Ship) -> None:
    """Multiples of sqrt(g L), 41.4 m/s here; 80 deg of heel; a heading may wind up for ever."""
    model = ShipModel(s175q, ("u", "v", "p", "r", "phi", "psi"), (CATALOGUE["rudder_servo"],))
    speed = np.sqrt(9.81 * 175.0)
    expected = [3.0 * speed, 2.0 * speed, 10.0, 3.0 * speed / 175.0, 1.4, np.inf, np.inf]
    np.testing.assert_allclose(domain(model), expected)
    fast = replace(s175q, particulars={**s175q.particulars, "U0": 50.0})
    np.testing.assert_allclose(domain(ShipModel(fast, ("v",), ())), [100.0])


def test_a_departure_in_words() -> None:
    assert str(Departure("phi", 12.0, 1.5)) == (
        "phi left the model's domain at t = 12.0 s (85.9 deg)"
    )
    assert "not a number" in str(Departure("v", 3.0, np.nan))
    assert "0.5 )" in str(Departure("lift", 3.0, 0.5))


def test_states_start_as_recorded_else_at_rest(steered: ShipModel) -> None:
    model = replace(
        steered, states=("u", "v", "p", "r", "phi"),
        effects=(*steered.effects, CATALOGUE["rudder_servo"]),
    )  # fmt: skip
    trial = constant(3, delta_order=0.2, r=0.01)
    begun = [guess(model, trial, s) for s in model.all_states]
    assert begun == [7.33, 0.0, 0.0, 0.01, 0.0, 0.2]


def test_speed_not_recorded_is_the_approach_speed(steered: ShipModel) -> None:
    simulator = prepare(steered, (), ("r",))
    silent = respond(simulator, constant(20, delta=0.1), {}, {}, sensitivities=False)
    told = respond(simulator, constant(20, delta=0.1, u=7.33), {}, {}, sensitivities=False)
    np.testing.assert_array_equal(silent.y, told.y)


def test_a_missing_signal_is_named_with_who_needs_it(steered: ShipModel) -> None:
    simulator = prepare(steered, (), ("r",))
    with pytest.raises(NotIdentifiable, match=r"'still' has no signal 'delta'.*linear_rudder"):
        respond(simulator, constant(5, u=7.3), {}, {})


def test_unknown_names_are_refused(steered: ShipModel) -> None:
    with pytest.raises(EffectError, match=r"'Nvv' is in no effect.*'Nv'"):
        prepare(steered, ("Nvv",), ("r",))
    with pytest.raises(EffectError, match=r"output 'heading' is not simulated.*v, p, r, phi"):
        prepare(steered, (), ("heading",))


def test_a_sensor_without_its_motion_is_refused(steered: ShipModel) -> None:
    model = replace(steered, effects=(*steered.effects, CATALOGUE["bias_psi"]))
    with pytest.raises(EffectError, match="psi"):
        prepare(model.with_values({"b_psi": 0.01}), (), ("r",))


def test_outputs_carry_bias_and_cross_axis(steered: ShipModel) -> None:
    more = (CATALOGUE["bias_r"], CATALOGUE["gyro_cross_axis"])
    model = replace(steered, effects=(*steered.effects, *more))
    model = model.with_values({"b_r": 0.002, "e_rp": 0.05})
    trial = constant(60, u=7.3, delta=0.2)
    plain = respond(prepare(steered, (), ("r",)), trial, {}, {}, sensitivities=False)
    sensed = respond(prepare(model, (), ("r",)), trial, {}, {}, sensitivities=False)
    p = plain.states[:, steered.all_states.index("p")]
    np.testing.assert_allclose(sensed.y[:, 0], plain.y[:, 0] + 0.002 + 0.05 * p, atol=1e-16)


def test_a_recorded_signal_can_be_an_output(steered: ShipModel) -> None:
    """The rudder's indicator, for instance; it has no slope by anything."""
    answer = respond(prepare(steered, ("Nv",), ("delta", "r")), constant(9, u=7.3, delta=0.2),
                     {"Nv": steered.value("Nv")}, {})  # fmt: skip
    assert np.all(answer.y[:, 0] == 0.2)
    assert np.all(answer.S[:, 0] == 0.0)


@pytest.mark.parametrize("engine", ENGINES)
def test_a_neutral_angle_acts_behind_the_steering_gear(engine: str, steered: ShipModel) -> None:
    """The indicator follows the order to zero; the ship still feels the neutral angle."""
    more = (CATALOGUE["rudder_servo"], CATALOGUE["rudder_offset"])
    geared = replace(steered, effects=(*steered.effects, *more))
    geared = geared.with_values({"T_delta": 2.0, "delta_0": 0.05})
    straight = constant(900, u=7.3, delta_order=0.0)
    answer = respond(prepare(geared, (), ("delta", "r"), engine), straight, {}, {}, False)
    turning = constant(900, u=7.3, delta=0.05)
    expected = respond(prepare(steered, (), ("r",), engine), turning, {}, {}, False)
    np.testing.assert_allclose(answer.y[-1], [0.0, expected.y[-1, 0]], rtol=1e-6, atol=1e-12)
