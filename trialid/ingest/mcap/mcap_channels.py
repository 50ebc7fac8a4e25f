"""Messages of known sources to channels, whatever kind of file they came from."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from trialid.ingest.adapter import Wanted, is_wanted
from trialid.ingest.bytes.bounds import check_channels
from trialid.ingest.bytes.unaligned import Places
from trialid.ingest.mcap import mcap_meaning
from trialid.ingest.mcap.mcap_names import Source
from trialid.ingest.mcap.mcap_stretches import Stretch
from trialid.ingest.mcap.mcap_topics import Timed, Topic
from trialid.recording import Channel

Share = tuple[Source, Stretch, Places]
"""The messages of a stretch that come from one source."""
Topics = dict[str, dict[tuple[object, ...], tuple[Source, Topic | None]]]
"""By topic and by what tells sources apart; None for a source that is left out."""


def topics(path: Path, shares: Iterable[Share], wanted: Wanted, remarks: list[str]) -> Topics:
    """The topics there are, with their numbers where somebody wants them and they can be read."""
    found: Topics = {}
    fields = 0
    for source, stretch, rows in shares:
        found.setdefault(source.topic, {})
        if source.key not in found[source.topic]:
            found[source.topic][source.key] = (source, topic_of(source, wanted, remarks))
            check_channels(path, len(found))
        topic = found[source.topic][source.key][1]
        if topic is not None:
            fields -= len(topic.fields)
            topic.add(stretch, rows)
            fields += len(topic.fields)
            check_channels(path, fields)
    return found


def topic_of(source: Source, wanted: Wanted, remarks: list[str]) -> Topic | None:
    """Where the messages of the source are collected; None when they are left out."""
    names = _names(source)
    if not any(_topic_asked(name, wanted) for name in names):
        return None
    text = mcap_meaning.text(source)
    if text:
        remarks.append(
            f"{source.topic}: left out, it holds {text} as they came; write them to a file of "
            "their own and give that as a log"
        )
        return None
    try:
        return Topic(source, lambda field: any(is_wanted(f"{n}:{field}", wanted) for n in names))
    except ValueError as error:
        remarks.append(f"{source.topic}: left out, {error}")
        return None


def _names(source: Source) -> tuple[str, str]:
    """What stands before the field in a channel's name: alone on the topic, and among others."""
    kind = mcap_meaning.ros_kind(source.kind) or source.encoding
    return source.topic, f"{source.topic}/{kind}"


def _topic_asked(topic: str, wanted: Wanted) -> bool:
    """True when a channel of the topic may be wanted."""
    channel = f"{topic}:"
    return is_wanted(channel, wanted) or any(want.startswith(channel) for want in wanted or ())


def channels(topics: Topics, remarks: list[str]) -> dict[str, Channel]:
    """One channel a name: a recorder that restarts writes the same topic as a second channel."""
    found: dict[str, Channel] = {}
    for same in topics.values():
        alone = len({_names(source)[1] for source, _ in same.values()}) == 1
        for source, topic in same.values():
            for timed in topic.timed(remarks) if topic else ():
                name = f"{_names(source)[0 if alone else 1]}:{timed.field}"
                part = _channel(name, source, timed)
                first = found.get(name)
                found[name] = part if first is None else _joined(first, part)
    return found


def _channel(name: str, source: Source, timed: Timed) -> Channel:
    what = mcap_meaning.field_meaning(source, timed.field)
    return Channel(
        name=name,
        t=timed.t,
        y=timed.y,
        unit=what.unit,
        clock=timed.clock,
        description=what.description,
        quantity=what.quantity,
        positive=what.positive,
        received=timed.received,
    )


def _joined(first: Channel, then: Channel) -> Channel:
    t, y = np.concatenate([first.t, then.t]), np.concatenate([first.y, then.y])
    clock = first.clock if first.clock == then.clock else f"{first.clock}, {then.clock}"
    received = None
    if first.received is not None or then.received is not None:
        received = np.concatenate(
            [c.t if c.received is None else c.received for c in (first, then)]
        )
    said = (first.description, first.quantity, first.positive, received)
    return Channel(first.name, t, y, first.unit, clock, *said)
