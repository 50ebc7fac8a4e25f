"""Faults of actuators over all kinds of ships: how often the right one is named, and a wrong one.

    PYTHONPATH=. python tests/actuators/ships/fault_table.py [--records 40] [--first N] [--jobs 2]

writes `tests/benchmarks/results/actuator_faults.md`. A record depends on its ship, its fault and
its seed alone. Seeds below 61200 were looked at while building; those from there on were not.
"""

import argparse
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Final

sys.path.extend(str(Path(__file__).parents[n]) for n in range(3))
sys.path.append(str(Path(__file__).parents[3] / ".ci"))

import faults
import test_otter as otter
import test_twin_rudders as twins
from at_commit import commit_of

from trialid.diagnosis.verdict import Verdict

RESULTS: Final = Path(__file__).parents[2] / "benchmarks" / "results" / "actuator_faults.md"
FIRST: Final = 61200
RIGHT, WRONG = 0.95, 0.02
"""Share of records at least named right, and at most named wrong, over all."""


@dataclass(frozen=True)
class Kind:
    """One fault of one ship: the record of a seed judged, and the name that would be right."""

    ship: str
    words: str
    verdict: Callable[[int], Verdict]
    wanted: Callable[[int], str | None]
    detectable: bool = True


def kinds() -> Iterator[Kind]:
    """Two thrusters, two rudders, twin screws with rudders, four pods, screws and tunnel, jets."""
    for fault in otter.FAULTS:
        yield Kind(
            "Otter, two thrusters",
            {"weak": "20 % weak", "half": "half as strong", "late": "0.5 s late"}.get(fault, fault)
            or "nothing",
            lambda seed, fault=fault: otter.verdict(seed, fault),
            lambda seed, fault=fault: otter.effect_of(fault, seed),
        )
    yield from _of_twins()
    for one in faults.FAULTS:
        yield Kind(SHIPS[one.ship.name], one.words, one.verdict, one.wanted)


SHIPS: Final = {
    "cargo": "cargo ship, twin screw, two rudders",
    "ferry": "ferry, four azimuths",
    "supply": "supply vessel, two screws, bow thruster",
    "jets": "fast ferry, two waterjets",
}


def _of_twins() -> Iterator[Kind]:
    ship = "container ship, two rudders"

    def half(seed: int) -> tuple[float, float]:
        return (0.5, 1.0) if seed % 2 == 0 else (1.0, 0.5)

    yield Kind(ship, "nothing", twins.found, lambda _: None)
    yield Kind(
        ship,
        "rudder half as effective",
        lambda seed: twins.found(seed, half(seed)),
        lambda seed: f"{twins.NAMES[seed % 2]}_weak",
    )
    yield Kind(
        ship,
        "rudder stuck",
        lambda seed: twins.found(seed, stuck=seed % 2),
        lambda seed: f"{twins.NAMES[seed % 2]}_stuck",
    )
    yield Kind(
        ship,
        "half as effective, both moved as one",
        lambda seed: twins.found(seed, half(seed), apart=False),
        lambda _: None,
        detectable=False,
    )


@dataclass(frozen=True)
class Count:
    """Records of one kind, and of them those named right, right with others, and wrong."""

    records: int = 0
    right: int = 0
    among_others: int = 0
    wrong: int = 0

    def __add__(self, other: "Count") -> "Count":
        return Count(
            self.records + other.records,
            self.right + other.right,
            self.among_others + other.among_others,
            self.wrong + other.wrong,
        )


def judged(number: int, seed: int) -> Count:
    """What is said of a record of a kind, by its number; what is not right is printed."""
    warnings.simplefilter("ignore")
    kind = [*kinds()][number]
    found, wanted = kind.verdict(seed), kind.wanted(seed)
    right = found.effect == wanted
    if not right:
        print(f"  {kind.ship}, {kind.words}, {seed}: {found.sentence}", flush=True)
    wrong = not right and found.effect is not None
    return Count(1, int(right), int(right and len(found.family) > 1), int(wrong))


def line(ship: str, words: str, c: Count) -> str:
    """A row of the table."""
    n = c.records
    return (
        f"| {ship} | {words} | {n} | {c.right} ({c.right / n:.0%}) | {c.among_others} | "
        f"{n - c.right - c.wrong} | {c.wrong} ({c.wrong / n:.1%}) |"
    )


HEAD: Final = """\
# Faults of actuators, named or not

`python tests/actuators/ships/fault_table.py --records {records} --first {first}`, commit {commit};
no seed was used while building. Each ship is a programme of its own, its model is begun at typical
values and knows nothing of the fault; whose it is goes by the seed. `right`: named, on its side (of
a healthy ship: no name); `with others`: so many of these in a family with what the record cannot
tell from it; `no name`: something else was said, and no name given. Two rudders that move as one do
not show which of them is weak: no name is right there, and they are not in the totals.

| ship | fault | records | right | with others | no name | wrong |
| :--- | :--- | ---: | ---: | ---: | ---: | ---: |
"""


def page(counts: Sequence[Count], first: int, at: str) -> tuple[str, Count, Count]:
    """The table with its totals; all faulty records that can be told, and all healthy ones."""
    faulty, healthy, lines = Count(), Count(), []
    for kind, count in zip(kinds(), counts, strict=True):
        lines.append(line(kind.ship, kind.words, count))
        if kind.words == "nothing":
            healthy += count
        elif kind.detectable:
            faulty += count
    lines += [line("all", "a fault", faulty), line("all", "nothing", healthy)]
    head = HEAD.format(records=counts[0].records, first=first, commit=at)
    return head + "\n".join(lines) + "\n", faulty, healthy


def main() -> int:
    """Write the page, anew after each seed; exit status 1 where the totals fall short."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--records", type=int, default=40)
    asked.add_argument("--first", type=int, default=FIRST)
    asked.add_argument("--jobs", type=int, default=2)
    said = asked.parse_args()
    at, numbers = commit_of(RESULTS.parent), range(len([*kinds()]))
    counts, faulty, healthy = [Count() for _ in numbers], Count(), Count()
    with ProcessPoolExecutor(said.jobs) as pool:
        for seed in range(said.first, said.first + said.records):
            one = pool.map(judged, numbers, [seed] * len(numbers))
            counts = [a + b for a, b in zip(counts, one, strict=True)]
            text, faulty, healthy = page(counts, said.first, at)
            RESULTS.write_text(text, encoding="utf-8")
            print(f"{seed}: {faulty}, healthy: {healthy}", flush=True)
    whole = faulty + healthy
    return int(faulty.right < RIGHT * faulty.records or whole.wrong > WRONG * whole.records)


if __name__ == "__main__":
    sys.exit(main())
