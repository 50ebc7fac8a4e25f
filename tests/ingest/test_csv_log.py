from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sample_writers import write_logs

from trialid.errors import LogError
from trialid.ingest import read

REAL = Path(__file__).parents[3] / "shared/data/kvlcc2_roll_decay/model_test_21337.csv"


def log(tmp_path, content):
    path = tmp_path / "log.txt"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def ns(*seconds):
    return [round(s * 1_000_000_000) for s in seconds]


@pytest.mark.parametrize(
    ("separator", "decimal"), [(",", "."), (";", ","), (";", "."), ("\t", ",")]
)
def test_round_trip(tmp_path, separator, decimal):
    rng = np.random.default_rng(5)
    t = np.arange(300) * 0.1
    columns = {"delta[deg]": rng.normal(size=300), "r[deg/s]": rng.normal(size=300) * 1e-9}
    columns["r[deg/s]"][4] = np.nan
    write_logs.write_csv(tmp_path / "log", t, columns, separator, decimal)
    recording = read(tmp_path / "log")
    assert recording.adapter == "csv"
    assert recording.remarks == ()
    for head, y in columns.items():
        channel = recording.channels[head.partition("[")[0]]
        assert f"{channel.name}[{channel.unit}]" == head
        assert channel.clock == "column t"
        np.testing.assert_array_equal(channel.y, y)
        np.testing.assert_array_equal(channel.t, np.rint(t * 1e9))


@settings(max_examples=50, deadline=None, derandomize=True)
@given(st.lists(st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=20))
def test_every_number_survives(tmp_path_factory, values):
    path = tmp_path_factory.mktemp("csv") / "log"
    y = np.array(values)
    write_logs.write_csv(path, np.arange(len(y)) * 1.0, {"u": y}, ";", ",")
    np.testing.assert_array_equal(read(path).channels["u"].y, y)


@pytest.mark.parametrize(
    ("head", "name", "unit"),
    [
        ("roll", "roll", None),
        ("roll[deg]", "roll", "deg"),
        ("roll [deg/s]", "roll", "deg/s"),
        ("roll rate (deg/s)", "roll rate", "deg/s"),
        ("roll []", "roll", None),
        ('"roll"', "roll", None),
    ],
)
def test_names_and_units(tmp_path, head, name, unit):
    (channel,) = read(log(tmp_path, f"time [s],{head}\n0,1\n1,2\n")).channels.values()
    assert (channel.name, channel.unit) == (name, unit)


@pytest.mark.parametrize(
    ("head", "texts", "expected"),
    [
        ("t[s]", ("0.5", "1"), ns(0.5, 1)),
        ("Time", ("0.5", "1"), ns(0.5, 1)),
        ("timestamp", ("1700000000.25", "1700000001"), ns(1700000000.25, 1700000001)),
        ("t[ms]", ("500", "1000"), ns(0.5, 1)),
        ("time (min)", ("1", "2"), ns(60, 120)),
        ("time", ("2023-11-14T22:13:20Z", "2023-11-14 23:13:20.5+01:00"), ns(17e8, 17e8 + 0.5)),
        (
            "time",
            ("2023-11-14T22:13:20", "2023-11-14T22:13:21.000001"),
            ns(17e8, 1700000001.000001),
        ),
    ],
)
def test_time_columns(tmp_path, head, texts, expected):
    text = "".join(f"{stamp},1\n" for stamp in texts)
    channel = read(log(tmp_path, f"{head},u\n{text}")).channels["u"]
    np.testing.assert_allclose(channel.t, expected, rtol=0, atol=256)
    assert channel.t.dtype == np.int64


def test_a_spreadsheet_in_the_windows_code_page(tmp_path):
    channel = read(log(tmp_path, "t;Krängung [°]\r\n0;1,5\r\n1;-2,5\r\n".encode("cp1252")))
    (roll,) = channel.channels.values()
    assert (roll.name, roll.unit, roll.y.tolist()) == ("Krängung", "°", [1.5, -2.5])


def test_empty_fields_are_not_available_and_text_columns_are_left_out(tmp_path):
    recording = read(log(tmp_path, "t,u,mode\n0,1,AUTO\n1,,AUTO\n2,NaN,HAND\n3,n/a,HAND\n\n"))
    np.testing.assert_array_equal(recording.channels["u"].y, [1, np.nan, np.nan, np.nan])
    assert recording.remarks == ("column 'mode' holds text, left out",)


