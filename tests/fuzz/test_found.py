"""What fuzzing found, each by the smallest thing that shows it."""

from pathlib import Path

import numpy as np
import pytest

from trialid.alignment import checks, clocks, signs, twins
from trialid.alignment.clocks import Series
from trialid.errors import AlignmentError, LogError
from trialid.ingest import template
from trialid.quantities import SIGNALS
from trialid.recording import Channel, Recording
from trialid.survey import channels, sketch

T = np.arange(200, dtype=np.int64) * 100_000_000
Y = np.sin(T / 1e9)
WILD = np.append(T, 10**18)
"""The last stamp of a damaged log is thirty years late."""


def series(t, y):
    return Series(SIGNALS["phi"], t, y, "")


def test_a_channel_without_a_value_beside_one_with_values():
    pair = {"a": series(T, Y), "b": series(T, np.full(len(T), np.nan))}
    assert twins.disagreements(pair) == ()
    assert twins.disagreements({"a": pair["b"], "b": pair["a"]}) == ()


def test_wild_stamps_make_no_clock_of_years():
    wild = series(WILD, np.append(Y, 0.0))
    assert checks.together({"phi": wild}) is None
    assert twins.disagreements({"a": wild, "b": wild}) == ()
    one = sketch.sketch(WILD, np.append(Y, 0.0))
    assert sketch.together(one, one) is None
    assert checks.together({"phi": series(T, Y)}).samples >= len(T) - 1


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
    assert np.isfinite(checks.together({"phi": series(T, y)}).signals["phi"]).all()


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
