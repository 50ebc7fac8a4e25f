"""Which runs a fleet file asks for: every voyage of every ship in every way that varies."""

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from datetime import date
from pathlib import Path
from typing import Final

from trialid.errors import PipelineError, TrialidError, nearest
from trialid.export.tracks import stems
from trialid.fleet.pipeline_changes import Change, changed_text, move_files, put_files
from trialid.fleet.task import PIPELINES, Hash, Task, file_hash, files_of, key_of
from trialid.fleet.variations import variations
from trialid.pipeline_file import Pipeline, load, read, where
from trialid.pipeline_file.complaints import dotted_key
from trialid.pipeline_file.fleet_file import FleetFile, FleetShip, matches
from trialid.result.fleet_rows import RunLabel
from trialid.workflow import history

_DATE: Final = re.compile(r"\d{4}-\d{2}-\d{2}(?!\d)")


@dataclass(frozen=True)
class Begun:
    """A voyage with the pipeline that is fitted to it, before anything varies.

    `logs` is the folder or file of the voyage, None for a pipeline that is complete.
    """

    ship: str
    voyage: str
    date: date | None
    pipeline: Path
    logs: Path | None


def plan(fleet: FleetFile, folder: Path) -> tuple[Task, ...]:
    """The runs of a fleet whose results go to a folder, ship by ship, in the order of voyages.

    What cannot be begun is a task with its problem; the others are not stopped by it.

    Raises
    ------
    PipelineError
        The template itself is wrong.
    """
    if fleet.template is not None:
        _check_files(fleet, load(fleet.template))
    asked = [run for begun in voyages(fleet) for run in _asked(fleet, begun, folder)]
    names = stems(run.label.run for run in asked)
    hash_of = file_hash()
    return tuple(
        _task(replace(run, label=replace(run.label, run=name)), folder, hash_of)
        for run, name in zip(asked, names, strict=True)
    )


def _check_files(fleet: FleetFile, template: Pipeline) -> None:
    names = [trial.name for trial in template.trials]
    for name in fleet.files:
        if name not in names:
            key = where(fleet, dotted_key("files", name))
            raise PipelineError(f"{key}: the template has no such trial; {nearest(name, names)}")


@dataclass(frozen=True, kw_only=True)
class Asked:
    """A run before its pipeline is written: the pipeline it begins with, and what is changed."""

    label: RunLabel
    place: Path
    pipeline: Pipeline | None = None
    changes: tuple[Change, ...] = ()
    problem: str = ""


def voyages(fleet: FleetFile) -> Iterator[Begun]:
    """Every voyage of every ship: those with a date in that order, then the others by name."""
    folder = fleet.path.parent
    for name, ship in fleet.ships.items():
        found = [
            _begun(name, ship, path, fleet.template if key == "voyages" else None)
            for key in ("voyages", "pipelines")
            for path in _named(folder, getattr(ship, key))
        ]
        found.sort(key=lambda each: (each.date is None, each.date or date.min))
        yield from found


def _named(folder: Path, patterns: tuple[str, ...]) -> list[Path]:
    return list(dict.fromkeys(path for each in patterns for path in matches(folder, each)))


def _begun(name: str, ship: FleetShip, path: Path, template: Path | None) -> Begun:
    voyage = path.stem if path.is_file() else path.name
    when = ship.dates.get(voyage) or _stated_date(voyage)
    if template is None:
        return Begun(name, voyage, when, path, None)
    return Begun(name, voyage, when, template, path)


def _stated_date(name: str) -> date | None:
    """The date that a name begins with, None where it begins with none.

    >>> _stated_date("2025-03-14 zig-zag"), _stated_date("2025-13-14"), _stated_date("zig-zag")
    (datetime.date(2025, 3, 14), None, None)
    """
    found = _DATE.match(name)
    try:
        return date.fromisoformat(found[0]) if found else None
    except ValueError:
        return None


def is_no_day(name: str) -> bool:
    """Whether a name begins like a date, and with none of the calendar.

    >>> is_no_day("2024-02-30 zig-zag"), is_no_day("2024-02-29"), is_no_day("zig-zag")
    (True, False, False)
    """
    return _DATE.match(name) is not None and _stated_date(name) is None


