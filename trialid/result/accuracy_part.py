"""The accuracy of a fit as rows of a result."""

import numpy as np

from trialid.accuracy.parameter_table import ParameterAccuracy
from trialid.diagnosis.diagnosed import Diagnosed
from trialid.identification.fit import Fit
from trialid.result.fit_rows import AccuracyPart, ParameterRow, WeakRow
from trialid.result.stability_part import stability_part


def accuracy_part(done: Diagnosed) -> AccuracyPart:
    """Sensitivities, errors and stability of a fit, with what weights and scales them in words."""
    fit, accuracy = done.fit, done.accuracy
    known = {x.name: x.prior for x in fit.problem.unknowns}
    return AccuracyPart(
        S_min=accuracy.S_min,
        S_max=accuracy.S_max,
        R=accuracy.R,
        n_effective=accuracy.n_effective,
        weighting=weighting(fit),
        scaling=(
            "relative to the estimate, or to the typical size where the estimate is near zero and "
            "for nuisance parameters; S_min, S_max and R of the physical parameters, with "
            "everything projected out that nuisance parameters can mimic"
        ),
        parameters=tuple(_parameter(p, known.get(p.name)) for p in accuracy.parameters),
        weak=tuple(
            WeakRow(
                sentence=w.sentence,
                parameters=w.parameters,
                relative_error=w.relative_error,
                moves=dict(w.moves),
            )
            for w in accuracy.weak
        ),
        stability=stability_part(done),
    )


def _parameter(p: ParameterAccuracy, prior: tuple[float, float] | None) -> ParameterRow:
    """One row; the two parts of Eq. 14 and their sum are relative, other errors in the unit."""
    size = abs(p.reference)
    return ParameterRow(
        name=p.name,
        value=p.value,
        unit=p.unit,
        S_i=p.S_i,
        S_imin=p.S_imin,
        R_i=p.R_i,
        relative_error=p.relative_error,
        noise_error=None if p.noise_error is None else p.noise_error / size,
        undermodelling_error=(
            None if p.undermodelling_error is None else p.undermodelling_error / size
        ),
        standard_error=p.standard_error,
        white_error=p.white_error,
        n_effective=p.n_effective,
        freedom=p.freedom,
        likely=p.likely,
        widened_by=p.widened_by,
        kind=p.kind,
        prior=prior,
        prior_share=p.prior_share,
    )


def weighting(fit: Fit) -> str:
    """How outputs count, in words."""
    about = "each trial's own mean" if fit.settings.norm == "mean" else "zero"
    weights = fit.problem.weights
    equal = bool(np.allclose(weights, 1.0))
    listed = ", ".join(f"{c} {w:.3g}" for c, w in zip(fit.problem.outputs, weights, strict=True))
    counted = "all outputs count alike" if equal else f"weights {listed}"
    return f"residuals over y_RMS of the output about {about}, all trials pooled; {counted}"
