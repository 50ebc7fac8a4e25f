"""What every adapter promises, as checks that its author can run on a log of the format.

from trialid.ingest.contract import broken_promises
assert not broken_promises(ADAPTER, Path("sample.tug"))
"""

import tempfile
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from trialid.errors import LogError
from trialid.ingest import ADAPTERS, HEAD
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids
from trialid.recording import Recording


def broken_promises(adapter: Adapter, log: Path, aids: Aids = NO_AIDS) -> list[str]:
    """What an adapter does not keep on a sound log of its format, in words; empty when all is kept.

    Raises
    ------
    LogError
        The log cannot be read at all.
    """
    head = log.read_bytes()[:HEAD]
    whole = adapter.read(log, None, aids)
    return [
        *_known_by_one(adapter, head),
        *_sound(whole),
        *_same(whole, adapter.read(log, None, aids), "a second reading"),
        *_parts(adapter, log, aids, whole),
        *_damaged(adapter, log, aids),
    ]


def _known_by_one(adapter: Adapter, head: bytes) -> Iterator[str]:
    if not adapter.recognises(head):
        yield "does not recognise its own log by its first bytes"
    others = [a.name for a in ADAPTERS if a is not adapter and not a.general and a.recognises(head)]
    if others and not adapter.general:
        yield f"recognises what {', '.join(others)} recognises too"
    if adapter.recognises(b"") and not adapter.general:
        yield "recognises an empty file"


def _sound(recording: Recording) -> Iterator[str]:
    if not recording.channels:
        yield "finds no channel in a sound log"
    for name, channel in recording.channels.items():
        if channel.name != name:
            yield f"channel {name!r} calls itself {channel.name!r}"
        if channel.t.dtype != np.int64 or channel.y.dtype != np.float64:
            yield f"channel {name!r}: t must be int64 [ns] and y float64"
        if channel.t.shape != channel.y.shape:
            yield f"channel {name!r}: {channel.t.size} stamps for {channel.y.size} values"
        if np.isinf(channel.y).any():
            yield f"channel {name!r}: an infinite value; what is not available is NaN"


def _same(one: Recording, other: Recording, what: str) -> Iterator[str]:
    if list(one.channels) != list(other.channels):
        yield f"{what} gives other channels"
        return
    for name, channel in one.channels.items():
        again = other.channels[name]
        if not (np.array_equal(channel.t, again.t)
                and np.array_equal(channel.y, again.y, equal_nan=True)):  # fmt: skip
            yield f"{what} gives other values of {name!r}"


def _parts(adapter: Adapter, log: Path, aids: Aids, whole: Recording) -> Iterator[str]:
    """A channel asked for alone is the channel of the whole."""
    for name, channel in list(whole.channels.items())[:4]:
        alone = adapter.read(log, [name], aids).channels.get(name)
        if alone is None or not np.array_equal(alone.y, channel.y, equal_nan=True):
            yield f"channel {name!r} asked for alone is another one"


def _damaged(adapter: Adapter, log: Path, aids: Aids) -> Iterator[str]:
    """A log that is cut gives what is intact, or is refused with a line."""
    content = log.read_bytes()
    with tempfile.TemporaryDirectory() as folder:
        for share in (0.9, 0.5, 0.1):
            cut = Path(folder, log.name)
            cut.write_bytes(content[: int(share * len(content))])
            try:
                adapter.read(cut, None, aids)
            except LogError:
                continue
            except (ValueError, LookupError, ArithmeticError, TypeError, OSError) as error:
                yield f"cut to {share:.0%} it raises {type(error).__name__}, not LogError"
