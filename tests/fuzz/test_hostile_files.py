"""Files made to do harm: they cost neither memory nor time, run nothing and steer no terminal."""

import gzip
import io
import json
import os
import struct
import zipfile
from pathlib import Path

import numpy as np
import openpyxl
import pytest
from click.testing import CliRunner
from limits import bounded

from trialid.cli import main
from trialid.ingest import Aids, read
from trialid.ingest.adapter import NO_AIDS
from trialid.ingest.tables.excel import excel_log

MB = 1_000_000
HEADS = {
    "mcap": b"\x89MCAP0\r\n", "dataflash": b"\xa3\x95\x80\x80Y", "tlog": bytes(8) + b"\xfd\x09",
    "blf": b"LOGG\x90\0\0\0", "sqlite": b"SQLite format 3\0", "xlsx": b"PK\x03\x04", "zip": b"PK",
    "parquet": b"PAR1", "mat5": b"MATLAB 5.0 MAT-file", "hdf5": b"\x89HDF\r\n\x1a\n",
    "nmea": b"$GPRMC,1*00\n", "candump": b"(1.0) can0 09F10D0B#00\n", "csv": b"t,u\n0,1\n",
    "numpy": b"\x93NUMPY\x01\0", "pickle": b"\x80\x04\x95", "elf": b"\x7fELF", "none": b"",
}  # fmt: skip


def reading(path, aids=NO_AIDS, megabytes=400.0):
    """What is read, or the message."""
    return bounded(lambda: read(path, None, aids), megabytes)


def refused(path, *words, aids=NO_AIDS, megabytes=400.0):
    message = reading(path, aids, megabytes)
    assert isinstance(message, str)
    assert all(word in message for word in words), message


def saved(path, content):
    path.write_bytes(content)
    return path


# --- what is no log at all ----------------------------------------------------------------------


@pytest.mark.parametrize("head", HEADS.values(), ids=HEADS)
@pytest.mark.parametrize("rest", [b"", b"\0" * MB, b"\xff" * MB], ids=["nothing", "0", "ff"])
def test_a_beginning_and_then_nothing(tmp_path, head, rest):
    reading(saved(tmp_path / "log", head + rest))


def test_noise(tmp_path):
    refused(saved(tmp_path / "log", np.random.default_rng(1).bytes(MB)), "none of the formats")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names here")
def test_a_pipe_that_nobody_writes_to(tmp_path):
    os.mkfifo(tmp_path / "log")
    refused(tmp_path / "log", "is no file")


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no such device here")
def test_a_device_without_an_end():
    refused(Path("/dev/zero"), "is no file")


def test_a_python_pickle_runs_nothing(tmp_path):
    class Evil:
        def __reduce__(self):
            return os.mkdir, (str(tmp_path / "harm"),)

    np.save(tmp_path / "log.npy", np.array([Evil()]), allow_pickle=True)
    refused(tmp_path / "log.npy", "none of the formats")
    assert not (tmp_path / "harm").exists()


# --- what unpacks to more -----------------------------------------------------------------------


