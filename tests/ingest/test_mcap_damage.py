import io

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer
from sample_writers import write_logs

from trialid.errors import LogError
from trialid.ingest import read
from trialid.ingest.mcap.mcap_damage import span_words

START = 1_700_000_000_000_000_000
COUNT = 600
TOPIC = "/x"
T = START + np.arange(COUNT, dtype=np.int64) * 10_000_000
Y = np.random.default_rng(3).normal(size=COUNT)
TRUE = dict(zip(T.tolist(), Y.tolist(), strict=True))


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A log of many small chunks, as bytes."""
    path = tmp_path_factory.mktemp("whole") / "log"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(write_logs, "CHUNK_SIZE", 2048)
        write_logs.write_json_mcap(path, {TOPIC: (T, Y)})
    return path.read_bytes()


def unchunked(path, *, data_crc):
    with path.open("wb") as file:
        writer = Writer(file, use_chunking=False, enable_data_crcs=data_crc)
        writer.start()
        channel = writer.register_channel(TOPIC, "json", 0)
        for t, y in TRUE.items():
            writer.add_message(channel, t, write_logs._json(t, y), t)
        writer.finish()
    return path


def damaged(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("damaged") / "log"
    path.write_bytes(content)
    return path


def read_or_nothing(path):
    """The samples a damaged log gives, and its remarks; nothing where it is refused."""
    try:
        recording = read(path)
    except LogError as error:
        return {}, (str(error),)
    channel = recording.channels.get(f"{TOPIC}:value")
    if channel is None:
        return {}, recording.remarks
    assert len(set(channel.t.tolist())) == len(channel.t)
    return dict(zip(channel.t.tolist(), channel.y.tolist(), strict=True)), recording.remarks


def middle_of_chunk(whole, number):
    chunk = make_reader(io.BytesIO(whole)).get_summary().chunk_indexes[number]
    return chunk.chunk_start_offset + chunk.chunk_length // 2


def test_the_whole_log_is_whole(whole, tmp_path_factory):
    found, remarks = read_or_nothing(damaged(tmp_path_factory, whole))
    assert found == TRUE
    assert remarks == ()


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.floats(0.0, 0.999))
def test_a_log_cut_short_gives_everything_before_the_cut(whole, tmp_path_factory, share):
    cut = int(share * len(whole))
    found, remarks = read_or_nothing(damaged(tmp_path_factory, whole[:cut]))
    assert found == dict(list(TRUE.items())[: len(found)])
    complete = cut / len(whole)
    assert len(found) >= (complete - 0.1) * COUNT  # at most the chunk that was being written
    assert remarks


def test_a_cut_says_how_much_was_recovered_and_which_time_is_lost(whole, tmp_path_factory):
    path = damaged(tmp_path_factory, whole[: middle_of_chunk(whole, 5)])
    found, (remark,) = read_or_nothing(path)
    assert "cut short here" in remark
    assert remark.startswith(f"recovered {len(found)} messages, lost 2023-11-14 22:13:20-22:13:21;")


@settings(max_examples=150, deadline=None, derandomize=True)
@given(st.integers(0, 10**9), st.integers(0, 7))
def test_a_flipped_bit_in_a_chunked_log_is_never_read_silently(whole, tmp_path_factory, at, bit):
    content = bytearray(whole)
    content[at % len(whole)] ^= 1 << bit
    found, remarks = read_or_nothing(damaged(tmp_path_factory, bytes(content)))
    assert found.items() <= TRUE.items()
    assert remarks or len(found) == COUNT
    assert not any("\n" in remark for remark in remarks)


def test_damage_in_one_chunk_costs_that_chunk(whole, tmp_path_factory):
    content = bytearray(whole)
    content[middle_of_chunk(whole, 3)] ^= 1
    found, (remark,) = read_or_nothing(damaged(tmp_path_factory, bytes(content)))
    lost = sorted(TRUE.keys() - found.keys())
    assert 0 < len(lost) < 0.1 * COUNT
    span = span_words(lost[0], lost[-1])
    assert remark.startswith(f"recovered {len(found)} of {COUNT} messages, lost {span}; damaged at")
    assert "the checksum of the chunk is wrong" in remark


def test_damage_in_the_first_chunk_takes_the_names_from_the_summary(whole, tmp_path_factory):
    content = bytearray(whole)
    content[middle_of_chunk(whole, 0)] ^= 1
    found, _ = read_or_nothing(damaged(tmp_path_factory, bytes(content)))
    assert 0.9 * COUNT < len(found) < COUNT


def test_messages_without_a_checksum_are_read_and_said_to_have_none(tmp_path):
    found, remarks = read_or_nothing(unchunked(tmp_path / "log", data_crc=False))
    assert found == TRUE
    assert remarks == ("the messages carry no checksum: damage inside them would not be seen",)


def test_the_checksum_of_an_unchunked_log_is_checked(tmp_path):
    path = unchunked(tmp_path / "log", data_crc=True)
    assert read_or_nothing(path) == (TRUE, ())
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    found, remarks = read_or_nothing(path)
    assert found == {}
    assert "the checksum of all messages is wrong" in remarks[0]


@pytest.mark.parametrize("compression", list(CompressionType))
def test_every_compression_is_read(tmp_path, compression):
    path = tmp_path / "log"
    with path.open("wb") as file:
        writer = Writer(file, compression=compression)
        writer.start()
        channel = writer.register_channel(TOPIC, "json", 0)
        for t, y in TRUE.items():
            writer.add_message(channel, t, write_logs._json(t, y), t)
        writer.finish()
    assert read_or_nothing(path) == (TRUE, ())


def test_a_recorder_that_died_between_two_chunks(whole, tmp_path_factory):
    content = whole[: whole.index(b"\x0f\x04\x00\x00\x00\x00\x00\x00\x00")]  # before DataEnd
    found, (remark,) = read_or_nothing(damaged(tmp_path_factory, content))
    assert found == TRUE
    assert "the closing record is missing, the recorder may have died" in remark
