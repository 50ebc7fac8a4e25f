"""Whether her roll is recorded to the side that it counts: before that is known nothing has a name.

A displacement ship heels out of her turns. A roll that is positive to port looks like one that
heels into them, and then what pushes her over in a turn is missing with the wrong sign: effects of
the hull take it up. A planing boat does heel inward, and only who was aboard knows.
"""

from typing import Final

import numpy as np

from trialid.errors import list_names
from trialid.identification.fit import Fit
from trialid.names.quantities import SIGNALS
from trialid.trial import Trial, heel_in_calm

CLEARLY: Final = 0.4
"""Correlation of heel and r u from which on she leans to one side in her turns. Of 104 records of a
stranger's ships it is -0.85 to -0.28, and 0.03 at most in 180 of drawn ships in a swell; of a boat
whose roll counts to port 0.45 to 0.69. Half of it trips no other, twice tells nothing."""

TURNING: Final = frozenset(("r", "psi"))
ABOUT_X: Final = frozenset(("phi", "p"))
"""What tells to which side she turns, and what goes by an axis that points ahead with z up too."""

PUSHES_OVER: Final = frozenset(("Kv", "Kr", "Kdelta"))
"""What heels her in a turn, of either sign by the side that the roll counts to."""

TURNS: Final = np.deg2rad(20.0)
"""[rad] Least change of heading that is a turn; zig-zags of 2 and 5 deg of the S-175 have less."""


def leans_to(fit: Fit) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """Trials in which she heels into her turns, and those in which she heels out of them.

    None where the roll does not count, or somebody stated its side.
    """
    read = {*fit.problem.outputs, *fit.problem.simulator.equations.inputs}
    if "phi" not in read or any("phi" in t.sided for t in fit.trials):
        return (), ()
    leans = {t.name: _lean(t) for t in fit.trials}
    inward = tuple(name for name, lean in leans.items() if lean > CLEARLY)
    return inward, tuple(name for name, lean in leans.items() if lean < -CLEARLY)


def _lean(trial: Trial) -> float:
    """Correlation of her heel with her rate of turn times her speed; 0 where nothing tells it."""
    if not {"phi", "r"} <= trial.signals.keys():
        return 0.0
    known = trial.valid["phi"] & trial.valid["r"]
    r, speed = trial.signals["r"], trial.signals.get("u", np.ones(trial.samples))
    turned = float(np.ptp(np.cumsum(r[known]))) * trial.period if known.any() else 0.0
    if turned < TURNS:
        return 0.0
    phi, turning = heel_in_calm(trial, r * speed, known)[known], (r * speed)[known]
    if not (np.ptp(phi) > 0.0 and np.ptp(turning) > 0.0):
        return 0.0
    return float(np.corrcoef(phi, turning)[0, 1])


def side_in_doubt(fit: Fit) -> str | None:
    """What her heel leaves open, and how to settle it; None where it leaves nothing."""
    inward, outward = leans_to(fit)
    if inward and outward:
        return (
            f"she heels into her turns in {_listed(inward)} and out of them in {_listed(outward)}: "
            "in one of them phi or the rate of turn counts to the other side; write positive for "
            'it, and positive = "starboard" for phi where she does heel both ways'
        )
    return _doubt(inward, _turned_about(fit, inward)) if inward else None


def pushed_over_otherwise(fit: Fit) -> bool:
    """Whether a rudder or a turn pushes her over to the other side than her file knows for sure."""
    known = {x.name: x.prior[0] for x in fit.problem.unknowns if x.prior and x.name in PUSHES_OVER}
    return any(name in fit.contradicted and fit.value(name) * x < 0.0 for name, x in known.items())


def _turned_about(fit: Fit, inward: tuple[str, ...]) -> tuple[str, ...]:
    """Signals that axes with z up turn about, where nobody stated the side of her turns.

    About x, which stays, so that the roll does; what goes to a side or turns to one does not.
    """
    trials = [t for t in fit.trials if t.name in inward]
    if any(TURNING & t.sided for t in trials):
        return ()
    names = dict.fromkeys(name for t in trials for name in t.signals)
    return tuple(n for n in names if n in SIGNALS and SIGNALS[n].mirror < 0 and n not in ABOUT_X)


def _doubt(inward: tuple[str, ...], turned: tuple[str, ...]) -> str:
    """Both readings; that of axes with z up only where her turns may be of the other side."""
    axes = (
        f", or {list_names(turned)} all do, as with z up (for each of these, "
        "else starboard is port in all predictions)"
    )
    return (
        f"she heels into her turns in {_listed(inward)}, where ships heel outward: phi alone "
        f'counts to port (write positive = "port" for phi){axes if turned else ""}; or positive = '
        '"starboard" for phi where she does heel inward'
    )


def _listed(trials: tuple[str, ...]) -> str:
    """The first few of them."""
    return ", ".join(trials[:3]) + (" and more" if trials[3:] else "")
