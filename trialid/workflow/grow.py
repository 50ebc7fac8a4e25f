"""The loop that adds what is missing until nothing is: fit, diagnose, decide, add, and again.

Where her file says how well numbers are known that the model holds, and they do as well as what
would be added, they are free before that. Forward by the refit whose fall carries over best to
blocks left out, and shows on held-out trials once effects were added, or by two effects at once
where none alone stands every check; then backward, each effect that was added left out in turn, and
what no longer pays is dropped for good. It stops where the evidence ends, and never keeps what
raised the error of held-out trials. Names are given at the end, to what survives: what leaving it
out costs says how much it is worth. Nothing is written here.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

from trialid.diagnosis.objections import HELD_OUT, likeliest_refit
from trialid.diagnosis.search.backward import Worth, to_drop, worth_naming, worths
from trialid.diagnosis.search.falls import worse_held_out
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.together import Together
from trialid.errors import TrialidError
from trialid.pipeline_file import Pipeline
from trialid.pipeline_file.prior_section import OfTheShip
from trialid.progress import Progress
from trialid.result.change_rows import GrownRow, StepRow, names_in
from trialid.ship.effect import Effect
from trialid.trial import Trial
from trialid.workflow import history
from trialid.workflow.addition_fit import fit_addition
from trialid.workflow.edit_model import proposed_steps
from trialid.workflow.edit_pipeline import drop_from_pipeline, free_in_pipeline
from trialid.workflow.outcome import Run
from trialid.workflow.read_trials import align_trials
from trialid.workflow.run import examine

NAMELESS: Final = ("missing", "not in catalogue", "cannot tell")
"""Verdicts on which a model goes on growing: what carries over joins it, with a name or without."""

MOST: Final = 12
"""Effects it adds on its own; who needs more has another trouble."""


@dataclass(frozen=True)
class Stage:
    """One step of the loop.

    `run` is the model with `added` in it (effects, or numbers free, with a comma), or without
    `dropped` (both None: the model as written), unless it was not `kept`; then it is the model
    before, and `refused` says why. `end` says why the loop ends here, empty where it goes on.
    `worths` are those of the effects that were added, the dearest first.
    """

    pipeline: Pipeline
    run: Run
    added: str | None
    kept: bool
    end: str
    dropped: str | None = None
    worths: tuple[Worth, ...] = ()
    refused: str = ""


@dataclass
class _Path:
    """What the loop remembers: effects it added, what it will not try again, and families."""

    trials: tuple[Trial, ...]
    progress: Progress
    own: list[Effect] = field(default_factory=list)
    joined: set[str] = field(default_factory=set)
    tried: set[frozenset[str]] = field(default_factory=set)
    kin: dict[str, frozenset[str]] = field(default_factory=dict)
    added: int = 0

    def seen(self, run: Run) -> None:
        """Remember which effects this record does not separate."""
        for c in run.findings.ranking:
            self.kin[c.effect.name] = self.kin.get(c.effect.name, frozenset()) | {*c.family}

    def join(self, effect: Effect, displaced: Sequence[str]) -> None:
        """Remember an effect, in the place of those it displaced.

        The place of a gear that the file had is never empty: what stands there is not the loop's.
        """
        kept = [e for e in self.own if e.name not in displaced]
        if not displaced or len(kept) < len(self.own):
            kept.append(effect)
        self.own = kept

    def has_grown(self, pipeline: Pipeline) -> bool:
        """Whether the model has an effect that was added."""
        return not self.joined.isdisjoint(pipeline.model.effects)

    def held(self, run: Run) -> tuple[str, ...]:
        """Numbers that do as well as an effect, to be free first, each about her file's value."""
        names = run.findings.verdict.held_as_well
        about = names and isinstance(run.pipeline.identify.priors, OfTheShip)
        return names if about and frozenset(names) not in self.tried else ()

    def next_up(self, run: Run) -> Refit | Together | None:
        """What to add: what is named, and in later steps whatever stands every check.

        Where that is nothing, two effects at once, if two explain what none alone does.
        """
        return self._alone(run) or self._together(run)

    def _alone(self, run: Run) -> Refit | None:
        verdict, level = run.findings.verdict, run.pipeline.diagnose.level
        if verdict.kind not in NAMELESS if self.own else verdict.effect is None:
            return None
        fit = run.findings.before.fit
        able = [r for r in run.findings.refits if self._new((r.candidate.effect.name,))]
        named = next((r for r in able if r.candidate.effect.name == verdict.effect), None)
        return named or likeliest_refit(fit, able, level, grown=bool(self.own))

    def _together(self, run: Run) -> Together | None:
        found = run.findings.together
        return found if found is not None and self._new(found.names) else None

    def _new(self, names: Sequence[str]) -> bool:
        """Whether effects were neither tried together before, nor any of them dropped."""
        return not self.joined & {*names} and frozenset(names) not in self.tried

    def end(self, run: Run) -> str:
        """Why nothing more is to be added, empty where something is."""
        verdict = run.findings.verdict
        if self.held(run):
            return ""
        if self.next_up(run) is None:
            tried = verdict.effect is not None and not self._new((verdict.effect,))
            return f"{verdict.effect} was tried" if tried else f"the verdict is `{verdict.kind}`"
        return f"{MOST} effects were added, the most it adds on its own" * (self.added >= MOST)


