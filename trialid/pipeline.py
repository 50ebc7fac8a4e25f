"""The whole chain: logs, alignment, fit, accuracy, what the error is made of, what is missing."""

import hashlib
import json
import os
import shutil
import tempfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from trialid import history, ingest
from trialid.accuracy import Accuracy, Subject, assess
from trialid.alignment import LogClock, SignalSource, align
from trialid.assembly import (
    available,
    build_model,
    candidates,
    check_bounds,
    check_moving,
    check_quiet,
    declared_quiet,
    settings_of,
    stated_noise,
)
from trialid.design import following, observed
from trialid.design.observed import Overshoot
from trialid.design.separation import Separation
from trialid.design.standard import Measure
from trialid.diagnosis.augment import Augmented
from trialid.diagnosis.completeness import Completeness, completeness
from trialid.diagnosis.missing_effect import Verdict, decide, refit
from trialid.diagnosis.missing_force import MissingForce, missing_force
from trialid.diagnosis.noise import Split, split
from trialid.diagnosis.score import Candidate, rank
from trialid.diagnosis.where import where as stretches_that_fail
from trialid.errors import RecipeError
from trialid.identification.fit import Fit, identify, step_halving
from trialid.identification.gauss_newton import Iteration
from trialid.identification.output_error import stretches
from trialid.identification.pose import Settings
from trialid.ingest import Aids, LogFile
from trialid.recipe import Recipe, TrialRecipe
from trialid.recipe.form import ClockRecipe
from trialid.report.force import ForceSeries, force_series, write_force_csv
from trialid.report.overlay import write_mcap
from trialid.report.page import write_page
from trialid.report.series import OutputSeries, TrialSeries, write_csv
from trialid.result import Diagnosed, Findings, plain
from trialid.ship.effect import Effect
from trialid.ship.model import ShipModel
from trialid.threads import one_thread
from trialid.trial import Trial

Progress = Callable[[str, float | None], None]

NEAR_ZERO: Final = 0.05
"""An estimate below this share of its typical size is scaled by the latter."""

STEP_ERROR: Final = 0.05
"""Share of the error that integration may make up before steps are made finer."""

MOST_SUBSTEPS: Final = 16


@dataclass(frozen=True)
class Outcome:
    """What a finished run leaves behind: plain data, the time series, the force where sought."""

    recipe: Recipe
    result: Mapping[str, Any]
    series: tuple[TrialSeries, ...]
    force: MissingForce | None

    @property
    def forces(self) -> tuple[ForceSeries, ...]:
        """The missing force in time, as pages draw it; empty where it was not sought."""
        return () if self.force is None else force_series(self.force)


@dataclass(frozen=True)
class Run:
    """A finished run: its findings, the same as plain data, and the time series."""

    recipe: Recipe
    findings: Findings
    result: Mapping[str, Any]
    series: tuple[TrialSeries, ...]

    @property
    def force(self) -> MissingForce | None:
        """The missing force, where it was sought."""
        return self.findings.force

    @property
    def outcome(self) -> Outcome:
        """The run without the matrices of its fits, which take most of the room."""
        return Outcome(self.recipe, self.result, self.series, self.force)


@one_thread
def run(recipe: Recipe, progress: Progress = lambda words, share: None, force: bool = False) -> Run:
    """Everything from a pipeline, nothing written.

    With `force` the missing force is sought whatever the verdict, beside a named effect.

    Raises
    ------
    TrialidError
        The input is wrong; nothing is left behind.
    """
    return examine(recipe, align_trials(recipe, progress), progress, force=force)


@one_thread
def examine(
    recipe: Recipe,
    trials: tuple[Trial, ...],
    progress: Progress,
    fit: Fit | None = None,
    force: bool = False,
) -> Run:
    """Everything from aligned trials on; `fit` where the model is fitted already.

    Raises
    ------
    TrialidError
        As `run`.
    """
    check_quiet(recipe, trials)
    steps, remark = history.read(recipe.path)
    catalogue = available(recipe)
    fit = fit or fit_of(recipe, trials, catalogue, progress)
    findings = _findings(recipe, fit, catalogue, progress, force)
    progress("done", 1.0)
    result = plain(findings)
    present, *proposed = result["history"]
    result["history"] = [*history.continued(steps, present), *proposed]
    result |= {"history_remark": remark or None, "sources": sources_of(recipe)}
    result["signals"] = signals_of(recipe)
    return Run(recipe, findings, result, time_series(fit))


