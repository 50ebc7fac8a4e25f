"""What fuzzing found, each by the smallest thing that shows it."""

import struct
from pathlib import Path

import numpy as np
import pytest
import seed_logs  # it finds the writers
from resealed import SEALS

from trialid.alignment import LogClock, SignalSource, clocks
from trialid.alignment.agreement import checks, duplicate_channels, signs
from trialid.alignment.clocks import Series
from trialid.alignment.log_clock import on_one_clock
from trialid.errors import AlignmentError, LogError
from trialid.ingest import read
from trialid.ingest.tables.templates import template
from trialid.inspection import channels, sketch
from trialid.names.quantities import SIGNALS
from trialid.recording import Channel, Recording

T = np.arange(200, dtype=np.int64) * 100_000_000
Y = np.sin(T / 1e9)
WILD = np.append(T, 10**18)
"""The last stamp of a damaged log is thirty years late."""


def series(t, y):
    return Series(SIGNALS["phi"], t, y, "")


def test_a_channel_without_a_value_beside_one_with_values():
    pair = {"a": series(T, Y), "b": series(T, np.full(len(T), np.nan))}
    assert duplicate_channels.disagreements(pair) == ()
    assert duplicate_channels.disagreements({"a": pair["b"], "b": pair["a"]}) == ()


def test_wild_stamps_make_no_clock_of_years():
    wild = series(WILD, np.append(Y, 0.0))
    assert checks.trial_of_series({"phi": wild}) is None
    assert duplicate_channels.disagreements({"a": wild, "b": wild}) == ()
    one = sketch.sketch(WILD, np.append(Y, 0.0))
    assert sketch.on_one_clock(one, one) is None
    assert checks.trial_of_series({"phi": series(T, Y)}).samples >= len(T) - 1


def test_a_rudder_that_is_valid_for_three_samples():
    valid = np.zeros(len(T), np.bool_)
    valid[10:13] = True
    strength, parts = signs.agreement(Y, Y, valid)
    assert np.isfinite(strength)
    assert len(parts) <= 2


def test_a_channel_out_of_order_without_a_value():
    t = T[::-1].copy()
    held = {"a": Channel("a", t, np.full(len(t), np.nan)), "b": Channel("b", t, Y)}
    a, b = channels.of_recording(Recording(Path("log"), "csv", "", held))
    assert (a.missing, b.missing) == (1.0, 0.0)


def test_messages_and_remarks_stay_on_one_line_and_steer_nothing():
    held = Recording(Path("log"), "csv", "", {}, ("bus can\x10\x1b[31m", "fine"))
    assert held.remarks == ("bus can\\x10\\x1b[31m", "fine")
    assert str(LogError("a column\x1b[31m\n  of the log")) == "a column\\x1b[31m of the log"


def test_a_step_next_to_nothing_beside_any_other():
    y = np.where(np.arange(len(T)) % 2, 1e-310, 0.0)
    y[100:] = Y[100:]
    assert np.isfinite(checks.trial_of_series({"phi": series(T, y)}).signals["phi"]).all()


def test_a_quaternion_of_numbers_past_all():
    y = np.where(np.arange(len(T)) < 20, 1e300, 0.5)
    held = {f"/imu.{axis}": Channel(f"/imu.{axis}", T, y) for axis in "xyzw"}
    found = list(channels.of_recording(Recording(Path("log"), "mcap", "", held)))
    assert {one.angle for one in found} == {None, "roll", "yaw"}
    nothing = {name: Channel(name, T, np.full(len(T), np.nan)) for name in held}
    assert len(list(channels.of_recording(Recording(Path("log"), "mcap", "", nothing)))) == 4


def test_a_trial_of_years_between_two_stamps():
    wild = series(WILD[-300:], np.append(Y, 0.0))
    with pytest.raises(AlignmentError, match="a stamp is wild"):
        clocks.common([wild], 1000.0, None, "trial 'a'")
    assert clocks.common([wild], 0.2, (0.0, 20.0), "trial 'a'").samples == 101


def test_a_form_of_dates_with_a_code_twice(tmp_path):
    aid = tmp_path / "aid.toml"
    aid.write_text(
        'reviewed = true\nheader = ["t", "u"]\n[time]\ncolumns = ["t"]\nformat = "%d.%m.%d"\n'
    )
    with pytest.raises(LogError, match=r"time\.format: '%d\.%m\.%d' holds a code twice"):
        template.load(aid)


def test_numbers_past_all_in_one_of_two_channels_of_a_quantity():
    wild = np.where(np.arange(len(T)) == 7, 1e200, Y)
    pair = {
        name: Channel(name, T, y, "rad/s", quantity="r") for name, y in {"a": Y, "b": wild}.items()
    }
    chosen = SignalSource("r", "a", "rad/s")
    assert (
        duplicate_channels.compare_duplicates([chosen], [Recording(Path("log"), "mcap", "", pair)])
        == ()
    )


def by_match(y):
    """The clock of a log by a channel of these values and that of another log."""
    t = np.arange(len(y), dtype=np.int64) * 100_000_000
    rough = np.convolve(np.random.default_rng(0).normal(size=len(y)), np.ones(50) / 50, "same")
    logs = {"a": rough + y, "b": rough}
    recordings = [
        Recording(Path(name), "csv", "", {name: Channel(name, t, y)}) for name, y in logs.items()
    ]
    return on_one_clock(recordings, [LogClock(match=("a", "b")), None], "trial", repair=False)


def test_a_clock_by_a_channel_with_numbers_past_all():
    y = np.zeros(2000)
    y[7] = 1e200
    (line,) = by_match(y)[1]
    assert "0.0000 s ahead" in line


def test_a_clock_by_a_channel_without_a_value():
    with pytest.raises(AlignmentError, match="'a' has 0 values, at least 100 are needed"):
        by_match(np.full(2000, np.nan))


def test_a_message_of_blf_too_short_for_its_kind_of_header(tmp_path):
    short = struct.pack("<4sHHLL", b"LOBJ", 40, 2, 48, 86).ljust(48, b"\0")
    (seed,) = (s for s in seed_logs.seed_logs(tmp_path) if s.name == "blf, small containers")
    path = tmp_path / "log"
    path.write_bytes(SEALS["blf"](seed.log, lambda number, c: short + c if not number else c)[0])
    whole, found = tmp_path / "whole", read(path)
    whole.write_bytes(seed.log)
    for name, channel in read(whole).channels.items():
        np.testing.assert_array_equal(found.channels[name].y, channel.y)
