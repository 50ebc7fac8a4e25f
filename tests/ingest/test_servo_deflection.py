import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from write_dataflash import pwm

from trialid.ingest.mavlink import servo_deflection

NOW = np.zeros(1, np.int64)


def known(**values):
    names = [f"SERVO1_{name}" for name in values]
    return servo_deflection.parameters(
        names, np.zeros(len(names), np.int64), np.array(list(values.values()), float)
    )


def shares(widths, **values):
    width = np.array(widths, float)
    t = np.zeros(len(width), np.int64)
    return servo_deflection.deflection(width, t, 1, known(FUNCTION=26, **values))


@settings(max_examples=300, deadline=None, derandomize=True)
@given(
    st.floats(-1, 1),
    st.integers(800, 1400),
    st.integers(1401, 1600),
    st.integers(1601, 2200),
    st.booleans(),
)
def test_the_pulse_width_the_autopilot_makes_comes_back(share, low, trim, high, flipped):
    width = pwm(share, low, trim, high, flipped)
    (found,) = shares([width], MIN=low, TRIM=trim, MAX=high, REVERSED=float(flipped))
    assert abs(found - share) <= 1.0001 / min(high - trim, trim - low)  # a count, truncated


def test_the_usual_formula_is_wrong_by_degrees():
    share = np.linspace(-1, 1, 201)
    widths = np.array([pwm(one, 1100, 1450, 1920, 0) for one in share])
    naive = (widths - 1500) / 400 * 35
    found = 35 * shares(widths, MIN=1100, TRIM=1450, MAX=1920, REVERSED=0)
    assert np.abs(naive - 35 * share).max() > 4
    assert np.abs(found - 35 * share).max() < 35 / 350


@pytest.mark.parametrize("width", [0, 65535])
def test_no_output_is_no_deflection(width):
    found = shares([1500, width], MIN=1100, TRIM=1500, MAX=1900, REVERSED=0)
    assert found[0] == 0.0
    assert np.isnan(found[1])


def test_parameters_that_contradict_each_other_give_nothing():
    found = shares([1400, 1600], MIN=1100, TRIM=1500, MAX=1500, REVERSED=0)
    assert found[0] == -0.25
    assert np.isnan(found[1])


def test_a_parameter_holds_from_when_it_was_set():
    t = np.array([0, 0, 0, 0, 0, 100], np.int64)
    names = [f"SERVO1_{n}" for n in ("FUNCTION", "MIN", "TRIM", "MAX", "REVERSED", "TRIM")]
    values = np.array([26, 1100, 1500, 1900, 0, 1600.0])
    history = servo_deflection.parameters(names, t, values)
    found = servo_deflection.deflection(
        np.full(3, 1600.0), np.array([-5, 99, 100], np.int64), 1, history
    )
    assert found.tolist() == [0.25, 0.25, 0.0]
    (remark,) = servo_deflection.changes(history)
    assert "SERVO1_TRIM 1500 to 1600 at 0.0 s" in remark


def test_an_output_that_steers_only_for_a_while():
    names = [f"SERVO1_{n}" for n in ("FUNCTION", "FUNCTION", "MIN", "TRIM", "MAX", "REVERSED")]
    values = np.array([26, 0, 1100, 1500, 1900, 0], float)
    history = servo_deflection.parameters(names, np.array([0, 50, 0, 0, 0, 0], np.int64), values)
    found = servo_deflection.deflection(
        np.full(2, 1700.0), np.array([10, 60], np.int64), 1, history
    )
    assert found[0] == 0.5
    assert np.isnan(found[1])


def test_what_is_missing_is_said():
    def words(channels=None, **values):
        return " / ".join(servo_deflection.remarks(known(**values), channels or {}))

    assert "no SERVOn_FUNCTION parameter" in words()
    assert "is 26 (GroundSteering) or 21 (Rudder)" in words(FUNCTION=73)
    assert "output 1 (ThrottleLeft): no share of full, SERVO1_MIN" in words(FUNCTION=73)
    assert "SERVO1_TRIM, SERVO1_REVERSED not in the log" in words(FUNCTION=21, MIN=1, MAX=2)


def test_motors_of_a_skid_steered_boat_are_outputs_of_their_own():
    names = [f"SERVO{n}_FUNCTION" for n in (1, 2, 3, 4)]
    values = np.array([73, 26, 74, 70.0])
    found = servo_deflection.outputs(
        servo_deflection.parameters(names, np.zeros(4, np.int64), values)
    )
    assert {n: (one.field, one.steers) for n, one in found.items()} == {
        1: ("throttle_left", False),
        2: ("deflection", True),
        3: ("throttle_right", False),
        4: ("throttle", False),
    }


def test_a_motor_whose_sign_is_a_relay_has_no_share():
    names = ["SERVO1_FUNCTION", "MOT_PWM_TYPE"]
    history = servo_deflection.parameters(names, np.zeros(2, np.int64), np.array([73, 3.0]))
    assert servo_deflection.outputs(history) == {}
    assert "a relay turns the motors round" in " / ".join(servo_deflection.remarks(history, {}))