def _findings(
    recipe: Recipe, fit: Fit, catalogue: Mapping[str, Effect], progress: Progress, force: bool
) -> Findings:
    """What the error is made of, where it is, what is missing, and the model with it."""
    trials = [s.trial for s in fit.scores]
    level = recipe.diagnose.level
    before, ranking, augmented = diagnose(recipe, fit, catalogue, progress)
    refits = tuple(refit(fit, trials, worth_refitting(recipe, ranking),
                         lambda words: progress(words, 0.7)))  # fmt: skip
    moves = bool(recipe.model.states)  # else no force is missing, of whatever shape
    whole = completeness(fit, augmented) if moves else Completeness(0.0, 0.0)
    verdict = decide(fit, ranking, refits, before.split, whole, level)
    named = next((r for r in refits if r.candidate.effect.name == verdict.effect), None)
    after = diagnose(recipe, named.fit, catalogue, progress)[0] if named else None
    sought = None
    if moves and (force or verdict.kind == "not in catalogue"):
        progress("looking for the missing force", 0.9)
        sought = missing_force(named.fit if named else fit, level)
    measures, overshoots = _imo(recipe, before)
    return Findings(
        recipe.name, recipe.path.name, before, ranking, augmented.left_out, refits,
        verdict, stretches_that_fail(fit), after, sought,
        _proposal(fit, verdict, catalogue), measures, overshoots,
    )  # fmt: skip


def _proposal(fit: Fit, verdict: Verdict, catalogue: Mapping[str, Effect]) -> Separation | None:
    """The trial that would tell apart what this record cannot."""
    pair = following.by_name(catalogue, verdict.family)
    if pair is None:
        return None
    sizes = dict(zip(fit.problem.outputs, fit.problem.y_rms, strict=True))
    noise = {c: eps * float(sizes[c]) for c, eps in fit.eps_by_output.items()}
    return following.next_trial(fit, pair, noise)


def _imo(recipe: Recipe, done: Diagnosed) -> tuple[tuple[Measure, ...], tuple[Overshoot, ...]]:
    """IMO's measures of the fitted ship, where the pipeline asks for them."""
    if not recipe.imo:
        return (), ()
    measures = following.standard_measures(done.fit, done.accuracy, done.split.undermodelling)
    return measures, observed.overshoots(done.fit)


def fit_of(
    recipe: Recipe, trials: tuple[Trial, ...], catalogue: Mapping[str, Effect], progress: Progress
) -> Fit:
    """The fit of the pipeline's model.

    Raises
    ------
    TrialidError
        The model or the record does not allow one.
    """
    model = build_model(recipe, catalogue)
    settings = settings_of(recipe)
    check_bounds(recipe, model, settings)
    check_moving(recipe, model, trials)
    progress("fitting", 0.3)
    return fitted(trials, model, settings, progress)


def sources_of(recipe: Recipe) -> list[dict[str, str]]:
    """What the result rests on besides the logs: ship, the user's own effects, how to read logs."""
    logs = [log for trial in recipe.trials for log in trial.logs]
    aids = dict.fromkeys(aid for log in logs for aid in (log.template, log.dbc))
    return [
        {
            "path": _as_written(recipe, path).as_posix(),
            "sha256": hashlib.sha256(path.read_bytes()).hexdigest(),
        }
        for path in (recipe.ship, *recipe.model.effects_from, *aids)
        if path is not None
    ]


def signals_of(recipe: Recipe) -> list[dict[str, str]]:
    """Which channel each signal of each trial was read from."""
    return [
        {"trial": trial.name, "signal": quantity, "channel": source.channel}
        for trial in recipe.trials
        for quantity, source in trial.signals.items()
    ]


