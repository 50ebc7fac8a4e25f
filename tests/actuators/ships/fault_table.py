"""Faults of actuators over all kinds of ships: how often the right one is named, and a wrong one.

    PYTHONPATH=. python tests/actuators/ships/fault_table.py [--records 40] [--first N] [--jobs 2]

writes `tests/benchmarks/results/actuator_faults.md`. A record depends on its ship, its fault and
its seed alone. Seeds below 61000 were looked at while building; those from there on were not.
"""

import argparse
import subprocess
import sys
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from typing import Final

sys.path.extend(str(Path(__file__).parents[n]) for n in range(3))

import faults
import test_otter as otter
import test_twin_rudders as twins

from trialid.diagnosis.verdict import Verdict

RESULTS: Final = Path(__file__).parents[2] / "benchmarks" / "results" / "actuator_faults.md"
FIRST: Final = 61000
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
    """Two thrusters, two rudders, twin screws with rudders, four pods, screws and a bow tunnel."""
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

    records: int
    right: int
    among_others: int
    wrong: int


def counted(number: int, seeds: Sequence[int]) -> Count:
    """What is said of the records of a kind, by its number; what is not right is printed."""
    warnings.simplefilter("ignore")
    kind = [*kinds()][number]
    right = others = wrong = 0
    for seed in seeds:
        found, wanted = kind.verdict(seed), kind.wanted(seed)
        right += found.effect == wanted
        others += found.effect == wanted and len(found.family) > 1
        wrong += found.effect not in (None, wanted)
        if found.effect != wanted:
            print(f"  {kind.ship}, {kind.words}, {seed}: {found.sentence}", flush=True)
    return Count(len(seeds), right, others, wrong)


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


def main() -> int:
    """Write the page; exit status 1 where less is named right, or more wrong, than asked for."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--records", type=int, default=40)
    asked.add_argument("--first", type=int, default=FIRST)
    asked.add_argument("--jobs", type=int, default=2)
    said = asked.parse_args()
    seeds, at = range(said.first, said.first + said.records), commit()
    lines, faulty, healthy = [], Count(0, 0, 0, 0), Count(0, 0, 0, 0)
    every = [*kinds()]
    with ProcessPoolExecutor(said.jobs) as pool:
        counts = pool.map(counted, range(len(every)), [seeds] * len(every))
        for kind, done in zip(every, counts, strict=True):
            lines.append(line(kind.ship, kind.words, done))
            print(lines[-1], flush=True)
            if kind.words == "nothing":
                healthy = _sum(healthy, done)
            elif kind.detectable:
                faulty = _sum(faulty, done)
    lines += [line("all", "a fault", faulty), line("all", "nothing", healthy)]
    print("\n".join(lines[-2:]))
    head = HEAD.format(records=said.records, first=said.first, commit=at)
    RESULTS.write_text(head + "\n".join(lines) + "\n", encoding="utf-8")
    whole = _sum(faulty, healthy)
    return int(faulty.right < RIGHT * faulty.records or whole.wrong > WRONG * whole.records)


def _sum(one: Count, other: Count) -> Count:
    return Count(
        one.records + other.records,
        one.right + other.right,
        one.among_others + other.among_others,
        one.wrong + other.wrong,
    )


def commit() -> str:
    command = ["git", "rev-parse", "--short", "HEAD"]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


if __name__ == "__main__":
    sys.exit(main())
