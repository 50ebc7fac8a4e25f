"""One trial in tables of every kind, real records, damage and files made to do harm."""

import sys
import zipfile
from pathlib import Path

import h5py
import numpy as np
import openpyxl
import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest
import scipy.io
import write_tables
from damage import damaged
from hypothesis import given, settings
from hypothesis import strategies as st

from trialid import ingest
from trialid.alignment import align
from trialid.errors import LogError
from trialid.ingest import Aids, packages, read
from trialid.ingest.tables import parquet_log, table_text

RECORDS = Path(__file__).parents[3] / "shared/data/kvlcc2_hsva_zigzag"
T = np.arange(0.0, 60.0, 0.1)
T_NS = write_tables.START_NS + np.rint(T * 1e9).astype(np.int64)
SERIES = {
    "delta": (T_NS, 0.1 * np.sin(T / 3)),
    "r": (T_NS, 0.01 * np.sin(T / 3 - 0.9)),
    "phi": (T_NS, 0.05 * np.sin(T / 2)),
    "u": (T_NS, 7.0 + 0.0 * T),
    "psi": (T_NS, 0.3 * np.sin(T / 10)),
}
forms = pytest.mark.parametrize("form", write_tables.FORMATS, ids=lambda one: one.name)


def refused(path, aids=Aids()):  # noqa: B008
    with pytest.raises(LogError) as caught:
        read(path, None, aids)
    assert "\n" not in str(caught.value)
    return str(caught.value)


@forms
def test_every_table_gives_the_trial_back(tmp_path, form):
    written = form.write(tmp_path / "log", SERIES)
    recording = read(tmp_path / "log", None, written.aids)
    assert recording.remarks == ()
    assert len(recording.channels) == len(SERIES)
    for source in written.sources:
        channel = recording.channels[source.channel]
        stamps, y = SERIES[source.quantity]
        ours = channel.y * write_tables.IN_SI[source.unit]
        np.testing.assert_allclose(ours, y, rtol=0, atol=written.resolution[source.quantity])
        step = written.clock_resolution * 1e9
        np.testing.assert_allclose(channel.t - channel.t[0], stamps - stamps[0], atol=step)
    trial = align("one", "fit", [recording], written.sources, 0.1)
    np.testing.assert_allclose(trial.signals["phi"], SERIES["phi"][1], atol=1e-6)


@forms
def test_only_the_wanted_columns_are_given(tmp_path, form):
    written = form.write(tmp_path / "log", SERIES)
    name = written.sources[2].channel
    assert list(read(tmp_path / "log", [name], written.aids).channels) == [name]


def test_dates_of_excel_and_parquet_are_dates(tmp_path):
    for form in (write_tables.excel, write_tables.parquet):
        form(tmp_path / "log", SERIES)
        channel = read(tmp_path / "log").channels["phi"]
        np.testing.assert_allclose(channel.t, T_NS, atol=1e6)


@pytest.mark.real_data
@pytest.mark.skipif(not RECORDS.is_dir(), reason="real records are not here")
@pytest.mark.parametrize("record", sorted(RECORDS.glob("*.dat")), ids=lambda path: path.stem[17:])
def test_the_records_of_a_model_basin(record):
    told = Path(__file__).parents[1] / "real_records" / "kvlcc2_hsva.template.toml"
    recording = read(record, None, Aids(template=told))
    table = np.loadtxt(record, encoding="cp1252", skiprows=4)
    np.testing.assert_array_equal(recording.channels["r"].y, table[:, 6])
    np.testing.assert_array_equal(recording.channels["r"].t, np.rint(table[:, 0] * 1e9))
    assert recording.channels["delta"].quantity == "delta"
    assert recording.channels["torque"].unit == "N*m"


def test_a_quick_table_and_a_careful_one_are_the_same(tmp_path, monkeypatch):
    text = "t;a;b;mode\n0;1,5;;AUTO\n1;-2;n/a;HAND\n2;1e3;3,25;\n"
    (tmp_path / "log").write_text(text)
    monkeypatch.setattr(table_text, "SHORT", 0)
    quick = read(tmp_path / "log")
    monkeypatch.setattr(table_text, "SHORT", 1 << 19)
    careful = read(tmp_path / "log")
    assert list(quick.channels) == list(careful.channels) == ["a", "b"]
    assert quick.remarks == careful.remarks == ("column 'mode' holds text, left out",)
    for name in quick.channels:
        np.testing.assert_array_equal(quick.channels[name].y, careful.channels[name].y)
        np.testing.assert_array_equal(quick.channels[name].t, careful.channels[name].t)


