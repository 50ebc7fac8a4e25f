"""One damaged log: what comes out of it, and what is wrong with that."""

import re
import time
import traceback
import warnings
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from seed_logs import SeedLog  # isort: skip  (it finds the writers)
from damage import damaged
from limits import (
    LONGEST_MESSAGE,
    MOST_MEGABYTES,
    MOST_SECONDS,
    Hang,
    forget_peak,
    peak_memory,
    time_limit,
)
from resealed import resealed
from sentence_checksums import forged

from trialid.alignment import align
from trialid.errors import TrialidError
from trialid.ingest import read
from trialid.ingest.adapter import Aids
from trialid.inspection import inspect_log
from trialid.recording import Channel, Recording
from trialid.report.files.log_data import plain
from trialid.report.terminal.log_contents import inspection

SURVEYED = 4
"""Every so many damaged logs one goes on to the survey and the alignment."""
PERIOD = 0.2

Pair = tuple[int, float]


@dataclass(frozen=True)
class Truth:
    """Samples of the sound log by channel, and which clock their stamps are of."""

    samples: Mapping[str, frozenset[Pair]]
    clocks: Mapping[str, str]

    @property
    def count(self) -> int:
        """Samples in all."""
        return sum(map(len, self.samples.values()))


@dataclass
class Verdict:
    """What became of one damaged log; `complaints` are empty when all is as it must be."""

    outcome: str = "refused"
    seconds: float = 0.0
    megabytes: float = 0.0
    samples: int = 0
    wrong: int = 0
    collisions: int = 0
    complaints: list[str] = field(default_factory=list)


