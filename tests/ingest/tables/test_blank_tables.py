"""Tables whose columns stand blanks apart: read where nothing is in doubt, refused where it is."""

import numpy as np
import pytest

from trialid.errors import LogError
from trialid.ingest import read
from trialid.ingest.tables.table_text import SHORT

T = np.arange(40) / 10
ROWS = np.column_stack([T, np.sin(T), np.cos(T)])


def table(header: str, gap: str = "  ", start: str = "", end: str = "", rows=ROWS) -> str:
    lines = [start + gap.join(f"{x:.4f}" for x in row) + end for row in rows]
    return "\n".join([*(start + line + end for line in header.split("\n")), *lines, ""])


def channels(tmp_path, text: str):
    log = tmp_path / "log.dat"
    log.write_text(text)
    return read(log).channels


LAID_OUT = {
    "one blank": table("t psi_deg r", gap=" "),
    "two blanks": table("t  psi_deg  r"),
    "blanks at both ends": table("t  psi_deg  r", start="   ", end="  "),
    "lines of a title": "Model 12, run 3\n\n" + table("t  psi_deg  r"),
    "a title like names": "time runs on\n" + table("t  psi_deg  r"),
    "units below": table("t  psi_deg  r\n[s]  [deg]  [deg/s]"),
    "decimal comma": table("t  psi_deg  r").replace(".", ","),
}


@pytest.mark.parametrize("text", LAID_OUT.values(), ids=LAID_OUT)
def test_as_many_numbers_in_each_row_as_names_are_read(tmp_path, text):
    found = channels(tmp_path, text)
    assert {*found} == {"psi_deg", "r"}
    assert found["r"].y == pytest.approx(np.cos(T), abs=1e-4)
    assert np.diff(found["r"].t) == pytest.approx(1e8)


def test_units_below_the_names_are_theirs(tmp_path):
    found = channels(tmp_path, LAID_OUT["units below"])
    assert [one.unit for one in found.values()] == ["deg", "deg/s"]


def test_a_long_one_is_read_alike(tmp_path):
    t = np.arange(3 * SHORT // 20) / 10
    text = table("t  psi_deg  r", rows=np.column_stack([t, np.sin(t), np.cos(t)]))
    assert len(text) > 2 * SHORT
    assert channels(tmp_path, text)["r"].y == pytest.approx(np.cos(t), abs=1e-4)


IN_DOUBT = {
    "blanks within names": table("t  yaw rate  r"),
    "units beside names": table("t [s]  psi [deg]  r [deg/s]"),
    "a name too few": table("t  r"),
}


@pytest.mark.parametrize("text", IN_DOUBT.values(), ids=IN_DOUBT)
def test_a_header_of_other_words_than_numbers_is_refused_with_what_was_expected(tmp_path, text):
    with pytest.raises(LogError, match="rows are 3 numbers that stand blanks apart") as told:
        channels(tmp_path, text)
    assert f"the {len(text.splitlines()[0].split())} words of line 1" in str(told.value)


@pytest.mark.parametrize(
    "text",
    [
        table("a  b  c"),
        "in time we came\nto say some words\nthat are no table\n",
        "t  psi\n0.0  1.0\n",
        table("t  r  r"),
    ],
)
def test_other_texts_are_no_such_table(tmp_path, text):
    with pytest.raises(LogError, match="none of the formats"):
        channels(tmp_path, text)


def test_a_row_of_other_length_further_down_is_named(tmp_path):
    rows = np.column_stack([np.arange(400) / 10] * 3)
    lines = table("t  psi_deg  r", rows=rows).splitlines()
    lines[350:355] = ["34.9  1.0"] * 5
    with pytest.raises(LogError, match="line 351: 2 fields where the header has 3"):
        channels(tmp_path, "\n".join([*lines, ""]))
