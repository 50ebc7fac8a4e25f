"""What the records leave in doubt about themselves: before that is settled nothing has a name."""

from dataclasses import replace

from trialid.diagnosis.records.heel_side import side_in_doubt
from trialid.diagnosis.records.rate_and_angle import rate_in_doubt
from trialid.diagnosis.verdict import Verdict
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect


def doubts_of(fit: Fit, named: Effect | None = None) -> tuple[str, ...]:
    """In words, with how to settle each; not of a sensor that an effect is `named` of."""
    found = (rate_in_doubt(fit, named), side_in_doubt(fit))
    return tuple(one for one in found if one is not None)


def settle(fit: Fit, verdict: Verdict, named: Effect | None = None) -> Verdict:
    """The verdict; of records in doubt, that and how to settle it.

    Where nothing is missing the roll's side takes no part; a rate that is wrong is in every number.
    """
    found = doubts_of(fit, named)
    if verdict.kind == "nothing missing":
        found = tuple(one for one in found if one != side_in_doubt(fit))
    if not found:
        return verdict
    doubt = "; ".join(found)
    if verdict.kind == "no fit":
        return replace(verdict, sentence=f"{verdict.sentence}; {doubt}", doubts=found)
    said = f"{doubt}; until then no effect is named"
    return Verdict("cannot tell", None, (), said, doubts=found)
