"""The messages of one topic, collected stretch by stretch as numbers; payloads are not kept."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.bytes.growing import Growing
from trialid.ingest.bytes.unaligned import Places
from trialid.ingest.mcap import mcap_clock, payload_cdr, payload_json, payload_protobuf
from trialid.ingest.mcap.mcap_names import Source
from trialid.ingest.mcap.mcap_stretches import Stretch
from trialid.ingest.mcap.payload import Column, Columns, Decoder, Keep, Payloads

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
class Collected:
    """One field while it is collected; `row` None as long as all messages have it."""

    y: Growing = field(default_factory=lambda: Growing(np.float64))
    row: Growing | None = None

    def add(self, first: int, messages: int, column: Column) -> None:
        """Add what came with so many messages, of which `first` is the number of the first."""
        if self.row is None and (self.y.count != first or len(column.row) != messages):
            self.row = Growing(np.int64)
            self.row.add(np.arange(self.y.count))
        if self.row is not None:
            self.row.add(first + column.row)
        self.y.add(column.y)

    def rows(self, messages: int) -> Places | None:
        """In which of the topic's messages the field stands; None when in all."""
        if self.row is not None:
            return self.row.array().astype(np.int64, copy=False)
        return None if self.y.count == messages else np.arange(self.y.count)


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
        self.log = Growing(np.int64)
        self.publish: Growing | None = None
        self.stamp: Growing | None = None
        self.fields: dict[str, Collected] = {}
        self.undecodable = 0
        self.reason = ""

    def add(self, stretch: Stretch, rows: Places) -> None:
        """Decode these messages of the stretch and keep their numbers."""
        columns = self.decoded(stretch, rows)
        self._add_times(stretch.log[rows], stretch.publish[rows], columns.stamp)
        self.stamped |= columns.stamped
        self.undecodable += columns.undecodable
        self.reason = self.reason or columns.reason
        self._add_fields(columns, len(rows))
        self.count += len(rows)

    def decoded(self, stretch: Stretch, rows: Places) -> Columns:
        """These messages of the stretch as columns."""
        payloads = Payloads(stretch.data, stretch.payload[rows], stretch.size[rows])
        return self.decode(payloads, self.keep)

    def _add_times(self, log: Times, publish: Times, stamp: Times) -> None:
        """Publish times are kept from where they are others than the log times, stamps if any."""
        if self.publish is None and not np.array_equal(publish, log):
            self.publish = Growing(np.int64)
            self.publish.add(self.log.so_far())
        if self.stamp is None and stamp.any():
            self.stamp = Growing(np.int64)
            self.stamp.add(np.zeros(self.count, np.int64))
        self.log.add(log)
        if self.publish is not None:
            self.publish.add(publish)
        if self.stamp is not None:
            self.stamp.add(stamp)

    def _add_fields(self, columns: Columns, messages: int) -> None:
        for name, column in columns.fields.items():
            if name in self.fields or len(self.fields) < MOST_FIELDS:
                self.fields.setdefault(name, Collected()).add(self.count, messages, column)

    def timed(self, remarks: list[str]) -> Iterator[Timed]:
        """The fields with their times, once; what was collected is let go on the way."""
        self._remark(remarks)
        name = STAMP_NAMES[self.source.encoding]
        log, publish, stamp = self._times()
        t, good, clock = mcap_clock.message_times(stamp, publish, log, name, stamped=self.stamped)
        received = None if np.array_equal(t, log) else log
        del publish, stamp
        if not good.all():
            left_out = f"{np.sum(~good)} messages without a usable {name} left out"
            remarks.append(f"{self.source.topic}: {left_out}")
        while self.fields:
            field_name = next(iter(self.fields))
            collected = self.fields.pop(field_name)
            row, y = collected.rows(self.count), collected.y.array().astype(np.float64, copy=False)
            del collected
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
        log = _times_of(self.log)
        publish = log if self.publish is None else _times_of(self.publish)
        stamp = np.zeros(self.count, np.int64) if self.stamp is None else _times_of(self.stamp)
        self.publish = self.stamp = None
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


def _times_of(grown: Growing) -> Times:
    return grown.array().astype(np.int64, copy=False)
