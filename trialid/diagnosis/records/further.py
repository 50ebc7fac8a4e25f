"""Whether a trial asks more of a ship than the others do, and what is left of each.

There a model that lacks a force may fail alone, and nothing is wrong with the trial.
"""

from collections.abc import Callable, Sequence
from typing import Final

import numpy as np

from trialid.diagnosis.noise.excitation import is_driven
from trialid.identification.fit import Fit
from trialid.simulation.integrate import record_for
from trialid.trial import Trial

FURTHER: Final = 1.1
"""Times what drives her in the others, or her speed, from which on she does there what she does in
none of them. Of the tanker's trials the largest lowers the error of the others by up to 0.65. Half
as far beyond 1 and twice find the same 8 of the 24, and none that is no other ship's."""

MOVES: Final = 2.0
"""Times what she moves by in the others, from which on it is the same. With 1.5 one of the 8 is
missed, with 3 none."""

WORSE: Final = 1.25
"""Times what is left of any other trial, in one that stands out. With the factor that mends it a
trial does by 1.02, one of another ship by 1.53 with what explains most of it; an outsider's that
was held out, whose speed read 12 % high, did by 5.9. Half as far beyond 1 and twice say the same.
Of 194 ships with an effect hidden one, whose rudder has a law of its own in gusts, has such a
factor told of the trial held out."""


def is_no_further(fit: Fit, name: str) -> bool:
    """Whether she is driven no further in a trial than in the others, nor faster, nor slower.

    Let go, she swings no further; and in no trial as many times as far as `MOVES`.
    """
    inputs = [n for n in fit.problem.simulator.equations.inputs if n != "u"]
    trial = next(t for t in fit.trials if t.name == name)
    others = [t for t in fit.problem.trials if t.name != name]
    asked = inputs if is_driven(inputs, [trial]) else fit.problem.outputs
    return (
        all(_share(trial, others, n) <= FURTHER for n in asked)
        and all(_share(trial, others, n) <= MOVES for n in fit.problem.outputs)
        and _share(trial, others, "u", min) * FURTHER >= 1.0
        and _share(trial, others, "u") <= FURTHER
    )


def left_of_each(fit: Fit) -> dict[str, float]:
    """Error of each trial over its outputs, by what moved in all; 0 of one without any."""
    squares = {s.trial.name: [*np.square([*s.eps_rmsn.values()])] for s in fit.scores}
    return {name: float(np.sqrt(np.mean(each or [0.0]))) for name, each in squares.items()}


def stands_out(fit: Fit, name: str) -> bool:
    """Whether more is left of a trial than of any other that is fitted."""
    left = left_of_each(fit)
    return left[name] > WORSE * max(left[t.name] for t in fit.problem.trials if t.name != name)


def _share(
    trial: Trial, others: Sequence[Trial], name: str, of: Callable[[list[float]], float] = max
) -> float:
    """How far a signal goes in a trial, in what it does in others; 1 where one has no record."""
    kept = [record_for(t, name) for t in (trial, *others)]
    most = [
        float(np.abs(t.signals[n]).max()) for t, n in zip((trial, *others), kept, strict=True) if n
    ]
    whole = of(most[1:]) if all(kept) else 0.0
    return most[0] / whole if whole > 0.0 else 1.0