def fitted(
    trials: tuple[Trial, ...], model: ShipModel, settings: Settings, progress: Progress
) -> Fit:
    """The fit with integration steps so fine that they are no part of its error."""
    fit = identify(trials, model, settings, _fit_progress(progress))
    while (
        max(step_halving(fit).values(), default=0.0) > STEP_ERROR * fit.eps_rmsn
        and fit.settings.substeps < MOST_SUBSTEPS
    ):
        finer = replace(fit.settings, substeps=2 * fit.settings.substeps)
        progress(f"fitting again with {finer.substeps} steps a sample", None)
        fit = identify(trials, model, finer, _fit_progress(progress), near=fit.estimates)
    return fit


def align_trials(recipe: Recipe, progress: Progress) -> tuple[Trial, ...]:
    """Logs of every trial, read and brought onto one clock."""
    done = []
    for i, trial in enumerate(recipe.trials):
        progress(f"reading {trial.name}", 0.3 * i / len(recipe.trials))
        done.append(align_trial(recipe, trial))
    return tuple(done)


def align_trial(recipe: Recipe, trial: TrialRecipe) -> Trial:
    """Logs of one trial, read and brought onto one clock."""
    sources = [
        SignalSource(q, s.channel, s.unit, s.positive, s.angle, s.delay, s.gain, s.offset)
        for q, s in trial.signals.items()
    ]
    logs = [LogFile(g.path, Aids(g.template, g.dbc, g.zone)) for g in trial.logs]
    clocks = [_log_clock(g.clock) for g in trial.logs]
    matched = [name for clock in clocks if clock and clock.match for name in clock.match]
    recordings = ingest.read_together(logs, [s.channel for s in sources] + matched)
    recordings = tuple(replace(r, path=_as_written(recipe, r.path)) for r in recordings)
    made = align(
        trial.name, trial.use, recordings, sources, recipe.align.period, trial.window,
        repair=recipe.align.clocks == "repair",
        log_clocks=[c for g, c in zip(logs, clocks, strict=True) for _ in ingest.files_of(g)],
        keep={q: s.keep for q, s in trial.signals.items() if s.keep},
    )  # fmt: skip
    if trial.speed is None:
        return made
    if "u" in made.signals:
        remark = f"the stated speed {trial.speed:g} m/s is not used: u is recorded"
        return replace(made, remarks=(*made.remarks, remark))
    signals = {**made.signals, "u": np.full(made.samples, trial.speed)}
    valid = {**made.valid, "u": np.ones(made.samples, dtype=bool)}
    remark = f"u is the stated approach speed {trial.speed:g} m/s, not a record"
    return replace(made, signals=signals, valid=valid, remarks=(*made.remarks, remark))


def _log_clock(clock: ClockRecipe | None) -> LogClock | None:
    if clock is None:
        return None
    within = {} if clock.within is None else {"within": clock.within}
    return LogClock(clock.offset, clock.drift or 0.0, clock.events or (), clock.match, **within)


def _as_written(recipe: Recipe, path: Path) -> Path:
    """A log's path from the pipeline's folder, so that a result holds no place of one machine."""
    folder = recipe.path.parent.resolve()
    return Path(os.path.relpath(path.resolve(), folder))


def _fit_progress(progress: Progress) -> Callable[[Iteration], None]:
    count = 0

    def tell(iteration: Iteration) -> None:
        nonlocal count
        count += 1
        share = 0.3 + 0.3 * count / (count + 10.0)
        progress(f"fitting: iteration {count}, error {np.sqrt(2.0 * iteration.V):.2%}", share)

    return tell


def diagnose(
    recipe: Recipe, fit: Fit, catalogue: Mapping[str, Effect], progress: Progress
) -> tuple[Diagnosed, tuple[Candidate, ...], Augmented]:
    """What the error is made of, how far the parameters can be trusted, and the ranking."""
    progress("looking for what is missing", 0.65)
    ranking, augmented = rank(
        fit, candidates(recipe, catalogue), recipe.diagnose.family_cos, recipe.diagnose.level
    )
    best, routes = split(fit, augmented, stated_noise(recipe), declared_quiet(recipe))
    return Diagnosed(fit, accuracy_of(fit, best), best, routes), ranking, augmented


