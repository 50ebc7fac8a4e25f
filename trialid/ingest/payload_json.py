"""JSON payloads: every number becomes a field, with or without a schema."""

import json
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from trialid.ingest.payload import (
    LONGEST_ARRAY,
    STAMP_FIELDS,
    Columns,
    Decoder,
    Fields,
    Keep,
    collect,
    nanoseconds,
)

if TYPE_CHECKING:
    from mcap.records import Schema

NANOS = ("nsec", "nanosec", "nanos", "nsecs")


def decoder(schema: "Schema | None") -> Decoder:
    """A decoder of JSON messages; a schema adds nothing that the messages do not say themselves."""
    del schema
    return _columns


def _columns(payloads: Sequence[bytes], keep: Keep) -> Columns:
    return collect(payloads, _decode, (ValueError, OverflowError), keep)


def _decode(payload: bytes) -> tuple[int, Fields]:
    message = json.loads(payload)
    if not isinstance(message, dict):
        raise ValueError("the message is no JSON object")
    return _stamp(message), list(_leaves(message, ""))


def _stamp(message: dict[str, Any]) -> int:
    header = message.get("header")
    inside = header.get("stamp") if isinstance(header, dict) else None
    for stamp in (inside, message.get("stamp"), message.get("timestamp")):
        if isinstance(stamp, int | float) and stamp > 0:
            return nanoseconds(0, round(stamp * 1e9))  # a bare number counts seconds
        if isinstance(stamp, dict) and _is_time(stamp):
            nanos = next(stamp[key] for key in NANOS if key in stamp)
            return nanoseconds(int(_seconds(stamp)), int(nanos))
    return 0


def _seconds(stamp: dict[str, Any]) -> int:
    return next(stamp[key] for key in ("sec", "seconds", "secs") if key in stamp)


def _is_time(value: dict[str, Any]) -> bool:
    return len(value) == 2 and any(k in value for k in NANOS) and bool(_SECONDS & value.keys())


_SECONDS = {"sec", "seconds", "secs"}


def _leaves(value: Any, path: str) -> Iterator[tuple[str, float]]:
    """Numbers below `value`; null is a number that is not available, NaN."""
    if path in STAMP_FIELDS or isinstance(value, bool | str):
        return
    if value is None:
        yield path, float("nan")
    elif isinstance(value, int | float):
        yield path, value
    elif isinstance(value, list):
        for i, item in enumerate(value if len(value) <= LONGEST_ARRAY else ()):
            yield from _leaves(item, f"{path}[{i}]")
    elif not _is_time(value):
        for key, item in value.items():
            yield from _leaves(item, f"{path}.{key}" if path else key)
