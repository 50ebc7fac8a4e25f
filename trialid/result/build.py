"""The result of a run, from what it found."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, Literal

import numpy as np

from trialid.design.following import Narrowing
from trialid.design.helm import Vessel
from trialid.design.imo.trial_numbers import Manoeuvre, ManoeuvreNumber, Overshoot, TurnMeasure
from trialid.design.separation import Separation
from trialid.design.standard import Measure
from trialid.design.steering.nomoto import Nomoto
from trialid.design.wind_and_current import cannot_tell, in_speed
from trialid.diagnosis.another_value import follow_with_another_value
from trialid.diagnosis.diagnosed import Diagnosed, Diagnosis
from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.records.course_keeping import mostly_on_course
from trialid.diagnosis.where.finding import Finding
from trialid.diagnosis.where.misfit import Where
from trialid.identification.check.own_clock import own_clocks
from trialid.identification.fit import Fit
from trialid.identification.output_error import step_halving
from trialid.identification.remarks import another_mass, remarks
from trialid.plugins import packages
from trialid.result.accuracy_part import accuracy_part, weighting
from trialid.result.change_rows import ChangePart, MovedRow, Pair, StepRow
from trialid.result.finding_rows import FindingRow, RestRow, ShareRow, WhereElsePart
from trialid.result.fit_rows import (
    FitPart,
    IntervalPart,
    IterationRow,
    ModelPart,
    PartsRow,
    RouteRow,
    SplitPart,
    StartsPart,
)
from trialid.result.force_series import missing_force_part
from trialid.result.imo import imo_part, sailed_part
from trialid.result.json_file import finite
from trialid.result.missing_rows import missing_rows, verdict_part
from trialid.result.schema import Result
from trialid.result.trial_row import trial_row
from trialid.version import VERSION


@dataclass(frozen=True, kw_only=True)
class Findings(Diagnosis):
    """All that a run found.

    `proposal` is None where nothing is to be told apart, `narrowing` where no effect widens a
    range. `ship` is the fitted one as she is sailed, None where no rudder steers her. `measures`
    and all below are there where the pipeline asks for IMO's measures.
    """

    name: str
    pipeline: str
    proposal: Separation | None = None
    narrowing: Narrowing | None = None
    ship: Vessel | None = None
    measures: tuple[Measure, ...] = ()
    overshoots: tuple[Overshoot, ...] = ()
    turns: tuple[TurnMeasure, ...] = ()
    manoeuvres: tuple[Manoeuvre, ...] = ()
    measured: tuple[ManoeuvreNumber, ...] = ()
    steering: Nomoto | None = None


def result_from(found: Findings, **beside: Any) -> Result:
    """The result; `beside` holds the parts that findings do not know: history, sources, signals."""
    fit = found.before.fit
    return finite(
        Result(
            version=VERSION,
            versions=_versions(),
            pipeline=found.name,
            file=found.pipeline,
            trials=tuple(trial_row(s, found.before.band) for s in fit.scores),
            model=_model(fit),
            fit=_fit(found.before, missing=found.verdict.kind == "missing"),
            split=_split(found.before.split, found.before.routes),
            accuracy=replace(
                accuracy_part(found.before),
                narrowed_by=found.narrowing.sentence if found.narrowing else None,
            ),
            where=tuple(_finding(f) for f in found.where.findings),
            where_else=_where_else(found.where),
            missing=missing_rows(found),
            not_tried=dict(found.left_out),
            missing_force=None if found.force is None else missing_force_part(found.force),
            verdict=verdict_part(found.verdict, found.proposal),
            imo=imo_part(found),
            sailed=None if found.ship is None else sailed_part(found.ship),
            before_after=_before_after(found),
            **beside,
        )
    )


def steps_from(found: Findings) -> tuple[StepRow, ...]:
    """The model as it is, then the one proposed; earlier steps are the history file's to tell."""
    present = replace(_stage(found.before, "as written", None), verdict=found.verdict.kind)
    if found.after is None:
        return (finite(present),)
    return finite((present, _stage(found.after, "proposed", found.verdict.effect)))


def _versions() -> dict[str, str]:
    import platform

    import llvmlite
    import scipy

    return {
        "python": platform.python_version(),
        "numpy": np.__version__,
        "scipy": scipy.__version__,
        "llvmlite": llvmlite.__version__,
        **packages(),
    }


def _model(fit: Fit) -> ModelPart:
    model = fit.model
    return ModelPart(
        ship=model.ship.name,
        particulars=dict(model.ship.particulars),
        rudder_positive="starboard",
        states=tuple(model.states),
        effects=tuple(e.name for e in model.effects),
        free=tuple(fit.settings.free),
        inputs=tuple(fit.problem.simulator.equations.inputs),
        outputs=tuple(fit.problem.outputs),
        nuisance=tuple(fit.settings.nuisance),
    )


