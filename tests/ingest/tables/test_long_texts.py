"""Long logs of text are read block by block: as they are read whole, in the memory of numbers."""

import tracemalloc
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from trialid.errors import LogError
from trialid.ingest import Aids, read
from trialid.ingest.bytes import encoded_text
from trialid.ingest.tables import table_quick, table_text

START = datetime(2026, 6, 3, 9, 12)


def rows(form, count=40, mark="."):
    """Lines of a time, a number, one that is often missing, a text and a number."""
    for i in range(count):
        stamp = (START + timedelta(milliseconds=100 * i)).strftime(form)
        y = f"{np.sin(i):.6f}".replace(".", mark)
        yield [stamp, y, "" if i % 3 else str(i), "AUTO" if i < 30 else "", str(7 - i)]


def text(separator=",", form="%Y-%m-%dT%H:%M:%S.%f", mark=".", last=""):
    head = separator.join(["time", "a", "b", "mode", "c"])
    return "\n".join([head, *(separator.join(row) for row in rows(form, mark=mark)), last])


TEXTS = {
    "ISO stamps": text().encode(),
    "stamps with their zone": text(form="%Y-%m-%dT%H:%M:%S.%fZ").encode(),
    "day first, decimal commas": text(";", "%d.%m.%Y %H:%M:%S.%f", ",").encode("cp1252"),
    "month first": text(";", "%m/%d/%Y %H:%M:%S.%f").encode(),
    "times of day": text(form="%H:%M:%S.%f").encode(),
    "cut short": text(last="2026-06-03T09:12:04.0,0.1").encode(),
    "blank lines at the end": text(last="\n\n").encode(),
    "16 bits": text("\t").encode("utf-16"),
    "ends of line of an old computer": text().replace("\n", "\r").encode(),
    "a comma far below": b"t;a\n" + b"".join(b"%d;%d\n" % (i, i) for i in range(30)) + b"30;1,5\n",
    "a text far below": b"t,a\n" + b"".join(b"%d,%d\n" % (i, i) for i in range(30)) + b"30,x\n",
    "a time that is none": text(last="soon,1,2,,4").encode(),
    "a row too long": text(last="2026-06-03T09:12:04.0,1,2,,4,5").encode(),
    "one too long, one too short": b"t,a,b\n0,1,2\n1,1,2,3\n2,1\n" + b"3,1,2\n" * 30,
    "rows of nothing": b"t,a\n" + b"".join(b"%d,%d\n" % (i, i) for i in range(30)) + b",\n31,2\n",
    "quotes": text(last='2026-06-03T09:12:04.0,"0.1",2,,4').encode(),
}
PLAIN = list(TEXTS)[: list(TEXTS).index("a comma far below") + 1]
"""Those about which nothing is odd."""


@pytest.mark.parametrize("name", TEXTS)
@pytest.mark.parametrize("wanted", [None, ["a"]])
def test_by_blocks_as_with_care(name, wanted, tmp_path, monkeypatch):
    path = tmp_path / "log.csv"
    path.write_bytes(TEXTS[name])
    monkeypatch.setattr(table_text, "SHORT", 0)
    with monkeypatch.context() as patch:
        patch.setattr(table_quick, "columns", lambda *told: None)
        careful = outcome(path, wanted)
    monkeypatch.setattr(encoded_text, "BLOCK", 128)
    if name in PLAIN:
        monkeypatch.delattr(table_text, "_whole")
    assert outcome(path, wanted) == careful


def outcome(path: Path, wanted, aids=Aids()):  # noqa: B008
    try:
        found = read(path, wanted, aids)
    except LogError as error:
        return str(error)
    return found.remarks, {
        name: (one.t.tolist(), repr(one.y.tolist()), one.unit, one.clock, one.quantity)
        for name, one in found.channels.items()
    }


def test_a_template_with_its_form_and_its_end(tmp_path, monkeypatch):
    path, told = tmp_path / "log.csv", tmp_path / "told.toml"
    body = text("||", "%d.%m.%Y %H:%M:%S.%f", ",").rstrip("\n")
    path.write_text(f"Anlage 7\n{body}\nMittel||1||2||3||4\n", encoding="cp1252")
    told.write_text(
        'reviewed = true\nheader = ["time", "a", "b", "mode", "c"]\nseparator = "||"\n'
        'decimal = ","\nencoding = "cp1252"\nskip = 1\nend = "Mittel"\n'
        'time = {columns = ["time"], format = "%d.%m.%Y %H:%M:%S.%f", zone = "Europe/Oslo"}\n'
        '[columns.a]\nrename = "u"\n'
    )
    monkeypatch.setattr(table_text, "SHORT", 0)
    with monkeypatch.context() as patch:
        patch.setattr(table_quick, "columns", lambda *told: None)
        careful = outcome(path, ["u", "c"], Aids(template=told))
    monkeypatch.setattr(encoded_text, "BLOCK", 128)
    assert set(careful[1]) == {"u", "c"}
    assert outcome(path, ["u", "c"], Aids(template=told)) == careful


def test_neither_the_text_nor_what_nobody_wants_is_kept(tmp_path, monkeypatch):
    monkeypatch.setattr(encoded_text, "BLOCK", 1 << 18)
    path, count = tmp_path / "log.csv", 60_000
    rng = np.random.default_rng(5)
    lines = [",".join(f"{y:.9f}" for y in row) for row in rng.standard_normal((600, 9))]
    with path.open("w") as file:
        file.write("t[s]," + ",".join("abcdefghi") + "\n")
        file.writelines(f"{0.1 * i:.1f},{lines[i % 600]}\n" for i in range(count))
    assert path.stat().st_size > 6_000_000
    read(path, ["c"])  # whatever is loaded once
    tracemalloc.start()
    found = read(path, ["c"])
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert len(found.channels["c"].y) == count
    numbers = 2 * 8 * count
    assert peak < numbers + 12 * encoded_text.BLOCK
