"""The fleet file: TOML that names ships, their voyages or pipelines, and what varies."""

import re
from collections.abc import Iterator, Mapping
from datetime import date
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field

from trialid.errors import nearest
from trialid.pipeline_file import check_form, content_of, table_of
from trialid.pipeline_file.allowed_values import NotEmpty, Rounds, Whole
from trialid.pipeline_file.complaints import Problem, dotted_key, refusal
from trialid.pipeline_file.form import Written
from trialid.pipeline_file.named_file import Origin, ReadFile
from trialid.pipeline_file.section import Section


def _as_list(given: Any) -> Any:
    return [given] if isinstance(given, str) else given


Patterns = Annotated[tuple[NotEmpty, ...], BeforeValidator(_as_list)]


class FleetShip(Section):
    """One ship: where her voyages or her pipelines are; a run each."""

    file: ReadFile | None = None
    """Her ship file, in place of the template's."""
    voyages: Patterns = ()
    """Folders of logs, one a voyage, as paths or patterns like `"logs/alpha/*"`; where the template
    has one trial with one log, files do as well. The template is fitted to each."""
    pipelines: Patterns = ()
    """Pipelines that are complete, as paths or patterns; a run each."""
    dates: Mapping[str, date] = {}
    """When a voyage or pipeline was, by the name of its folder or file without suffix; left out:
    the date `YYYY-MM-DD` that the name begins with, if it does."""


class VarySection(Section):
    """What varies beside ships and voyages: every run is done in each of these ways."""

    trial: Literal["as written", "leave one out"] = "as written"
    """`"leave one out"`: the run as written, and one for each fitted trial with that one held
    out."""
    structure: Literal["as written", "each"] = "as written"
    """`"each"`: a run for each list of the pipeline's `[structures]`, in place of its own
    effects."""
    seed: tuple[Whole, ...] = ()
    """A run for each of these seeds, in place of `identify.seed`."""
    bootstrap: Rounds | None = None
    """The run as written, and so many whose fitted trials are drawn from its own, with
    replacement."""
    bootstrap_seed: Whole = 0
    """Seed of those draws."""


class FleetFile(Written):
    """A fleet file, complete."""

    name: NotEmpty
    """What the fleet is called; left out: the file's name."""
    template: ReadFile | None = None
    """The pipeline that is fitted to each voyage; it runs by itself on the logs it names."""
    files: Mapping[str, Patterns] = {}
    """What the logs of a trial of the template are called in the folder of a voyage, by the trial's
    name: a pattern for each log; left out: as in the template."""
    logs: Literal["path", "content"] = "path"
    """How logs travel to the workers: by their path, where all see the same folders, or
    `"content"`."""
    ships: Annotated[Mapping[str, FleetShip], Field(alias="fleet", min_length=1)]
    """The ships, a table `[fleet.NAME]` each."""
    vary: VarySection = VarySection()
    """What varies beside ships and voyages."""


def load_fleet(path: Path) -> FleetFile:
    """Give the fleet in a TOML file.

    Raises
    ------
    PipelineError
        In one line: the file, the key's full path, what is wrong, the nearest valid names.
    """
    content = content_of(path, "fleet")
    table = table_of(content, path, "fleet")
    fleet = check_form(FleetFile, table, Origin(path, content))
    if problems := list(_contradictions(fleet)):
        raise refusal(path, problems)
    return fleet


def matches(folder: Path, pattern: str) -> list[Path]:
    """What a path or pattern names below a folder, hidden things left out, by name.

    Numbers in names go by value: trip 3 before trip 10.
    """
    plain = folder / pattern
    base, rest = (Path("/"), pattern[1:]) if pattern.startswith("/") else (folder, pattern)
    try:
        found = [plain] if plain.exists() else base.glob(rest)
        return sorted((path for path in found if not path.name.startswith(".")), key=_by_name)
    except (OSError, ValueError):  # a name too long for any file, or no pattern
        return []


def _by_name(path: Path) -> tuple[list[str | int], str]:
    """What paths are sorted by: text as it is, numbers by value; alike in that, by their digits."""
    parts = re.split(r"([0-9]+)", "\0".join(path.parts))
    return [int(part) if place % 2 else part for place, part in enumerate(parts)], str(path)


def _contradictions(fleet: FleetFile) -> Iterator[Problem]:
    """Everything wrong that no single key shows."""
    for name, ship in fleet.ships.items():
        yield from _ship_problems(fleet, name, ship)
    if fleet.files and fleet.template is None:
        yield "files", "goes with a template, and none is named; leave it out"


def _ship_problems(fleet: FleetFile, name: str, ship: FleetShip) -> Iterator[Problem]:
    at = ("fleet", name)
    if not ship.voyages and not ship.pipelines:
        yield dotted_key(*at), "names neither voyages nor pipelines; write one of them"
    if ship.voyages and fleet.template is None:
        yield dotted_key(*at, "voyages"), "need a pipeline to be fitted; name it: template = ..."
    if ship.file is not None and not ship.voyages:
        yield dotted_key(*at, "file"), "goes with voyages; a pipeline names its own ship"
    yield from _path_problems(fleet, name, ship)


def _path_problems(fleet: FleetFile, name: str, ship: FleetShip) -> Iterator[Problem]:
    at, found = ("fleet", name), list[str]()
    for key in ("voyages", "pipelines"):
        for place, pattern in enumerate(getattr(ship, key)):
            there = matches(fleet.path.parent, pattern)
            found += [path.stem if path.is_file() else path.name for path in there]
            if not there:
                yield dotted_key(*at, key, place), f"{pattern!r} names nothing that is there"
    for voyage in ship.dates:
        if voyage not in found:
            known = nearest(voyage, found)
            yield dotted_key(*at, "dates", voyage), f"no such voyage or pipeline; {known}"
