"""Tables as spreadsheets, programs and people write them, read without a template."""

import io

import numpy as np
import pandas as pd
import pytest
from openpyxl import Workbook

from trialid.errors import LogError
from trialid.ingest import LogFile, files_of, read

START = 1744373300_000_000_000
"""2025-04-11 12:08:20 UTC."""


def log(tmp_path, text, name="log.csv"):
    path = tmp_path / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def stamps(path, channel="u"):
    return read(path).channels[channel].t.tolist()


@pytest.mark.parametrize(
    ("head", "first", "second", "ns"),
    [
        ("time_s", "0.5", "1.5", 500_000_000),
        ("t_s", "0.5", "1.5", 500_000_000),
        ("elapsed", "0.5", "1.5", 500_000_000),
        ("time_ms", "500", "1500", 500_000_000),
        ("elapsed_ms", "500", "1500", 500_000_000),
        ("time_utc", "2025-04-11T12:08:20Z", "2025-04-11T12:08:21Z", START),
        ("utc", "2025-04-11 12:08:20", "2025-04-11 12:08:21", START),
        ("datetime", "2025-04-11 12:08:20.0", "2025-04-11 12:08:21", START),
        ("DateTime (UTC)", "2025-04-11 12:08:20", "2025-04-11 12:08:21", START),
        ("Time", "11.04.2025 12:08:20", "11.04.2025 12:08:21", START),
        ("Time", "11-Apr-2025 12:08:20", "11-Apr-2025 12:08:21", START),
        ("Time", "4/11/2025 12:08:20 PM", "4/13/2025 12:08:20 PM", START),
        ("", "2025-04-11_12:08:20:000000", "2025-04-11_12:08:20:500000", START),
        ("Uhrzeit", "12:08:20,5", "12:08:21,5", 43_700_500_000_000),
        ("Time", "12:08:20:500", "12:08:21:500", 43_700_500_000_000),
        ("Time", "0.5 sec", "1.5 sec", 500_000_000),
        ("time", "0 days 00:00:00.500000", "0 days 00:00:01.500000", 500_000_000),
        ("time", "00:00.5", "00:01.5", 500_000_000),
        ("time", "20250411T120820Z", "20250411T120821Z", START),
        ("Timestamp", "11 April 2025 12:08:20", "11 April 2025 12:08:21", START),
        ("Timestamp", "Apr 11, 2025 12:08:20", "Apr 11, 2025 12:08:21", START),
        ("Timestamp", "Fri Apr 11 12:08:20 2025", "Fri Apr 11 12:08:21 2025", START),
    ],
)
def test_time_columns_as_they_are_called_and_written(tmp_path, head, first, second, ns):
    path = log(tmp_path, f"{head};u\n{first};1\n{second};2\n")
    found = stamps(path)
    assert found[0] == ns
    assert found[1] > found[0]
    assert list(read(path).channels) == ["u"]


@pytest.mark.parametrize("cell", ["01:30", "3 kn", "Foo 11, 2025 12:08:20", "20250411120820"])
def test_what_may_be_no_time_or_two_is_refused(tmp_path, cell):
    with pytest.raises(LogError, match="no time"):
        read(log(tmp_path, f"time;u\n{cell};1\n{cell};2\n"))


def test_nine_digits_of_a_second_are_kept(tmp_path):
    text = "time,u\n2025/04/11 12:08:20.316091061,1\n2025/04/11 12:08:20.416091062,2\n"
    assert stamps(log(tmp_path, text)) == [START + 316091061, START + 416091062]


@pytest.mark.parametrize(("first", "step"), [(0, 1000), (0, 20), (123_456_789, 1_000_000)])
def test_whole_numbers_that_may_be_milliseconds_are_asked_for(tmp_path, first, step):
    """Taken for seconds a run of seven minutes was one of five days."""
    rows = "".join(f"{first + k * step},{k}\n" for k in range(5))
    with pytest.raises(LogError, match=rf"step by {step} may be seconds, milliseconds"):
        read(log(tmp_path, f"timestamp,u\n{rows}"))
    assert len(stamps(log(tmp_path, f"timestamp[ms],u\n{rows}"))) == 5


def test_whole_seconds_are_seconds(tmp_path):
    for first, step in ((0, 1), (0, 5), (1_650_000_000, 60)):
        rows = "".join(f"{first + k * step},{k}\n" for k in range(5))
        found = stamps(log(tmp_path, f"timestamp,u\n{rows}"))
        assert np.diff(found).tolist() == [step * 10**9] * 4


