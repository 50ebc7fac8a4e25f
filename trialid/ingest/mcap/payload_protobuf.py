"""Protobuf payloads, decoded by the types the log's own schema describes.

Messages of single numbers, as Keelson's, are laid out and their columns lifted at once; whatever
has no layout the library parses one by one, and the tests hold the one to the other.
"""

import dataclasses
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from trialid.ingest.bytes.unaligned import Places
from trialid.ingest.mcap import protobuf_layout
from trialid.ingest.mcap.payload import (
    LONGEST_ARRAY,
    STAMP_FIELDS,
    Columns,
    Decoder,
    Fields,
    Keep,
    Lifted,
    Payloads,
    as_float,
    collect,
    labels,
    nanoseconds,
    of_equal_size,
)
from trialid.ingest.mcap.protobuf_layout import Layout, Unusual

if TYPE_CHECKING:
    from google.protobuf.descriptor import Descriptor
    from mcap.records import Schema

TIME = "google.protobuf.Timestamp"
NO_NUMBERS = frozenset({TIME, "google.protobuf.Duration"})
KNOWN_LAYOUTS = 64
"""Layouts of one length that are kept for the next stretch of the log."""
LATEST_S = 9_223_372_036
"""Seconds that still fit 64 bits of nanoseconds."""


def decoder(schema: "Schema | None") -> Decoder:
    """A decoder of the messages `schema` describes; ValueError when it describes none."""
    from google.protobuf.message import DecodeError
    from mcap.exceptions import McapError
    from mcap_protobuf.decoder import DecoderFactory

    try:
        parse = DecoderFactory().decoder_for("protobuf", schema)
    except (McapError, DecodeError, TypeError, KeyError) as error:
        raise ValueError(f"its schema cannot be used: {error}") from error
    if parse is None:
        raise ValueError("its schema is missing")

    def decode(payload: bytes) -> tuple[int, Fields]:
        message = parse(payload)
        return _stamp(message), _leaves(message, "")

    def one_by_one(payloads: Payloads, keep: Keep) -> Columns:
        return collect(payloads, decode, (DecodeError,), keep)

    descriptor = parse(b"").DESCRIPTOR
    if not protobuf_layout.lays_out(descriptor):
        return one_by_one
    return _laid_out(descriptor, one_by_one)


def _laid_out(descriptor: "Descriptor", one_by_one: Decoder) -> Decoder:
    """A decoder that lifts what has a layout, and leaves the rest to the one that parses."""
    known: dict[int, list[Layout]] = {}
    time = _time_path(descriptor)
    hidden = tuple(_hidden(descriptor, ""))

    def columns(payloads: Payloads, keep: Keep) -> Columns:
        lifted = Lifted(len(payloads))
        left = [
            _lift(
                lifted=lifted,
                payloads=payloads,
                rows=rows,
                known=known,
                descriptor=descriptor,
                time=time,
                keep=_Kept(keep, hidden),
            )
            for rows in of_equal_size(payloads.size)
        ]
        rest = np.sort(np.concatenate(left)) if left else np.zeros(0, np.int64)
        if len(rest):
            some = Payloads(payloads.data, payloads.at[rest], payloads.size[rest])
            lifted.add(rest, one_by_one(some, keep))
        return lifted.columns()

    return columns


@dataclasses.dataclass(frozen=True)
class _Kept:
    """Fields somebody wants that are not parts of a time."""

    keep: Keep
    hidden: tuple[str, ...]

    def __call__(self, path: str) -> bool:
        return not path.startswith(self.hidden) and self.keep(path)


