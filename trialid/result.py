"""The result of a run as plain data: `result.json`, schema trialid-result/1.

Numbers are SI unless a unit stands beside them; what is not known is None, never 0.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np

import trialid
from trialid.accuracy import Accuracy, ParameterAccuracy
from trialid.design.observed import Overshoot
from trialid.design.separation import Separation
from trialid.design.standard import Measure
from trialid.diagnosis.leftover.finding import Bars, Finding, Spectrum
from trialid.diagnosis.missing_effect import Refit, Verdict
from trialid.diagnosis.missing_force import MissingForce
from trialid.diagnosis.noise import Split
from trialid.diagnosis.score import VISIBLE, Candidate
from trialid.diagnosis.where import Where
from trialid.errors import EffectError
from trialid.identification.fit import Fit, step_halving
from trialid.report.design_data import of_measures
from trialid.report.force import missing_force_data
from trialid.ship.model import ShipModel
from trialid.ship.stability import PARTS, Stability, stability

SCHEMA: Final = "trialid-result/1"
Plain = dict[str, Any]


@dataclass(frozen=True)
class Diagnosed:
    """One fit with everything that was found out about it."""

    fit: Fit
    accuracy: Accuracy
    split: Split
    routes: tuple[Split, ...]


@dataclass(frozen=True)
class Findings:
    """All that a run found.

    `after` is the confirmed refit, diagnosed in its turn; None where no effect was named. `force`
    is None where nobody asked and the verdict is another; `proposal` where nothing is to be told
    apart. `measures` and `overshoots` are there where the pipeline asks for IMO's measures.
    """

    name: str
    pipeline: str
    before: Diagnosed
    ranking: tuple[Candidate, ...]
    left_out: Mapping[str, str]
    refits: tuple[Refit, ...]
    verdict: Verdict
    where: Where
    after: Diagnosed | None
    force: MissingForce | None = None
    proposal: Separation | None = None
    measures: tuple[Measure, ...] = ()
    overshoots: tuple[Overshoot, ...] = ()


def plain(found: Findings) -> Plain:
    """Everything as plain data, ready for `json.dumps`."""
    fit = found.before.fit
    return finite(
        {
            "schema": SCHEMA,
            "version": trialid.__version__,
            "versions": _versions(),
            "pipeline": found.name,
            "file": found.pipeline,
            "trials": [_trial(s) for s in fit.scores],
            "model": _model(fit),
            "fit": _fit(fit),
            "split": _split(found.before.split, found.before.routes),
            "accuracy": _accuracy(fit, found.before.accuracy),
            "where": [_finding(f) for f in found.where.findings],
            "where_else": _where_else(found.where),
            "missing": _missing(found),
            "not_tried": dict(found.left_out),
            "missing_force": None if found.force is None else missing_force_data(found.force),
            "verdict": _verdict(found.verdict, found.proposal),
            "imo": _imo(found),
            "history": _history(found),
            "before_after": _before_after(found),
        }
    )


def finite(value: Any) -> Any:
    """Infinite and undefined numbers have no place in JSON: they are not known."""
    if isinstance(value, Mapping):
        return {k: finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [finite(v) for v in value]
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    return value


def _versions() -> Plain:
    import platform

    import llvmlite
    import scipy

    return {
        "python": platform.python_version(),
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "llvmlite": llvmlite.__version__,
    }


def _trial(score: Any) -> Plain:
    trial = score.trial
    return {
        "name": trial.name,
        "use": trial.use,
        "logs": [{"path": g.path, "sha256": g.sha256, "adapter": g.adapter} for g in trial.logs],
        "samples": trial.samples,
        "period": trial.period,
        "duration": trial.duration,
        "remarks": [*trial.remarks, *_departure(score)],
        "eps_rmsn": dict(score.eps_rmsn),
    }


def _departure(score: Any) -> list[str]:
    departure = score.response.departure
    return [] if departure is None else [f"simulation: {departure}; so the trial has no score"]


def _model(fit: Fit) -> Plain:
    model = fit.model
    return {
        "ship": model.ship.name,
        "rudder_positive": "starboard",
        "states": list(model.states),
        "effects": [e.name for e in model.effects],
        "free": list(fit.settings.free),
        "inputs": list(fit.problem.simulator.equations.inputs),
        "outputs": list(fit.problem.outputs),
        "nuisance": list(fit.settings.nuisance),
    }


def _fit(fit: Fit) -> Plain:
    return {
        "eps_rmsn": fit.eps_rmsn,
        "eps_rmsn_by_output": fit.eps_by_output,
        "eps_rmsn_check": fit.eps_check,
        "eps_rmsn_check_by_output": fit.eps_check_by_output or None,
        "V": fit.V,
        "iterations": [
            {"V": i.V, "eps_rmsn": math.sqrt(2.0 * i.V), "step": i.step} for i in fit.iterations
        ],
        "converged": fit.converged,
        "reason": fit.explanation,
        "starts": {"agreeing": fit.agreeing[0], "of": fit.agreeing[1]},
        "samples": len(fit.residual),
        "step_halving": step_halving(fit) or None,
        "substeps": fit.settings.substeps,
        "weighting": weighting(fit),
        "y_rms": dict(zip(fit.problem.outputs, map(float, fit.problem.y_rms), strict=True)),
    }


def weighting(fit: Fit) -> str:
    """How outputs count, in words."""
    about = "its own mean" if fit.settings.norm == "mean" else "zero"
    weights = fit.problem.weights
    equal = bool(np.allclose(weights, 1.0))
    listed = ", ".join(f"{c} {w:.3g}" for c, w in zip(fit.problem.outputs, weights, strict=True))
    counted = "all outputs count alike" if equal else f"weights {listed}"
    return f"residuals over y_RMS of the output about {about}, all trials pooled; {counted}"


def _split(split: Split, routes: Sequence[Split]) -> Plain:
    chosen = _route(split)
    chosen["by_output"] = (
        None
        if split.by_output is None
        else {c: {"noise": x, "undermodelling": m} for c, (x, m) in split.by_output.items()}
    )
    return {**chosen, "routes": [_route(r) | {"available": r.available} for r in routes]}


def _route(split: Split) -> Plain:
    interval = None
    if split.noise_interval is not None and split.undermodelling_interval is not None:
        interval = {
            "noise": list(split.noise_interval),
            "undermodelling": list(split.undermodelling_interval),
        }
    return {
        "noise": split.noise,
        "undermodelling": split.undermodelling,
        "method": split.method,
        "why": split.why,
        "interval": interval,
    }


def _accuracy(fit: Fit, accuracy: Accuracy) -> Plain:
    return {
        "S_min": accuracy.S_min,
        "S_max": accuracy.S_max,
        "R": accuracy.R,
        "n_effective": accuracy.n_effective,
        "weighting": weighting(fit),
        "scaling": (
            "relative to the estimate, or to the typical size where the estimate is near zero and "
            "for nuisance parameters; S_min, S_max and R of the physical parameters, with "
            "everything projected out that nuisance parameters can mimic"
        ),
        "parameters": [_parameter(p) for p in accuracy.parameters],
        "weak": [
            {"sentence": w.sentence, "parameters": list(w.parameters),
             "relative_error": w.relative_error, "moves": dict(w.moves)}
            for w in accuracy.weak
        ],
        "stability": _stability(fit.model, accuracy),
    }  # fmt: skip


def _parameter(p: ParameterAccuracy) -> Plain:
    """One row; the two parts of Eq. 14 and their sum are relative, other errors in the unit."""
    size = abs(p.reference)
    return {
        "name": p.name,
        "value": p.value,
        "unit": p.unit,
        "S_i": p.S_i,
        "S_imin": p.S_imin,
        "R_i": p.R_i,
        "relative_error": p.relative_error,
        "noise_error": None if p.noise_error is None else p.noise_error / size,
        "undermodelling_error": (
            None if p.undermodelling_error is None else p.undermodelling_error / size
        ),
        "standard_error": p.standard_error,
        "white_error": p.white_error,
        "n_effective": p.n_effective,
        "kind": p.kind,
    }


def _stability(model: ShipModel, accuracy: Accuracy) -> Plain | None:
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
    return _levers(plain_form) | {"roll_coupled": coupled}


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


def _levers(s: Stability) -> Plain:
    return {
        "L_r": s.L_r,
        "L_v": s.L_v,
        "margin": s.margin,
        "standard_error": s.standard_error,
        "stable": s.stable,
    }


def _finding(f: Finding) -> Plain:
    return {
        "output": f.output,
        "finding": f.kind,
        "doing": f.doing,
        "share": f.share,
        "excess": f.excess,
        "p_value": f.p_value,
        "t_start": f.t_start,
        "t_end": f.t_end,
        "trial": f.trial,
        "sentence": f.sentence,
        "picture": _picture(f.picture),
    }


def _picture(picture: Bars | Spectrum) -> Plain:
    """What a finding's picture is drawn from, in the units of reports."""
    form = "bars" if isinstance(picture, Bars) else "spectrum"
    return {"form": form, **asdict(picture)}


