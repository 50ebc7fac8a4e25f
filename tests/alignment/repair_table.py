"""How far faulty clocks move what is fitted, with the repair and without; the truth is known.

    PYTHONPATH=. python tests/alignment/repair_table.py

writes `tests/benchmarks/results/alignment.md`.
"""

import sys
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import faulty_logs as made
import numpy as np
from s175q import SETTINGS, TEN

RESULTS = Path(__file__).parents[1] / "benchmarks" / "results" / "alignment.md"
WITH_DELAY = replace(SETTINGS, nuisance=("initial_state", "delay"))
LATE = made.SOURCES | {"delta": replace(made.SOURCES["delta"], delay=1.0)}

HEAD = """\
# Clocks repaired, against a known truth

`python tests/alignment/repair_table.py`: zig-zags 10-10 and 20-20 of the ship S175Q, twenty minutes
each, gyro, inclinometer and rudder at 10 Hz with sensor noise, two recorders; ten derivatives
fitted. Largest move of any of them from the fit of the same records without a fault, in standard
errors of that fit.

What a clock cannot know stays: stamps cut to whole seconds leave a constant of up to half a period
in each channel, 26 ms between rudder and gyro here, and that alone is a standard error. A delay
that is fitted takes it.

"""


@dataclass(frozen=True)
class Row:
    """A fault, how it is repaired, what happens without; moves in standard errors."""

    fault: str
    repair: str
    moved: float
    by: str
    without: str
    unrepaired: float
    by_unrepaired: str


def rows(only: tuple[str, ...] = ()) -> Iterator[Row]:
    """The table, or the rows of some faults."""
    references = {}
    for fault, alter, (how, mended), (without, spoilt), settings in CASES:
        if only and fault not in only:
            continue
        after = _moved(alter, mended, settings, references)
        before = _moved(alter, spoilt, SETTINGS, references)
        yield Row(fault, how, *after, without, *before)


def _moved(alter, way, settings, references) -> tuple[float, str]:
    if settings.nuisance not in references:
        clean = [made.trial(angle, made.sensors(angle)) for angle in made.TRIALS]
        references[settings.nuisance] = made.fitted(clean, settings)
    theta, errors = references[settings.nuisance]
    trials = [
        way(angle, alter(made.sensors(angle), np.random.default_rng(100 + angle)))
        for angle in made.TRIALS
    ]
    found, _ = made.fitted(trials, settings)
    off = np.abs(found - theta) / errors
    return float(off.max()), TEN[int(off.argmax())]


Way = tuple[str, Callable]
REPAIRED: Way = ("repair", made.trial)
AS_LOGGED: Way = ("as logged", lambda a, m: made.trial(a, m, repair=False))
HELD: Way = ("last value held", made.held)
NUMBERED: Way = ("by row number", lambda a, m: made.trial(a, made.numbered(m), repair=False))
DECLARED: Way = ("declared delay", lambda a, m: made.trial(a, m, LATE))
FREE: Way = ("repair, delay fitted", made.trial)
MATCHED: Way = ("match", lambda a, m: made.trial(a, m, clock=made.BY_MATCH))
EVENTS: Way = ("two events", lambda a, m: made.trial(a, m, clock=made.by_events()))

CASES = (
    ("28 ms jitter", made.jittered, REPAIRED, AS_LOGGED, SETTINGS),
    ("rudder 1 s late", made.late_rudder, DECLARED, AS_LOGGED, SETTINGS),
    ("rudder 1 s late, delay fitted", made.late_rudder, FREE, AS_LOGGED, WITH_DELAY),
    ("1 Hz roll", made.slow_roll, REPAIRED, HELD, SETTINGS),
    ("1 message in 500 dropped", made.dropped, REPAIRED, NUMBERED, SETTINGS),
    ("clock 1.3 s ahead, 500 ppm fast", made.drifting, MATCHED, AS_LOGGED, SETTINGS),
    ("the same, by events", made.drifting, EVENTS, AS_LOGGED, SETTINGS),
    ("delivered five at a time", made.bundled, REPAIRED, AS_LOGGED, SETTINGS),
    ("clock set back 2.3 s", made.set_back, REPAIRED, AS_LOGGED, SETTINGS),
    ("stamps in whole seconds", made.whole_seconds, REPAIRED, AS_LOGGED, SETTINGS),
    ("whole seconds, delay fitted", made.whole_seconds, FREE, AS_LOGGED, WITH_DELAY),
)


def table(done: list[Row]) -> str:
    """The rows as a table of a Markdown page."""
    head = ("fault", "repaired by", "largest move", "without", "largest move")
    cells = [
        (r.fault, r.repair, f"{r.moved:.2f} ({r.by})", r.without,
         f"{r.unrepaired:.1f} ({r.by_unrepaired})")
        for r in done
    ]  # fmt: skip
    lines = [head, tuple("-" * 3 for _ in head), *cells]
    return "".join("| " + " | ".join(line) + " |\n" for line in lines)


if __name__ == "__main__":
    page = HEAD + table(list(rows()))
    RESULTS.write_text(page, encoding="utf-8")
    print(page)
