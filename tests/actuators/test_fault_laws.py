"""Faults of actuators do to their signals what they say; numbers by hand."""

from dataclasses import replace

import pytest
from boats import EFFECTS, SHIP, ship_with
from test_actuator_laws import values

from trialid.effects.actuators import actuator_effects


@pytest.mark.parametrize("kept", [0.0, 0.5, 0.8])
def test_what_is_weak_keeps_its_share_of_the_force(kept: float) -> None:
    """Whatever drives it: also where the thrust goes with the square."""
    for name in ("left", "jet", "bow", "rudder_port"):
        push = next(e for e in EFFECTS.values() if name in e.signals and e.name.endswith("s"))
        at = values(push, 3)
        [moved] = EFFECTS[f"{name}_weak"]({name: at[name], f"weak_{name}": 1.0 - kept})
        still = push(at | {s: 0.0 for s in push.signals if s == name})[0]
        whole, less = push(at)[0], push(at | {name: at[name] + moved[name]})[0]
        expected = [c + kept * (b - c) for b, c in zip(whole, still, strict=True)]
        assert list(less) == pytest.approx(expected, rel=1e-6, abs=1e-4 * abs(whole.N))


@pytest.mark.parametrize("kept", [0.0, 0.5, 0.8])
def test_what_is_weak_of_a_share_of_full_keeps_that_share_of_it(kept: float) -> None:
    """With which power of it the thrust goes nobody knows: a motor's voltage is no revolutions."""
    [moved] = EFFECTS["pod_weak"]({"pod": 0.6, "weak_pod": 1.0 - kept})
    assert 0.6 + moved["pod"] == pytest.approx(0.6 * kept)
    assert "share of full of pod times 1 - weak_pod" in EFFECTS["pod_weak"].equation
    assert "force of left times 1 - weak_left" in EFFECTS["left_weak"].equation


@pytest.mark.parametrize(("name", "square"), [("left", True), ("bow", True), ("jet", False)])
def test_what_is_stuck_gives_a_share_of_the_thrust_at_its_limit(name: str, square: bool) -> None:
    """Ahead and astern, whatever is recorded; a stated thrust is the share itself."""
    limited = [replace(a, limit=50.0) if a.name == name else a for a in SHIP.actuators]
    made = actuator_effects(ship_with(tuple(limited)))
    fault = next(e for e in made.values() if e.name.endswith("_stuck") and name in e.signals)
    stuck, held = fault.parameters
    for share, kept in ((0.36, 30.0), (-0.36, -30.0)) if square else ((0.36, 18.0), (-1.0, -50.0)):
        for recorded in (-7.0, 45.0):
            [moved] = fault({name: recorded, stuck: 1.0, held: share})
            assert recorded + moved[name] == pytest.approx(kept)
    assert fault({name: 4.0, stuck: 0.0, held: 0.36})[0][name] == 0.0


def test_of_a_pod_the_drive_is_stuck_apart_from_the_angle() -> None:
    assert EFFECTS["pod_stuck"].signals == ("pod_angle",)
    assert EFFECTS["pod_share_stuck"].signals == ("pod",)
    assert "its square = held_pod_share of that at " in EFFECTS["pod_share_stuck"].equation


def test_reversed_and_exchanged_do_what_they_say() -> None:
    [moved] = EFFECTS["left_reversed"]({"left": 4.0, "reversed_left": 2.0})
    assert 4.0 + moved["left"] == pytest.approx(-4.0)
    [moved] = EFFECTS["rudder_port_rudder_stbd_exchanged"](
        {"rudder_port": 0.1, "rudder_stbd": -0.3, "swap_rudder_port_rudder_stbd": 1.0}
    )
    assert 0.1 + moved["rudder_port"] == pytest.approx(-0.3)
    assert -0.3 + moved["rudder_stbd"] == pytest.approx(0.1)


@pytest.mark.parametrize("held", [0.0, 0.6, 1.0])
def test_a_bucket_that_sticks_stays_open_or_closed(held: float) -> None:
    """Both ends lie inside of its range: at an end it would be taken for another fault."""
    fault = EFFECTS["jet_bucket_stuck"]
    [moved] = fault({"jet_bucket": 0.3, "stuck_jet_bucket": 1.0, "held_jet_bucket": held})
    assert 0.3 + moved["jet_bucket"] == pytest.approx(held)
    assert fault.parameters["held_jet_bucket"].low < held < fault.parameters["held_jet_bucket"].high
    assert fault.is_whole
    assert fault.signals == ("jet_bucket",)
