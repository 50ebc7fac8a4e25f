"""How fast tests are rated: 500 candidates of 20 minutes with ten sensitivities, beside SciPy.

    python tests/benchmarks/design.py

Every candidate is sailed, held against limits and rated. SciPy's LSODA with forward differences
does one of them, several times before and after; the mean is scaled up. Exit status 1 where SciPy
is less than 100 times slower: seconds, of which 10 were asked, depend on the machine of the day
(11.0 on a slow one), and of LSODA timed once the ratio came out as 96, 110 and 149 in an hour.
"""

import sys
import time
from pathlib import Path
from typing import Final

import baselines
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parents[1] / "design"))

from s175q import TEN
from waters import GOAL, ROLL, SHIP, VESSEL, D

from trialid.design.kinds import Test, sail
from trialid.design.limits import Limits
from trialid.design.search import outcome
from trialid.simulation.integrate import inputs, prepare
from trialid.threads import one_thread

CANDIDATES: Final = 500
WANTED_RATIO: Final = 100.0
REPEATS: Final = 8
"""Of SciPy's, before ours and after it."""
DURATION: Final = 1200.0
LIMITS: Final = Limits(rudder=35 * D, heel=20 * D, speed_loss=0.9)


def candidates() -> list[Test]:
    """Step sequences and zig-zags in turn, drawn with an explicit seed."""
    draw = np.random.default_rng(0)
    made = []
    for i in range(CANDIDATES):
        if i % 2:
            angle, heading = draw.uniform(5 * D, 35 * D), draw.uniform(5 * D, 30 * D)
            made.append(Test("zigzag", {"angle": angle, "heading": heading}, DURATION))
        else:
            angles = tuple(draw.uniform(-35 * D, 35 * D, 12))
            made.append(Test("steps", {"angles": angles}, DURATION))
    return made


@one_thread
def ours() -> float:
    """Processor seconds of all candidates."""
    tests = candidates()
    outcome([tests[0]], SHIP, LIMITS)  # compiles
    began = time.process_time()
    rated = [outcome([test], SHIP, LIMITS) for test in tests]
    seconds = time.process_time() - began
    able = sum(one.rating is not None for one in rated)
    print(f"{CANDIDATES} candidates, {able} within the limits: {seconds:.2f} s of one processor")
    return seconds


@one_thread
def scipys() -> float:
    """Processor seconds SciPy takes for one candidate: one response and one more a parameter."""
    trial = sail(Test("zigzag", {"angle": 10 * D, "heading": 10 * D}, DURATION), VESSEL, ROLL).trial
    simulator = prepare(GOAL.model, TEN, GOAL.settings.outputs)
    eq, known = simulator.equations, {**simulator.fixed}
    known |= {n: GOAL.model.value(n) for n in eq.parameters}
    theta = np.array([known[n] for n in eq.parameters])
    x0 = np.array([trial.signals[s][0] for s in eq.states])
    u = inputs(simulator, trial, known)
    began = time.process_time()
    for _ in range(REPEATS):
        baselines.lsoda(eq, theta, x0, u, trial.period)
    return (time.process_time() - began) / REPEATS * (1 + len(TEN))


def main() -> int:
    """Measure, print, and say whether it is fast enough."""
    before, mine, after = scipys(), ours(), scipys()
    theirs = 0.5 * (before + after) * CANDIDATES
    ratio = theirs / mine
    print(
        f"SciPy's LSODA with forward differences, one scaled up: {theirs:.0f} s, {ratio:.0f} times"
    )
    fine = ratio >= WANTED_RATIO
    print("fast enough" if fine else f"wanted: {WANTED_RATIO:g} times")
    return 0 if fine else 1


if __name__ == "__main__":
    sys.exit(main())