def worth_refitting(recipe: Recipe, ranking: tuple[Candidate, ...]) -> tuple[Candidate, ...]:
    """The best candidates that stand out and are physical."""
    standing = [c for c in ranking if c.allowed and c.p_value < recipe.diagnose.level]
    return tuple(standing[: recipe.diagnose.refit])


def accuracy_of(fit: Fit, parts: Split) -> Accuracy:
    """Eq. 8 to 14 for every unknown of a fit."""
    subjects = []
    for unknown, value in zip(fit.problem.unknowns, fit.theta, strict=True):
        near_zero = abs(value) < NEAR_ZERO * unknown.size
        typical = unknown.kind == "nuisance" or near_zero
        reference = unknown.size if typical else float(value)
        known = unknown.prior[1] if unknown.prior else None
        subjects.append(
            Subject(unknown.name, unknown.kind, unknown.unit, float(value), reference, known)
        )
    return assess(
        subjects, fit.psi, fit.residual, stretches(fit.problem), parts.noise, parts.undermodelling
    )


def time_series(fit: Fit) -> tuple[TrialSeries, ...]:
    """Measured and predicted of every trial, for the report."""
    outputs = fit.problem.outputs
    names = fit.problem.simulator.equations.inputs
    return tuple(
        TrialSeries(
            s.trial.name, s.trial.use, s.trial.t,
            {n: s.trial.signals[n] for n in names if n in s.trial.signals},
            tuple(
                OutputSeries(c, s.trial.signals[c], s.response.y[:, i], s.compared[:, i])
                for i, c in enumerate(outputs)
            ),
        )
        for s in fit.scores
    )  # fmt: skip


def write(done: Run | Outcome, folder: Path) -> None:
    """The run's folder: report, result, series, a recording that opens in plot tools, the pipeline.

    Everything is written beside and moved in place at the end, so that a run that is broken off
    leaves the old folder or the new one, never half of one.

    Raises
    ------
    RecipeError
        The place exists and is no folder of a run.
    """
    if folder.exists() and not (folder / "result.json").exists() and any(folder.iterdir()):
        raise RecipeError(
            f"--out {folder}: exists and is not the folder of a run; name another place"
        )
    made = [parent for parent in folder.parents if not parent.exists()]
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        _write_beside(done, folder)
    finally:
        if not folder.exists():
            for parent in made:
                with suppress(OSError):
                    parent.rmdir()


def _write_beside(done: Run | Outcome, folder: Path) -> None:
    work = Path(tempfile.mkdtemp(prefix=".trialid-", dir=folder.parent))
    new, old = work / "new", work / "old"
    try:
        new.mkdir()
        _write_files(done, new)
        _write_origin(done, new, folder)
        if folder.exists():
            folder.replace(old)
        new.replace(folder)
    finally:
        if old.exists() and not folder.exists():
            old.replace(folder)
        shutil.rmtree(work, ignore_errors=True)


def _write_files(done: Run | Outcome, folder: Path) -> None:
    text = json.dumps(done.result, indent=1, allow_nan=False)
    (folder / "result.json").write_text(text + "\n", encoding="utf-8")
    write_csv(folder / "series.csv", done.series)
    write_mcap(folder / "predicted.mcap", done.result, done.series)
    forces = force_series(done.force) if done.force is not None else ()
    if forces:
        write_force_csv(folder / "missing_force.csv", forces)
    write_page(folder / "report.html", done.result, done.series, forces)
    (folder / "pipeline.toml").write_bytes(done.recipe.content)


def _write_origin(done: Run | Outcome, work: Path, folder: Path) -> None:
    """`run.json`: what `trialid run --repeat` needs to find the logs again from the folder."""
    recipe = done.recipe
    origin = {
        "schema": "trialid-run/1",
        "version": done.result["version"],
        "pipeline": Path(os.path.relpath(recipe.path.resolve(), folder.resolve())).as_posix(),
        "sha256": hashlib.sha256(recipe.content).hexdigest(),
        "seed": recipe.identify.seed,
        "force": done.force is not None,
    }
    text = json.dumps(origin, indent=1) + "\n"
    (work / "run.json").write_text(text, encoding="utf-8")
