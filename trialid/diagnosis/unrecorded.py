"""What nobody logged, where no effect that could be tried is the answer.

On a pond in wind whose log has no anemometer, the wind is among what may be missing, and no effect
of it was tried. Who reads that something is missing should read that too.
"""

from collections import Counter
from collections.abc import Iterable
from dataclasses import replace
from typing import Final

from trialid.diagnosis.search.augment import missing_signals
from trialid.diagnosis.verdict import Verdict
from trialid.identification.fit import Fit
from trialid.names.quantities import SIGNALS
from trialid.ship.effect import Effect
from trialid.ship.model import STATES

NAMELESS: Final = ("not in catalogue", "cannot tell")

SHOWN: Final = 5
"""Signals that a sentence names; the report lists every effect that was not tried."""


def name_records(fit: Fit, verdict: Verdict, effects: Iterable[Effect]) -> Verdict:
    """The verdict; where something is missing and has no name, with the records that lack."""
    if verdict.kind not in NAMELESS:
        return verdict
    trial = fit.problem.trials[0]
    outer = SIGNALS.keys() - set(STATES) | {"psi"}  # what acts on her, and whence: by the heading
    wanted = Counter(s for e in effects for s in missing_signals(fit.model, trial, e) if s in outer)
    if not wanted:
        return verdict
    shown = [s for s, _ in wanted.most_common(SHOWN)]
    others = " and others" if len(wanted) > SHOWN else ""
    said = (
        f"{verdict.sentence}; no record holds {', '.join(shown)}{others}, and no effect that needs "
        "one of them was tried"
    )
    return replace(verdict, sentence=said)
