"""JSON logs: records a line or in a list, lists a column; what is nested, lacking or cut off."""

import json

import numpy as np
import pytest

from trialid.errors import LogError
from trialid.ingest import Aids, LogFile, draft_template, files_of, read

ROWS = [
    {"time": f"2026-05-04T10:00:0{i}Z", "nav": {"rot": 0.5 * i, "at": [57.0 + i, 10.0]}, "on": True}
    for i in range(5)
]
PLAIN = {"t": [0.0, 0.5, 1.0, 1.5], "rudder": [1, 2, None, 4], "mode": ["a", "b", "b", "b"]}


def lines(records):
    return "".join(json.dumps(one) + "\n" for one in records)


def saved(folder, text, name="log.json"):
    (folder / name).write_text(text, encoding="utf-8")
    return folder / name


@pytest.mark.parametrize("text", [lines(ROWS), json.dumps(ROWS), json.dumps(ROWS, indent=1)])
def test_records_have_columns_by_all_names_on_the_way(tmp_path, text):
    found = read(saved(tmp_path, text))
    assert found.adapter == "json"
    assert list(found.channels) == ["nav.rot", "nav.at.0", "nav.at.1"]
    assert found.channels["nav.rot"].y.tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]
    assert np.diff(found.channels["nav.at.0"].t).tolist() == [1_000_000_000] * 4
    assert "column 'on' holds text, left out" in found.remarks


@pytest.mark.parametrize("indent", [None, 1])
def test_lists_a_column(tmp_path, indent):
    found = read(saved(tmp_path, json.dumps(PLAIN, indent=indent)))
    y = found.channels["rudder"].y
    assert y[[0, 1, 3]].tolist() == [1.0, 2.0, 4.0]
    assert np.isnan(y[2])


def test_fields_that_come_later_were_not_measured_before(tmp_path):
    rows = [{"t": 0.1 * i, "r" if i % 2 else "u": str(i)} for i in range(6)]
    found = read(saved(tmp_path, lines(rows))).channels
    assert np.isnan(found["u"].y).tolist() == [False, True] * 3
    assert found["r"].y[1::2].tolist() == [1.0, 3.0, 5.0]


def test_many_records_are_read_in_parts(tmp_path, monkeypatch):
    rows = [{"t": i, "r": 0.5 * i, **({"late": i} if i > 700 else {})} for i in range(1000)]
    whole = read(saved(tmp_path, lines(rows))).channels
    monkeypatch.setattr("trialid.ingest.tables.json_log.BLOCK", 1000)
    parts = read(tmp_path / "log.json").channels
    assert parts["late"].y[701:].tolist() == list(range(701, 1000))
    for name, one in whole.items():
        np.testing.assert_array_equal(parts[name].y, one.y)


def test_seconds_and_nanoseconds_are_one_time(tmp_path):
    """As ROS messages that are saved as JSON have it."""
    rows = [{"stamp": {"sec": i // 2, "nanosec": 5 * 10**8 * (i % 2)}, "r": i} for i in range(6)]
    found = read(saved(tmp_path, lines(rows))).channels["r"]
    assert np.diff(found.t).tolist() == [500_000_000] * 5


def test_one_value_a_row(tmp_path):
    rows = [{"ts": i // 2, "topic": ("rudder", "rot")[i % 2], "value": i} for i in range(8)]
    found = read(saved(tmp_path, lines(rows))).channels
    assert found["rudder"].y.tolist() == [0.0, 2.0, 4.0, 6.0]
    assert found["rot"].y.tolist() == [1.0, 3.0, 5.0, 7.0]


def test_a_last_line_that_is_cut_off_is_told(tmp_path):
    found = read(saved(tmp_path, lines(ROWS)[:-20]))
    assert found.remarks[0] == "line 5, the last, is cut off and left out"
    assert len(found.channels["nav.rot"].y) == 4


def test_a_template_says_which_field_is_the_time(tmp_path):
    rows = [{"sent": 100 * i, "roll": 0.5 * i if i < 3 else -999} for i in range(5)]
    log = saved(tmp_path, lines(rows))
    with pytest.raises(LogError, match="none of its fields is called a time"):
        read(log)
    drafted = draft_template(log)
    assert "# QUESTION: no column is called time; is it this one?" in drafted
    answered = drafted.replace("reviewed = false\n", 'reviewed = true\nmissing = ["-999"]\n')
    aid = saved(tmp_path, answered.replace('# unit = "ms"', 'unit = "ms"'), "t.toml")
    found = read(log, None, Aids(template=aid)).channels["phi"]
    assert np.diff(found.t).tolist() == [100_000_000] * 4
    assert np.isnan(found.y).tolist() == [False] * 3 + [True] * 2


CANBOAT = {"timestamp": "2026-05-04-10:00:00.1", "src": 1, "pgn": 127251, "fields": {"Rate": 0.1}}
REFUSED = {
    "damaged": (lines(ROWS[:2]) + '"nav"}\n' + lines(ROWS[2:]), 'line 3: "nav"} is no JSON'),
    "cut list": (json.dumps(ROWS)[:-20], "is no JSON that can be read"),
    "no record": (json.dumps([*ROWS, 7]), "record 6: is no JSON object"),
    "unequal": (json.dumps({"t": [0, 1], "r": [1]}), "no list of equal length for each"),
    "canboat": (lines([CANBOAT] * 3), "canboat's analyzer"),
    "deep": (
        lines([{"t": 0}]) + '{"t":' + '{"a":' * 90_000 + "0" + "}" * 90_001 + "\n",
        "line 2: ",
    ),
    "about a log": (json.dumps({"time": "10:00", "L": 3}), "none of the formats"),
    "about a log, indented": (json.dumps({"time": "10:00", "L": 3}, indent=1), "none of the"),
    "no time": (lines([{"r": 1}, {"r": 2}]), "none of its fields is called a time"),
}


@pytest.mark.parametrize(("text", "words"), REFUSED.values(), ids=REFUSED)
def test_what_is_no_log_is_refused_in_a_line(tmp_path, text, words):
    with pytest.raises(LogError) as error:
        read(saved(tmp_path, text))
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_one_value_of_more_than_fits_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("trialid.ingest.tables.json_log.MOST_BYTES", 100)
    with pytest.raises(LogError, match="export one record a line"):
        read(saved(tmp_path, json.dumps(ROWS)))


def test_records_that_share_few_fields_are_more_than_they_look(tmp_path, monkeypatch):
    monkeypatch.setattr("trialid.ingest.tables.json_log.MOST_VALUES", 1000)
    with pytest.raises(LogError, match="export a shorter time, or fewer fields"):
        read(saved(tmp_path, lines([{"t": i, f"r{i}": 1} for i in range(100)])))


def test_what_lies_beside_logs_in_their_folder_is_none(tmp_path):
    saved(tmp_path, lines(ROWS), "log.jsonl")
    saved(tmp_path, json.dumps({"time": "2026", "L": 160.0}, indent=2), "about.json")
    assert [path.name for path in files_of(LogFile(tmp_path))] == ["log.jsonl"]
