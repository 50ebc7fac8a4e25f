"""Pushes where they point, struts of pods, the race of one on another: by hand, and compiled."""

from dataclasses import replace

import numpy as np
import pytest
from boats import eight_actuators, ship_with

from trialid.effects.actuators import actuator_effects
from trialid.effects.actuators.push_kinds import Push
from trialid.effects.actuators.pushes import turned
from trialid.ship.actuators import Actuator
from trialid.simulation.integrate import prepare, respond


@pytest.mark.parametrize("direction", [0.0, 30.0, 90.0, -120.0])
def test_a_push_is_turned_with_its_actuator(direction: float) -> None:
    """Ahead and to its right, as the ship sees both: rotated by hand; a pod's angle adds to it."""
    one = Actuator(name="pod", kind="azimuth", x=-5.0, y=2.0, direction=np.deg2rad(direction))
    ahead, right = (np.exp(1j * (one.direction + turn)) for turn in (0.0, np.pi / 2.0))
    push = 3.0 * ahead + 2.0 * right
    force = turned(one, Push(3.0, 2.0))
    assert pytest.approx((push.real, push.imag)) == (force.X, force.Y)
    assert pytest.approx(-5.0 * push.imag - 2.0 * push.real) == force.N
    at = {"pod": 2.0, "pod_angle": 0.4, "k_pod_ahead": 1.0, "k_pod_astern": 1.0}
    pushed = actuator_effects(ship_with((one,)))["azimuths"](at)[0]
    along = 4.0 * np.exp(1j * (one.direction + 0.4))
    assert pytest.approx((along.real, along.imag)) == (pushed.X, pushed.Y)


def test_thrust_falls_with_the_speed_ahead_and_a_rudder_s_drag_turns_to_its_side() -> None:
    screw = Actuator(name="screw", kind="thruster", x=-5.0, y=-2.0)
    lost = actuator_effects(ship_with((screw,)))["thrusters_advance"]
    at = {"screw": 3.0, "u": 2.0, "k_advance": 0.5}
    assert lost(at)[0] == pytest.approx((-3.0, 0.0, 0.0, -6.0))
    assert lost(at | {"screw": -3.0})[0] == pytest.approx((-3.0, 0.0, 0.0, -6.0))
    ship = ship_with((Actuator(name="stbd", kind="rudder", x=-5.0, y=2.0),))
    drag = actuator_effects(ship)["rudders_drag"]({"stbd": 0.5, "Xdd": -0.004})[0]
    assert drag == pytest.approx((-0.001, 0.0, 0.0, 0.002 / ship.particulars["L"]))


def test_a_strut_is_a_rudder_of_its_pod() -> None:
    """Turned clockwise under way it pushes to starboard and back, and against a drift, at rest not.

    By hand at 30 deg and 2 m/s: U_P = 2, v_P = -1, F_N = 6 N over 3 kg/m.
    """
    ones = (Actuator(name="pod", kind="azimuth", x=-5.0, y=0.0),)
    strut = actuator_effects(ship_with(ones))["azimuths_strut"]
    at = {"pod_angle": np.pi / 6.0, "u": 2.0, "v": 0.0, "r": 0.0, "k_strut": 3.0}
    X, Y, _, N = strut(at)[0]
    assert pytest.approx((-3.0, 6.0 * np.sqrt(0.75), -30.0 * np.sqrt(0.75))) == (X, Y, N)
    drifting = strut(at | {"pod_angle": 0.0, "u": 0.0, "v": 1.0})[0]
    assert pytest.approx((0.0, -3.0)) == (drifting.X, drifting.Y)
    turning = strut(at | {"pod_angle": 0.0, "r": 0.1})[0]
    assert turning.Y > 0.0 > turning.N
    assert strut(at | {"u": 0.0})[0] == pytest.approx((0.0,) * 4)


def test_a_pod_loses_thrust_to_the_flow_that_it_looks_into() -> None:
    """By hand, 60 deg to starboard, 5 m aft of the origin: U_P = 2 / 2 = 1, T = -4 * 3 * 1.

    A drift to starboard counts as speed where it looks across; an idle pod loses nothing.
    """
    ones = (Actuator(name="pod", kind="azimuth", x=-5.0, y=0.0),)
    lost = actuator_effects(ship_with(ones))["azimuths_advance"]
    at = {"pod": 3.0, "pod_angle": np.pi / 3.0, "u": 2.0, "v": 0.0, "r": 0.0, "k_pod_advance": 4.0}
    X, Y, _, N = lost(at)[0]
    assert pytest.approx((-6.0, -12.0 * np.sqrt(0.75), 60.0 * np.sqrt(0.75))) == (X, Y, N)
    assert pytest.approx(-6.0) == lost(at | {"pod": -3.0})[0].X
    across = lost(at | {"pod_angle": np.pi / 2.0, "u": 0.0, "v": 0.5, "r": 0.02})[0]
    assert pytest.approx((0.0, -12.0 * 0.4), abs=1e-12) == (across.X, across.Y)
    assert lost(at | {"pod": 0.0})[0] == pytest.approx((0.0,) * 4)


