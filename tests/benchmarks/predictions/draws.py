"""Ten thousand zig-zags with drawn parameters, and a loop over SciPy's integrator beside them.

    python tests/benchmarks/predictions/draws.py

Processor seconds on one core. SciPy integrates the same equations of the same ship, written out as
a NumPy function by `trialid export --as python`, with an event at each reversal (solve_ivp, LSODA,
rtol 1e-6), for a few ships, and is reckoned up. Exit status 1 where ours is not 20 times as fast.
"""

import sys
import time
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp

sys.path.insert(0, str(Path(__file__).parents[2]))
import s175q

from trialid.design.helm import vessel
from trialid.design.imo import measures
from trialid.design.prediction.keeping_place import sail_each
from trialid.design.standard import LENGTHS, STEPS, STRAIGHT, in_calm
from trialid.effects import CATALOGUE
from trialid.ship.model import ShipModel
from trialid.simulation.reference import evaluator
from trialid.workflow.use.orders import named_manoeuvre

NUMBER, BY_SCIPY, WANTED = 10_000, 20, 20.0
EFFECTS = ("linear_hull", "linear_rudder", "linear_roll", "heel_yaw", "yaw_drag_rar")
RATE, ANGLE = np.deg2rad(3.0), np.deg2rad(20.0)


def main() -> int:
    """Print the table; 1 where the kernel is not as fast as wanted."""
    effects = tuple(CATALOGUE[n] for n in EFFECTS)
    model = ShipModel(s175q.SHIP, ("v", "p", "r", "phi"), effects)
    ship = in_calm(vessel(model, 0.5, {"u": 7.33}, RATE))
    names = ship.simulator.equations.parameters
    theta = np.array([ship.model.value(n) for n in names])
    rng = np.random.default_rng(1)
    drawn = theta * (1.0 + 0.05 * rng.standard_normal((NUMBER, len(theta))))
    asked, one = named_manoeuvre(["zigzag", "20", "20"]), STEPS * ship.period
    began = time.process_time()
    passages = sail_each(ship, drawn, asked.told, STRAIGHT * one, LENGTHS * one)
    ours = [measures.overshoots(p)[0] for p in passages if p.departure is None]
    kernel = time.process_time() - began
    began = time.process_time()
    theirs = [first_overshoot(ship, row) for row in drawn[:BY_SCIPY]]
    scipy = (time.process_time() - began) * NUMBER / BY_SCIPY
    apart = np.rad2deg(np.max(np.abs(np.subtract(theirs, ours[:BY_SCIPY]))))
    print(f"{len(ours)} zig-zags 20/20 of four reversals: {kernel:.1f} s; SciPy {scipy:.0f} s,")
    print(f"{scipy / kernel:.0f} times as long; first overshoots apart {apart:.2f} deg at most")
    return 0 if scipy > WANTED * kernel else 1


def first_overshoot(ship, theta) -> float:
    """By SciPy's integrator, the rudder a state that moves by its rate; [rad]."""
    eq = ship.simulator.equations
    run = evaluator(eq.f, (*eq.states, *eq.inputs, *eq.parameters), scalar=True)
    psi, order = eq.states.index("psi"), ANGLE
    state, t, far = np.zeros(len(eq.states) + 1), 0.0, 0.0
    inputs = [dict.fromkeys(eq.inputs, 0.0) | ship.constants]

    def rates(t, x):
        """The ship's, and the rudder's towards the order."""
        u = [x[-1] if n == "delta" else inputs[0][n] for n in eq.inputs]
        gap = order - x[-1]
        moves = RATE * np.sign(gap) if abs(gap) > 1e-3 else RATE * gap / 1e-3
        return [*run([*x[:-1], *u, *theta]), moves]

    for leg in range(4):
        side = 1.0 if leg % 2 == 0 else -1.0
        order = side * ANGLE

        def beyond(t, x, side=side):
            return side * x[psi] - ANGLE

        vars(beyond).update(terminal=True, direction=1.0)
        found = solve_ivp(
            rates, (t, t + 2e3), state, "LSODA", events=beyond, rtol=1e-6, atol=1e-9, max_step=2.0
        )
        t, state = found.t[-1], found.y[:, -1]
        if leg == 1:
            far = float(np.max(found.y[psi]))
    return far - ANGLE


if __name__ == "__main__":
    sys.exit(main())
