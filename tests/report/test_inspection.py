"""The survey on a terminal: what a person meets first, and what no log can do to it."""

import dataclasses
import json
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console

from trialid.errors import printable
from trialid.inspection import inspect_log
from trialid.inspection.inspected import Inspection
from trialid.report.files.log_data import plain
from trialid.report.terminal.log_contents import inspection

SAMPLES = Path(__file__).parents[2] / "sample_data" / "hidden_effect"


def text(found: Inspection, width=100, everything=False):
    console = Console(width=width)
    with console.capture() as capture:
        for part in inspection(found, everything=everything):
            console.print(part, markup=False, highlight=False)
    return capture.get()


@pytest.fixture(scope="module")
def ros():
    return inspect_log(SAMPLES / "zigzag-20.mcap")


def test_recognised_channels_come_first_with_their_letters(ros):
    lines = text(ros).splitlines()
    delta, *_ = [line for line in lines if "/steering/rudder:data  " in line]
    assert "/steering/rudder:data" in delta
    assert "not stated" in delta
    assert lines.index(delta) < next(i for i, line in enumerate(lines) if line.startswith("other"))
    assert "1199.9 s, 2026-05-28 20:26:40 to 2026-05-28 20:46:39 UTC" in lines[1]


def test_the_side_of_the_rudder_is_offered_with_its_evidence(ros):
    words = " ".join(text(ros).split())
    assert 'positive = "starboard", by its correlation' in words
    assert "(-0.98), if that is positive to port" in words


def test_unlikely_channels_are_folded_unless_all_are_asked_for(ros):
    assert "covariance[8]" not in text(ros)
    assert "other channels: 35" in text(ros)
    assert "/imu:linear_acceleration_covariance[8]" in text(ros, 140, everything=True)


@pytest.mark.parametrize("width", [60, 80, 100, 160])
def test_no_line_is_longer_than_the_terminal(ros, width):
    assert max(len(line) for line in text(ros, width).splitlines()) <= width


def test_hundreds_of_messages_are_counted(tmp_path):
    log = tmp_path / "a.csv"
    log.write_text("t," + ",".join(f"m{i}:a" for i in range(40)) + "\n" + "1" + ",2" * 40 + "\n")
    found = text(inspect_log(log))
    assert "and 28 more messages; --all shows every channel" in found
    assert "m39" not in found


def test_names_steer_neither_terminal_nor_markup(ros):
    rudder = ros.channels["/steering/rudder:data"]
    evil = dataclasses.replace(rudder, name="rudder\x1b]0;x\x07 [/bold][red]", unit="[deg]\x1b[0m")
    other = dataclasses.replace(rudder, name="\x1b[2J:[b]", guess=None)
    said = text(dataclasses.replace(ros, channels={"a": evil, "b": other}, warnings=("\x1b[1m",)))
    assert "\x1b" not in said
    assert "\x07" not in said
    assert "rudder\\x1b]0;x\\x07 [/bold][red]" in said
    assert "\\x1b[2J" in said
    assert "[b]" in said
    assert printable("a\nb\u202e") == "a\\nb\\u202e"


def test_two_sources_are_set_side_by_side(tmp_path):
    t = np.arange(0, 400, 0.5)
    rows = np.column_stack([t, np.sin(0.2 * t), np.sin(0.2 * t) + 0.5])
    log = tmp_path / "a.csv"
    np.savetxt(log, rows, delimiter=",", header="t,rot[deg/s],yaw_rate[deg/s]", comments="")
    words = " ".join(text(inspect_log(log)).split())
    assert "2 sources of yaw rate r: rot 2 Hz, yaw_rate 2 Hz" in words
    assert "yaw_rate against rot: +0.5 deg/s apart" in words


def test_plain_data_is_json_with_null_for_what_is_not_known(ros):
    data = json.loads(json.dumps(plain(ros), allow_nan=False))
    assert data["schema"] == "trialid-survey/1"
    channels = {(c["channel"], c["as"]): c for c in data["channels"]}
    rudder = channels["/steering/rudder:data", None]
    assert (rudder["quantity"], rudder["unit"], rudder["positive"]) == ("delta", None, None)
    assert rudder["rate"] == pytest.approx(5)
    assert channels["/imu:orientation", "roll"]["known"] == "defined by the format"
    assert data["start"].startswith("2026-05-28")
    assert len(data["files"][0]["sha256"]) == 64