def _where_else(found: Where) -> Plain:
    """What is no finding: shares by output, the noise described, what could not be examined."""
    return {
        "by_output": [asdict(row) for row in found.by_output],
        "rest": [
            {"output": r.output, "sentence": r.sentence, "picture": _picture(r.picture)}
            for r in found.rest
        ],
        "not_examined": list(found.not_examined),
        "questions": found.questions,
    }


def _missing(found: Findings) -> list[Plain]:
    refitted = {r.candidate.effect.name: r.fit for r in found.refits}
    # the named one first: what was foreseen by linearisation gives way to what was fitted
    ordered = sorted(found.ranking, key=lambda c: c.effect.name != found.verdict.effect)
    return [_candidate(i + 1, c, refitted.get(c.effect.name), found) for i, c in enumerate(ordered)]


def _candidate(rank: int, c: Candidate, refit: Fit | None, found: Findings) -> Plain:
    return {
        "rank": rank,
        "effect": c.effect.name,
        "equation": c.effect.equation,
        "family": list(c.family),
        "cosines": dict(c.cosines),
        "parameters": {n: _expected(c, n, refit) for n in c.expected},
        "eps_rmsn_predicted": c.eps_predicted,
        "eps_rmsn_refitted": refit.eps_rmsn if refit else None,
        "eps_rmsn_check": refit.eps_check if refit else None,
        "score": c.score,
        "p_value": c.p_value,
        "visibility": c.visibility,
        "verdict": _standing(c, found),
        "sentence": _sentence(c, refit, found),
    }


