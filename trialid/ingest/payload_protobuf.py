"""Protobuf payloads, decoded by the classes the log's own schema describes."""

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from trialid.ingest.payload import (
    LONGEST_ARRAY,
    STAMP_FIELDS,
    Columns,
    Decoder,
    Fields,
    Keep,
    Payloads,
    collect,
    labels,
    nanoseconds,
)

if TYPE_CHECKING:
    from mcap.records import Schema

TIME = "google.protobuf.Timestamp"
NO_NUMBERS = frozenset({TIME, "google.protobuf.Duration"})


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

    def columns(payloads: Payloads, keep: Keep) -> Columns:
        return collect(payloads, decode, (DecodeError,), keep)

    return columns


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
