"""ROS 2 payloads (CDR with `ros2msg` definitions), decoded a stretch of the log at a time.

Messages of one topic mostly have their numbers at the same places. So the first message is walked
field by field to learn the places; all messages with the same length and the same string and array
lengths then share that layout, and numpy lifts the columns out at once. Messages of another layout
are walked in their turn. mcap-ros2-support decodes the same messages one by one; the tests hold
this file to it.

Elements of an array that stands behind a list of names as long as it is are called by name, as in
`sensor_msgs/JointState`: `position[rudder]`. A name lasts, an index holds for one message only.
"""

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from trialid.ingest.bytes.unaligned import Bytes, Places, alike, numbers
from trialid.ingest.mcap.cdr_layout import Layout, Malformed, Walk, full_name, parse_definitions
from trialid.ingest.mcap.payload import (
    Columns,
    Decoder,
    Keep,
    Lifted,
    Payloads,
    as_float,
    of_equal_size,
)

if TYPE_CHECKING:
    from mcap.records import Schema

KNOWN_LAYOUTS = 64
"""Layouts of one length that are kept for the next stretch of the log."""


def decoder(schema: "Schema | None") -> Decoder:
    """A decoder of the messages `schema` describes; ValueError when it is no `ros2msg`."""
    if schema is None or schema.encoding != "ros2msg":
        raise ValueError(f"its schema is {schema.encoding if schema else 'missing'}, not ros2msg")
    root = full_name(schema.name, "")
    definitions = parse_definitions(root, schema.data.decode("utf-8", "replace"))
    known: dict[int, list[Layout]] = {}

    def walk(payload: bytes) -> Layout:
        walk = Walk(definitions, payload)
        walk.message(root, "")
        return walk.layout

    def columns(payloads: Payloads, keep: Keep) -> Columns:
        lifted = Lifted(len(payloads))
        for rows in of_equal_size(payloads.size):
            layouts = known.setdefault(int(payloads.size[rows[0]]), [])
            _lift_all(lifted, payloads, rows, layouts, walk, keep)
        return lifted.columns()

    return columns


def _lift(lifted: Lifted, payloads: Payloads, layout: Layout, rows: Places, keep: Keep) -> None:
    """Lift the wanted columns out of messages of one layout."""
    data, at = payloads.data, payloads.at[rows]
    for offset in layout.stamp[:1]:
        seconds = numbers(data, at + offset, layout.order + "i4").astype(np.int64)
        nanos = numbers(data, at + offset + 4, layout.order + "u4").astype(np.int64)
        lifted.stamp[rows] = seconds * 1_000_000_000 + nanos
        lifted.stamped = True
    for kind, leaves in layout.leaves.items():
        kept = [(name, offset) for name, offset in leaves if keep(name)]
        if kept:
            places = at + np.array([offset for _, offset in kept])[:, None]
            block = numbers(data, places, layout.order + kind)
            for (name, _), y in zip(kept, block, strict=True):
                lifted.note(name, rows, as_float(y))  # a copy: the block can be let go


def _lift_all(
    lifted: Lifted,
    payloads: Payloads,
    rows: Places,
    layouts: list[Layout],
    walk: Callable[[bytes], Layout],
    keep: Keep,
) -> None:
    """Lift messages of one size by the layouts known, and by those learned on the way."""
    for layout in layouts:
        rows = _lift_alike(lifted, payloads, layout, rows, keep)
    while len(rows):
        at, size = int(payloads.at[rows[0]]), int(payloads.size[rows[0]])
        try:
            layout = walk(payloads.data[at : at + size].tobytes())
        except Malformed as error:
            lifted.failed(str(error))
            rows = rows[1:]
            continue
        if len(layouts) < KNOWN_LAYOUTS:
            layouts.append(layout)
        rows = _lift_alike(lifted, payloads, layout, rows, keep)


def _lift_alike(
    lifted: Lifted, payloads: Payloads, layout: Layout, rows: Places, keep: Keep
) -> Places:
    """Lift the messages of this layout; the rows that are of another."""
    if not len(rows):
        return rows
    same = _share(layout, payloads.data, payloads.at[rows])
    if same.any():
        _lift(lifted, payloads, layout, rows[same], keep)
    return rows[~same]


def _share(layout: Layout, data: Bytes, at: Places) -> NDArray[np.bool_]:
    """True for the messages whose lengths and names are those of the layout; (n,)."""
    same = np.ones(len(at), np.bool_)
    for offset, word in layout.words:
        same &= alike(data, at + offset, word)
    if layout.lengths:
        offsets, counts = np.array(layout.lengths).T
        found = numbers(data, at[:, None] + offsets, layout.order + "u4")
        same &= (found == counts).all(axis=1)
    return same
