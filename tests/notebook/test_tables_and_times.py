"""A table of a user's becomes a trial with its times right, or is refused in one line."""

from typing import Any

import numpy as np
import pandas as pd
import pytest

from trialid.errors import AlignmentError
from trialid.trial import Trial

STEP = 0.2
SECONDS = 5.0 + STEP * np.arange(60)
OSLO = pd.Timestamp("2026-03-01T12:00", tz="Europe/Oslo")
DATES = [OSLO + pd.Timedelta(seconds=s) for s in SECONDS]
RATE = {"r": np.sin(SECONDS)}
UNITS = {"r": "deg/s"}


def made(t: Any, units: dict | None = None, **more: Any) -> Trial:
    frame = pd.DataFrame({"t": t, **RATE})
    return Trial.from_frame("mine", frame, units=units or UNITS, **more)


@pytest.mark.parametrize(
    "t",
    [
        SECONDS,
        [f"{s}" for s in SECONDS],
        pd.to_timedelta(SECONDS, unit="s"),
        DATES,
        [day.tz_localize(None) for day in DATES],
        [day.tz_convert("UTC") if i % 2 else day for i, day in enumerate(DATES)],
        [day.isoformat() for day in DATES],
        pd.array(SECONDS, dtype="Float64"),
    ],
    ids=["seconds", "texts", "spans", "zone", "no zone", "two zones", "iso", "nullable"],
)
def test_times_of_every_form_are_seconds(t: Any) -> None:
    assert made(t).period == pytest.approx(STEP)
    indexed = pd.DataFrame(RATE, index=pd.Index(t, name="t"))
    assert Trial.from_frame("mine", indexed, units=UNITS).period == pytest.approx(STEP)
    assert Trial.from_arrays("mine", t, RATE, units=UNITS).period == pytest.approx(STEP)


@pytest.mark.parametrize(("unit", "size"), [("ms", 1e3), ("us", 1e6), ("ns", 1e9), ("min", 1 / 60)])
def test_a_unit_of_the_times_is_heeded(unit: str, size: float) -> None:
    found = made(size * SECONDS, {**UNITS, "t": unit})
    assert found.period == pytest.approx(STEP)
    assert [*found.signals] == ["r"]


@pytest.mark.parametrize("size", [1e3, 1e6, 1e9])
def test_counts_of_a_finer_unit_are_no_seconds(size: float) -> None:
    with pytest.raises(AlignmentError, match="too slow for a manoeuvre; state its unit, such as u"):
        made((size * SECONDS).round().astype("int64"))
    assert made(size * SECONDS, {**UNITS, "t": "s"}).period == pytest.approx(size * STEP)


def test_row_numbers_are_no_times() -> None:
    frame = pd.DataFrame(RATE)
    for rows in (frame, frame[::2], frame[frame["r"] > -2.0]):
        with pytest.raises(AlignmentError, match="no column 't', and its index only numbers"):
            Trial.from_frame("mine", rows, units=UNITS)
    named = frame.set_axis(pd.Index(np.arange(len(frame)), name="t"))
    assert Trial.from_frame("mine", named, units=UNITS).period == 1.0


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        ({"t": SECONDS.astype(str).astype(object) + "!"}, "t begins with '5.0!'; expected seconds"),
        ({"t": DATES, "units": {**UNITS, "t": "ms"}}, "t holds dates or spans of time, which need"),
        ({"t": SECONDS + 0j}, "t: expected numbers, got complex128"),
        ({"use": "foo"}, "use = 'foo'; expected 'fit', or 'check'"),
        ({"positive": {"xx": "port"}}, "positive names 'xx', which is no signal"),
        ({"positive": {"r": "left"}}, "expected 'port' or 'starboard'"),
        ({"positive": {"u": "port"}}, "'u' has no port or starboard"),
        ({"units": {"t": "s"}}, "no column has a unit; name those that are signals"),
    ],
)
def test_a_table_that_says_too_little_is_one_line(asked: dict, said: str) -> None:
    with pytest.raises(AlignmentError, match=said):
        made(**{"t": SECONDS, **asked})


