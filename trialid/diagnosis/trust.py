"""How far each unknown of a fit can be trusted."""

from typing import Final

from trialid.accuracy.likely import Averaged
from trialid.accuracy.parameter_table import Accuracy, Subject, assess
from trialid.accuracy.widened import with_ranges, with_rivals
from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.noise.recorded_inputs import felt_noise
from trialid.identification.fit import Fit
from trialid.identification.one_search import influence
from trialid.identification.output_error import stretches

NEAR_ZERO: Final = 0.05
"""An estimate below this share of its typical size is scaled by the latter."""


def accuracy_of(fit: Fit, parts: Split, averaged: Averaged) -> Accuracy:
    """Eq. 8 to 14 for every unknown of a fit, and where it is likely to lie whatever is missing.

    Eq. 14 is a bound, so it takes the upper end of what may be the model's part of the error.
    """
    model, seen = parts.undermodelling_interval, fit.examined
    subjects = []
    for unknown, value in zip(fit.problem.unknowns, fit.theta, strict=True):
        near_zero = abs(value) < NEAR_ZERO * unknown.size
        typical = unknown.kind == "nuisance" or near_zero
        reference = unknown.size if typical else float(value)
        known = unknown.prior[1] if unknown.prior else None
        ends, name, kind = (unknown.low, unknown.high), unknown.name, unknown.kind
        subjects.append(
            Subject(name, kind, unknown.unit, float(value), reference, known, ends=ends)
        )
    made = assess(
        subjects=subjects,
        psi=seen.psi,
        residual=influence(seen.residual) if fit.settings.loss == "huber" else seen.residual,
        stretches=stretches(seen.problem),
        noise=parts.noise,
        undermodelling=parts.undermodelling if model is None else model[1],
        level=seen.level,
        felt=felt_noise(seen),
    )
    return with_rivals(with_ranges(made, averaged), fit.rivals)
