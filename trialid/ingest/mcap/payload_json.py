"""JSON payloads: every number becomes a field, with or without a schema.

Elements of a list are called by name where names stand beside it, `{"name": ["rudder"], "position":
[0.1]}` as `position[rudder]`, or in it, `{"joints": [{"name": "rudder", "position": 0.1}]}` as
`joints[rudder].position`; else by their index.
"""

import json
import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

from trialid.ingest.mcap.payload import (
    LONGEST_ARRAY,
    NAMES_FIELDS,
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

NANOS = frozenset({"nsec", "nanosec", "nanos", "nsecs"})
SECONDS = frozenset({"sec", "seconds", "secs"})
NUMBER = (int, float)
NO_NUMBER = (bool, str)
"""A union written out would be made anew for every value of every message."""
FAILURES = (ValueError, OverflowError, RecursionError, TypeError)
"""What unreadable text, absurd numbers and nests without end raise."""


def decoder(schema: "Schema | None") -> Decoder:
    """A decoder of JSON messages; a schema adds nothing that the messages do not say themselves."""
    del schema
    return _columns


def _columns(payloads: Payloads, keep: Keep) -> Columns:
    return collect(payloads, _decode, FAILURES, keep)


def _decode(payload: bytes) -> tuple[int, Fields]:
    message = json.loads(payload)
    if not isinstance(message, dict):
        raise ValueError("the message is no JSON object")
    return _stamp(message), list(_leaves(message, ""))


def _stamp(message: dict[str, Any]) -> int:
    header = message.get("header")
    inside = header.get("stamp") if isinstance(header, dict) else None
    for stamp in (inside, message.get("stamp"), message.get("timestamp")):
        if isinstance(stamp, NUMBER) and 0 < stamp < math.inf:
            return nanoseconds(0, round(stamp * 1e9))  # a bare number counts seconds
        if isinstance(stamp, dict) and _is_time(stamp):
            parts = {key in NANOS: part for key, part in stamp.items()}
            return nanoseconds(int(parts[False]), int(parts[True]))
    return 0


def _is_time(value: dict[str, Any]) -> bool:
    """Whether it is of two parts, seconds and nanoseconds."""
    return len(value) == 2 and not (NANOS.isdisjoint(value) or SECONDS.isdisjoint(value))


def _leaves(value: Any, path: str, names: Sequence[str] = ()) -> Iterator[tuple[str, float]]:
    """Numbers below `value`; null is a number that is not available, NaN."""
    if path in STAMP_FIELDS or isinstance(value, NO_NUMBER):
        return
    if value is None:
        yield path, float("nan")
    elif isinstance(value, NUMBER):
        yield path, value
    elif isinstance(value, list):
        called = names if len(names) == len(value) else _called(value)
        for i, item in enumerate(value if len(value) <= LONGEST_ARRAY else ()):
            yield from _leaves(item, f"{path}[{called[i] if called else i}]")
    elif not _is_time(value):
        naming = (k for k in value if k in NAMES_FIELDS)
        beside = next((n for k in naming if (n := _texts(value[k]))), ())
        for key, item in value.items():
            yield from _leaves(item, f"{path}.{key}" if path else key, beside)


def _texts(value: Any) -> Sequence[str]:
    return (labels(value) or ()) if isinstance(value, list) else ()


def _called(value: list[Any]) -> Sequence[str]:
    """Names the elements of a list have in themselves; none unless all have one."""
    if not value or not isinstance(value[0], dict):
        return ()
    return labels([item.get("name") if isinstance(item, dict) else None for item in value]) or ()