def _fit(done: Diagnosed, *, missing: bool) -> FitPart:
    """What is missing makes other values of a held-out trial: until it is there nobody asks."""
    fit = done.fit
    other = () if missing else follow_with_another_value(fit.examined)
    return FitPart(
        eps_rmsn=fit.eps_rmsn,
        eps_rmsn_by_output=fit.eps_by_output,
        eps_rmsn_check=fit.eps_check,
        eps_rmsn_check_by_output=fit.eps_check_by_output or None,
        V=fit.V,
        iterations=tuple(
            IterationRow(V=i.V, eps_rmsn=math.sqrt(2.0 * i.V), step=i.step) for i in fit.iterations
        ),
        converged=fit.converged,
        reason=fit.explanation,
        starts=StartsPart(agreeing=fit.agreeing[0], of=fit.agreeing[1]),
        samples=len(fit.residual),
        step_halving=step_halving(fit.problem, fit.theta) or None,
        substeps=fit.settings.substeps,
        weighting=weighting(fit),
        y_rms=dict(zip(fit.problem.outputs, map(float, fit.problem.y_rms), strict=True)),
        band=dict(done.band),
        search=fit.told,
        remarks=(
            *other,
            *remarks(fit),
            *mostly_on_course(fit),
            *own_clocks(fit, done.accuracy),
            *another_mass(fit, done.accuracy),
            *in_speed(fit, done.accuracy),
            *cannot_tell(fit, done.accuracy),
        ),
    )


def _split(split: Split, routes: Sequence[Split]) -> SplitPart:
    by_output = None
    if split.by_output is not None:
        by_output = {
            c: PartsRow(noise=x, undermodelling=m) for c, (x, m) in split.by_output.items()
        }
    chosen = _route(split)
    return SplitPart(
        noise=chosen.noise,
        undermodelling=chosen.undermodelling,
        method=chosen.method,
        why=chosen.why,
        interval=chosen.interval,
        by_output=by_output,
        routes=tuple(_route(r) for r in routes),
    )


def _route(split: Split) -> RouteRow:
    known = split.noise_interval is not None and split.undermodelling_interval is not None
    ends = IntervalPart(noise=split.noise_interval, undermodelling=split.undermodelling_interval)
    return RouteRow(
        noise=split.noise,
        undermodelling=split.undermodelling,
        method=split.method,
        why=split.why,
        interval=ends if known else None,
        available=split.available,
    )


def _finding(f: Finding) -> FindingRow:
    return FindingRow(
        output=f.output,
        finding=f.kind,
        doing=f.doing,
        share=f.share,
        excess=f.excess,
        p_value=f.p_value,
        t_start=f.t_start,
        t_end=f.t_end,
        trial=f.trial,
        sentence=f.sentence,
        picture=f.picture,
    )


def _where_else(found: Where) -> WhereElsePart:
    """What is no finding: shares by output, the noise described, what could not be examined."""
    return WhereElsePart(
        by_output=tuple(ShareRow(**asdict(row)) for row in found.by_output),
        rest=tuple(
            RestRow(output=r.output, sentence=r.sentence, picture=r.picture) for r in found.rest
        ),
        not_examined=found.not_examined,
        questions=found.questions,
    )


def _stage(d: Diagnosed, step: Literal["as written", "proposed"], added: str | None) -> StepRow:
    return StepRow(
        step=step,
        effects=tuple(e.name for e in d.fit.model.effects),
        added=added,
        dropped=None,
        eps_rmsn=d.fit.eps_rmsn,
        noise=d.split.noise,
        undermodelling=d.split.undermodelling,
        undermodelling_interval=d.split.undermodelling_interval,
        eps_rmsn_check=d.fit.eps_check,
        verdict=None,
        free=tuple(d.fit.settings.free),
        logs=tuple(g.sha256 for s in d.fit.scores for g in s.trial.logs),
        version=VERSION,
    )


def _before_after(found: Findings) -> ChangePart | None:
    if found.after is None or found.verdict.effect is None:
        return None
    before, after = found.before, found.after
    tried = (r.candidate.effect for r in found.refits)
    effect = next(e for e in tried if e.name == found.verdict.effect)
    checks = before.fit.eps_check, after.fit.eps_check
    return ChangePart(
        effect=effect.name,
        equation=effect.equation,
        eps_rmsn=(before.fit.eps_rmsn, after.fit.eps_rmsn),
        eps_rmsn_check=None if None in checks else checks,
        by_output={c: (x, after.fit.eps_by_output[c]) for c, x in before.fit.eps_by_output.items()},
        noise=_pair(before.split.noise, after.split.noise),
        undermodelling=_pair(before.split.undermodelling, after.split.undermodelling),
        undermodelling_interval=after.split.undermodelling_interval,
        parameters=_moved(before, after),
    )


def _pair(a: float | None, b: float | None) -> Pair | None:
    return None if a is None or b is None else (a, b)


def _moved(before: Diagnosed, after: Diagnosed) -> tuple[MovedRow, ...]:
    old = before.fit.estimates
    return tuple(
        MovedRow(
            name=p.name,
            unit=p.unit,
            before=old.get(p.name),
            after=p.value,
            standard_error=p.standard_error,
        )
        for p in after.accuracy.physical
    )
