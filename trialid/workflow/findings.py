"""All that a run finds out: the diagnosis, the next trial, standard measures."""

from collections.abc import Mapping
from contextlib import suppress
from typing import Any, Final

import numpy as np

from trialid.accuracy.likely import student
from trialid.design import following
from trialid.design.following import Narrowing
from trialid.design.helm import Vessel
from trialid.design.imo import observed
from trialid.design.imo.trial_measures import measure_trials
from trialid.design.prediction.likely_spread import LikelySpread, likely_spread
from trialid.design.separation import Separation
from trialid.design.standard import Measure, embrace
from trialid.design.steering.nomoto import Nomoto, nomoto
from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import Diagnosed, DiagnoseSettings, Diagnosis
from trialid.diagnosis.search.freed import candidates_to_free
from trialid.diagnosis.verdict import Verdict
from trialid.errors import DesignError
from trialid.identification.fit import Fit
from trialid.inspection.channel_names import over_ground
from trialid.inspection.name_words import is_through_water
from trialid.pipeline_file import Pipeline
from trialid.progress import Progress
from trialid.result.build import Findings
from trialid.second_process import both
from trialid.ship.effect import Effect
from trialid.workflow.build_model import candidates, declared_quiet, stated_noise

OVER_GROUND: Final = ("current_in_speed_record", "drift_in_speed_record", "current_in_surge")
"""What is tried of a speed that may be one over ground. Of two strangers' ships whose channel was
`stw`, or a water speed by its format, a current of 2.5 m/s had a name, and a compass's deviation
was called one."""


def diagnose_settings(pipeline: Pipeline, catalogue: Mapping[str, Effect]) -> DiagnoseSettings:
    """The pipeline's `[diagnose]` as the diagnosis takes it.

    Raises
    ------
    PipelineError
        A listed effect does not exist.
    """
    asked = pipeline.diagnose
    tried = candidates(pipeline, catalogue)
    if asked.candidates == "all" and _says_water(pipeline):
        tried = {name: one for name, one in tried.items() if name not in OVER_GROUND}
    return DiagnoseSettings(
        candidates=tried,
        coefficients=asked.candidates == "all",
        family_cos=asked.family_cos,
        level=asked.level,
        refit=asked.refit,
        noise=stated_noise(pipeline),
        quiet=declared_quiet(pipeline),
    )


def _says_water(pipeline: Pipeline) -> bool:
    """Whether in every trial the channel of the speed says that it is through the water."""
    read = [trial.signals.get("u") for trial in pipeline.trials]
    return all(
        one and one.channel and is_through_water(one.channel) and not over_ground(one.channel, None)
        for one in read
    )


def find_out(
    pipeline: Pipeline,
    fit: Fit,
    catalogue: Mapping[str, Effect],
    progress: Progress,
    *,
    force: bool,
    grown: bool,
) -> Findings:
    """The diagnosis of a pipeline's fit, and what follows from it."""
    found = diagnose(
        fit, diagnose_settings(pipeline, catalogue), progress, force=force, grown=grown
    )
    ship = _ship(found.before.fit)
    progress("looking for the trial to sail next", 0.95)
    (narrowing, imo), proposed = both(
        lambda: (narrowing_trial(found, catalogue), _imo(pipeline, found, ship)),
        lambda: proposal(found.before.fit.examined, found.verdict, catalogue),
    )
    return Findings(
        **vars(found),
        name=pipeline.name,
        pipeline=pipeline.path.name,
        proposal=proposed,
        narrowing=narrowing,
        ship=ship,
        **imo,
    )


def _steering(ship: Vessel | None, spread: LikelySpread) -> Nomoto | None:
    """Nomoto's numbers of the fitted ship; None where she has none."""
    try:
        return None if ship is None else nomoto(ship, spread)
    except DesignError:
        return None


def proposal(fit: Fit, verdict: Verdict, catalogue: Mapping[str, Effect]) -> Separation | None:
    """The trial that would tell apart what this record cannot."""
    pair = following.by_name({**catalogue, **candidates_to_free(fit)}, verdict.family)
    return None if pair is None else following.next_trial(fit, pair, _noise(fit))


def _noise(fit: Fit) -> dict[str, float]:
    """What is left of each output [SI]."""
    sizes = dict(zip(fit.problem.outputs, fit.problem.y_rms, strict=True))
    return {c: eps * float(sizes[c]) for c, eps in fit.eps_by_output.items()}


def narrowing_trial(found: Diagnosis, catalogue: Mapping[str, Effect]) -> Narrowing | None:
    """The trial that would narrow the widest likely range, where an effect makes it so."""
    fit, rows = found.before.fit.examined, found.before.accuracy.physical
    rows = tuple(r for r in rows if r.may_be_off is not None)
    if found.verdict.kind == "no fit" or not rows:
        return None
    worst = max(rows, key=lambda r: r.may_be_off or 0.0)
    effect = catalogue.get(worst.widened_by or "")
    if effect is None:
        return None
    return following.narrowing_trial(fit, worst.name, effect, _noise(fit))


def _ship(fit: Fit) -> Vessel | None:
    """The fitted ship as she is sailed; None where no rudder steers her."""
    try:
        return following.sailed_ship(fit)
    except DesignError:
        return None


def _imo(pipeline: Pipeline, found: Diagnosis, ship: Vessel | None) -> dict[str, Any]:
    """IMO's measures of the fitted ship and of the trials, where the pipeline asks for them.

    Their ranges hold what other models say beside which the parameters are, too.
    """
    if not pipeline.imo:
        return {}
    done, fit = found.before, found.before.fit
    spread = _spread(done)
    wider = {
        p.name: float(student(p.freedom) / student(np.inf)) for p in done.own_accuracy.parameters
    }
    errors = {p.name: wider[p.name] * p.standard_error for p in done.own_accuracy.parameters}
    sailed = measure_trials(fit, errors, spread)
    by_heading = {one.trial for one in sailed.numbers if one.kind == "zig-zag"}
    integrals = (one for one in observed.overshoots(fit) if one.trial not in by_heading)
    measures, steering = following.measures_within(fit, spread), _steering(ship, spread)
    for _, other in done.others:
        measures, steering = _beside(measures, steering, other)
    return {
        "measures": measures,
        "overshoots": tuple(integrals),
        "turns": sailed.turns,
        "manoeuvres": sailed.manoeuvres,
        "measured": sailed.numbers,
        "steering": steering,
    }


def _spread(done: Diagnosed) -> LikelySpread:
    """All that predictions by a fit are uncertain by."""
    off = done.doubts
    return likely_spread(
        done.fit, done.own_accuracy.covariance, off.standing, off.held, off.missing
    )


def _beside(
    measures: tuple[Measure, ...], steering: Nomoto | None, other: Diagnosed
) -> tuple[tuple[Measure, ...], Nomoto | None]:
    """The same with ranges that hold those of another model of the ship.

    What an effect makes of her that cannot be sailed, as an order that comes late, widens none.
    """
    spread, fit = _spread(other), other.fit
    with suppress(DesignError):
        measures = embrace(measures, following.measures_within(fit, spread))
    there = None if steering is None else _steering(_ship(fit), spread)
    return measures, steering if steering is None or there is None else steering.embracing(there)
