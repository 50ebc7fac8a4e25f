import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_recordings import channel, recording

from trialid.alignment import SignalSource, align
from trialid.errors import AlignmentError, LogError

T = np.arange(0, 60, 0.5)


def quaternion(roll, pitch, yaw):
    """x, y, z, w by rotating the axes one after the other: yaw, then pitch, then roll."""

    def product(a, b):
        (ax, ay, az, aw), (bx, by, bz, bw) = a, b
        return (
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        )

    about_x = (np.sin(roll / 2), 0 * roll, 0 * roll, np.cos(roll / 2))
    about_y = (0 * roll, np.sin(pitch / 2), 0 * roll, np.cos(pitch / 2))
    about_z = (0 * roll, 0 * roll, np.sin(yaw / 2), np.cos(yaw / 2))
    return product(product(about_z, about_y), about_x)


def log_of(roll, pitch, yaw, scale=1.0):
    parts = zip("xyzw", quaternion(roll, pitch, yaw), strict=True)
    return recording(*(channel(f"/imu:orientation.{axis}", T, scale * q) for axis, q in parts))


def angle(log, quantity, as_, **more):
    source = SignalSource(quantity, "/imu:orientation", as_=as_, **more)
    return align("t", "fit", [log], [source], 0.5).signals[quantity]


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(0.1, 10.0))
def test_angles_of_a_quaternion(pitch, offset, scale):
    roll, yaw = 0.5 * np.sin(T), offset + 0.02 * T
    log = log_of(roll, pitch + 0 * T, yaw, scale)
    np.testing.assert_allclose(angle(log, "phi", "roll"), roll, atol=1e-9)
    np.testing.assert_allclose(angle(log, "phi", "pitch"), pitch, atol=1e-9)
    np.testing.assert_allclose(angle(log, "psi", "yaw"), yaw, atol=1e-9)


def test_yaw_about_an_upward_axis_is_turned_round_by_positive_port():
    turning = 0.1 * T  # counterclockwise, two turns and more: also unwrapped
    log = log_of(0 * T, 0 * T, turning)
    np.testing.assert_allclose(angle(log, "psi", "yaw", positive="port"), -turning, atol=1e-9)


def test_a_quaternion_of_zeros_is_not_available():
    parts = dict(zip("xyzw", quaternion(0.1 + 0 * T, 0 * T, 0 * T), strict=True))
    dead = (T > 20) & (T < 40)
    log = recording(
        *(
            channel(f"/imu:orientation.{axis}", T, np.where(dead, 0.0, part))
            for axis, part in parts.items()
        )
    )
    source = SignalSource("phi", "/imu:orientation", as_="roll")
    trial = align("t", "fit", [log], [source], 0.5)
    np.testing.assert_array_equal(trial.valid["phi"], ~dead)
    np.testing.assert_allclose(trial.signals["phi"], 0.1, atol=1e-12)


def test_a_missing_field_of_the_quaternion_is_named():
    log = recording(channel("/imu:orientation.x", T, 0 * T), channel("/imu:rate.x", T, 0 * T))
    with pytest.raises(LogError, match=r"no channel '/imu:orientation.y' in trial.log; did you"):
        angle(log, "phi", "roll")


def test_fields_of_different_stamps_are_no_quaternion():
    log = recording(
        *(
            channel(f"/imu:orientation.{axis}", T[:-1] if axis == "w" else T, lambda t: 0 * t)
            for axis in "xyzw"
        )
    )
    with pytest.raises(AlignmentError, match="do not share their stamps"):
        angle(log, "phi", "roll")


def test_a_quaternion_is_in_radians():
    log = log_of(0.1 * np.sin(T), 0 * T, 0 * T)
    with pytest.raises(AlignmentError, match=r"the log states 'rad' .* the pipeline 'deg'"):
        angle(log, "phi", "roll", unit="deg")
    np.testing.assert_allclose(angle(log, "phi", "roll", unit="rad"), 0.1 * np.sin(T), atol=1e-9)


def test_gain_and_offset_come_before_the_unit_and_the_side():
    share = channel("servo:deflection", T, np.sin(T / 5))
    source = SignalSource("delta_order", "servo:deflection", "deg", "port", gain=35.0, offset=2.0)
    found = align("t", "fit", [recording(share)], [source], 0.5).signals["delta_order"]
    np.testing.assert_allclose(found, -np.radians(35 * np.sin(T / 5) + 2), atol=1e-12)