FIELD = st.text("0123456789.,eE+-_ naNAif/x", max_size=6)


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.lists(st.tuples(FIELD, FIELD), min_size=1, max_size=6), st.sampled_from(";\t"))
def test_whatever_stands_in_the_fields_both_ways_agree(tmp_path_factory, rows, separator):
    path = tmp_path_factory.mktemp("log") / "log"
    body = "".join(f"{i}{separator}{a}{separator}{b}\n" for i, (a, b) in enumerate(rows))
    path.write_text(f"t{separator}a{separator}b\n{body}")
    found = []
    for short in (0, 1 << 19):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(table_text, "SHORT", short)
            found.append(outcome(path))
    assert found[0] == found[1]


def outcome(path, aids=Aids()):  # noqa: B008
    try:
        recording = read(path, None, aids)
    except LogError as error:
        return str(error)
    return recording.remarks, {name: repr(c.y.tolist()) for name, c in recording.channels.items()}


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
def test_encodings_of_spreadsheets(tmp_path, encoding):
    text = "Zeit;Krängung [°]\r\n0;1,5\r\n1;-2,5\r\n"
    (tmp_path / "log").write_bytes(text.encode(encoding))
    (channel,) = read(tmp_path / "log").channels.values()
    assert (channel.name, channel.unit, channel.y.tolist()) == ("Krängung", "°", [1.5, -2.5])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t," + ",".join("u" * 20_000) + "\n" + "0," * 20_000 + "0\n", "20001 columns, where no"),
        ("t,u\n" + "," * 500_000 + "\n", "a header but no rows"),
        ("t,u\n1" + "," * 500_000 + "\n", "line 2: 500001 fields where the header has 2"),
        ("t,u\n" + '"' * 400_001, "look for a stray quote"),
        ("t,u\n9999-12-31T23:59:59Z,1\n", "'9999-12-31T23:59:59Z' is out of range"),
    ],
    ids=["wide", "separators", "long row", "quotes", "late"],
)
def test_texts_made_to_do_harm(tmp_path, text, message):
    (tmp_path / "log").write_text(text)
    assert message in refused(tmp_path / "log")


def test_wide_text_that_was_cut_in_a_character(tmp_path):
    raw = "t\tu\r\n0\t1,5\r\n1\t2,5\r\n2\t".encode("utf-16")
    (tmp_path / "log").write_bytes(raw + b"3")
    recording = read(tmp_path / "log")
    assert recording.channels["u"].y.tolist()[:2] == [1.5, 2.5]


def test_a_file_of_several_pieces_keeps_its_kinds(tmp_path):
    """A column that is numbers for many rows and then text is an error at its line."""
    lines = [f"{i},{i}\n" for i in range(200_000)] + ["200000,AUTO\n"]
    (tmp_path / "log").write_text("t,u\n" + "".join(lines))
    assert "line 200002, column 'u': 'AUTO' where a number" in refused(tmp_path / "log")


def test_names_and_units_say_the_quantity(tmp_path):
    text = "t,Rudder [deg],ROT [deg/min],p,u [m/s],heel,roll,heading [m/s]\n" + "0,1,2,3,4,5,6,7\n"
    (tmp_path / "log").write_text(text)
    found = {name: c.quantity for name, c in read(tmp_path / "log").channels.items()}
    assert found == {
        "Rudder": "delta", "ROT": "r", "u": "u",
        "p": None, "heel": None, "roll": None, "heading": None,
    }  # fmt: skip


def test_damage_gives_one_line_or_what_is_intact(tmp_path):
    """Bits turned, cut, doubled: nothing but LogError, and packed data never come out wrong."""
    rng = np.random.default_rng(4)
    for form in write_tables.FORMATS:
        written = form.write(tmp_path / form.name, SERIES)
        raw = (tmp_path / form.name).read_bytes()
        for _ in range(25):
            path = tmp_path / "damaged"
            path.write_bytes(damaged(raw, rng))
            found = outcome(path, written.aids)
            if isinstance(found, str):
                assert "\n" not in found
            elif form.name in ("mat5", "xlsx"):
                _, true = outcome(tmp_path / form.name, written.aids)
                assert found[1].items() <= true.items()