def test_a_time_that_stands_still_is_no_clock(tmp_path):
    """A date whose time of day stands in another column is the same in every row."""
    rows = "".join(f"2025-04-11 00:00:00,{y}\n" for y in range(5))
    with pytest.raises(LogError, match="time stands still: time tells one time in all 5 rows"):
        read(log(tmp_path, f"time,u\n{rows}"))


def test_dates_with_slashes_are_read_where_a_day_above_12_tells_the_order(tmp_path):
    sure = log(tmp_path, "time,u\n03/12/2026 09:00:00,1\n03/13/2026 09:00:00,2\n")
    assert np.diff(stamps(sure)).tolist() == [86_400 * 10**9]
    unsure = log(tmp_path, "time,u\n03.12.26 09:00:00,1\n03.12.26 09:00:01,2\n")
    with pytest.raises(LogError, match="one way only"):
        read(unsure)
    for date, later in (("03/12/2026", "04/12/2026"), ("03-12-2026", "04-12-2026")):
        rows = f"time,u\n{date} 23:59:59,1\n{later} 00:00:00,2\n"
        with pytest.raises(LogError, match=f"'{date}' may be day 3 of month 12 or day 12 of"):
            read(log(tmp_path, rows))


def test_a_date_that_may_be_two_is_left_out_where_all_is_of_one_day(tmp_path):
    """How the day is written matters to no trial; a log of the first twelve days was refused."""
    for date in ("03/12/2026", "03-12-2026"):
        for rows in (
            "time,u\n{0} 01:00:00 PM,1\n{0} 01:00:01 PM,2\n",
            "time,u\n{0} 13:00:00,1\n{0} 13:00:01,2\n",
            "date,time,u\n{0},13:00:00,1\n{0},13:00:01,2\n",
        ):
            path = log(tmp_path, rows.format(date))
            assert list(stamps(path)) == [13 * 3600 * 10**9, (13 * 3600 + 1) * 10**9]
            found = read(path)
            assert "time of day without a date" in found.channels["u"].clock
            assert f"'{date}' may be day 3 of month 12 or day 12 of month 3: read without" in str(
                found.remarks
            )


def test_a_date_that_is_the_same_in_either_order_is_read(tmp_path):
    one = stamps(log(tmp_path, "time,u\n03/03/2026 09:00:00,1\n03/03/2026 09:00:01,2\n"))
    other = stamps(log(tmp_path, "time,u\n2026-03-03 09:00:00,1\n2026-03-03 09:00:01,2\n"))
    assert list(one) == list(other)


def test_what_pandas_writes_by_default(tmp_path):
    frame = pd.DataFrame({"time": [0.0, 0.1, 0.2], "rudder": [1.0, 2.0, 3.0]})
    path = tmp_path / "log.csv"
    frame.to_csv(path)
    recording = read(path)
    assert list(recording.channels) == ["rudder"]
    assert recording.remarks == ("the first column only numbers the rows, left out",)
    pd.read_csv(path).to_csv(path, index=False)  # read and written once more: Unnamed: 0
    assert list(read(path).channels) == ["rudder"]
    frame.index = pd.date_range("2025-04-11 12:08:20", periods=3, freq="100ms")
    frame.drop(columns="time").to_csv(path)
    assert stamps(path, "rudder") == [START, START + 100_000_000, START + 200_000_000]


def test_a_row_label_that_is_no_time_is_not_taken_for_one(tmp_path):
    with pytest.raises(LogError, match="no time column among"):
        read(log(tmp_path, ",u\n0,1\n1,2\n"))
    recording = read(log(tmp_path, ",t,u\n7.5,0,1\n3.5,1,2\n"))
    assert recording.channels["column 1"].y.tolist() == [7.5, 3.5]


def test_a_name_may_begin_with_a_sign_or_a_count(tmp_path):
    recording = read(log(tmp_path, "time,-rudder,#gyro,1_rpm\n0,1,2,3\n1,2,3,4\n"))
    assert list(recording.channels) == ["-rudder", "#gyro", "1_rpm"]
    for values in ("-1.5", "12 kn", "2026-04-11", "3"):  # a row of values names nothing
        with pytest.raises(LogError, match="none of the formats"):
            read(log(tmp_path, f"1,{values},7 deg\n2,{values},8 deg\n"))


