"""Templates: an export is read exactly or not at all; clocks; drafts that ask before they load."""

import re

import numpy as np
import openpyxl
import pytest
import scipy.io
from test_table_logs import SERIES, forms, refused

from trialid.errors import LogError
from trialid.ingest import Aids, LogFile, draft_template, files_of, read
from trialid.ingest.tables.templates import template
from trialid.ingest.tables.templates.template_guess import guess

START = 1_699_192_800  # 2023-11-05 14:00:00 UTC
PLAIN = """
reviewed = true
header = ["t", "roll"]
time = { columns = ["t"], kind = "seconds" }
"""


def given(tmp_path, content, told, name="log"):
    path, aid = tmp_path / name, tmp_path / "template.toml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    aid.write_text(told, encoding="utf-8")
    return path, Aids(template=aid)


def seconds(path, aids):
    """The one channel's stamps [s], its clock and the remarks."""
    recording = read(path, None, aids)
    (channel,) = recording.channels.values()
    return (channel.t / 1e9).tolist(), channel.clock, recording.remarks


def test_all_that_a_text_export_may_have(tmp_path):
    text = (
        "Messanlage 3\n# Kanal 1: Kreisel\nZeit;Krängung;Krängung;Welle\n;ist;soll;\n"
        "[ms];[°];[°];[1/min]\nx;y;z;-\n# von Hand\n0;1.234,5;-;9999\n\n500;-0,25;2;1'5\n"
    ).replace("1'5", "15") + "Mittel;1;1;1\n"
    told = """
reviewed = true
separator = ";"
decimal = ","
thousands = "."
encoding = "cp1252"
comment = "#"
skip = 1
header_rows = 2
units_row = true
skip_after = 1
missing = ["-", "9999"]
end = "Mittel"
header = ["Zeit", "Krängung ist", "Krängung soll", "Welle"]
[time]
columns = ["Zeit"]
kind = "seconds"
[columns]
"Krängung ist" = { rename = "phi" }
Welle = { unit = "rpm" }
"""
    path, aids = given(tmp_path, text.encode("cp1252"), told)
    channels = read(path, None, aids).channels
    assert {n: (c.unit, c.quantity) for n, c in channels.items()} == {
        "phi": ("°", "phi"), "Krängung soll": ("°", None), "Welle": ("rpm", None),
    }  # fmt: skip
    assert channels["phi"].t.tolist() == [0, 500_000_000]
    assert channels["phi"].y.tolist() == [1234.5, -0.25]
    np.testing.assert_array_equal(channels["Krängung soll"].y, [np.nan, 2])
    np.testing.assert_array_equal(channels["Welle"].y, [np.nan, 15])


@pytest.mark.parametrize(
    ("separator", "row"),
    [("whitespace", "  {}   {}\n"), ("tab", "{}\t{}\n"), (" | ", "{} | {}\n"), ("::", "{}::{}\n")],
)
def test_separators(tmp_path, separator, row):
    text = "".join(row.format(*pair) for pair in (("t", "roll"), (0, 1.5), (1, -2)))
    path, aids = given(tmp_path, text, f'separator = "{separator}"\n{PLAIN}')
    assert read(path, None, aids).channels["roll"].y.tolist() == [1.5, -2.0]


def test_headers_that_stand_twice_are_numbered(tmp_path):
    text = "t,roll,roll\n0,1,2\n1,3,4\n"
    told = PLAIN.replace('"roll"', '"roll", "roll#2"')
    path, aids = given(tmp_path, text, told)
    channels = read(path, None, aids).channels
    assert {name: c.y.tolist() for name, c in channels.items()} == {
        "roll": [1, 3],
        "roll#2": [2, 4],
    }
    assert "column 'roll' stands twice in the header; rename one, here or by a template" in refused(
        path
    )


@pytest.mark.parametrize(
    ("text", "difference"),
    [
        ("t,heel\n0,1\n", "column 2 of 2: the file has 'heel' where the template has 'roll' of 2"),
        ("t,roll,x\n0,1,2\n", "column 3 of 3: the file has 'x' where the template has none of 2"),
        ("t\n0\n", "column 2 of 1: the file has no such column where the template has 'roll'"),
        ("t;roll\n0;1\n", "column 1 of 1: the file has 't;roll' where the template has 't'"),
        ("t,roll\n0,1,2\n", "line 2: 3 fields where the header has 2 (t, roll)"),
        ("t,roll\n0,1\nx,2\n", "line 3, column 't': 'x' is no time"),
        ("t,roll\n0,1\n1,oops\n", "line 3, column 'roll': 'oops' where a number was expected"),
    ],
)
def test_another_export_is_refused_with_the_difference(tmp_path, text, difference):
    path, aids = given(tmp_path, text, PLAIN)
    assert difference in refused(path, aids)


