"""Structures compared: each trial left out in turn, and once more without any use of each trial."""

from dataclasses import replace
from itertools import combinations
from pathlib import Path

import numpy as np

from trialid import own_files
from trialid.diagnosis.one_standard_error import Choice
from trialid.errors import NotIdentifiable, PipelineError
from trialid.pipeline_file import Pipeline, where
from trialid.progress import Progress, silent
from trialid.report.words.structure_words import sentences
from trialid.result.fit_rows import LogRow
from trialid.result.json_file import text_of
from trialid.result.structure_rows import NAME, StructureRow, Structures
from trialid.threads import one_thread
from trialid.version import VERSION
from trialid.workflow.origin import sources_of
from trialid.workflow.structures.asked_structures import Structure
from trialid.workflow.structures.comparison import Comparison
from trialid.workflow.structures.rounds import FITS, Compute, Rounds


@one_thread
def compare_structures(
    pipeline: Pipeline,
    progress: Progress = silent,
    folder: Path | None = None,
    stability: bool = True,
    compute: Compute | None = None,
) -> Structures:
    """Every structure with its error on trials left out, and the simplest that is as good.

    Parameters
    ----------
    folder
        Where fits are kept as they are done and found again, and `structures.json` is written;
        None writes nothing.
    stability
        Whether the choice is made again without any use of each trial.
    compute
        What does many fits at once; None does one after the other, here. The digits are the same.

    Raises
    ------
    TrialidError
        The input is wrong, only one trial is fitted, no structure can be fitted at all, or the
        folder holds what is not ours.
    """
    if folder is not None:
        own_files.check_folder(folder, (NAME, FITS), "comparison")
    _check_trials(pipeline)
    compared = Comparison(pipeline, progress)
    rounds = Rounds(compared=compared, folder=folder, progress=progress, compute=compute)
    rounds.fit([()])
    if all(reasons := [rounds.why_not(s) for s in rounds.structures]):
        raise NotIdentifiable(f"no structure can be fitted: {reasons[0]}")
    rounds.fit([(name,) for name in rounds.names])
    again = dict[str, Choice | None]()
    if stability and len(rounds.names) > 2:
        rounds.fit(list(combinations(rounds.names, 2)))
        again = {name: rounds.choice(name) for name in rounds.names}
    found = _result(pipeline, rounds, again)
    if folder is not None:
        with own_files.replacing(folder, below=(NAME,)) as work:
            (work / NAME).write_text(text_of(found), encoding="utf-8")
    return found


def _check_trials(pipeline: Pipeline) -> None:
    if sum(trial.use == "fit" for trial in pipeline.trials) < 2:
        raise PipelineError(
            f"{where(pipeline, 'trial')}: structures are compared by leaving out whole trials, and "
            "only one is fitted here; fit two or more (stretches of one trial share its start, its "
            "sensors and its weather, and flatter every structure)"
        )


def _result(pipeline: Pipeline, rounds: Rounds, again: dict[str, Choice | None]) -> Structures:
    choice = rounds.choice()
    rows = [_row(s, rounds, choice) for s in rounds.structures]
    logs = [g for t in rounds.compared.trials for g in t.logs]
    found = Structures(
        version=VERSION,
        pipeline=pipeline.name,
        file=pipeline.path.name,
        trials=rounds.names,
        logs=tuple(LogRow(path=g.path, sha256=g.sha256, adapter=g.adapter) for g in logs),
        sources=sources_of(pipeline),
        rows=tuple(sorted(rows, key=lambda row: (row.why_not is not None, row.behind or 0.0))),
        not_tried=rounds.compared.not_tried,
        best=choice.best if choice else None,
        chosen=choice.simplest if choice else None,
        chosen_without={name: each.simplest if each else None for name, each in again.items()},
    )
    return replace(found, sentences=sentences(found))


def _row(structure: Structure, rounds: Rounds, choice: Choice | None) -> StructureRow:
    name, whole = structure.name, rounds.done[structure.name, ()]
    fits = [rounds.done.get((name, (n,))) for n in rounds.names]
    errors = {n: x for fit in fits if fit for n, x in fit.errors.items()}
    behind, error = choice.behind.get(name, (None, None)) if choice else (None, None)
    return StructureRow(
        name=name,
        effects=tuple(effect.name for effect in structure.model.effects),
        free=structure.settings.free,
        parameters=whole.parameters or None,
        eps_rmsn=whole.eps_rmsn,
        eps_rmsn_check=whole.eps_rmsn_check,
        left_out=errors,
        unforetold=tuple(n for fit in fits if fit for n in fit.unforetold),
        eps_rmsn_left_out=float(np.mean(list(errors.values()))) if behind is not None else None,
        behind=behind,
        behind_standard_error=error,
        as_good=choice is not None and name in choice.as_good,
        why_not=rounds.why_not(structure) or None,
    )
