"""How fast a ship of eight actuators is: against C, and from the model to the first result.

    python tests/actuators/engine_of_eight.py

As `tests/benchmarks/engine.py`, whose table this is.
"""

import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np

sys.path.append(str(Path(__file__).parents[1] / "benchmarks"))

import boats
from engine import PERIOD, SAMPLES, Case, Row, against_c, cold_cache, main, ms, timed

from trialid.simulation.integrate import prepare

OUTPUTS = ("u", "r")


def rows() -> Iterator[Row]:
    """Four pods, two rudders and two bow thrusters."""
    model, free, trial = boats.eight_actuators(SAMPLES, PERIOD)
    case = Case(prepare(model, free, OUTPUTS), trial)
    yield from against_c(case, "eight actuators, ", 1.15)
    took = []
    for _ in range(5):
        with cold_cache():
            took.append(timed(_first_result, time.perf_counter)[1])
    found = float(np.median(took))
    told = ("  traced, compiled and run once, cold", ms(found), "", f"{found:.2f} s", "< 0.3 s")
    yield Row(*told, fine=found < 0.3)


def _first_result() -> None:
    model, free, trial = boats.eight_actuators(20, PERIOD)
    Case(prepare(model, free, OUTPUTS), trial).run()()


if __name__ == "__main__":
    sys.exit(main(rows))