def test_a_gzip_bomb_is_not_unpacked(tmp_path):
    with gzip.open(tmp_path / "log", "wb", 9) as file:
        for _ in range(300):
            file.write(bytes(MB))
    refused(tmp_path / "log", "none of the formats")
    with gzip.open(tmp_path / "log", "wb", 9) as file:
        file.write(b"t,u\n")
        for _ in range(300):
            file.write(b"0,0\n" * (MB // 4))
    refused(tmp_path / "log", "which no log of its size does", megabytes=100)


def _sheets(count, size):
    """An Excel file of blank sheets, and its bytes."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", "<a/>")
        for i in range(count):
            archive.writestr(f"xl/worksheets/sheet{i}.xml", b" " * size)
    return made.getvalue()


def test_a_zip_bomb_is_counted_before_it_is_believed(tmp_path):
    path = saved(tmp_path / "log", _sheets(1, 500 * MB))
    assert path.stat().st_size < MB
    refused(path, "unpacks to more than 400 MB", megabytes=100)


def test_a_zip_bomb_whose_members_overlap(tmp_path):
    """A thousand entries of the directory that are one and the same member."""
    raw = _sheets(1, 10 * MB)
    at = raw.rindex(b"PK\x01\x02")
    end = raw.rindex(b"PK\x05\x06")
    entries = raw[at:end] * 1000
    first = raw.index(b"PK\x01\x02")
    head = raw[first:at]
    tail = struct.pack("<4s4H2LH", b"PK\x05\x06", 0, 0, 1001, 1001, len(head + entries), first, 0)
    path = saved(tmp_path / "log", raw[:first] + head + entries + tail)
    refused(path, "unpacks to more than 400 MB", megabytes=100)


# --- texts --------------------------------------------------------------------------------------


def test_a_table_of_a_million_columns(tmp_path):
    names = "t," + ",".join(f"c{i}" for i in range(MB))
    row = ",".join(["1"] * (MB + 1))
    refused(
        saved(tmp_path / "log", f"{names}\n{row}\n{row}\n".encode()),
        "line 1: more than 2 MB without",
    )


LINES = {
    "csv": b"t,u\n0,1\n", "candump": b"(1.0) can0 09F10D0B#00FFFFFFFFFFFFFF\n",
    "nmea": b"$GPROT,1.0,A*29\r\n" * 3, "signalk": b"1700000000000;N;$GPROT,1.0,A*29\n" * 3,
    "json": b'{"t":0,"u":1}\n{"t":1,"u":[', "trc": b";$FILEVERSION=1.1\n",
    "asc": b"date Mon Jan 1 00:00:00 2024\nbase hex timestamps absolute\n",
}  # fmt: skip


FILLERS = {"digits": b"1", "fields": b"1,", "dollars": b"$", "quotes": b'"'}


def _long_line(path, form, filler):
    reading(saved(path, LINES[form] + filler * (200 * MB // len(filler)) + b"\n"), megabytes=900)


@pytest.mark.parametrize("filler", FILLERS.values(), ids=FILLERS)
@pytest.mark.study(turn="each")
def test_a_row_of_two_hundred_megabytes(tmp_path, filler):
    _long_line(tmp_path / "log", "csv", filler)


@pytest.mark.study(turn=13)
def test_a_sentence_of_two_hundred_megabytes(tmp_path):
    _long_line(tmp_path / "log", "nmea", b"$")


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("form", LINES)
@pytest.mark.parametrize("filler", FILLERS.values(), ids=FILLERS)
def test_a_line_of_two_hundred_megabytes_in_every_text(tmp_path, form, filler):
    _long_line(tmp_path / "log", form, filler)


def test_a_table_of_many_short_lines(tmp_path):
    reading(saved(tmp_path / "log", b"t,u\n" + b"\n" * 20 * MB), megabytes=900)


# --- aids ---------------------------------------------------------------------------------------

TABLE = b"t,u\n0,1\n1,2\n"
HUGE_NUMBERS = {
    "skip": "skip = 1000000000000000000000000",
    "skip, 64 bits": "skip = 9223372036854775807",
    "header_rows": "header_rows = 1000000000",
    "skip_after": "skip_after = 1000000000",
    "float": "skip = 1e308",
    "infinite": "skip = inf",
    "digits": "skip = " + "9" * 5000,
    "nested": "skip = " + "[" * 50_000 + "]" * 50_000,
    "tables": "[" + ".".join("a" * 5000) + "]",
    "inline": "skip = " + "{a=" * 5000 + "1" + "}" * 5000,
}


@pytest.mark.parametrize("line", HUGE_NUMBERS.values(), ids=HUGE_NUMBERS)
def test_a_template_with_huge_numbers(tmp_path, line):
    log = saved(tmp_path / "log", TABLE)
    aid = tmp_path / "aid.toml"
    aid.write_text(
        f'reviewed = true\nseparator = ","\nheader = ["t", "u"]\n{line}\n'
        '[time]\ncolumns = ["t"]\nunit = "s"\n'
    )
    refused(log, str(tmp_path), aids=Aids(template=aid))


def test_a_description_of_a_million_signals(tmp_path):
    log = saved(tmp_path / "log", b"(1.0) can0 123#00\n")
    lines = [b'VERSION ""\nBU_: A\nBO_ 291 M: 8 A\n']
    lines += [b' SG_ S%d : 0|8@1+ (1,0) [0|0] "" A\n' % i for i in range(MB)]
    refused(log, "bus.dbc", aids=Aids(dbc=saved(tmp_path / "bus.dbc", b"".join(lines))))


# --- Excel --------------------------------------------------------------------------------------


def _with_sheet(path, rows, extra=None):
    book = openpyxl.Workbook()
    for row in rows:
        book.active.append(row)
    book.save(path)
    with zipfile.ZipFile(path, "a") as archive:
        for name, content in (extra or {}).items():
            archive.writestr(name, content)
    return path


def test_formulas_and_links_to_other_files_are_not_followed(tmp_path):
    saved(tmp_path / "other.csv", b"t,u\n0,666\n")
    link = (
        '<?xml version="1.0"?><Relationships xmlns="http://schemas.openxmlformats.org/package/2006/'
        'relationships"><Relationship Id="rId1" Type="http://schemas.openxmlformats.org/'
        f'officeDocument/2006/relationships/externalLinkPath" Target="{tmp_path}/other.csv" '
        'TargetMode="External"/></Relationships>'
    )
    rows = [["t", "u"], [0, "=[1]other!B2"], [1, '=WEBSERVICE("http://example.org")'], [2, 2.5]]
    links = {"xl/externalLinks/_rels/externalLink1.xml.rels": link}
    found = reading(_with_sheet(tmp_path / "log.xlsx", rows, links))
    np.testing.assert_array_equal(found.channels["u"].y, [np.nan, np.nan, 2.5])


def test_entities_that_grow_are_not_expanded(tmp_path):
    laughs = "".join(f'<!ENTITY l{i} "{f"&l{i - 1};" * 10}">' for i in range(1, 10))
    sheet = (
        f'<?xml version="1.0"?><!DOCTYPE x [<!ENTITY l0 "ha">{laughs}]><worksheet xmlns="http://'
        'schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData><row r="1"><c r="A1" '
        't="inlineStr"><is><t>&l9;</t></is></c></row></sheetData></worksheet>'
    )
    whole = _with_sheet(tmp_path / "whole.xlsx", [["t", "u"], [0, 1]])
    with zipfile.ZipFile(whole) as old, zipfile.ZipFile(tmp_path / "log", "w") as new:
        for member in old.infolist():
            is_sheet = "sheet1" in member.filename
            new.writestr(member.filename, sheet if is_sheet else old.read(member))
    reading(tmp_path / "log")


SHEET = (
    '<worksheet xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main"><sheetData>'
    "{}</sheetData></worksheet>"
)
CELLS = "<row>" + "<c><v>1</v></c>" * 4 + "</row>"
FAR = '<row r="1048576"><c r="{}1048576"><v>1</v></c></row>'
SST = '<sst xmlns="http://schemas.openxmlformats.org/spreadsheetml/2006/main">'
STRINGS = '<sst count="{0}" uniqueCount="{0}"><si><t>a</t></si></sst>'
ABORTING = {
    "rows with a place, cells with none": {
        "sheet1.xml": '<row r="1048576">' + "<c/>" * 16384 + "</row>"},
    "a prefix": {"sheet1.xml": '<x:row r="1048576">' + "<x:c/>" * 16384 + "</x:row>"},
    "no place at all": {"sheet1.xml": CELLS * 3_000_000},
    "a corner": {"sheet1.xml": FAR.format("XFD")},
    "another name": {"x1.xml": FAR.format("XFD")},
    "strings": {"strings": STRINGS.format(4_000_000_000)},
    "strings, 64 bits": {"strings": STRINGS.format(2**64 - 1)},
    "many sheets": {f"s{i}.xml": FAR.format("A") for i in range(1, 5)},
}  # fmt: skip


def _aborting(path, parts):
    """A workbook of the sheets of `parts`, in folders and under names as its relations say."""
    sheets = {name: one for name, one in parts.items() if name != "strings"} or {
        "sheet1.xml": CELLS
    }
    office = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
    package = "http://schemas.openxmlformats.org/package/2006/relationships"
    named = [(f"rId{i}", i, name) for i, name in enumerate(sheets, 1)]
    book = "".join(f'<sheet name="S{i}" sheetId="{i}" r:id="{rid}"/>' for rid, i, _ in named)
    links = "".join(
        f'<Relationship Id="{rid}" Type="{office}/worksheet" Target="w/{name}"/>'
        for rid, _, name in named
    )
    if "strings" in parts:
        links += f'<Relationship Id="s" Type="{office}/sharedStrings" Target="sharedStrings.xml"/>'
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr("_rels/.rels", f'<Relationships xmlns="{package}"><Relationship Id="r" '
                         f'Type="{office}/officeDocument" Target="xl/workbook.xml"/>'
                         "</Relationships>")  # fmt: skip
        archive.writestr("xl/workbook.xml", '<workbook xmlns="http://schemas.openxmlformats.org/'
                         f'spreadsheetml/2006/main" xmlns:r="{office}"><sheets>{book}</sheets>'
                         "</workbook>")  # fmt: skip
        links = f'<Relationships xmlns="{package}">{links}</Relationships>'
        archive.writestr("xl/_rels/workbook.xml.rels", links)
        if "strings" in parts:
            archive.writestr("xl/sharedStrings.xml", parts["strings"])
        for name, rows in sheets.items():
            archive.writestr(f"xl/w/{name}", SHEET.format(rows))
    return path


@pytest.mark.parametrize("parts", ABORTING.values(), ids=ABORTING)
@pytest.mark.study(turn="each")
def test_a_workbook_that_asks_for_all_memory_is_counted_first(tmp_path, parts):
    refused(_aborting(tmp_path / "log", parts), "log", "export it as CSV")


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (700, 30)])
def test_cells_without_places_are_read(tmp_path, rows, columns):
    """Some programs write none; the first cell is then A1."""
    row = "<row>" + "<c><v>2</v></c>" * columns + "</row>"
    path = _aborting(tmp_path / "log", {"a.xml": row * rows})
    assert excel_log.sheets(path) == {"S1": [[2.0] * columns] * rows}


@pytest.mark.parametrize("signal", ["SIGABRT", "SIGKILL", "SIGXCPU"])
def test_a_reader_that_dies_is_a_line(tmp_path, signal, monkeypatch):
    """Whatever passes the count: the reader is a process of its own."""
    child = tmp_path / "child.py"
    child.write_text(f"import os, signal\nos.kill(os.getpid(), signal.{signal})\n")
    monkeypatch.setattr(excel_log.excel_sheets, "__file__", str(child))
    refused(_with_sheet(tmp_path / "log", [["t", "u"], [0, 1]]), "more memory or time")


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no limits of a process here")
@pytest.mark.study(turn=12)
def test_a_long_text_that_many_cells_share(tmp_path, monkeypatch):
    """A megabyte in twenty thousand cells: 20 GB, of which no part of the file speaks."""
    cells = "".join(f'<row r="{i}"><c r="A{i}" t="s"><v>0</v></c></row>' for i in range(1, 20_000))
    parts = {"strings": f"{SST}<si><t>{'a' * MB}</t></si></sst>", "a.xml": cells}
    refused(_aborting(tmp_path / "log", parts), "more memory or time")


# --- names --------------------------------------------------------------------------------------

NAMES = ("u[red]x", "r<script>alert(1)</script>", "roll\x1b[31m", "a[bold", "r\u202er")


def inspected(path, *options):
    return CliRunner().invoke(main.commands, ["inspect", str(path), *options], prog_name="trialid")


def _clean(text):
    return text.replace("\n", "").isprintable()


def test_names_of_columns_steer_no_terminal(tmp_path):
    t = np.arange(0.0, 20.0, 0.1)
    rows = [",".join(["t", *NAMES])]
    rows += [",".join(f"{x:.3f}" for x in (k, *[np.sin(k)] * len(NAMES))) for k in t]
    path = saved(tmp_path / "log.csv", "\n".join(rows).encode())
    done = inspected(path, "--all")
    assert done.exit_code == 0, done.output
    assert _clean(done.stdout)
    assert all(name in done.stdout for name in NAMES[:2])
    assert NAMES[2] in {
        one["channel"] for one in json.loads(inspected(path, "--json").stdout)["channels"]
    }


def test_names_of_files_steer_no_terminal(tmp_path):
    name = "log\x1b[31m[red]\n<b>\r.csv"
    good = saved(tmp_path / name, b"t,u\n0,1\n1,2\n2,4\n3,4\n")
    assert _clean(inspected(good).stdout)
    bad = saved(tmp_path / ("bad" + name), b"t,u\n0,x\n1,2\n")
    done = inspected(bad)
    assert done.exit_code == 2
    assert done.stderr.count("\n") == 1
    assert _clean(done.stderr)
    refused(bad, "bad")