def test_a_pod_in_the_race_of_another_loses_thrust() -> None:
    """The one aft, behind one that pushes ahead; the one ahead, before one that backs.

    Half of it 7 deg off the axis, and at twice the distance of the nearest two; across it none.
    """
    ones = tuple(
        Actuator(name=n, kind="azimuth", x=x, y=0.0)
        for n, x in (("aft", -10.0), ("fore", 0.0), ("bow", 20.0))
    )
    race = actuator_effects(ship_with(ones))["azimuths_race"]
    still = dict.fromkeys(race.signals, 0.0) | {"k_lost": 0.5}
    at = still | {"aft": 2.0, "fore": 3.0}
    assert race(at)[0] == pytest.approx((-3.0, 0.0, 0.0, 0.0), rel=1e-3)
    backs = race(at | {"fore": -3.0})[0]
    assert abs(backs.X) < 0.01
    assert pytest.approx(3.0, rel=1e-3) == race(at | {"aft": -2.0, "fore": -3.0})[0].X
    off = race(at | {"fore_angle": np.deg2rad((130.0 / 0.7**3) ** (1.0 / 3.0))})[0]
    assert pytest.approx(-1.5, rel=1e-2) == off.X
    assert abs(race(at | {"fore_angle": np.pi / 2.0})[0].X) < 0.01
    far = race(still | {"fore": 2.0, "bow": 3.0})[0]
    assert pytest.approx(-1.5, rel=1e-3) == far.X
    aside = race(at | {"aft_angle": np.pi / 2.0})[0]
    assert pytest.approx((0.0, -3.0, 30.0), rel=1e-3, abs=0.01) == (aside.X, aside.Y, aside.N)


def test_a_pod_behind_a_fixed_screw_loses_thrust_and_the_screw_does_not() -> None:
    """As pods of contra-rotating drives: 3 m behind it, in line. By hand k_lost n n_screw.

    Turned across it pushes there, so that is where thrust is lost; a screw of another command has
    another unit, and is left out.
    """
    pod = Actuator(name="pod", kind="azimuth", x=-10.0, y=0.0)
    screw = Actuator(name="screw", kind="thruster", x=-7.0, y=0.0)
    race = actuator_effects(ship_with((pod, screw)))["azimuths_race"]
    assert set(race.signals) == {"pod", "pod_angle", "screw"}
    at = {"pod": 2.0, "pod_angle": 0.0, "screw": 3.0, "k_lost": 0.5}
    assert race(at)[0] == pytest.approx((-3.0, 0.0, 0.0, 0.0), rel=1e-3)
    across = race(at | {"pod_angle": np.pi / 2.0})[0]
    assert pytest.approx((0.0, -3.0, 30.0), rel=1e-3, abs=1e-6) == (across.X, across.Y, across.N)
    assert abs(race(at | {"screw": -3.0})[0].X) < 0.01
    other = replace(screw, command="thrust")
    assert "azimuths_race" not in actuator_effects(ship_with((pod, other)))


def test_compiled_and_numpy_agree_on_struts_races_and_what_holds_drives_back() -> None:
    model, free, trial = eight_actuators()
    own = actuator_effects(model.ship)
    added = [own[f"azimuths_{n}"] for n in ("strut", "advance", "race", "deadband", "saturation")]
    for effect in added:
        model = model + effect
    stated = {n: p.start for e in added for n, p in e.parameters.items()}
    sought = (*free, *stated)
    values = {n: model.value(n) for n in free} | stated | {"dead_azimuths": 0.05}
    values["n_full_azimuths"] = 0.3
    model = model.with_values(values)
    compiled, plain = (
        respond(
            prepare(model, sought, ("u", "r"), engine),
            trial,
            values,
            {"u": 5.0, "v": 0.1, "r": 0.001},
        )
        for engine in ("compiled", "numpy")
    )
    assert compiled.departure is None
    assert np.all(np.abs(plain.S[:, :, -len(stated) :]).max(axis=(0, 1)) > 0.0)
    for one, other in ((compiled.y, plain.y), (compiled.S, plain.S)):
        size = np.abs(other).max(axis=0)
        assert np.all(np.abs(one - other) <= 1e-9 * size + 1e-300)