def _expected(c: Candidate, name: str, refit: Fit | None) -> Plain:
    """A parameter of a candidate, with the ends of its physical range; None where open."""
    parameter = c.effect.parameters[name]
    return {
        "expected": c.expected[name] if c.visibility > VISIBLE else None,
        "refitted": refit.estimates[name] if refit else None,
        "unit": parameter.unit,
        "low": parameter.low,
        "high": parameter.high,
    }


def _standing(c: Candidate, found: Findings) -> str:
    if c.effect.name == found.verdict.effect:
        return "missing"
    if c.effect.name in found.verdict.family:
        return "same family"
    if c.visibility <= VISIBLE:
        return "not visible"
    if not c.allowed:
        return "unphysical"
    return "stands out" if c.p_value < 0.05 else "no evidence"


def _sentence(c: Candidate, refit: Fit | None, found: Findings) -> str:
    eps = found.before.fit.eps_rmsn
    if c.visibility <= VISIBLE:
        return f"{c.effect.name} leaves no trace here that the free parameters could not leave too"
    said = f"would bring the error from {eps:.2%} to {c.eps_predicted:.2%} (p = {c.p_value:.2g})"
    if refit is not None:
        said += f"; fitted, it brings it to {refit.eps_rmsn:.2%}"
    return f"{c.effect.name} {said}"