def test_two_columns_that_tell_the_same_time_are_one_clock(tmp_path):
    rows = [(f"2025-04-11 12:08:2{k}", f"{3.0 + k}", k) for k in range(5)]
    text = "time_utc,t_s,u\n" + "".join(f"{a},{b},{c}\n" for a, b, c in rows)
    recording = read(log(tmp_path, text))
    assert recording.channels["u"].t[0] == START
    assert recording.remarks == ("t_s tell the same time and are left out",)
    text = "time_utc,t_s,u\n" + "".join(f"{a},{10 * c},{c}\n" for a, _, c in rows)
    with pytest.raises(LogError, match="several time columns among time_utc, t_s, u"):
        read(log(tmp_path, text))


GERMAN = (
    "Schiff: MS Test   Versuch: Z-Manöver;;;\n;;;\n"
    "Datum;Uhrzeit;Ruderlage [°];Fahrt [kn]\n"
    "11.04.2025;12:08:20;-0,1;11,10\n11.04.2025;12:08:21;0,2;11,12\n"
)


def test_titles_date_and_time_apart_and_decimal_commas(tmp_path):
    recording = read(log(tmp_path, GERMAN.encode("cp1252")))
    rudder = recording.channels["Ruderlage"]
    assert (rudder.unit, rudder.y.tolist()) == ("°", [-0.1, 0.2])
    assert rudder.t.tolist() == [START, START + 10**9]


def test_two_lines_that_may_both_be_the_header_are_left_to_a_template(tmp_path):
    with pytest.raises(LogError, match="template"):
        read(log(tmp_path, "time,rudder\nlog,feedback\n0,1\n1,2\n"))


def sheet(path, rows):
    book = Workbook()
    for row in rows:
        book.active.append(row)
    book.save(path)
    return path


def test_a_sheet_with_titles_and_numbers_as_texts_with_commas(tmp_path):
    rows = [line.split(";") for line in GERMAN.splitlines()]
    recording = read(sheet(tmp_path / "log.xlsx", rows))
    assert recording.channels["Ruderlage"].y.tolist() == [-0.1, 0.2]
    assert recording.channels["Fahrt"].t.tolist() == [START, START + 10**9]
    with pytest.raises(LogError, match="may be the decimal mark or part the thousands"):
        read(sheet(tmp_path / "log.xlsx", [*rows, ["11.04.2025", "12:08:22", "1.234", "2,5"]]))


def test_trailing_rows_and_columns_of_separators(tmp_path):
    for text in (
        "t,u,v\n0,1,2\n1,3,4\n,,\n,,\n,,\n",
        "t,u,v\n0,1,2\n,,\n,,\n1,3,4\n,,\n",
    ):
        recording = read(log(tmp_path, text))
        assert recording.channels["v"].y.tolist() == [2.0, 4.0]
        assert recording.remarks == ("3 rows without any value, left out",)
    for text in ("t,u,,\n0,1,,\n1,3,,\n", "t,u\n0,1,\n1,3,\n"):
        recording = read(log(tmp_path, text))
        assert {name: c.y.tolist() for name, c in recording.channels.items()} == {"u": [1.0, 3.0]}
    with pytest.raises(LogError, match="line 2: 3 fields where the header has 2"):
        read(log(tmp_path, "t,u\n0,1,\n1,3,4\n"))


@pytest.mark.parametrize(
    "note", ["Wind 5 kn, sea state 2\n", "calm\n", "Trial 1: good, calm\nTrial 2: rain, wind\n"]
)
def test_a_note_in_a_folder_of_logs_is_no_log(tmp_path, note):
    log(tmp_path, note, "notes.txt")
    path = log(tmp_path, "t,u\n0,1\n1,2\n")
    assert files_of(LogFile(tmp_path)) == (path,)


def test_a_table_as_text_is_the_same_as_one_in_memory(tmp_path):
    text = "t,u\n" + "".join(f"{k},{k / 7}\n" for k in range(50)) + ",\n" * 5
    frame = pd.read_csv(io.StringIO(text)).dropna()
    np.testing.assert_array_equal(read(log(tmp_path, text)).channels["u"].y, frame["u"])


def test_a_row_of_units_may_say_how_the_time_is_written(tmp_path):
    """Below titles, as a spreadsheet of a trial has it; the header had no row of data under it."""
    rows = "Sea trial,\nDate:,14.05.2026\nTime,Heading\nhh:mm:ss,deg\n09:55:00,1.5\n09:55:01,2.5\n"
    heading = read(log(tmp_path, rows)).channels["Heading"]
    assert (heading.unit, heading.y.tolist()) == ("deg", [1.5, 2.5])
    assert np.diff(heading.t).tolist() == [10**9]
