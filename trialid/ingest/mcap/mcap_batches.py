"""How the channels of a large log are shared out among readings that each fit the memory."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

SMALL = 8 * 2**20
"""Bytes of a log that is read whole."""
BUDGET = 160 * 2**20
"""Bytes of numbers in one reading; what is under way while it is read comes on top."""
NUMBER = 8
TIMES = 3
"""Log time, publish time and stamp of every message."""


@dataclass
class Size:
    """How much a topic gives: messages, and numbers of each of its fields.

    `name` is what stands before the field in a channel's name.
    """

    name: str
    messages: int = 0
    fields: dict[str, int] = field(default_factory=dict)

    @property
    def times(self) -> int:
        """Bytes of the times, which every reading of the topic holds."""
        return self.messages * TIMES * NUMBER

    def bytes_of(self, name: str) -> int:
        """Bytes of a field; one that not all messages have holds times of its own."""
        own = 1 if self.fields[name] == self.messages else TIMES + 1
        return self.fields[name] * own * NUMBER


def plan_batches(sizes: Iterable[Size]) -> tuple[tuple[str, ...], ...]:
    """Wanted channels of each reading: whole topics, and parts of those that are too large.

    >>> plan_batches([Size("/a", 9, {"x": 9}), Size("/b", 1, {"y": 1})])
    (('/a:', '/b:'),)
    """
    batches: list[list[str]] = []
    left = 0
    for cost, wants in _parts(sizes):
        if not batches or cost > left:
            batches.append([])
            left = BUDGET
        batches[-1].extend(wants)
        left -= cost
    return tuple(tuple(batch) for batch in batches)


def _parts(sizes: Iterable[Size]) -> Iterator[tuple[int, list[str]]]:
    """Bytes and channels of what is read together."""
    for size in sizes:
        whole = size.times + sum(size.bytes_of(name) for name in size.fields)
        if whole <= BUDGET:
            yield whole, [f"{size.name}:"]
            continue
        cost, wants = size.times, list[str]()
        for name in sorted(size.fields):
            more = size.bytes_of(name)
            if wants and cost + more > BUDGET:
                yield cost, wants
                cost, wants = size.times, []
            cost += more
            wants.append(f"{size.name}:{name}")
        yield cost, wants