def _verdict(v: Verdict, proposal: Separation | None) -> Plain:
    return {
        "kind": v.kind,
        "effect": v.effect,
        "family": list(v.family),
        "sentence": v.sentence,
        "next_trial": None if proposal is None else _next_trial(proposal),
    }


def _next_trial(proposal: Separation) -> Plain:
    """The trial that would tell rivals apart, or that none of those any crew can run does."""
    name = proposal.programme[0].name
    told = f"{name}: {proposal.sentence}" if proposal.after.separate else proposal.sentence
    return {
        "sentence": told,
        "test": name if proposal.after.separate else None,
        "effects": list(proposal.names),
        "cosine": proposal.after.cosine,
        "cosine_before": None if proposal.before is None else proposal.before.cosine,
    }


def _imo(found: Findings) -> Plain | None:
    """Standard measures, predicted; overshoots the trials hold, measured beside predicted."""
    if not found.measures:
        return None
    return {
        "measures": of_measures(found.measures),
        "speed_simulated": "u" in found.before.fit.model.states,
        "overshoots": [asdict(one) for one in found.overshoots],
    }


def _history(found: Findings) -> list[Plain]:
    """The model as it is, then the one proposed; earlier steps are the history file's to tell."""
    rows = [_stage(found.before, "as written", None) | {"verdict": found.verdict.kind}]
    if found.after is not None:
        rows.append(_stage(found.after, "proposed", found.verdict.effect))
    return rows


def _stage(d: Diagnosed, step: str, added: str | None) -> Plain:
    return {
        "step": step,
        "effects": [e.name for e in d.fit.model.effects],
        "added": added,
        "dropped": None,
        "eps_rmsn": d.fit.eps_rmsn,
        "noise": d.split.noise,
        "undermodelling": d.split.undermodelling,
        "undermodelling_interval": list(d.split.undermodelling_interval or ()) or None,
        "eps_rmsn_check": d.fit.eps_check,
        "verdict": None,
        "free": list(d.fit.settings.free),
        "logs": [g.sha256 for s in d.fit.scores for g in s.trial.logs],
        "version": trialid.__version__,
    }


def _before_after(found: Findings) -> Plain | None:
    if found.after is None or found.verdict.effect is None:
        return None
    before, after = found.before, found.after
    effect = next(e for e in after.fit.model.effects if e.name == found.verdict.effect)
    checks = [before.fit.eps_check, after.fit.eps_check]
    return {
        "effect": effect.name,
        "equation": effect.equation,
        "eps_rmsn": [before.fit.eps_rmsn, after.fit.eps_rmsn],
        "eps_rmsn_check": None if None in checks else checks,
        "by_output": {
            c: [x, after.fit.eps_by_output[c]] for c, x in before.fit.eps_by_output.items()
        },
        "noise": _pair(before.split.noise, after.split.noise),
        "undermodelling": _pair(before.split.undermodelling, after.split.undermodelling),
        "undermodelling_interval": list(after.split.undermodelling_interval or ()) or None,
        "parameters": _moved(before, after),
    }


def _pair(a: float | None, b: float | None) -> list[float] | None:
    return None if a is None or b is None else [a, b]


def _moved(before: Diagnosed, after: Diagnosed) -> list[Plain]:
    old = before.fit.estimates
    return [
        {
            "name": p.name,
            "unit": p.unit,
            "before": old.get(p.name),
            "after": p.value,
            "standard_error": p.standard_error,
        }
        for p in after.accuracy.physical
    ]