def test_a_folder_of_exports_with_the_template_among_them(tmp_path):
    for name in ("b.txt", "a.txt"):
        _, aids = given(tmp_path, "t,roll\n0,1\n", PLAIN, name)
    assert [one.name for one in files_of(LogFile(tmp_path, aids))] == ["a.txt", "b.txt"]


def test_an_end_that_is_not_there(tmp_path):
    path, aids = given(tmp_path, "t,roll\n0,1\n", 'end = "Mean"\n' + PLAIN)
    assert "no line begins with 'Mean', where the template has the table end" in refused(path, aids)


@pytest.mark.parametrize(
    ("told", "complaint"),
    [
        (PLAIN.replace("true", "false"), "reviewed: false; read through the template, answer its"),
        (PLAIN.replace("true", '"yes"'), "reviewed: must be a valid boolean, got 'yes'"),
        (PLAIN.replace("reviewed = true", ""), "reviewed: missing; a template needs it"),
        ("seperator = ';'" + PLAIN, "seperator: unknown key; did you mean 'separator'?"),
        (PLAIN.replace("kind", "knd"), "time.knd: unknown key; did you mean 'kind'?"),
        (PLAIN.replace('["t"]', '["x"]'), "template: time.columns: 'x' is not in header; known: r"),
        (PLAIN + '[columns]\nrol = { unit = "deg" }', "columns: 'rol' is not in header; did you"),
        (PLAIN + '[columns]\nroll = { unit = "2+2" }', "columns.roll.unit: '2+2' is not a unit"),
        ('separator = "."' + PLAIN, "separator: '.' cannot separate fields, for it stands in num"),
        ('encoding = "cp12520"' + PLAIN, "encoding: 'cp12520' is no encoding of text; did you me"),
        ('decimal = ","' + PLAIN, "decimal ',' also separates fields or thousands"),
        (PLAIN.replace('"seconds"', '"index"'), "time: an index needs its rate [1/s]"),
        (PLAIN.replace(' }', ', zone = "Europe/Olso" }', 1), "time.zone: 'Europe/Olso' is no time"),
        ("skip = -1" + PLAIN, "skip: must be greater than or equal to 0, got -1"),
        ("= 3", "not TOML: "),
    ],
)  # fmt: skip
def test_a_wrong_template_is_told_by_its_key(tmp_path, told, complaint):
    path, aids = given(tmp_path, "t,roll\n0,1\n", told)
    message = refused(path, aids)
    assert message.startswith(f"{aids.template}: ")
    assert complaint in message


def test_a_template_that_is_not_there(tmp_path):
    path, _ = given(tmp_path, "t,roll\n0,1\n", PLAIN)
    assert "the template cannot be read (No such file" in refused(
        path, Aids(template=tmp_path / "x")
    )


def test_a_template_is_no_use_for_a_log_of_messages(tmp_path):
    path, aids = given(tmp_path, b"\x89MCAP0\r\n" + bytes(60), PLAIN)
    said = refused(path, aids)
    assert "is mcap, where template is for excel, parquet, mat, npz, json, csv; leave it" in said


CLOCKS = {
    "ms": ('kind = "seconds", unit = "ms"', ["0", "500"], [0.0, 0.5]),
    "index": ('kind = "index", rate = 20', ["0", "2"], [0.0, 0.1]),
    "day first": ('format = "%d/%m/%Y %H:%M:%S"', ["05/11/2023 14:00:00"], [START]),
    "month first": ('format = "%m/%d/%Y %H:%M:%S"', ["11/05/2023 14:00:00"], [START]),
    "zone": (
        'format = "%d.%m.%Y %H:%M:%S.%f", zone = "Europe/Oslo"',
        ["05.11.2023 15:00:00.25", "05.11.2023 15:00:00.5"],
        [START + 0.25, START + 0.5],
    ),
    "iso": ('zone = "Europe/Oslo"', ["2023-11-05T15:00:00"], [START]),
    "iso with its own": ('zone = "Europe/Oslo"', ["2023-11-05T14:00:00Z"], [START]),
    "excel": ('kind = "excel days"', ["45235.583333333336"], [START]),
    "matlab": ('kind = "matlab datenum"', ["739195.5833333334"], [START]),
    "of day": ('kind = "time of day"', ["14:00:00.25", "14:00:01"], [50400.25, 50401.0]),
    "of day, packed": ('kind = "time of day", format = "%H%M%S"', ["000130", "000131"], [90, 91]),
}


@pytest.mark.parametrize(("told", "texts", "expected"), CLOCKS.values(), ids=list(CLOCKS))
def test_clocks(tmp_path, told, texts, expected):
    text = "t,roll\n" + "".join(f"{stamp},1\n" for stamp in texts)
    path, aids = given(tmp_path, text, PLAIN.replace('kind = "seconds"', told))
    np.testing.assert_allclose(seconds(path, aids)[0], expected, rtol=0, atol=2e-5)


