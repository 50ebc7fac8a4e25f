"""Declaring an effect: the signature says it all, and what it lacks is said at once."""

import numpy as np
import pytest

from trialid.errors import EffectError
from trialid.ship.effect import Delayed, Force, Measured, Parameter, Rate, Steered, effect


def test_a_bare_number_is_a_primed_coefficient() -> None:
    @effect(source="test")
    def drag(v, r, *, Yv=-0.01, T=Parameter(2.0, "s", low=0.1)):
        """Y = Yv v."""
        return Force(Y=Yv * v * T)

    assert drag.name == "drag"
    assert drag.signals == ("v", "r")
    assert drag.parameters["Yv"] == Parameter(-0.01, "1", -np.inf, np.inf, 0.0)
    assert drag.parameters["T"].unit == "s"
    assert drag.forms == (Force,)
    assert drag.equation == "Y = Yv v."


def test_only_a_force_can_be_primed() -> None:
    @effect(source="test")
    def sensor(*, b=0.1):
        """Yaw rate: r = r + b."""
        return Measured(r=b)

    assert sensor.system == "SI"


def test_several_results_of_one_effect() -> None:
    @effect(source="test", system="SI", states={"x_s": None})
    def all_of_them(v, x_s, *, a=1.0):
        """One of each."""
        return (
            Force(Y=a * v), Rate(x_s=v - x_s), Measured(r=a), Steered(delta=a), Delayed(r=a),
        )  # fmt: skip

    assert all_of_them.forms == (Force, Rate, Measured, Steered, Delayed)
    force, rate, *_ = all_of_them({"v": 2.0, "x_s": 0.5, "a": 3.0})
    assert force.Y == 6.0
    assert dict(rate) == {"x_s": 1.5}


def no_docstring(v):
    return Force(Y=v)


def unknown_signal(delat):
    """Y."""
    return Force(Y=delat)


def unknown_state(v, lift):
    """Y."""
    return Force(Y=lift)


def no_typical_value(v, *, Yv):
    """Y."""
    return Force(Y=Yv * v)


def wrong_result(v):
    """Y."""
    return {"Y": v}


def nothing(v):
    """Y."""


def unknown_output(v):
    """Y."""
    return Measured(heading=v)


def cannot_run(v):
    """Y."""
    return Force(Y=v / 0.0)


def unknown_force(v):
    """Y."""
    return Force(Z=v)


@pytest.mark.parametrize(
    ("function", "says"),
    [
        (no_docstring, "'no_docstring' has no docstring; write its equation there"),
        (unknown_signal, r"'delat', which is not a quantity \(did you mean 'delta'"),
        (unknown_state, "asks for signal 'lift'.*a parameter goes after the `\\*`"),
        (no_typical_value, "'Yv' has no typical value; write `Yv=...`"),
        (wrong_result, "returns dict; expected one of Force, Rate, Measured, Steered, Delayed"),
        (nothing, "returns NoneType; expected one of"),
        (unknown_output, r"Measured\(heading=...\), and 'heading' is not a signal"),
        (cannot_run, "'cannot_run' cannot be evaluated: float division by zero"),
        (unknown_force, "cannot be evaluated: .*'Z'"),
    ],
)
def test_what_is_missing_is_said(function: object, says: str) -> None:
    with pytest.raises(EffectError, match=says) as caught:
        effect(source="test")(function)
    assert "\n" not in str(caught.value)
