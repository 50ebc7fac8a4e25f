"""Messages of one topic as columns of numbers: what every decoder of payloads gives."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.bytes.unaligned import Bytes, Places

LONGEST_ARRAY = 64
"""Longer arrays are pictures and point clouds, not channels; they are left out."""

STAMP_FIELDS = ("header.stamp", "stamp", "timestamp")
"""Where a message keeps the time of its measurement."""

NAMES_FIELDS = frozenset({"name", "joint_names"})
"""Fields of texts that name the elements of the arrays beside them: `position[rudder]`."""


@dataclass(frozen=True)
class Payloads:
    """N payloads that lie in one stretch of bytes: where each begins, and how long it is; (N,)."""

    data: Bytes
    at: Places
    size: Places

    def __len__(self) -> int:
        return len(self.at)

    def each(self) -> Iterator[bytes]:
        """One payload after the other."""
        view = self.data.data
        for at, size in zip(self.at.tolist(), self.size.tolist(), strict=True):
            yield bytes(view[at : at + size])


@dataclass(frozen=True)
class Column:
    """One numeric field: its values, and in which messages it stood; (n,) each, n <= N."""

    row: Places
    y: NDArray[np.float64]


@dataclass(frozen=True)
class Columns:
    """N messages of one topic, decoded.

    Parameters
    ----------
    stamp
        The time the message itself states [ns], 0 where it states none; (N,).
    fields
        Dotted field name to its column: `angular_velocity.z`, `position[0]`, `position[rudder]`.
    stamped
        True when the messages have a place for a stamp, be it empty.
    undecodable
        How many messages could not be decoded, and why the first of them could not.
    """

    stamp: NDArray[np.int64]
    fields: dict[str, Column]
    stamped: bool = False
    undecodable: int = 0
    reason: str = ""


def as_float(values: NDArray[np.generic]) -> NDArray[np.float64]:
    """A copy as float64; a broken number, a signalling NaN among them, is no reason to warn."""
    with np.errstate(invalid="ignore", over="ignore"):
        return values.astype(np.float64)


class Lifted:
    """Columns while they are lifted out of N messages, some messages at a time."""

    def __init__(self, count: int) -> None:
        self.stamp = np.zeros(count, np.int64)
        self.stamped = False
        self.pieces: dict[str, list[Column]] = {}
        self.undecodable = 0
        self.reason = ""

    def note(self, name: str, rows: Places, y: NDArray[np.float64]) -> None:
        """The field's values in the messages of these rows; (n,) each."""
        self.pieces.setdefault(name, []).append(Column(rows, y))

    def failed(self, reason: str) -> None:
        """One message cannot be decoded."""
        self.undecodable += 1
        self.reason = self.reason or reason

    def add(self, rows: Places, columns: Columns) -> None:
        """What was decoded elsewhere of the messages of these rows."""
        self.stamp[rows] = columns.stamp
        self.undecodable += columns.undecodable
        self.reason = self.reason or columns.reason
        for name, column in columns.fields.items():
            self.note(name, rows[column.row], column.y)

    def columns(self) -> Columns:
        """What has been lifted, in the order of the messages."""
        fields = {name: _joined(parts) for name, parts in self.pieces.items()}
        stamped = self.stamped or bool(self.stamp.any())
        return Columns(self.stamp, fields, stamped, self.undecodable, self.reason)


def _joined(parts: list[Column]) -> Column:
    """The pieces of one field in the order of the messages."""
    if len(parts) == 1:
        return parts[0]
    row = np.concatenate([part.row for part in parts])
    order = np.argsort(row, kind="stable")
    return Column(row[order], np.concatenate([part.y for part in parts])[order])


def of_equal_size(size: Places) -> Iterator[Places]:
    """Rows of the messages of one size, in order; one group after the other."""
    if not len(size):
        return
    order = np.argsort(size, kind="stable")
    yield from np.split(order, np.flatnonzero(np.diff(size[order])) + 1)


Keep = Callable[[str], bool]
"""True for a field name somebody wants."""

Decoder = Callable[[Payloads, Keep], Columns]
"""Payloads of one topic and the wanted fields to columns."""

Fields = Iterable[tuple[str, float]]


def nanoseconds(seconds: int, nanos: int) -> int:
    """A stamp in two parts as one [ns]; 0, no stamp, when it does not fit 64 bits."""
    stamp = seconds * 1_000_000_000 + nanos
    return stamp if 0 < stamp < 2**63 else 0


def labels(names: Sequence[object]) -> list[str] | None:
    """The names as what stands between the brackets of a field; None unless all can.

    >>> labels(["rudder", "sail"]), labels(["rudder", "rudder"]), labels(["a[0]"])
    (['rudder', 'sail'], None, None)
    """
    texts = [name for name in names if isinstance(name, str) and name.isprintable()]
    good = [text for text in texts if text.strip() and not set("[]") & set(text)]
    return good if good and len(set(good)) == len(names) else None


def collect(
    payloads: Payloads,
    decode: Callable[[bytes], tuple[int, Fields]],
    failures: tuple[type[Exception], ...],
    keep: Keep,
) -> Columns:
    """Columns from a decoder that gives stamp and fields of one message at a time."""
    stamp = np.zeros(len(payloads), np.int64)
    found: dict[str, tuple[list[int], list[float]] | None] = {}
    errors: list[str] = []
    for row, payload in enumerate(payloads.each()):
        try:
            stamp[row], fields = decode(payload)
            _note(found, row, fields, keep)
        except failures as error:
            errors.append(str(error) or type(error).__name__)
    columns = {
        name: Column(np.array(pair[0], np.int64), np.array(pair[1], np.float64))
        for name, pair in found.items()
        if pair is not None
    }
    stamped = bool(stamp.any())
    return Columns(stamp, columns, stamped, len(errors), errors[0] if errors else "")


def _note(
    found: dict[str, tuple[list[int], list[float]] | None], row: int, fields: Fields, keep: Keep
) -> None:
    """Note the fields somebody wants; None stands for one that nobody does."""
    for name, value in [(name, float(value)) for name, value in fields]:
        if name not in found:
            found[name] = ([], []) if keep(name) else None
        pair = found[name]
        if pair is not None:
            pair[0].append(row)
            pair[1].append(value)
