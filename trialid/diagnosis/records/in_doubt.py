"""What the records leave in doubt about themselves: before that is settled nothing has a name."""

from dataclasses import replace
from typing import Final

from trialid.diagnosis.records.heel_side import pushed_over_otherwise, side_in_doubt
from trialid.diagnosis.records.rate_and_angle import rate_in_doubt
from trialid.diagnosis.records.rudder_late import rudder_in_doubt
from trialid.diagnosis.records.sampling_in_doubt import sampling_in_doubt
from trialid.diagnosis.records.speed_in_doubt import speed_in_doubt
from trialid.diagnosis.records.unit_in_doubt import unit_in_doubt
from trialid.diagnosis.verdict import Verdict
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect

NO_FIT: Final = "no fit: "

OF_ALL: Final = (unit_in_doubt, speed_in_doubt, sampling_in_doubt)
"""Doubts that every number hangs on."""


def in_doubt(fit: Fit) -> bool:
    """Whether the records leave anything in doubt about themselves."""
    asked = *OF_ALL, rate_in_doubt, rudder_in_doubt, side_in_doubt
    return any(one(fit) is not None for one in asked)


def settle(fit: Fit, verdict: Verdict, named: Effect | None = None) -> Verdict:
    """The verdict; of records in doubt, that and how to settle it.

    Nothing of a sensor that an effect is `named` of. Where nothing is missing the roll's side takes
    no part, unless what pushes her over has another sign than her file's: a boat that heels inward
    is told by hers; nor does a rudder that is late. A rate, a speed or a unit that is wrong is in
    every number.
    """
    whole = verdict.kind == "nothing missing"
    side = None if whole and not pushed_over_otherwise(fit) else side_in_doubt(fit)
    rudder = None if whole else rudder_in_doubt(fit, named)
    asked = *(one(fit) for one in OF_ALL), rate_in_doubt(fit, named), rudder, side
    found = tuple(one for one in asked if one is not None)
    if not found:
        return verdict
    doubt = "; ".join(found)
    if verdict.kind == "no fit":
        why = verdict.sentence.removeprefix(NO_FIT)  # what is wrong with the records comes first
        return replace(verdict, sentence=f"{NO_FIT}{doubt}; {why}", doubts=found)
    said = f"{doubt}; until then no effect is named"
    return Verdict("cannot tell", None, (), said, doubts=found)
