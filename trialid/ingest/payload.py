"""Messages of one topic as columns of numbers: what every decoder of payloads gives."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

LONGEST_ARRAY = 64
"""Longer arrays are pictures and point clouds, not channels; they are left out."""

STAMP_FIELDS = ("header.stamp", "stamp", "timestamp")
"""Where a message keeps the time of its measurement."""


@dataclass(frozen=True)
class Column:
    """One numeric field: its values, and in which messages it stood; (n,) each, n <= N."""

    row: NDArray[np.intp]
    y: NDArray[np.float64]


@dataclass(frozen=True)
class Columns:
    """The N messages of one topic, decoded.

    Parameters
    ----------
    stamp
        The time the message itself states [ns], 0 where it states none; (N,).
    fields
        Dotted field name to its column: `angular_velocity.z`, `position[0]`.
    undecodable
        How many messages could not be decoded, and why the first of them could not.
    """

    stamp: NDArray[np.int64]
    fields: dict[str, Column]
    undecodable: int = 0
    reason: str = ""


Keep = Callable[[str], bool]
"""True for a field name somebody wants."""

Decoder = Callable[[Sequence[bytes], Keep], Columns]
"""Payloads of one topic and the wanted fields to columns."""

Fields = Iterable[tuple[str, float]]


def nanoseconds(seconds: int, nanos: int) -> int:
    """A stamp in two parts as one [ns]; 0, no stamp, when it does not fit 64 bits."""
    stamp = seconds * 1_000_000_000 + nanos
    return stamp if 0 < stamp < 2**63 else 0


def collect(
    payloads: Sequence[bytes],
    decode: Callable[[bytes], tuple[int, Fields]],
    failures: tuple[type[Exception], ...],
    keep: Keep,
) -> Columns:
    """Columns from a decoder that gives stamp and fields of one message at a time."""
    stamp = np.zeros(len(payloads), np.int64)
    found: dict[str, tuple[list[int], list[float]]] = {}
    errors: list[str] = []
    for row, payload in enumerate(payloads):
        try:
            stamp[row], fields = decode(payload)
            _note(found, row, [pair for pair in fields if keep(pair[0])])
        except failures as error:
            errors.append(str(error) or type(error).__name__)
    columns = {name: Column(np.array(rows), np.array(y)) for name, (rows, y) in found.items()}
    return Columns(stamp, columns, len(errors), errors[0] if errors else "")


def _note(found: dict[str, tuple[list[int], list[float]]], row: int, fields: Fields) -> None:
    for name, value in fields:
        rows, values = found.setdefault(name, ([], []))
        rows.append(row)
        values.append(float(value))