@pytest.mark.parametrize("table", [pd.Series(RATE["r"]), RATE, [[1.0]], None])
def test_what_is_no_table_is_one_line(table: Any) -> None:
    with pytest.raises(AlignmentError, match=r"^expected a pandas DataFrame, got a "):
        Trial.from_frame("mine", table, units=UNITS)


def test_a_column_that_holds_no_numbers_says_which_value() -> None:
    frame = pd.DataFrame({"t": SECONDS, "r": [f"{r:.3f}".replace(".", ",") for r in RATE["r"]]})
    with pytest.raises(AlignmentError, match=r"r: '-0,959' \(row 0\) is no number; of decimal com"):
        Trial.from_frame("mine", frame, units=UNITS)
    twice = pd.concat(
        [made_frame := pd.DataFrame({"t": SECONDS, **RATE}), made_frame[["r"]]], axis=1
    )
    with pytest.raises(AlignmentError, match="the table has 2 columns 'r'"):
        Trial.from_frame("mine", twice, units=UNITS)
    with pytest.raises(AlignmentError, match="units names 'rr', which is no signal"):
        Trial.from_arrays("mine", SECONDS, RATE, units={**UNITS, "rr": "deg"})
    with pytest.raises(AlignmentError, match="'t' is the time"):
        Trial.from_arrays("mine", SECONDS, {"t": SECONDS}, units={"t": "s"})


def test_a_value_that_is_missing_is_a_gap_whatever_stands_for_it() -> None:
    column = pd.array([None, *RATE["r"][1:]], dtype="Float64")
    found = Trial.from_frame("mine", pd.DataFrame({"t": SECONDS, "r": column}), units=UNITS)
    assert found.valid["r"].tolist() == [False] + [True] * 59


@pytest.mark.parametrize(
    ("given", "unit", "said"),
    [
        (
            np.linspace(-20.0, 20.0, 60),
            "rad",
            "reaches 1146 deg in 'rad'; no rudder is turned half",
        ),
        (SECONDS > 6.0, "rad", "expected numbers, got bool"),
    ],
)
def test_a_rudder_that_is_none_is_refused(given: Any, unit: str, said: str) -> None:
    units, side = {"delta": unit}, {"delta": "starboard"}
    with pytest.raises(AlignmentError, match=said):
        Trial.from_arrays("mine", SECONDS, {"delta": given}, units=units, positive=side)


def test_times_that_run_backwards_are_said_to() -> None:
    with pytest.raises(AlignmentError, match=r"t runs backwards, from 16\.8 to 5 s"):
        made(SECONDS[::-1])


def test_a_heading_begins_again_after_a_turn_in_its_own_unit() -> None:
    """In degrees it jumps by 360: as radians by 57 turns."""
    heading = {"psi": (10.0 * SECONDS + 300.0) % 360.0}
    with pytest.raises(
        AlignmentError, match="psi: jumps by 358 rad as 'rad', and a heading begins"
    ):
        Trial.from_arrays("mine", SECONDS, heading, units={"psi": "rad"})
    for unit, factor in (("deg", 1.0), ("rad", np.pi / 180.0)):
        scaled = {"psi": factor * heading["psi"]}
        found = Trial.from_arrays("mine", SECONDS, scaled, units={"psi": unit})
        assert np.ptp(found.signals["psi"]) == pytest.approx(np.deg2rad(358.0))


def test_a_column_of_a_signal_without_a_unit_is_told_and_another_is_not() -> None:
    frame = pd.DataFrame({"t": SECONDS, **RATE, "psi": SECONDS, "note": "calm"})
    assert Trial.from_frame("mine", frame, units=UNITS).remarks == (
        "left out, as units states none of them: psi",
    )
    assert Trial.from_frame("mine", frame.drop(columns="psi"), units=UNITS).remarks == ()


def test_a_column_of_two_dimensions_says_which_it_should_have() -> None:
    with pytest.raises(AlignmentError, match=r"values of shape \(60, 1\) for 60 times; give one"):
        Trial.from_arrays("mine", SECONDS, {"r": RATE["r"][:, None]}, units=UNITS)