def _asked(fleet: FleetFile, begun: Begun, folder: Path) -> Iterator[Asked]:
    """A run for each way in which a voyage is done, or the reason why there is none."""
    label = RunLabel(
        run=f"{begun.ship}-{begun.voyage}", ship=begun.ship, voyage=begun.voyage, date=begun.date
    )
    place = begun.pipeline
    try:
        pipeline = load(place)
        ways = list(variations(fleet.vary, pipeline, label))
        voyage = _voyage_changes(fleet, begun, pipeline, folder)
    except TrialidError as error:
        yield Asked(label=label, place=place, problem=_of(place, error))
        return
    for one, changes in ways:
        yield Asked(label=one, place=place, pipeline=pipeline, changes=(*voyage, *changes))


def _of(place: Path, error: Exception) -> str:
    """What is wrong, without the path of the pipeline that the row is about."""
    return str(error).removeprefix(f"{place}: ")


def _voyage_changes(
    fleet: FleetFile, begun: Begun, pipeline: Pipeline, folder: Path
) -> list[Change]:
    """What of the template is another for this voyage."""
    if begun.logs is None:
        return []
    place = _place(folder, begun.voyage)
    logs = {
        trial.name: _logs_of(begun.logs, trial.name, [g.path for g in trial.logs], fleet)
        for trial in pipeline.trials
    }
    if begun.logs.is_file() and sum(map(len, logs.values())) != 1:
        raise PipelineError(
            f"{begun.logs.name}: is a file, and the template reads {sum(map(len, logs.values()))} "
            "logs; name a folder that holds them"
        )
    return [put_files(fleet.ships[begun.ship].file, logs, place)]


def _logs_of(voyage: Path, trial: str, written: list[Path], fleet: FleetFile) -> list[Path]:
    """The logs of a trial in the folder of a voyage: by their patterns, or called as written.

    Raises
    ------
    PipelineError
        There is none, or more than one.
    """
    if voyage.is_file():
        return [voyage for _ in written]
    patterns = fleet.files.get(trial) or tuple(path.name for path in written)
    if len(patterns) != len(written):
        raise PipelineError(
            f"files.{trial}: names {len(patterns)} logs, and the template's trial has "
            f"{len(written)}; write a pattern for each"
        )
    return [_only(voyage, trial, pattern) for pattern in patterns]


def _only(voyage: Path, trial: str, pattern: str) -> Path:
    found = matches(voyage, pattern)
    if len(found) != 1:
        count = "none" if not found else str(len(found))
        raise PipelineError(
            f"{voyage.name}: holds {count} of the one log {pattern!r} of trial {trial!r}; "
            "write its name into [files]"
        )
    return found[0]


def _place(folder: Path, name: str) -> Path:
    return folder / PIPELINES / f"{name}.toml"


def _task(run: Asked, folder: Path, hash_of: Hash) -> Task:
    """A run with its pipeline as text, and the key of all that goes into it."""
    if run.pipeline is None:
        return Task(label=run.label, pipeline=run.place, content=b"", problem=run.problem)
    place, content = run.place, run.pipeline.content
    if run.changes:
        place = _place(folder, run.label.run)
        place.parent.mkdir(parents=True, exist_ok=True)  # which files are seen from
        changes = [move_files(run.pipeline, place), *run.changes]
        content = changed_text(content, run.label.run, changes)
    made = Task(label=run.label, pipeline=place, content=content, made=bool(run.changes))
    try:
        pipeline = read(content, place)
        files, grown = files_of(pipeline), made.made and _has_grown(run.place, pipeline)
        key = key_of(content, place, files, hash_of, grown)
        return replace(made, files=files, grown=grown, key=key)
    except (TrialidError, OSError) as error:
        return replace(made, made=False, problem=_of(place, error))


def _has_grown(template: Path, pipeline: Pipeline) -> bool:
    """Whether what is made of a template has effects that were added to that."""
    steps, _ = history.read(template)
    return history.has_joined(steps, pipeline.model.effects)