def test_date_and_time_in_columns_of_their_own(tmp_path):
    text = "Date,Time,roll\n05/11/23,14:00:00,1\n05/11/23,14:00:01,2\n"
    path, aids = given(tmp_path, text, """
reviewed = true
header = ["Date", "Time", "roll"]
time = { columns = ["Date", "Time"], format = "%d/%m/%y %H:%M:%S" }
""")  # fmt: skip
    assert seconds(path, aids)[0] == [START, START + 1]
    assert "date and time stand in separate columns, 'Date' and 'Time'; write one" in refused(path)


def test_a_time_of_day_runs_on_through_midnight_and_it_is_said(tmp_path):
    text = "t,roll\n23:59:59,1\n00:00:00.5,2\n12:00:00,3\n00:00:01,4\n"
    path, aids = given(tmp_path, text, PLAIN.replace("seconds", "time of day"))
    found, clock, remarks = seconds(path, aids)
    assert found == [86399.0, 86400.5, 129600.0, 86401.0]
    assert remarks == ("the time of day passes midnight at line 3, stamps run on from there",)
    assert clock == "column t, time of day without a date"


def test_a_step_back_within_the_day_is_no_midnight(tmp_path):
    text = "t,roll\n14:00:01,1\n14:00:00,2\n14:00:01,3\n14:00:01,4\n"
    path, aids = given(tmp_path, text, PLAIN.replace("seconds", "time of day"))
    found, _, remarks = seconds(path, aids)
    assert found == [50401.0, 50400.0, 50401.0, 50401.0]  # left to alignment, as stamps given twice
    assert remarks == ()


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,u\n05/11/2023 9:00,1\n06/11/2023 9:00,1\n", "'05/11/2023' may be day 5 of month 11"),
        ("t,u\n12:30,1\n", "'12:30' is no time; write seconds or ISO-8601 dates"),
        ("t,u\n45235.5,1\n45235.50001,2\n", "45235.5 may be seconds or days; state the unit"),
        ("t,u\n739195.5,1\n739195.50001,2\n", "739195.5 may be seconds or days; state the unit"),
        ("t;u\n0;1,5\n1;1.234\n", "line 3: '1.234' beside '1,5': a point may be the decimal mark"),
        ("t[s];u\n[ms];[deg]\n0;1\n", "the header says 's' and the row of units 'ms'; say which"),
        ("date,time,u\n20231105,140000,1\n", "date and time stand in separate columns"),
    ],
)
def test_what_can_be_read_in_two_ways_is_not_read(tmp_path, text, message):
    (tmp_path / "log").write_text(text)
    found = refused(tmp_path / "log")
    assert message in found
    assert "template" in found


def test_seconds_at_a_likely_rate_are_seconds(tmp_path):
    (tmp_path / "log").write_text("t,u\n45235.5,1\n45235.6,2\n")
    assert read(tmp_path / "log").channels["u"].t.tolist() == [45235500000000, 45235600000000]


@pytest.mark.parametrize(
    "units_row",
    ["[s];[°];[°/s]", "s;deg;deg/s", "(s);(deg);-", ";°;°/min", "-;deg;knots", "[s];°;%"],
)
def test_a_row_of_units_is_no_data(tmp_path, units_row):
    text = f"Zeit;Krängung;Drehrate\n{units_row}\n0;1,5;2\n"
    (tmp_path / "log").write_bytes(text.encode("cp1252"))
    roll = read(tmp_path / "log").channels["Krängung"]
    assert (roll.unit, roll.y.tolist()) == (units_row.split(";")[1].strip("()[]"), [1.5])


def test_seconds_since_1970_that_went_through_32_bits(tmp_path):
    whole = START + np.arange(600) * 0.1
    for name, t in (("single", whole.astype(np.float32)), ("double", np.float32(whole) * 1.0)):
        with (tmp_path / name).open("wb") as file:
            scipy.io.savemat(file, {"t": t, "u": np.arange(600.0)})
        message = refused(tmp_path / name)
        assert "went through 32 bits, which tell times 128 s apart where samples are" in message
    text = "".join(f"{x:.1f},1\n" for x in whole.astype(np.float32))
    (tmp_path / "csv").write_text("t,u\n" + text)
    assert "went through 32 bits" in refused(tmp_path / "csv")


def test_a_time_of_32_bits_that_is_good_enough_is_said(tmp_path):
    t = (50_000 + np.arange(600) * 0.1).astype(np.float32)
    with (tmp_path / "log").open("wb") as file:
        scipy.io.savemat(file, {"t": t, "u": np.arange(600.0)})
    assert read(tmp_path / "log").remarks == ("stamps of 32 bits, good to 0.0039 s",)


