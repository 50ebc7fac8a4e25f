"""Measured, predicted and residual laid over one another in an MCAP file for plot tools.

Protobuf with its descriptor inside: Foxglove and PlotJuggler show typed columns without any
plug-in, which JSON messages do not give them (`formats.md` 1.6 of the design).
"""

import json
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from operator import attrgetter
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from trialid.report import labels
from trialid.report.series import TrialSeries
from trialid.trial import Vector

if TYPE_CHECKING:
    from google.protobuf.message import Message
    from mcap.writer import Writer

CHUNK = 64 * 1024
"""Small chunks: what is left of a damaged file is what stands in whole chunks."""

_ROLES = {
    "measured": attrgetter("observed"),
    "predicted": attrgetter("predicted"),
    "residual": attrgetter("residual"),
}


@dataclass(frozen=True)
class Track:
    """One topic: when [ns] and what, field name to values in SI."""

    topic: str
    message: str
    t: NDArray[np.int64]
    fields: Mapping[str, Vector]


def write_mcap(path: str | Path, result: Mapping[str, Any], series: Sequence[TrialSeries]) -> None:
    """The series as protobuf messages, the run's manifest as metadata, its result attached.

    Log time is trial time from zero, so that the trials of a run lie over one another. A sample
    inside a gap is NaN.
    """
    tracks = [
        track for each in zip(series, _topics(series), strict=True) for track in _tracks(*each)
    ]
    with Path(path).open("wb") as stream:
        _write(stream, result, tracks)


def _topics(series: Sequence[TrialSeries]) -> list[str]:
    """One topic stem a trial, of letters plot tools take in an expression."""
    stems: list[str] = []
    for trial in series:
        stem = re.sub(r"[^\w-]", "_", trial.name, flags=re.ASCII) or "_"
        while stem in stems:
            stem += "_"
        stems.append(stem)
    return stems


def _tracks(trial: TrialSeries, stem: str) -> Iterator[Track]:
    t = np.rint(trial.t * 1e9).astype(np.int64)
    if len(t) and t.min() < 0:
        # MCAP times are unsigned, and its writer loses the whole file over one negative time.
        raise ValueError(f"trial {trial.name!r} has samples before its time zero")
    topic = f"/trialid/{stem}/"
    yield Track(topic + "inputs", "trialid.Inputs", t, _inputs(trial))
    for role, take in _ROLES.items():
        fields = {labels.message_field(output.name): take(output) for output in trial.outputs}
        yield Track(topic + role, "trialid.Outputs", t, fields)


def _inputs(trial: TrialSeries) -> dict[str, Vector]:
    return {labels.message_field(name): values for name, values in trial.inputs.items()}


def _write(stream: BinaryIO, result: Mapping[str, Any], tracks: Sequence[Track]) -> None:
    from mcap.writer import Writer

    writer = Writer(stream, chunk_size=CHUNK)
    writer.start(library=f"trialid {result.get('version') or ''}".strip())
    messages = _messages(tracks)
    channels = _channels(writer, tracks, messages)
    for t, index, message in _in_order(tracks, messages):
        writer.add_message(channels[index], t, message, t)
    writer.add_metadata("trialid", _manifest(result))
    attached = json.dumps(result, ensure_ascii=False, allow_nan=False).encode()
    writer.add_attachment(0, 0, "result.json", "application/json", attached)
    writer.finish()  # type: ignore[no-untyped-call]


def _messages(tracks: Iterable[Track]) -> "dict[str, type[Message]]":
    """Message types by name, each with every field any of its topics has."""
    fields: dict[str, dict[str, None]] = {}
    for track in tracks:
        fields.setdefault(track.message, {}).update(dict.fromkeys(track.fields))
    return {name: _message(name, tuple(each)) for name, each in fields.items()}


def _message(name: str, fields: Sequence[str]) -> "type[Message]":
    """A message type made here and now: a time stamp and one double a field."""
    from google.protobuf import descriptor_pb2, descriptor_pool, message_factory, timestamp_pb2

    stamp = timestamp_pb2.DESCRIPTOR
    package, _, short = name.rpartition(".")
    file = descriptor_pb2.FileDescriptorProto(
        name=f"{name}.proto", package=package, syntax="proto3", dependency=[stamp.name]
    )
    message = file.message_type.add(name=short)
    kind = descriptor_pb2.FieldDescriptorProto
    one = kind.LABEL_OPTIONAL
    time = ".google.protobuf.Timestamp"
    message.field.add(name="timestamp", number=1, label=one, type=kind.TYPE_MESSAGE, type_name=time)
    for place, field in enumerate(fields, start=2):
        message.field.add(name=field, number=place, label=one, type=kind.TYPE_DOUBLE)
    pool = descriptor_pool.DescriptorPool()
    pool.AddSerializedFile(stamp.serialized_pb)
    pool.AddSerializedFile(file.SerializeToString())
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(name))


def _channels(
    writer: "Writer", tracks: Sequence[Track], messages: "Mapping[str, type[Message]]"
) -> list[int]:
    """A channel a track, with the descriptors a reader needs: the time stamp's too."""
    from mcap_protobuf.schema import register_schema

    schemas = {name: register_schema(writer, message) for name, message in messages.items()}
    return [writer.register_channel(t.topic, "protobuf", schemas[t.message]) for t in tracks]


def _in_order(
    tracks: Sequence[Track], messages: "Mapping[str, type[Message]]"
) -> Iterator[tuple[int, int, bytes]]:
    """Log time [ns], track and encoded message of every sample, in the order of time.

    Readers then meet chunks that do not overlap.
    """
    encoded = [_encoded(track, messages[track.message]) for track in tracks]
    times = np.concatenate([track.t for track in tracks] or [np.empty(0, np.int64)])
    owner = np.repeat(np.arange(len(tracks)), [len(track.t) for track in tracks])
    order = np.argsort(times, kind="stable")
    for t, index in zip(times[order].tolist(), owner[order].tolist(), strict=True):
        yield t, index, next(encoded[index])


def _encoded(track: Track, message: "type[Message]") -> Iterator[bytes]:
    names = [field.name for field in message.DESCRIPTOR.fields if field.name != "timestamp"]
    absent = np.full(len(track.t), np.nan)
    columns = [track.fields.get(name, absent).tolist() for name in names]
    one: Any = message()
    for t, *values in zip(track.t.tolist(), *columns, strict=True):
        one.timestamp.seconds, one.timestamp.nanos = divmod(t, 10**9)
        for name, value in zip(names, values, strict=True):
            setattr(one, name, value)
        yield one.SerializeToString()


def _manifest(result: Mapping[str, Any]) -> dict[str, str]:
    """What the file was made from, as the text-to-text table MCAP has for it."""
    keys = ("schema", "version", "pipeline")
    manifest = {key: str(result[key]) for key in keys if result.get(key) is not None}
    for trial in result.get("trials") or ():
        for log in trial.get("logs") or ():
            manifest[f"sha256 {log['path']}"] = str(log.get("sha256") or "")
    return manifest
