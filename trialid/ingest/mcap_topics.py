"""The messages of one topic, collected stretch by stretch as numbers; payloads are not kept."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from trialid.ingest import mcap_clock, payload_cdr, payload_json, payload_protobuf
from trialid.ingest.mcap_names import Source
from trialid.ingest.mcap_records import Stretch
from trialid.ingest.payload import Columns, Decoder, Keep, Payloads
from trialid.ingest.unaligned import Places

DECODERS = {
    "cdr": payload_cdr.decoder,
    "protobuf": payload_protobuf.decoder,
    "json": payload_json.decoder,
}
"""Message encoding to its decoder."""
STAMP_NAMES = {"cdr": "header stamp", "protobuf": "message timestamp", "json": "message timestamp"}
MOST_FIELDS = 4096
"""Fields of one topic; messages that name new ones without end would fill the memory."""

Times = NDArray[np.int64]


@dataclass(frozen=True)
class Timed:
    """One field of a topic; `received` are log times where `t` are others; (N,) each."""

    field: str
    t: Times
    y: NDArray[np.float64]
    clock: str
    received: Times | None


@dataclass
class Pieces:
    """One field while it is collected; `row` None where all messages of a stretch have it."""

    row: list[Places | None] = field(default_factory=list)
    first: list[int] = field(default_factory=list)
    y: list[NDArray[np.float64]] = field(default_factory=list)
    count: int = 0


class Topic:
    """What one source has sent so far.

    Parameters
    ----------
    source
        Where the messages come from.
    keep
        True for the fields somebody wants.

    Raises ValueError when nobody can decode its messages.
    """

    def __init__(self, source: Source, keep: Keep) -> None:
        self.source = source
        self.keep = keep
        self.decode = _decoder(source)
        self.count = 0
        self.stamped = False
        self.log: list[Times] = []
        self.publish: list[Times] = []
        self.stamp: list[Times] = []
        self.fields: dict[str, Pieces] = {}
        self.undecodable = 0
        self.reason = ""

    def add(self, stretch: Stretch, rows: Places) -> None:
        """Decode these messages of the stretch and keep their numbers."""
        columns = self.decoded(stretch, rows)
        log, publish = stretch.log[rows], stretch.publish[rows]
        self.log.append(log)
        self.publish.append(log if np.array_equal(publish, log) else publish)
        self.stamp.append(columns.stamp)
        self.stamped |= columns.stamped
        self.undecodable += columns.undecodable
        self.reason = self.reason or columns.reason
        self._add_fields(columns, len(rows))
        self.count += len(rows)

    def decoded(self, stretch: Stretch, rows: Places) -> Columns:
        """These messages of the stretch as columns."""
        payloads = Payloads(stretch.data, stretch.payload[rows], stretch.size[rows])
        return self.decode(payloads, self.keep)

    def _add_fields(self, columns: Columns, count: int) -> None:
        for name, column in columns.fields.items():
            if name not in self.fields and len(self.fields) == MOST_FIELDS:
                continue
            pieces = self.fields.setdefault(name, Pieces())
            pieces.row.append(None if len(column.row) == count else column.row)
            pieces.first.append(self.count)
            pieces.y.append(column.y)
            pieces.count += len(column.y)

    def timed(self, remarks: list[str]) -> Iterator[Timed]:
        """The fields with their times, once; what was collected is let go on the way."""
        self._remark(remarks)
        name = STAMP_NAMES[self.source.encoding]
        log, publish, stamp = self._times()
        t, good, clock = mcap_clock.measured(stamp, publish, log, name, stamped=self.stamped)
        received = None if np.array_equal(t, log) else log
        del publish, stamp
        if not good.all():
            left_out = f"{np.sum(~good)} messages without a usable {name} left out"
            remarks.append(f"{self.source.topic}: {left_out}")
        while self.fields:
            field_name = next(iter(self.fields))
            row, y = _row(self.fields[field_name], self.count), _y(self.fields.pop(field_name))
            if row is None and not good.all():
                row = np.arange(self.count)
            if row is None:
                yield Timed(field_name, t, y, clock, received)
            else:
                kept = good[row]
                at = row[kept]
                late = None if received is None else received[at]
                yield Timed(field_name, t[at], y[kept], clock, late)

    def _times(self) -> tuple[Times, Times, Times]:
        """Log and publish times and stamps; the first two are one array where they are equal."""
        same = all(p is log for p, log in zip(self.publish, self.log, strict=True))
        log = _joined(self.log)
        publish = log if same else _joined(self.publish)
        stamp = _joined(self.stamp)
        self.log, self.publish, self.stamp = [], [], []
        return log, publish, stamp

    def _remark(self, remarks: list[str]) -> None:
        topic = self.source.topic
        if self.undecodable:
            bad = f"{self.undecodable} of {self.count} messages"
            remarks.append(f"{topic}: {bad} cannot be decoded ({self.reason})")
        if len(self.fields) == MOST_FIELDS:
            remarks.append(f"{topic}: has more than {MOST_FIELDS} fields, the others are left out")


def _decoder(source: Source) -> Decoder:
    if source.encoding not in DECODERS:
        raise ValueError(f"encoding {source.encoding!r} is none of {', '.join(DECODERS)}")
    decoder: Callable[..., Decoder] = DECODERS[source.encoding]
    return decoder(source.schema)


def _joined(parts: list[NDArray[np.int64]]) -> NDArray[np.int64]:
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


def _row(pieces: Pieces, count: int) -> Places | None:
    """In which of the topic's messages the field stands, None when in all."""
    if pieces.count == count:
        return None
    each = zip(pieces.row, pieces.first, pieces.y, strict=True)
    return np.concatenate([f + (np.arange(len(y)) if r is None else r) for r, f, y in each])


def _y(pieces: Pieces) -> NDArray[np.float64]:
    return np.concatenate(pieces.y)