def test_values_that_are_nowhere_are_null(tmp_path):
    log = tmp_path / "a.csv"
    log.write_text("t,rudder\n0,\n1,\n")
    (channel,) = json.loads(json.dumps(plain(inspect_log(log)), allow_nan=False))["channels"]
    assert channel["range"] is None
    assert channel["missing"] == 1.0
    assert "not  available" in text(inspect_log(log))


def test_remarks_and_warnings_are_shown_up_to_a_number(ros):
    file = dataclasses.replace(ros.files[0], remarks=tuple(f"lost {i}" for i in range(20)))
    said = text(dataclasses.replace(ros, files=(file,), warnings=("the clock is wild",)))
    assert "- lost 0" in said
    assert "more; --json has them all" in said
    assert "- the clock is wild" in said


def test_angles_are_in_degrees_with_the_unit_of_the_log(tmp_path):
    log = tmp_path / "a.csv"
    log.write_text("t,roll[rad],rot[rad/s],stw[kn]\n0,-0.1,0,9\n1,0.1,0.01745,10\n")
    lines = text(inspect_log(log)).splitlines()
    (place,) = (i for i, line in enumerate(lines) if line.startswith("  roll"))
    assert lines[place].split()[-3:] == ["-5.73", "5.73", "deg"]
    assert lines[place + 1].split() == ["log", "rad"]
    assert any(line.split()[-3:] == ["0", "0.9998", "deg/s"] for line in lines)
    assert any(line.split()[-3:] == ["9", "10", "kn"] for line in lines)
    ranges = {one["channel"]: one["range"] for one in plain(inspect_log(log))["channels"]}
    assert ranges["roll"] == [-0.1, 0.1]  # in the log's own unit


def test_a_short_name_does_not_pad_the_table_to_the_terminal(ros):
    (tight,) = (line for line in text(ros, 160).splitlines() if line.startswith("channel"))
    assert len(tight.rstrip()) < 100


def test_a_long_name_is_broken_after_a_separator(ros):
    rudder = ros.channels["/steering/rudder:data"]
    named = dataclasses.replace(rudder, name="ship/sensors/steering_gear/rudder_angle/main:value")
    said = text(dataclasses.replace(ros, channels={"a": named}), 80)
    assert "  ship/sensors/steering_gear/ " in said
    assert "  rudder_angle/main:value " in said


def test_channels_of_two_clocks_have_a_span_each(ros):
    first, second, *_ = ros.channels.values()
    undated = dataclasses.replace(second, start=2 * 10**9, end=5 * 10**9)
    both = dataclasses.replace(ros, channels={"a": first, "b": undated})
    title = " ".join(text(both, 200).splitlines()[1].split())
    assert "two clocks: 1199.8 s, 2026-05-28 20:26:40 to" in title
    assert title.endswith("; 3.0 s, 2.000 s to 5.000 s")
    assert plain(both)["duration"] == pytest.approx(1200, abs=1)


def test_two_recorders_whose_clocks_differ_are_told_what_to_write(tmp_path):
    t = np.arange(0, 400, 0.2)
    for name, late in (("rot", 0.0), ("gyro_z", 3.0)):
        motion = np.cumsum(np.random.default_rng(2).normal(size=len(t)))
        rows = np.column_stack([t + late, motion - motion.mean()])
        head = f"t,{name}[deg/s]"
        np.savetxt(tmp_path / f"{name}.csv", rows, delimiter=",", header=head, comments="")
    words = " ".join(text(inspect_log(tmp_path)).split())
    assert "rot against gyro_z: 3 s earlier" in words
    assert 'the one that holds gyro_z: clock = { match = ["gyro_z", "rot"] }' in words


def test_units_that_the_log_does_not_state_are_asked_for(ros, tmp_path):
    words = " ".join(text(ros).split())
    assert "no unit is stated for /speed/stw:data, /steering/rudder:data: `unit` in the" in words
    log = tmp_path / "a.csv"
    log.write_text("t,rudder[deg],heading_deg\n0,1,2\n1,2,3\n")
    assert "no unit is stated" not in text(inspect_log(log))


@pytest.mark.parametrize(
    ("zone", "told"), [("Z", "02:00:01 UTC"), ("", "02:00:01 as written, no zone is given")]
)
def test_dates_are_of_utc_only_where_they_say_so(tmp_path, zone, told):
    rows = [f"2026-10-25T02:00:0{i}{zone},{i}" for i in (0, 1)]
    (tmp_path / "log.csv").write_text("\n".join(("time,rudder", *rows)))
    assert told in text(inspect_log(tmp_path / "log.csv"), width=200)
