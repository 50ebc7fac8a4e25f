"""What nobody logged, where no effect that could be tried is the answer.

On a pond in wind whose log has no anemometer, the wind is among what may be missing, and no effect
of it was tried. Who reads that something is missing should read that too.
"""

from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from trialid.diagnosis.found_values import by_heading, of_the_ship
from trialid.diagnosis.records.rudder_jumps import jump_in, said_of
from trialid.diagnosis.search.candidates import missing_signals
from trialid.diagnosis.verdict import Verdict
from trialid.effects.track import current_in_speed
from trialid.identification.fit import Fit
from trialid.names.quantities import SIGNALS
from trialid.ship.effect import Effect
from trialid.ship.model import STATES
from trialid.simulation.integrate import shared_record

UNANSWERED: Final = ("not in catalogue", "cannot tell", "nothing missing")
"""Verdicts with which something is or may be missing that has no name: nothing of what was tried is
missing of a ship in 14 m/s of wind, whose heading and wind nobody gave."""

READ_OVER_GROUND: Final = "drift_in_speed_record"
READ_WITH_CURRENT: Final = "current_in_speed_record"
CURRENTS: Final = {READ_WITH_CURRENT, current_in_speed.name}
"""Effects of a model whose speed is one over ground, and of the current in it."""

SHOWN: Final = 5
"""Signals that a sentence names; the report lists every effect that was not tried."""


def name_records(fit: Fit, verdict: Verdict, effects: Iterable[Effect]) -> Verdict:
    """The verdict; where what is missing has no name, with the signals that not all trials hold.

    Whatever it is, with what is recorded as the rudder, where that is its order.
    """
    tried = tuple(effects)
    unrecorded = _unrecorded(fit, tried) if verdict.kind in UNANSWERED else ""
    jump = jump_in(fit)
    clauses = (
        verdict.sentence,
        _or_current(fit, verdict, tried),
        unrecorded,
        said_of(jump) if jump else "",
    )
    return replace(verdict, sentence="; ".join(filter(None, clauses)))


def _or_current(fit: Fit, verdict: Verdict, effects: Iterable[Effect]) -> str:
    """That a wind which nobody recorded may be a current, where the speed is one over ground.

    And a current something else, where it is not. Of three of four ships in a current, of another
    hull than the model's, wind was named last; of one of eight boats in wind, whose log is through
    the water, a current.
    """
    present = {e.name for e in fit.problem.simulator.model.effects}
    over_ground = READ_OVER_GROUND in present
    if verdict.effect == READ_WITH_CURRENT and not over_ground:
        return (
            "that is of a speed recorded over ground, and the model takes it as one through the "
            "water: where it is that, a wind that nobody recorded may look like it"
        )
    wind = any(e.name == verdict.effect and by_heading(e) and of_the_ship(e) for e in effects)
    if not wind or not over_ground or present & CURRENTS:
        return ""
    return "the speed is over ground, and a current in it, unrecorded too, may look like that"


def _unrecorded(fit: Fit, effects: Iterable[Effect]) -> str:
    """The signals that not all trials hold, and what follows; empty where nothing does."""
    trial = shared_record(fit.trials)
    outer = SIGNALS.keys() - set(STATES) | {"psi"}  # what acts on her, and whence: by the heading
    wanted = Counter(s for e in effects for s in missing_signals(fit.model, trial, e) if s in outer)
    if not wanted:
        return ""
    shown = [s for s, _ in wanted.most_common(SHOWN)]
    others = " and others" if len(wanted) > SHOWN else ""
    return (
        f"not every trial is given {', '.join(shown)}{others}, and no effect that needs one of "
        "them was tried"
    )
