"""The checks that an author of an adapter runs: ours keep them, and each broken promise is told."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from trialid.errors import LogError
from trialid.ingest import adapter_of
from trialid.ingest.contract import broken_promises
from trialid.recording import Channel, Recording

SAMPLES = Path(__file__).parents[2] / "sample_data" / "hidden_effect"


@pytest.mark.parametrize("log", sorted(SAMPLES.iterdir()), ids=lambda log: log.name)
def test_ours_keep_them(log: Path) -> None:
    assert broken_promises(adapter_of(log), log) == []


def channels(y: np.ndarray) -> dict[str, Channel]:
    return {"x": Channel("x", np.arange(y.size, dtype=np.int64), y)}


def broken(tmp_path: Path, **how) -> list[str]:
    """What is said of an adapter that reads bytes as numbers, with one thing wrong."""
    log = tmp_path / "a.odd"
    log.write_bytes(b"ODD1" + bytes(range(100)))

    def read(path, wanted, aids):
        y = np.frombuffer(path.read_bytes()[4:], dtype=np.uint8).astype(float)
        return Recording(path, "0", "odd", channels(y))

    sound = replace(
        adapter_of(SAMPLES / "zigzag-15.csv"),
        name="odd", general=False, recognises=lambda head: head.startswith(b"ODD1"), read=read,
    )  # fmt: skip
    return broken_promises(replace(sound, **how), log)


def test_a_plain_one_keeps_them(tmp_path: Path) -> None:
    assert broken(tmp_path) == []


def reading(make):
    return lambda path, wanted, aids: Recording(path, "0", "odd", make(path, wanted))


COUNT = iter(range(1000))


@pytest.mark.parametrize(
    ("how", "said"),
    [
        ({"recognises": lambda head: False}, "does not recognise its own log"),
        ({"recognises": lambda head: True}, "recognises an empty file"),
        ({"read": reading(lambda p, w: {})}, "finds no channel"),
        ({"read": reading(lambda p, w: channels(np.array([np.inf])))}, "an infinite value"),
        ({"read": reading(lambda p, w: channels(np.array([float(next(COUNT))])))}, "a second"),
        ({"read": reading(lambda p, w: channels(np.zeros(1 if w else 2)))}, "asked for alone"),
        (
            {"read": reading(lambda p, w: channels(np.array([float(p.read_bytes()[100])])))},
            "raises IndexError, not LogError",
        ),
    ],
)
def test_each_broken_promise_is_told(tmp_path: Path, how: dict, said: str) -> None:
    assert any(said in words for words in broken(tmp_path, **how))


def test_a_log_that_cannot_be_read_is_no_broken_promise(tmp_path: Path) -> None:
    def read(path, wanted, aids):
        raise LogError("nothing")

    with pytest.raises(LogError, match="nothing"):
        broken(tmp_path, read=read)