def test_only_wanted_columns_are_read(tmp_path):
    recording = read(log(tmp_path, "t,u,v\n0,1,oops\n1,2,3\n"), ["u"])
    assert list(recording.channels) == ["u"]


def test_a_last_line_cut_short_is_left_out_and_said(tmp_path):
    recording = read(log(tmp_path, "t,u,v\n0,1,2\n1,2,3\n2,"))
    assert recording.channels["u"].y.tolist() == [1.0, 2.0]
    assert recording.remarks == ("line 4, the last, is cut short and left out",)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,u\n0,1\n1,2,3\n", "line 3: 3 fields where the header has 2 (t, u); mend or delete"),
        ("t,u\n0,1\n1\n2,3\n", "otherwise, draft a template (trialid inspect LOG --template FILE)"),
        ("t,u\n0,1\n1,abc\n", "line 3, column 'u': 'abc' where a number was expected"),
        ("t,u\n0,1.5\n1,1.234,5\n", "line 3: 3 fields"),
        ("x,u\n0,1\n", "no time column among x, u; name exactly one of them 't' or 'time'"),
        (
            ",".join(f"c{i}" for i in range(80)) + "\n" + ",".join("1" * 80) + "\n",
            "c29 and 50 more; name exactly one",
        ),
        ("t,time,u\n0,1,2\n", "several time columns among t, time, u"),
        ("t,u,u\n0,1,2\n", "column 'u' stands twice in the header; rename one"),
        ("t,u\n", "a header but no rows"),
        ("t,u\n12:30,1\n", "line 2, column 't': '12:30' is no time; write seconds or ISO"),
        ("t,u\n0,1\n,2\n", "line 3, column 't': '' is no time in seconds"),
        (
            "timestamp,u\n170000000000,1\n",
            "line 2, column 'timestamp': '170000000000' is no time",
        ),
        (
            "t,u\n2023-11-14T22:13:20Z,1\n2023-13-14,2\n",
            "line 3, column 't': '2023-13-14' is no ISO",
        ),
        ("t[furlong],u\n0,1\n", "header of the time column: unit 'furlong' cannot become 's'"),
    ],
)
def test_errors_name_file_line_and_column_in_one_line(tmp_path, text, message):
    path = log(tmp_path, text)
    with pytest.raises(LogError) as caught:
        read(path)
    assert str(caught.value).startswith(str(path))
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.real_data
@pytest.mark.skipif(not REAL.exists(), reason="real records are not here")
def test_a_real_roll_decay():
    recording = read(REAL)
    assert list(recording.channels) == ["x", "y", "z", "phi", "theta", "psi"]
    phi = recording.channels["phi"]
    assert len(phi.t) == 9166
    assert phi.unit is None
    assert np.median(np.diff(phi.t)) / 1e9 == pytest.approx(0.01, rel=0.01)
    assert np.abs(phi.y).max() < 0.5


def test_torn_rows_and_a_repeated_header_cost_only_themselves(tmp_path):
    lines = ["t,u", *(f"{k},{k % 7}" for k in range(400))]
    lines[100] += ",9"
    lines[200] = "199"
    lines.insert(300, "t,u")
    recording = read(log(tmp_path, "\n".join(lines) + "\n"))
    assert len(recording.channels["u"].y) == 398
    assert recording.remarks == (
        "left out: the header, repeated (first line 301, 1 in all)",
        "left out: rows that have not the header's 2 fields (first line 101, 2 in all)",
    )


def test_more_torn_rows_than_a_logger_leaves_are_another_layout(tmp_path):
    lines = ["t,u", *(f"{k},{k % 7}" + ",9" * (k % 50 == 3) for k in range(400))]
    with pytest.raises(LogError, match="line 5: 3 fields where the header has 2"):
        read(log(tmp_path, "\n".join(lines) + "\n"))


@pytest.mark.parametrize("word", ["-", "---", "#N/A", "None"])
def test_a_word_for_no_value_is_a_value_that_lacks(tmp_path, word):
    channels = read(log(tmp_path, f"t,u,v\n0,1,5\n1,{word},6\n2,3,7\n")).channels
    assert channels["v"].y.tolist() == [5, 6, 7]
    assert channels["u"].y == pytest.approx([1, np.nan, 3], nan_ok=True)