def _lift(
    lifted: Lifted,
    payloads: Payloads,
    rows: Places,
    known: dict[int, list[Layout]],
    descriptor: "Descriptor",
    time: str | None,
    keep: Keep,
) -> Places:
    """Lift messages of one size; the rows that have no layout."""
    layouts = known.setdefault(int(payloads.size[rows[0]]), [])
    odd: list[int] = []
    for layout in tuple(layouts):
        rows = _lift_alike(lifted, payloads, rows, layout, time, keep)
    while len(rows):
        at, size = int(payloads.at[rows[0]]), int(payloads.size[rows[0]])
        try:
            layout = protobuf_layout.layout(descriptor, payloads.data[at : at + size].tobytes())
        except Unusual:
            odd.append(int(rows[0]))
            rows = rows[1:]
            continue
        if len(layouts) == KNOWN_LAYOUTS:
            return np.concatenate([np.array(odd, np.int64), rows])
        layouts.append(layout)
        rows = _lift_alike(lifted, payloads, rows, layout, time, keep)
    return np.array(odd, np.int64)


def _lift_alike(
    lifted: Lifted,
    payloads: Payloads,
    rows: Places,
    layout: Layout,
    time: str | None,
    keep: Keep,
) -> Places:
    """Lift messages of one layout; the rows that are of another."""
    if not len(rows):
        return rows
    same = layout.share(payloads.data, payloads.at[rows])
    alike, at = rows[same], payloads.at[rows[same]]
    if len(alike):
        parts = {"seconds": np.zeros(len(at), np.int64), "nanos": np.zeros(len(at), np.int64)}
        for leaf in layout.leaves:
            of, _, name = leaf.path.rpartition(".")
            if time is not None and of == time:
                parts[name] = protobuf_layout.values(leaf, payloads.data, at).astype(np.int64)
            elif keep(leaf.path):
                y = as_float(protobuf_layout.values(leaf, payloads.data, at))
                lifted.note(leaf.path, alike, y)
        fits = (parts["seconds"] >= 0) & (parts["seconds"] < LATEST_S)
        stamp = np.where(fits, parts["seconds"], 0) * 1_000_000_000 + parts["nanos"]
        lifted.stamp[alike] = np.where(fits, np.maximum(stamp, 0), 0)
    return rows[~same]


def _time_path(descriptor: "Descriptor") -> str | None:
    """The field that holds the message's own time."""
    for path in STAMP_FIELDS:
        inner: Any = descriptor
        for name in path.split("."):
            found = inner.fields_by_name.get(name) if inner else None
            inner = found.message_type if found else None
        if inner is not None and inner.full_name == TIME:
            return path
    return None


def _hidden(descriptor: "Descriptor", prefix: str) -> Iterator[str]:
    """What the fields of times and durations in a message begin with."""
    for field in descriptor.fields:
        inner = field.message_type
        if inner is not None and inner.full_name in NO_NUMBERS:
            yield f"{prefix}{field.name}."
        elif inner is not None:
            yield from _hidden(inner, f"{prefix}{field.name}.")


def _stamp(message: Any) -> int:
    """The message's own time [ns], 0 when it has none."""
    for path in STAMP_FIELDS:
        value = message
        for name in path.split("."):
            value = getattr(value, name, None)
        if getattr(getattr(value, "DESCRIPTOR", None), "full_name", "") == TIME:
            return nanoseconds(getattr(value, "seconds", 0), getattr(value, "nanos", 0))
    return 0


def _leaves(message: Any, prefix: str) -> Iterator[tuple[str, float]]:
    """Numbers in the message; a field that knows it was not set gives none."""
    for field in message.DESCRIPTOR.fields:
        if field.has_presence and not message.HasField(field.name):
            continue
        yield from _numbers(getattr(message, field.name), prefix + field.name)


def _numbers(value: Any, path: str) -> Iterator[tuple[str, float]]:
    if isinstance(value, int | float):
        if not isinstance(value, bool):
            yield path, value
    elif hasattr(value, "DESCRIPTOR"):
        if value.DESCRIPTOR.full_name not in NO_NUMBERS:
            yield from _leaves(value, f"{path}.")
    elif not isinstance(value, str | bytes) and not hasattr(value, "keys"):  # keys: a map
        items = list(value) if len(value) <= LONGEST_ARRAY else []
        called = labels([getattr(item, "name", None) for item in items])
        for i, item in enumerate(items):
            yield from _numbers(item, f"{path}[{called[i] if called else i}]")