def harmed(seed: SeedLog, others: tuple[bytes, ...], key: tuple[int, ...]) -> bytes:
    """The damaged bytes, by nothing but the seed and the key."""
    rng = np.random.default_rng(key)
    if seed.reseal:
        return resealed(seed.reseal, seed.log, rng)
    whole = seed.log if seed.harmed == "log" else _aid(seed).read_bytes()
    keep = int(rng.choice((0, 16, 200)))
    foreign = seed.covered == "nothing" and rng.random() < 0.5  # what is spliced in is true there
    other = others[int(rng.integers(len(others)))] if foreign else whole
    return damaged(whole, rng, min(keep, len(whole) // 2), seed.likeness, other)


def truth(seed: SeedLog, path: Path) -> Truth:
    """All samples of the sound log."""
    path.write_bytes(seed.log)
    whole = read(path, None, seed.aids)
    return Truth(_samples(whole), {name: one.clock for name, one in whole.channels.items()})


def judged(seed: SeedLog, true: Truth, content: bytes, folder: Path, number: int) -> Verdict:
    """Read the damaged log as a user would, and look at what comes out."""
    path, aids = _placed(seed, content, folder)
    verdict = Verdict()
    forget_peak()
    begin = time.perf_counter()
    try:
        with time_limit(), warnings.catch_warnings():
            warnings.simplefilter("error")
            _read(seed, true, path, aids, content, verdict)
            if number % SURVEYED == 0:
                _look(seed, path, aids, verdict)
    except Hang as hang:
        verdict.complaints.append(f"{_where(hang)}: more than {MOST_SECONDS:g} s")
    except Exception as error:  # noqa: BLE001  what else comes out is what is looked for
        verdict.complaints.append(f"{_where(error)}: {type(error).__name__}: {error}"[:400])
    verdict.seconds = time.perf_counter() - begin
    verdict.megabytes = peak_memory()
    if verdict.megabytes > MOST_MEGABYTES:
        verdict.complaints.append(f"{verdict.megabytes:.0f} MB")
    return verdict


def _where(error: BaseException) -> str:
    """The lines of the package it came through, the last three."""
    frames = traceback.extract_tb(error.__traceback__)
    inside = [
        f"{Path(one.filename).name}:{one.lineno}" for one in frames if "trialid" in one.filename
    ]
    return " ".join(inside[-3:])


def _placed(seed: SeedLog, content: bytes, folder: Path) -> tuple[Path, Aids]:
    path = folder / "harmed"
    if seed.harmed == "log":
        path.write_bytes(content)
        return path, seed.aids
    path.write_bytes(seed.log)
    aid = folder / f"{seed.harmed}.aid"
    aid.write_bytes(content)
    return path, Aids(**{seed.harmed: aid})


def _aid(seed: SeedLog) -> Path:
    aid = getattr(seed.aids, seed.harmed)
    assert isinstance(aid, Path)
    return aid


def _read(
    seed: SeedLog, true: Truth, path: Path, aids: Aids, content: bytes, verdict: Verdict
) -> None:
    try:
        recording = read(path, None, aids)
    except TrialidError as error:
        verdict.complaints += _of_message(str(error), path.parent)
        return
    found = _samples(recording)
    verdict.samples = sum(map(len, found.values()))
    whole = verdict.samples == true.count and not recording.remarks
    verdict.outcome = "whole" if whole else "in part"
    verdict.complaints += _of_recording(recording)
    if seed.covered != "nothing":
        _compare(seed, true, recording, content, verdict)


def _compare(
    seed: SeedLog, true: Truth, recording: Recording, content: bytes, verdict: Verdict
) -> None:
    """Count samples that no original has, as far as a checksum covers them."""
    known = _by_plain_name(true.samples)
    covered = seed.covered
    if seed.open_head and content[: seed.open_head] != seed.log[: seed.open_head]:
        covered = "values"
    channels = recording.channels.items()
    other_clock = {name for name, one in channels if one.clock != true.clocks.get(name)}
    odd = []
    for name, pairs in _by_plain_name(_samples(recording)).items():
        same = known.get(name, frozenset())
        stamped = covered == "pairs" or name.startswith("ATTITUDE")
        stamped &= name not in other_clock  # it takes another and says so
        values = {y for _, y in same}
        wrong = pairs - same if stamped else {one for one in pairs if one[1] not in values}
        verdict.wrong += len(wrong)
        odd += [f"{name} {t} {y}" for t, y in sorted(wrong)[:2]]
    if verdict.wrong and b"*" in seed.log[:400]:
        verdict.collisions = min(verdict.wrong, len(forged(content, seed.log)))
        verdict.wrong -= verdict.collisions
    if verdict.wrong:
        verdict.complaints.append(f"{verdict.wrong} wrong samples: {'; '.join(odd[:3])}")


def _by_plain_name(samples: Mapping[str, frozenset[Pair]]) -> dict[str, frozenset[Pair]]:
    """By names without what no checksum covers: the connection, the number of a restart."""
    found: dict[str, frozenset[Pair]] = {}
    for name, pairs in samples.items():
        bare = re.sub(r"/boot\d+", "", re.sub(r"/[^/:]*\.(?=[A-Z]{2}\b)", "/", name))
        found[bare] = found.get(bare, frozenset()) | pairs
    return found


def _samples(recording: Recording) -> dict[str, frozenset[Pair]]:
    return {name: _pairs(channel) for name, channel in recording.channels.items()}


def _pairs(channel: Channel) -> frozenset[Pair]:
    good = np.isfinite(channel.y)
    return frozenset(zip(channel.t[good].tolist(), channel.y[good].tolist(), strict=True))


def _of_message(message: str, place: Path) -> Iterator[str]:
    if not message.isprintable():
        yield f"a message of several lines or with control characters: {message[:200]!r}"
    if str(place) not in message:
        yield f"a message that names no file: {message[:200]}"
    if len(message) > LONGEST_MESSAGE:
        yield f"a message of {len(message)} letters: {message[:200]}"


def _of_recording(recording: Recording) -> Iterator[str]:
    for remark in recording.remarks:
        if not remark.isprintable() or len(remark) > LONGEST_MESSAGE:
            yield f"a remark of several lines, long or with control characters: {remark[:200]!r}"
    for name, one in recording.channels.items():
        if one.name != name or one.t.dtype != np.int64 or one.y.dtype != np.float64:
            yield f"channel {name!r} is not as agreed"
        if one.t.shape != one.y.shape or one.t.ndim != 1:
            yield f"channel {name!r} has {one.t.shape} stamps of {one.y.shape} values"


def _look(seed: SeedLog, path: Path, aids: Aids, verdict: Verdict) -> None:
    """The survey as `inspect` shows it, and the trial as `align` writes it."""
    from trialid.cli.console import render

    try:
        found = inspect_log(path, aids)
        plain(found)
        text = render(*inspection(found, everything=True), width=160)
    except TrialidError as error:
        verdict.complaints += _of_message(str(error), path.parent)
    else:
        if not text.replace("\n", "").isprintable():
            verdict.complaints.append("control characters on the terminal")
    try:
        align("harmed", "fit", [read(path, None, aids)], seed.sources, PERIOD)
    except TrialidError as error:
        if not str(error).isprintable():
            verdict.complaints.append(f"control characters in a message: {str(error)[:200]!r}")
