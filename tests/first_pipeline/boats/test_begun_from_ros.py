"""Topics of ROS in a table: no column states a unit, and angles count from the east to port."""

import numpy as np
import pytest

from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import starter

HEADER = (
    "time,/cmd_left.data,/cmd_right.data,/imu/data.angular_velocity.z,/imu/data.orientation.yaw,"
    "{command}/gps/vel.twist.linear.x,/gps/vel.twist.linear.y"
)


@pytest.fixture(scope="module")
def begun(tmp_path_factory):
    """A boat that turns away from the stronger thruster, her yaw to port from the east."""
    folder, rng = tmp_path_factory.mktemp("ros"), np.random.default_rng(4)
    dt, t = 0.1, np.arange(0.0, 240.0, 0.1)
    logs = []
    for k in range(3):
        turn = np.repeat(rng.uniform(-300.0, 300.0, 24), 100)
        r, lagged = np.zeros(len(t)), 0.0  # to starboard
        for i in range(1, len(t)):
            lagged += dt * (0.0008 * turn[i] - lagged) / 1.5
            r[i] = lagged
        psi = k + np.cumsum(r) * dt
        u = 1.2 + 0.1 * rng.standard_normal(len(t))
        commanded = np.repeat(rng.uniform(0.0, 1.0, 24), 100)
        columns = [t, 500 + turn, 500 - turn, -r, np.pi / 2 - psi]
        columns += [commanded, 0.5 * commanded, u * np.sin(psi), u * np.cos(psi)]
        columns[4] = (columns[4] + np.pi) % (2.0 * np.pi) - np.pi
        path = folder / f"run{k}.csv"
        header = HEADER.format(command="/cmd_vel.twist.linear.x,/cmd_vel.twist.linear.y,")
        np.savetxt(path, np.column_stack(columns), "%.5f", ",", header=header, comments="")
        logs.append(path)
    given = Given(length=2.0, beam=1.0, displacement=62.0)
    return starter([inspect_log(one) for one in logs], folder / "begun.toml", None, given)


def test_the_velocity_is_her_speed_and_no_command_is(begun):
    one = next(s for s in begun.trials[0].signals if s.quantity == "u")
    assert (one.source.name, one.source.angle, one.unit) == (
        "/gps/vel.twist.linear",
        "speed",
        "m/s",
    )
    text = next(iter(t for p, t in begun.files.items() if p.name == "begun.toml"))
    assert '{ channel = "/gps/vel.twist.linear", as = "speed", unit = "m/s" }' in text
    assert "FILL IN" not in one.why


def test_rate_and_yaw_of_one_message_count_alike_and_no_thruster_is_in_doubt(begun):
    signals = {s.quantity: s for s in begun.trials[0].signals}
    assert signals["r"].positive == signals["psi"].positive == "port"
    drives = [s for name, s in signals.items() if name.startswith("thruster")]
    assert len(drives) == 2
    assert all(s.of_side.rests_on("measured") for s in drives)


def test_her_yaw_is_turned_to_the_north(begun):
    text = next(iter(t for p, t in begun.files.items() if p.name == "begun.toml"))
    assert 'positive = "port", offset = -1.5708' in text
    assert "CAREFUL: counted from the east, as ROS has it" in text
