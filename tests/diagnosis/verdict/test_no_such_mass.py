"""What ends at values that no ship has is not named: it stands in for something else."""

from types import SimpleNamespace
from typing import Any

import pytest
import s175q

from trialid.diagnosis.found_values import mostly_at_ends, no_such_mass
from trialid.diagnosis.objections import NO_SUCH_VALUE
from trialid.effects import CATALOGUE
from trialid.ship.model import ShipModel

STATED = {n: s175q.MODEL.value(n) for n in ("m", "I_zz", "I_xx", "Yvdot")}


def with_mass(name: str, value: float, *, at_bounds: bool = False) -> tuple[Any, Any]:
    """The effect, and the S-175 with it at this value."""
    effect = CATALOGUE[name]
    [parameter] = effect.parameters
    model: ShipModel = (s175q.MODEL + effect).with_values({parameter: value})
    return effect, SimpleNamespace(model=model, at_bounds={parameter: value} if at_bounds else {})


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("displacement_error", 0.8 * STATED["m"]),  # a block coefficient of 1.01
        ("displacement_error", -1.01 * STATED["m"]),
        ("sway_added_mass_error", -1.01 * STATED["Yvdot"]),
        ("yaw_inertia_error", 0.26 * STATED["m"] - STATED["I_zz"]),
        ("yaw_inertia_error", -1.01 * STATED["I_zz"]),
        ("roll_inertia_error", -1.01 * STATED["I_xx"]),
    ],
)
def test_a_mass_that_no_ship_has(name: str, value: float) -> None:
    assert no_such_mass in NO_SUCH_VALUE
    assert no_such_mass(*with_mass(name, value))


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("displacement_error", 0.15 * STATED["m"]),
        ("sway_added_mass_error", 0.5 * STATED["Yvdot"]),
        ("sway_added_mass_error", -0.5 * STATED["Yvdot"]),
        ("yaw_inertia_error", 0.5 * STATED["I_zz"]),
        ("gravity_centre_ahead", 0.02),
    ],
)
def test_one_that_a_ship_may_have(name: str, value: float) -> None:
    """But not at the end of what was sought."""
    assert not no_such_mass(*with_mass(name, value))
    assert no_such_mass(*with_mass(name, value, at_bounds=True))


def test_what_is_stated_and_what_is_added_count_together() -> None:
    effect, fit = with_mass("displacement_error", 0.25 * STATED["m"])
    assert not no_such_mass(effect, fit)
    twice = fit.model.with_values({"m": 1.55 * STATED["m"]})
    assert no_such_mass(effect, SimpleNamespace(model=twice, at_bounds={}))


def test_nothing_is_said_of_a_force() -> None:
    fit = SimpleNamespace(model=s175q.MODEL, at_bounds={"Nrar": 1.0})
    assert not no_such_mass(CATALOGUE["yaw_drag_rar"], fit)


@pytest.mark.parametrize(
    ("name", "ended", "told"),
    [
        ("surge_turning", ("Xvr", "Xvv"), True),
        ("surge_turning", ("Xvv",), False),
        ("surge_turning", (), False),
        ("yaw_drag_rar", ("Nrar",), False),
        ("sway_cubic_cross", ("Yvvr", "Yvrr"), True),
        ("rudder_servo_limited", ("T_servo",), False),
    ],
)
def test_most_of_what_an_effect_adds_at_its_ends(name: str, ended: tuple[str, ...], told) -> None:
    """What only shapes it may well be there: a gear that is as quick as it can be."""
    assert mostly_at_ends in NO_SUCH_VALUE
    fit: Any = SimpleNamespace(at_bounds=dict.fromkeys(ended, 0.05))
    assert mostly_at_ends(CATALOGUE[name], fit) is told
