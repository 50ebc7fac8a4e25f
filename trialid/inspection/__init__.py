"""What is in a log: every channel, how healthy its clock is, and which quantity it looks like.

`inspect_log` reads logs of any size, in parts that fit into memory, and keeps no samples.
"""

from collections.abc import Callable, Collection, Iterator, Sequence
from pathlib import Path

from trialid.alignment import frames
from trialid.alignment.clocks import CALENDAR_NS
from trialid.alignment.quality import steps_back
from trialid.errors import LogError
from trialid.ingest import LogFile, adapter_of, files_of
from trialid.ingest.adapter import NO_AIDS, Aids
from trialid.inspection import channels, relations
from trialid.inspection.capital_letters import with_capitals
from trialid.inspection.channel_names import quantity
from trialid.inspection.inspected import ChannelInspection, Inspection, LogFileInspection
from trialid.inspection.speed_letters import axes_words, with_speed_letters
from trialid.inspection.trials_in_folder import follow_one_another

__all__ = ["Inspection", "inspect_log", "inspect_trials"]

A_YEAR_NS = 366 * 86400 * 10**9


def inspect_log(path: Path, aids: Aids = NO_AIDS) -> Inspection:
    """What a log, or a folder of logs that follow one another, holds.

    Raises
    ------
    LogError
        There is no such log, it cannot be read, or it holds no number at all.
    """
    return _together(path, _read(path, aids), aids)


def inspect_trials(
    path: Path, aids: Aids = NO_AIDS, say: Callable[[str], None] = lambda words: None
) -> tuple[Inspection, ...]:
    """The same, of a folder that holds recordings of their own each of its files by itself.

    Files of a folder that cannot be read, beside others that can, are left out; `say` is told why.

    Raises
    ------
    LogError
        As `inspect_log`.
    """
    files = _readable(path, aids, say) if path.is_dir() else _read(path, aids)
    if follow_one_another([found for found, _ in files]):
        return (_together(path, files, aids),)
    return tuple(_together(log.path, [(found, log)], aids) for found, log in files if found)


def _readable(path: Path, aids: Aids, say: Callable[[str], None]) -> "list[File]":
    """Files of a folder: a table of remarks beside logs, or one log that is damaged, stops none.

    Nor does one that is called as the logs are and is none, as an empty one.
    """
    files, errors = list[File](), list[LogError]()
    logs = files_of(LogFile(path, aids))
    called = {one.suffix for one in logs}
    beside = (child for child in path.iterdir() if child.is_file() and child.suffix in called)
    for one in sorted({*logs, *(child for child in beside if child.name[0] != ".")}):
        try:
            files.append(_file(one, aids))
        except LogError as error:
            errors.append(error)
    if not files:
        raise errors[0]
    for left in (*errors, *_below(path, called)):
        say(str(left))
    return files


def _below(path: Path, called: Collection[str]) -> Iterator[str]:
    """Folders in a folder of logs that hold files which are called as these are."""
    for folder in sorted(child for child in path.iterdir() if child.is_dir()):
        if any(one.suffix in called for one in folder.glob("[!.]*")):  # none where unreadable
            yield f"{folder}: folders in a folder are not looked into; name it, too"


File = tuple[list[ChannelInspection], LogFileInspection]


def _read(path: Path, aids: Aids) -> list[File]:
    return [_file(file, aids) for file in files_of(LogFile(path, aids))]


def _together(path: Path, read: Sequence[File], aids: Aids) -> Inspection:
    """Files of one recording."""
    parts: dict[str, list[ChannelInspection]] = {}
    for found, _ in read:
        for one in found:
            parts.setdefault(one.key, []).append(one)
    files = tuple(log for _, log in read)
    if not parts:
        remarks = "; ".join(remark for file in files for remark in file.remarks)
        raise LogError(f"{path}: holds no channel of numbers; {remarks or 'take another log'}")
    together = {key: channels.merge_channels(pieces) for key, pieces in parts.items()}
    known = with_speed_letters(relations.recognise(with_capitals(together)))
    return Inspection(path, files, known, tuple(_warnings(list(known.values()))), aids)


def _file(path: Path, aids: Aids) -> File:
    """One file, in as many readings as its adapter wants."""
    adapter = adapter_of(path, aids)
    found: dict[str, ChannelInspection] = {}
    remarks: dict[str, None] = {}
    digest = ""
    for wanted in adapter.batches(path, aids):
        recording = adapter.read(path, wanted, aids)
        digest = recording.sha256
        remarks |= dict.fromkeys(recording.remarks)
        found |= {one.key: one for one in channels.of_recording(recording)}
    return list(found.values()), LogFileInspection(path, adapter.name, digest, tuple(remarks))


def _warnings(all_of_them: Sequence[ChannelInspection]) -> Iterator[str]:
    """What a person should know before using any channel."""
    yield from _wild_stamps(all_of_them)
    useful = [one for one in all_of_them if one.guess is not None]
    yield from dict.fromkeys(words for one in useful for words in _of_clock(one))
    yield from axes_words({one.key: one for one in all_of_them})
    yield from map(_turns_of_what, filter(_of_some_turns, all_of_them))
    if not useful:
        yield "no channel looks like a ship's motion; map channels by hand in a pipeline"


def _of_some_turns(one: ChannelInspection) -> bool:
    """Whether it is called a shaft's revolutions, in a unit that does not say what turns."""
    shaft = quantity(one.name, None) in ("n", "n_p", "n_s")
    return shaft and one.guess is None and one.unit in frames.TURNS_OF_WHAT


def _turns_of_what(one: ChannelInspection) -> str:
    return (
        f"{one.name}: {one.unit} may be revolutions or radians in a second: map it by hand with "
        'unit = "rps" or unit = "rad/s"'
    )


def _of_clock(one: ChannelInspection) -> Iterator[str]:
    """Warnings about a channel's stamps, which are those of its whole message."""
    name, clock, late = one.message or "the table", one.clock, one.clock.received
    if clock.steps_back:
        yield f"{name}: {steps_back(clock.steps_back, clock.furthest_back)}"
    if late is not None and abs(late.drift) * (one.end - one.start) / 1e9 > 0.1:
        yield f"{name}: its clock drifts by {late.drift * 1e6:.3g} ppm against the recorder's"
    if one.rate and clock.jitter * one.rate > 0.5:
        yield (
            f"{name}: stamps are uneven, {clock.jitter:.3g} s rms in a period of "
            f"{1 / one.rate:.3g} s; times of receipt rather than of measurement?"
        )


def _wild_stamps(all_of_them: Sequence[ChannelInspection]) -> Iterator[str]:
    start = min(one.start for one in all_of_them)
    end = max(one.end for one in all_of_them)
    dated = sum(one.start > CALENDAR_NS for one in all_of_them)
    if 0 < dated < len(all_of_them):
        yield (
            f"{dated} of {len(all_of_them)} channels are dated, the others count from another "
            "start: two clocks"
        )
    elif end - start > A_YEAR_NS:
        yield "the stamps span more than a year; one of them is wild"
