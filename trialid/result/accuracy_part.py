"""The accuracy of a fit as rows of a result."""

from collections.abc import Sequence

import numpy as np

from trialid.accuracy.parameter_table import Accuracy, ParameterAccuracy
from trialid.errors import EffectError
from trialid.identification.fit import Fit
from trialid.result.fit_rows import (
    AccuracyPart,
    LeversPart,
    ParameterRow,
    StabilityPart,
    WeakRow,
)
from trialid.ship.model import ShipModel
from trialid.ship.stability import PARTS, Stability, stability


def accuracy_part(fit: Fit, accuracy: Accuracy) -> AccuracyPart:
    """Sensitivities, errors and stability of a fit, with what weights and scales them in words."""
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
        stability=_stability(fit.model, accuracy),
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


def _stability(model: ShipModel, accuracy: Accuracy) -> StabilityPart | None:
    turning = tuple(n for n in ("Yurm", "Kurm") if n in model.parameters)
    values = _values(model, (*PARTS, "m", "x_G", *turning))
    if values is None or values["Yv"] == 0.0:
        return None
    names = tuple(p.name for p in accuracy.parameters)
    plain_form = stability(values, names, accuracy.covariance)
    coupled_values = _values(model, (*PARTS, "m", "x_G", "z_G", "Kv", "Kr", "GM", *turning))
    coupled = None
    if coupled_values is not None and model.ship.particulars["U0"] > 0.0:
        full = coupled_values | _heel(model)
        coupled = _levers(stability(full, names, accuracy.covariance, coupled=True))
    return StabilityPart(**vars(_levers(plain_form)), roll_coupled=coupled)


def _values(model: ShipModel, names: Sequence[str]) -> dict[str, float] | None:
    if any(n not in model.parameters for n in names):
        return None
    try:
        return {n: model.value(n) for n in names}
    except EffectError:
        return None


def _heel(model: ShipModel) -> dict[str, float]:
    """Heel derivatives (zero where no effect has them) and the stiffness G_phi; primed."""
    known = {n: model.value(n) if n in model.parameters else 0.0 for n in ("Yphi", "Nphi", "Kphi")}
    p = model.ship.particulars
    stiffness = 2.0 * p["g"] * p["nabla"] * model.value("GM") / (p["L"] ** 3 * p["U0"] ** 2)
    return {"Yphi": known["Yphi"], "Nphi": known["Nphi"], "G_phi": stiffness - known["Kphi"]}


def _levers(s: Stability) -> LeversPart:
    return LeversPart(
        L_r=s.L_r,
        L_v=s.L_v,
        margin=s.margin,
        standard_error=s.standard_error,
        stable=s.stable,
    )


def weighting(fit: Fit) -> str:
    """How outputs count, in words."""
    about = "its own mean" if fit.settings.norm == "mean" else "zero"
    weights = fit.problem.weights
    equal = bool(np.allclose(weights, 1.0))
    listed = ", ".join(f"{c} {w:.3g}" for c, w in zip(fit.problem.outputs, weights, strict=True))
    counted = "all outputs count alike" if equal else f"weights {listed}"
    return f"residuals over y_RMS of the output about {about}, all trials pooled; {counted}"
