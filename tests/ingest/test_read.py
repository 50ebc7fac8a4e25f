import hashlib

import pytest

from trialid import ingest
from trialid.errors import LogError
from trialid.ingest import Aids, LogFile, adapter, read, read_together

TEXT = "t,u,r\n0,1,2\n1,2,3\n"


def write(path, text=TEXT):
    path.write_text(text)
    return path


def refused(path):
    with pytest.raises(LogError) as caught:
        read(path)
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith(f"{path}: ")
    return str(caught.value)


def test_the_hash_of_the_file_is_in_the_recording(tmp_path):
    path = write(tmp_path / "a.log")
    recording = read(path)
    assert recording.sha256 == hashlib.sha256(path.read_bytes()).hexdigest()
    assert recording.path == path


def test_a_missing_file_names_what_lies_there(tmp_path):
    write(tmp_path / "zigzag20.csv")
    assert "no such file; did you mean 'zigzag20.csv'?" in refused(tmp_path / "zigzag2O.csv")
    assert "no such file; the folder holds: zigzag20.csv" in refused(tmp_path / "other")
    assert "no such file; nor is there a folder" in refused(tmp_path / "no" / "log")


def test_a_folder_names_the_files_in_it(tmp_path):
    for i in range(7):
        write(tmp_path / f"log{i}.csv")
    message = refused(tmp_path)
    assert "is a folder, not a log; name a file in it: log0.csv" in message
    assert "and 2 more" in message


def test_an_empty_file(tmp_path):
    assert "is empty (0 bytes)" in refused(write(tmp_path / "log", ""))


def test_an_unknown_file_shows_its_first_bytes(tmp_path):
    path = tmp_path / "log.mcap"
    path.write_bytes(b"\x7fELF\x02\x01" + bytes(50))
    message = refused(path)
    assert "is none of the formats that are read (MCAP, MAVLink, ROS bags, ULog," in message
    assert "it begins b'\\x7fELF" in message


def test_two_adapters_that_recognise_one_file(tmp_path, monkeypatch):
    other = adapter.Adapter("other", lambda head: True, read, general=True)
    monkeypatch.setattr(ingest, "ADAPTERS", (*ingest.ADAPTERS, other))
    message = refused(write(tmp_path / "log"))
    assert "more than one adapter recognises it (of csv, other)" in message


def test_a_particular_format_goes_before_a_general_one(tmp_path, monkeypatch):
    mine = adapter.Adapter("mine", lambda head: head.startswith(b"t,u"), lambda *asked: asked)
    monkeypatch.setattr(ingest, "ADAPTERS", (*ingest.ADAPTERS, mine))
    path = write(tmp_path / "log")
    assert ingest.adapter_of(path, Aids()) is mine


def test_an_aid_the_format_has_no_use_for(tmp_path):
    path = write(tmp_path / "log")
    with pytest.raises(LogError) as caught:
        read(path, None, Aids(dbc=path))
    assert str(caught.value).startswith(f"{path}: is csv, where dbc is for ")


def test_a_folder_of_logs_is_read_as_its_files(tmp_path):
    write(tmp_path / "b.csv", "t,u\n2,3\n3,4\n")
    write(tmp_path / "a.csv", "t,u\n0,1\n1,2\n")
    (tmp_path / "notes.bin").write_bytes(bytes(9))
    (tmp_path / ".hidden.csv").write_text("t,u\n9,9\n")
    found = read_together([LogFile(tmp_path)], ["u"])
    assert [one.path.name for one in found] == ["a.csv", "b.csv"]


def test_a_folder_without_a_log(tmp_path):
    (tmp_path / "notes.bin").write_bytes(bytes(9))
    with pytest.raises(
        LogError, match=r"no file in this folder is a log; it holds: notes\.bin; a table of"
    ):
        read_together([LogFile(tmp_path)])


def test_a_folder_of_trials_names_its_folders(tmp_path):
    for name in ("b", "a", ".git"):
        (tmp_path / name).mkdir()
    with pytest.raises(LogError, match=r"it holds folders: a, b; name those, a trial each$"):
        read_together([LogFile(tmp_path)])


@pytest.mark.parametrize(
    "head",
    [
        b"\x89MCAP0\r\n\x01",
        b"t,u\n0,1\n",
        b"t;u",
        b"\xef\xbb\xbft,u\n",
        b"(1700000000.0) can0 09F10D00#00\n",
        b" (1700000000.000000)  can0  09F10D00   [2]  00 01\n",
        b"2016-02-28T19:57:02.364Z,2,127250,7,255,8,ff,00,00,00,00,00,00,00\n",
        b"16:29:27.082 R 09F8017F 50 C3 B8 13 47 D8 2B C6\n",
        b"A173321.107 23FF7 1F513 012F3070002F30709F\n",
        b"LOGG\x90\x00\x00\x00",
    ],
)
def test_exactly_one_adapter_recognises_each_format(head):
    assert sum(one.recognises(head) for one in ingest.ADAPTERS) == 1


@pytest.mark.parametrize(
    "head",
    [
        b"",
        b"\x00" * 64,
        b'{"a": 1, "b": 2}\n',
        b"0.0,1.0,2.0\n0.1,1.0,2.0\n",
        b"\xfd\x1c\x00\x00",
    ],
)
def test_what_is_no_table_is_not_taken_for_one(head):
    assert not any(one.recognises(head) for one in ingest.ADAPTERS)


def test_logs_read_together_are_filtered_only_when_all_is_found(tmp_path):
    first = write(tmp_path / "first", "t,u,r\n0,1,2\n1,2,3\n")
    second = write(tmp_path / "second", "t,phi,x\n0,1,2\n1,2,3\n")
    found = read_together([LogFile(first), LogFile(second)], ["u", "phi"])
    assert [list(recording.channels) for recording in found] == [["u"], ["phi"]]
    unfound = read_together([LogFile(first), LogFile(second)], ["u", "psi"])
    assert [list(recording.channels) for recording in unfound] == [["u", "r"], ["phi", "x"]]