def stages(pipeline: Pipeline, progress: Progress) -> Iterator[Stage]:
    """The model as written, then one stage for what is added, set free or dropped.

    Raises
    ------
    TrialidError
        The model as written cannot be fitted.
    """
    trials = align_trials(pipeline, progress)
    path = _Path(trials, progress)
    run = examine(pipeline, trials, progress)
    path.seen(run)
    stage = Stage(pipeline, run, None, True, path.end(run))
    yield stage
    while not stage.end:
        stage = _freed(path, stage) if path.held(stage.run) else _forward(path, stage)
        yield stage
        while stage.kept and (less := _backward(path, stage)) is not None:
            stage = less
            yield stage


def _forward(path: _Path, stage: Stage) -> Stage:
    """The stage with the next effect in the model, or why that is not kept."""
    up = path.next_up(stage.run)
    assert up is not None
    effects, before = up.effects, stage.run.findings.before.fit
    name = ", ".join(e.name for e in effects)
    path.tried.add(frozenset(e.name for e in effects))
    path.added += len(effects)
    try:
        after, fit, trouble = fit_addition(stage.pipeline, path.trials, before, up, path.progress)
        if trouble:
            return _not_kept(path, stage, name, f"{trouble} with {name}")
        run = examine(after, path.trials, path.progress, fit, grown=True)
        _check_carries(run)
    except TrialidError as error:
        return _not_kept(path, stage, name, f"with {name}: {error}")
    path.joined |= {e.name for e in effects}
    for effect in effects:
        path.join(effect, before.model.displaced_by(effect))
    return _told(path, after, run, added=name)


def _freed(path: _Path, stage: Stage) -> Stage:
    """The stage with numbers free that do as well as an effect, or why they stay as they are."""
    names, before = path.held(stage.run), stage.run.findings.before.fit
    path.tried.add(frozenset(names))
    name = ", ".join(names)
    try:
        after = free_in_pipeline(stage.pipeline, names)
        run = examine(after, path.trials, path.progress, grown=path.has_grown(after))
        _check_carries(run)
    except TrialidError as error:
        return _not_kept(path, stage, name, f"with {name} free: {error}")
    if worse_held_out(before, run.findings.before.fit):
        return _not_kept(path, stage, name, f"{HELD_OUT} with {name} free")
    return _told(path, after, run, added=name)


def _check_carries(run: Run) -> None:
    """Refuse a model whose fit carries no verdict, with the reason."""
    if run.findings.verdict.kind == "no fit":
        raise TrialidError(run.findings.verdict.sentence)


def _not_kept(path: _Path, stage: Stage, name: str, why: str) -> Stage:
    """The model before once more; the loop goes on where something else stands every check."""
    end = why if path.end(stage.run) else ""
    return replace(stage, added=name, dropped=None, kept=False, end=end, refused=why)


def _told(
    path: _Path, after: Pipeline, run: Run, added: str | None, dropped: str | None = None
) -> Stage:
    """The stage of a changed model, with what each effect in it is worth."""
    path.seen(run)
    fit = run.findings.before.fit
    path.progress("leaving out what was added", None)
    each = worths(fit, path.trials, path.own, path.kin)
    return Stage(
        pipeline=after,
        run=run,
        added=added,
        kept=True,
        end=path.end(run),
        dropped=dropped,
        worths=each,
    )


def _backward(path: _Path, stage: Stage) -> Stage | None:
    """The stage without what no longer pays, None where all of it does; twins cover each other."""
    if len(path.own) < 2:
        return None
    fit = stage.run.findings.before.fit
    idle = to_drop(fit, worths(fit, path.trials, path.own, known=stage.worths))
    if idle is None:
        return None
    try:
        edit = drop_from_pipeline(stage.pipeline, idle.effect)
        run = examine(edit.after, path.trials, path.progress, grown=True)
    except TrialidError:  # the file's own starts lead nowhere: the model stays as it is
        return None
    less = run.findings.before.fit
    failed = not less.converged or run.findings.verdict.kind == "no fit"
    if failed or worse_held_out(fit, less):
        return None
    path.own = [e for e in path.own if e.name != idle.effect]
    return _told(path, edit.after, run, None, idle.effect)


def survivors(done: Sequence[Stage]) -> tuple[str, ...]:
    """Effects that were added, and numbers set free, that still are so, as they came."""
    last = done[-1].pipeline
    there = {*last.model.effects, *last.identify.free}
    joined = (name for s in done if s.kept for name in names_in(s.added))
    return tuple(name for name in joined if name in there)


def conclude(done: Sequence[Stage]) -> tuple[Run, tuple[StepRow, ...]]:
    """The last model's run with the history of all stages, and the steps the file lacks.

    A model that is as written leaves no step behind.
    """
    first, last = done[0], done[-1]
    before, _ = history.read(first.pipeline.path)
    rows = [stage_row(s, s.run.result.present) for s in done[1:] if s.kept]
    told = (*history.continue_steps(before, first.run.result.present), *rows)
    result = replace(
        last.run.result,
        history=(*told, *proposed_steps(last.run.result)),
        grown=grown_rows(last.worths),
    )
    return replace(last.run, result=result), told[len(before) :] if rows else ()


def stage_row(stage: Stage, present: StepRow) -> StepRow:
    """A stage as a step of the history: how its model came about."""
    if stage.added:
        return replace(present, step="added", added=stage.added, dropped=None)
    if stage.dropped:
        return replace(present, step="dropped", added=None, dropped=stage.dropped)
    return replace(present, step="as written", added=None, dropped=None)


def grown_rows(found: Sequence[Worth]) -> tuple[GrownRow, ...]:
    """What each effect that was added is worth, the dearest first, and which of them are named."""
    names = worth_naming(found)
    return tuple(
        GrownRow(
            effect=w.effect,
            left_out_with_it=tuple(n for n in w.together if n != w.effect),
            costs=w.costs,
            named=w.effect in names,
        )
        for w in found
    )