def test_a_sheet_by_a_template(tmp_path):
    book = openpyxl.Workbook()
    sheet = book.create_sheet("Fahrt 2")
    rows = (
        ["Probefahrt"],
        ["Zeit", "Ruder", None],
        ["s", "°", None],
        [0, -999, "x"],
        [1, 2.5, None],
    )
    for row in (*rows, ["Mittel", 3]):
        sheet.append(row)
    book["Sheet"].append(["t", "u"])
    book.save(tmp_path / "log.xlsx")
    told = """
reviewed = true
sheet = "Fahrt 2"
skip = 1
units_row = true
missing = ["-999"]
end = "Mittel"
header = ["Zeit", "Ruder", "column C"]
time = { columns = ["Zeit"], kind = "seconds" }
columns = { Ruder = { rename = "delta" } }
"""
    (tmp_path / "t.toml").write_text(told)
    recording = read(tmp_path / "log.xlsx", None, Aids(template=tmp_path / "t.toml"))
    delta = recording.channels["delta"]
    assert (delta.unit, delta.quantity, delta.t.tolist()) == ("°", "delta", [0, 10**9])
    np.testing.assert_array_equal(delta.y, [np.nan, 2.5])
    (tmp_path / "t.toml").write_text(told.replace("Fahrt 2", "Fahrt 3"))
    aids = Aids(template=tmp_path / "t.toml")
    assert "has no sheet 'Fahrt 3', which the template names, but: Sheet" in refused(
        tmp_path / "log.xlsx", aids
    )


def test_a_group_by_a_template(tmp_path):
    run = {"clock": np.arange(5.0), "roll": np.array([1.0, -999, 3, 4, 5])}
    with (tmp_path / "log").open("wb") as file:
        scipy.io.savemat(file, {"trial": {"run": run}, "t": np.arange(3.0)})
    told = PLAIN.replace('"t"', '"clock"') + 'group = "trial.run"\nmissing = ["-999"]\n'
    (tmp_path / "t.toml").write_text(told)
    aids = Aids(template=tmp_path / "t.toml")
    roll = read(tmp_path / "log", None, aids).channels["roll"]
    np.testing.assert_array_equal(roll.y, [1, np.nan, 3, 4, 5])
    (tmp_path / "t.toml").write_text(told.replace("trial.run", "trial"))
    assert "has no vector 'clock', which the template takes the time from" in refused(
        tmp_path / "log", aids
    )


@forms
def test_a_draft_loads_once_it_is_reviewed(tmp_path, form):
    written = form.write(tmp_path / "log", SERIES)
    text = draft_template(tmp_path / "log")
    aid = tmp_path / "draft.toml"
    aid.write_text(text, encoding="utf-8")
    assert "reviewed: false" in refused(tmp_path / "log", Aids(template=aid))
    aid.write_text(text.replace("reviewed = false\n", "reviewed = true\n"), encoding="utf-8")
    ours = read(tmp_path / "log", None, Aids(template=aid)).channels.values()
    true = read(tmp_path / "log", None, written.aids).channels.values()
    for one, other in zip(ours, true, strict=True):
        np.testing.assert_array_equal(one.y, other.y)
        np.testing.assert_array_equal(one.t, other.t)


def test_a_draft_asks_what_it_cannot_know(tmp_path):
    rows = [f"05/11/2023,14:00:0{i},{y}\n" for i, y in enumerate(("1", "xx", "3"))]
    text = "Run 7\nDate,Time,roll\n" + "".join(rows)
    (tmp_path / "log").write_text(text)
    drafted = draft_template(tmp_path / "log")
    assert "# QUESTION: 05/11/2023 may begin with the day (%d) or the month (%m); which?" in drafted
    assert "# QUESTION: which time zone?" in drafted
    assert "# QUESTION: these stand among numbers" in drafted
    told = template.parse(drafted, tmp_path / "draft")
    assert (told.skip, told.missing, told.time.columns) == (1, ("xx",), ("Date", "Time"))
    assert not told.reviewed


def test_what_is_no_table_has_no_draft(tmp_path):
    (tmp_path / "log").write_text("dear all,\nplease find the log attached.\n")
    with pytest.raises(LogError, match="no lines of numbers side by side in it"):
        draft_template(tmp_path / "log")
    assert guess(tmp_path / "log") is None


def test_the_template_of_the_tests_says_all_its_keys():
    """Every key of a template is told of in its docstring, so that nobody has to read the code."""
    doc = f"{template.Template.__doc__} {template.Time.__doc__} time"
    for name in (*template.Template.model_fields, *template.Time.model_fields):
        assert re.search(rf"\b{name}\b", doc), name
