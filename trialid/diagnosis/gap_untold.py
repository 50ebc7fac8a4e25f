"""A gap of the catalogue that is claimed, and that the record does not tell."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.diagnosis.force.missing_force import MissingForce
from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.search.score import Candidate
from trialid.diagnosis.verdict import Verdict
from trialid.diagnosis.verdict_sentences import no_force, untold
from trialid.identification.fit import Fit

MOST_OF_IT: Final = 0.5
"""Share of what is not noise that an effect must foretell to explain, to be told where chance does
as well: an outsider's waterjet, whose push goes with her revolutions, has 0.90 of it by one trial
of three. Of 32 records of what the catalogue lacks none is told so, with half of it neither; with
twice the waterjet is not."""


def without_gap(
    fit: Fit,
    verdict: Verdict,
    ranking: Sequence[Candidate],
    parts: Split,
    force: MissingForce | None,
    level: float,
) -> Verdict:
    """The verdict, which claims no gap of the catalogue where that is not told.

    Not where an effect would explain most of what is no noise, though by this record chance does as
    well: one that acts in few of its stretches is not told from it. Nor where no force in any
    equation stands out beside noise of the colour that it has then.
    """
    if verdict.kind != "not in catalogue":
        return verdict
    if (best := _untold(fit, ranking, parts, level)) is not None:
        family = (best.effect.name,)
        return replace(verdict, kind="cannot tell", family=family, sentence=untold(fit, best))
    if force is None or force.possible:
        return verdict
    return replace(verdict, kind="cannot tell", sentence=no_force(verdict.sentence, force))


def _untold(fit: Fit, ranking: Sequence[Candidate], parts: Split, level: float) -> Candidate | None:
    """The effect that would explain most of what is known to be no noise, as chance does."""
    able = [c for c in ranking if c.allowed and c.p_value >= level and np.isfinite(c.eps_predicted)]
    best = min(able, key=lambda c: c.eps_predicted, default=None)
    if best is None or parts.undermodelling is None:
        return None
    explained = fit.eps_rmsn**2 - best.eps_predicted**2
    return best if explained >= MOST_OF_IT * parts.undermodelling**2 else None