def test_a_damaged_variable_takes_no_other_with_it(tmp_path):
    write_tables.matlab_5(tmp_path / "log", SERIES)
    raw = (tmp_path / "log").read_bytes()
    (tmp_path / "log").write_bytes(raw[:-600])
    recording = read(tmp_path / "log")
    assert recording.remarks == ("recovered 5 of about 6 variables, the others are damaged",)
    np.testing.assert_allclose(recording.channels["phi"].y, np.degrees(SERIES["phi"][1]))


def test_an_excel_file_that_unpacks_to_too_much(tmp_path, monkeypatch):
    write_tables.excel(tmp_path / "log", SERIES)
    monkeypatch.setattr("trialid.ingest.tables.excel.excel_guard.MOST_BYTES", 50_000)
    assert "unpacks to more than 0 MB" in refused(tmp_path / "log")


def test_an_excel_file_that_lies_about_its_size(tmp_path, monkeypatch):
    """Megabytes of blanks that the directory gives as ten bytes."""
    monkeypatch.setattr("trialid.ingest.tables.excel.excel_guard.MOST_BYTES", 20_000_000)
    with zipfile.ZipFile(tmp_path / "log", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", "<a/>")
        with archive.open("xl/worksheets/sheet1.xml", "w", force_zip64=False) as member:
            for _ in range(25):
                member.write(b" " * 1_000_000)
    raw = bytearray((tmp_path / "log").read_bytes())
    at = raw.rindex(b"PK\x01\x02")
    raw[at + 24 : at + 28] = (10).to_bytes(4, "little")
    (tmp_path / "log").write_bytes(raw)
    assert len(raw) < 1_000_000
    assert "unpacks to more than 20 MB" in refused(tmp_path / "log")


def test_one_stray_cell_at_the_far_end_of_a_sheet(tmp_path):
    book = openpyxl.Workbook()
    book.active["A1"], book.active["XFD1048576"] = "t", 1
    book.save(tmp_path / "log.xlsx")
    message = refused(tmp_path / "log.xlsx")
    assert "reaches to row 1048576, column 16384, 17179869184 cells; no more than 2 mil" in message


def test_a_formula_is_not_run(tmp_path):
    book = openpyxl.Workbook()
    for row in (["t", "u"], [0, '=HYPERLINK("http://example.org")'], [1, 2.5]):
        book.active.append(row)
    book.save(tmp_path / "log.xlsx")
    np.testing.assert_array_equal(read(tmp_path / "log.xlsx").channels["u"].y, [np.nan, 2.5])


def test_several_sheets_are_asked_about(tmp_path):
    book = openpyxl.Workbook()
    for sheet in (book.active, book.create_sheet("Run 2")):
        for row in (["t", "u"], [0, 1], [1, 2]):
            sheet.append(row)
    book.save(tmp_path / "log.xlsx")
    message = refused(tmp_path / "log.xlsx")
    assert "several sheets hold a table: Sheet, Run 2; say which by a template" in message


def test_a_text_among_the_numbers_of_a_sheet_has_its_place(tmp_path):
    book = openpyxl.Workbook()
    for row in (["t", "u"], [0, 1], [], [1, "oops"]):
        book.active.append(row)
    book.save(tmp_path / "log.xlsx")
    assert "sheet 'Sheet', row 4, column 'u': 'oops' where a number" in refused(
        tmp_path / "log.xlsx"
    )


def test_parquet_of_texts_and_lists_gives_its_numbers(tmp_path):
    table = pa.table({
        "t": [0.0, 1.0], "u": pa.array([1, None], pa.int32()), "mode": ["a", "b"],
        "list": [[1.0], [2.0]], "pair": [{"x": 1}, {"x": 2}],
    })  # fmt: skip
    pq.write_table(table, tmp_path / "log")
    recording = read(tmp_path / "log")
    np.testing.assert_array_equal(recording.channels["u"].y, [1, np.nan])
    assert [remark.split(",")[0] for remark in recording.remarks] == [
        "column 'mode' holds string", "column 'list' holds list<element: double>",
        "column 'pair' holds struct<x: int64>",
    ]  # fmt: skip


def test_parquet_of_very_many_rows_is_not_unpacked(tmp_path, monkeypatch):
    monkeypatch.setattr(parquet_log, "MOST_VALUES", 1000)
    write_tables.parquet(tmp_path / "log", SERIES)
    message = refused(tmp_path / "log")
    assert "600 rows of 6 columns are more than 0 million numbers; name fewer channels" in message
    monkeypatch.setattr(parquet_log, "MOST_VALUES", 1200)
    assert list(read(tmp_path / "log", ["phi"]).channels) == ["phi"]


def test_hdf5_that_declares_more_than_is_there(tmp_path):
    with h5py.File(tmp_path / "log", "w") as file:
        file["t"] = np.arange(10.0)
        file["u"] = np.arange(10.0)
        file.create_dataset("huge", (10**12,), "f8", chunks=(1000,))
    recording = read(tmp_path / "log")
    assert list(recording.channels) == ["u"]
    assert "recovered 2 of 3 arrays; huge declares 8000000000000 bytes" in recording.remarks[0]


def test_hdf5_that_points_to_other_files_is_not_followed(tmp_path):
    with h5py.File(tmp_path / "other", "w") as file:
        file["secret"] = np.arange(10.0)
    with h5py.File(tmp_path / "log", "w") as file:
        file["t"] = np.arange(10.0)
        file["out"] = h5py.ExternalLink(str(tmp_path / "other"), "secret")
        file["loop"] = file["/"]
    assert read(tmp_path / "log").channels == {}


def test_a_matlab_variable_that_declares_more_than_is_there(tmp_path):
    with (tmp_path / "log").open("wb") as file:
        scipy.io.savemat(file, {"t": np.arange(9.0), "u": np.arange(9.0)})
    raw = bytearray((tmp_path / "log").read_bytes())
    at = raw.rindex((9).to_bytes(4, "little"))
    raw[at : at + 4] = (2**31 - 1).to_bytes(4, "little")
    (tmp_path / "log").write_bytes(raw)
    assert read(tmp_path / "log").channels == {}


def test_structs_matrices_and_other_lengths_of_matlab(tmp_path):
    struct = {"t": np.arange(5.0), "roll": np.arange(5.0), "xy": np.ones((5, 2)), "L": [1.0, 2.0]}
    with (tmp_path / "log").open("wb") as file:
        scipy.io.savemat(file, {"trial": struct, "x": np.arange(7.0), "name": "zigzag"})
    recording = read(tmp_path / "log")
    assert list(recording.channels) == ["trial.roll", "trial.xy[0]", "trial.xy[1]"]
    assert recording.remarks == ("not as long as the time, left out: trial.L",)
    assert recording.channels["trial.roll"].quantity == "phi"


def test_matlab_objects_are_asked_for_as_plain_arrays(tmp_path):
    with h5py.File(tmp_path / "log", "w") as file:
        file["roll"] = np.arange(5.0)
        file["Time"] = np.arange(6, dtype=np.uint32)
        file["Time"].attrs["MATLAB_object_decode"] = np.int32(3)
    message = refused(tmp_path / "log")
    assert (
        "Time can only be read by MATLAB itself; save plain arrays, as in t = seconds(" in message
    )


@pytest.mark.parametrize("form", ["xlsx", "parquet", "mat73"])
def test_without_the_package_it_is_said_how_to_have_it(tmp_path, form, monkeypatch):
    writer = next(one for one in write_tables.FORMATS if one.name == form)
    writer.write(tmp_path / "log", SERIES)
    module = {"xlsx": "python_calamine", "parquet": "pyarrow", "mat73": "h5py"}[form]
    monkeypatch.setitem(sys.modules, module, None)
    message = refused(tmp_path / "log")
    assert f"needs the package {module}" in message
    assert message.endswith("run: pip install 'trialid[tables]'")
    with pytest.raises(LogError):
        packages.require(module, tmp_path, "this")


@forms
def test_exactly_one_adapter_recognises_each(tmp_path, form):
    form.write(tmp_path / "log", SERIES)
    head = (tmp_path / "log").read_bytes()[: ingest.HEAD]
    able = [one for one in ingest.ADAPTERS if one.recognises(head)]
    by_template = [one for one in ingest.ADAPTERS if one.by_template and one.by_template(head)]
    assert len([one for one in by_template if not one.general] or by_template) == 1
    assert able in (by_template[:1], []) or form.name == "german_csv"


def test_pandas_reads_the_same_numbers(tmp_path):
    rng = np.random.default_rng(3)
    path = tmp_path / "log"
    table = pd.DataFrame({"t": T, **{f"c{i}": rng.normal(size=len(T)) for i in range(4)}})
    table.to_csv(path, index=False)
    channels = read(path).channels
    for name in channels:
        np.testing.assert_array_equal(channels[name].y, table[name])
