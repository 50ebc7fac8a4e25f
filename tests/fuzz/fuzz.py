r"""Damage small logs of every format, read them, and see that nothing but our errors comes out.

    PYTHONPATH=. python tests/fuzz/fuzz.py --count 50000 --jobs 2 --seed 0 --out table.md
    PYTHONPATH=. python tests/fuzz/fuzz.py --count 1000 --only xlsx,tlog

Each damaged log goes through `trialid.ingest.read`, every fourth on through the survey, its table
and the alignment. A log offends when anything but a TrialidError of one line that names the file
comes out, when it takes longer than 10 s or more than 1 GB in all, and when a sample that a
checksum covers (`seed_logs`) is none of the sound log's. What offends is written to `--keep` with
the reason beside it; exit status 1. The same seed damages the same bytes, for any `--jobs`.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path

from judge import SURVEYED, Verdict
from seed_logs import SeedLog, seed_logs
from workers import results

OUTCOMES = ("whole", "in part", "refused")


@dataclass
class Row:
    """What became of all damaged logs of a format."""

    seed: SeedLog
    count: dict[str, int] = field(default_factory=lambda: dict.fromkeys(OUTCOMES, 0))
    seconds: float = 0.0
    megabytes: float = 0.0
    samples: int = 0
    wrong: int = 0
    collisions: int = 0
    offending: list[str] = field(default_factory=list)

    def add(self, number: int, found: Verdict) -> None:
        self.count[found.outcome] = self.count.get(found.outcome, 0) + 1
        self.seconds = max(self.seconds, found.seconds)
        self.megabytes = max(self.megabytes, found.megabytes)
        self.samples += found.samples
        self.wrong += found.wrong
        self.collisions += found.collisions
        self.offending += [f"{self.seed.name}, {number}: {one}" for one in found.complaints]


def fuzz(
    count: int, jobs: int, start: int, keep: Path, only: Sequence[str] = ()
) -> tuple[Row, ...]:
    """Rows of all formats, or of those whose names begin as one of `only`; `count` logs in all."""
    with tempfile.TemporaryDirectory() as folder:
        seeds = seed_logs(Path(folder))
        chosen = [not only or one.name.startswith(tuple(only)) for one in seeds]
        each, more = divmod(count, sum(chosen))
        rest = iter([1] * more + [0] * len(seeds))
        counts = [each + next(rest) if asked else 0 for asked in chosen]
        rows = [Row(seed) for seed in seeds]
        for case, found in results(seeds, counts, start, jobs, keep):
            rows[case.place].add(case.number, found)
    return tuple(row for row, asked in zip(rows, chosen, strict=True) if asked)


def table(rows: Sequence[Row]) -> str:
    """Markdown, with the sums below."""
    head = (
        "format", "covered", "logs", "read whole", "in part", "refused", "worst s", "worst MB",
        "samples", "wrong", "collisions",
    )  # fmt: skip
    lines = [head, ["---"] * len(head), *map(_cells, rows)]
    total = sum(sum(row.count.values()) for row in rows)
    outcomes = [sum(row.count[name] for row in rows) for name in OUTCOMES]
    worst = [f"{max(r.seconds for r in rows):.2f}", f"{max(r.megabytes for r in rows):.0f}"]
    sums = [sum(r.samples for r in rows), sum(r.wrong for r in rows)]
    lines.append(["all", "", total, *outcomes, *worst, *sums, sum(r.collisions for r in rows)])
    return "\n".join("| " + " | ".join(map(str, line)) + " |" for line in lines)


def _cells(row: Row) -> list[object]:
    seed, covered = row.seed, row.seed.covered
    wrong = ["-", "-"] if covered == "nothing" else [row.wrong, row.collisions]
    numbers = [f"{row.seconds:.2f}", f"{row.megabytes:.0f}", row.samples, *wrong]
    outcomes = [row.count[name] for name in OUTCOMES]
    shown = "-" if covered == "nothing" else covered
    return [seed.name, shown, sum(row.count.values()), *outcomes, *numbers]


def report(rows: Sequence[Row], start: int, took: float) -> str:
    """The table with what it is, for the record."""
    total = sum(sum(row.count.values()) for row in rows)
    offending = [one for row in rows for one in row.offending]
    return f"""# Damaged logs

`python tests/fuzz/fuzz.py --count {total} --seed {start}`: {total} damaged logs, {took:.0f} s;
every {SURVEYED}th went on through the survey and the alignment. {len(offending)} of them offend:
something but our own error of one line came out, it took over 10 s or 1 GB (of the whole process,
imports included), or a sample that a checksum covers was none of the sound log's.

Covered: `pairs` values and stamps, `values` values alone (stamps stand outside of the checksum).
Collisions are samples of sentences that fit their eight bits of exclusive or and were never
written; no reader can see them. Resealed: damaged beneath the checksum, which then fits.

{table(rows)}
"""


def main() -> int:
    """Print the table; 1 where a log offends."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--count", type=int, default=2000)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--only", default="", help="beginnings of names, with commas between")
    parser.add_argument("--keep", type=Path, default=Path("fuzz_offending"))
    parser.add_argument("--out", type=Path, help="write the report to this file too")
    asked = parser.parse_args()
    begin = time.perf_counter()
    only = [one for one in asked.only.split(",") if one]
    rows = fuzz(asked.count, asked.jobs, asked.seed, asked.keep, only)
    text = report(rows, asked.seed, time.perf_counter() - begin)
    print(text)
    if asked.out is not None:
        asked.out.write_text(text, encoding="utf-8")
    offending = [one for row in rows for one in row.offending]
    for one in offending[:50]:
        print(one, file=sys.stderr)
    return bool(offending)


if __name__ == "__main__":
    sys.exit(main())
