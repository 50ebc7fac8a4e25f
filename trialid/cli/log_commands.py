"""The commands about logs alone: what is in them, and their aligned series."""

import json
import sys
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from trialid import temporary
from trialid.cli.answering import check_trial_names
from trialid.cli.console import file_width, note, progress_bar, render, say
from trialid.cli.particulars_options import (
    KNOT,
    given_from,
    option_names,
    particulars_options,
    water_option,
)
from trialid.errors import TrialidError

if TYPE_CHECKING:
    from trialid.inspection import Inspection
    from trialid.ship.estimate import Given
    from trialid.workflow.first_pipeline import Starter

FILE: Final = click.Path(path_type=Path)
OF_THE_SHIP: Final = (
    *("--length", "--beam", "--draught", "--block", "--displacement", "--gm", "--roll-period"),
    *("--rudder-area", "--rho"),
)
"""What `--init` asks for; `trialid ship` takes more."""


def _options(*options: Callable[..., Any]) -> Callable[[Callable[..., None]], Callable[..., None]]:
    """Many options as one decorator, in the order of the help."""

    def of(command: Callable[..., None]) -> Callable[..., None]:
        for option in reversed(options):
            command = option(command)
        return command

    return of


@click.command(short_help="Show what is in a log; begin a pipeline.")
@_options(
    click.argument("logs", nargs=-1, required=True, type=FILE, metavar="LOG..."),
    click.option("--all", "everything", is_flag=True, help="Show every channel, not only those "
                 "that look like a ship's motion."),
    click.option("--init", "pipeline", type=FILE, metavar="PIPELINE.toml",
                 help="Write a pipeline to begin with: a trial each log, one of several held "
                 "out."),
    click.option("--ship", type=FILE, metavar="SHIP.toml", help="With --init: the ship's file."),
    particulars_options(*OF_THE_SHIP, prefix="With --init and no --ship: her "),
    click.option("--speed", type=click.FloatRange(min=0, min_open=True), metavar="KNOTS",
                 help="With --init: the approach speed, where no log tells it."),
    click.option("--template", type=FILE, metavar="FILE",
                 help="Write a draft of the template that says how the table LOG is laid out."),
    click.option("--with-template", "layout", type=FILE, metavar="FILE",
                 help="Read tables as this template says."),
    click.option("--dbc", type=FILE, help="What the frames of a CAN bus mean."),
    click.option("--zone", help="Time zone of stamps that state none, like Europe/Oslo."),
    click.option("--json", "as_json", is_flag=True, help="Print plain data, and nothing else."),
)  # fmt: skip
def inspect(
    logs: tuple[Path, ...], everything: bool, pipeline: Path | None, ship: Path | None,
    speed: float | None, template: Path | None, layout: Path | None, dbc: Path | None,
    zone: str | None, as_json: bool, **particulars: Any,
) -> None:  # fmt: skip
    """Show what is in each LOG, a file or a folder of files: channels, rates, gaps, clocks.

    Channels that look like a ship's motion come first, with how that is known. What cannot be
    known from the log alone, as the side a rudder counts positive, is said, with the evidence.
    """
    if template is not None:
        _draft_template(logs, template)
        return
    given = given_from(particulars)
    check_new_pipeline(pipeline, ship, speed, given)
    surveys = look_into(logs, layout, dbc, zone)
    if as_json:
        _print_plain(surveys)
    else:
        _print_tables(surveys, everything)
    if pipeline is not None:
        _begin(surveys, pipeline, ship, speed, given)


@click.command(short_help="Write aligned series for other programs.")
@_options(
    click.argument("pipeline", type=FILE),
    click.option("--out", type=FILE, required=True, metavar="FILE",
                 help="Where to; the suffix says the format: .csv, .parquet, .mat or .mcap."),
    click.option("--trial", "only", multiple=True, metavar="NAME",
                 help="Only this trial; may be given again."),
    click.option("--force", is_flag=True, help="Replace FILE."),
    click.option("--quiet", is_flag=True, help="No progress and no summary."),
)  # fmt: skip
def align(pipeline: Path, out: Path, only: tuple[str, ...], force: bool, quiet: bool) -> None:
    """Write the aligned series of PIPELINE, a TOML file, for other programs; nothing is fitted.

    All in SI with the unit in each name, on one clock for each trial; what was not measured is
    empty or NaN. Channels, remarks and hashes of the logs are inside, of CSV in FILE.json.
    """
    from trialid import export
    from trialid.pipeline_file import load, sources

    export.check_place(out, replace=force)
    asked = load(pipeline)
    export.check_unread(out, sources(asked))
    check_trial_names(only, [trial.name for trial in asked.trials], pipeline)
    from trialid.export.provenance import provenance
    from trialid.workflow.quantities_read import quantities_of
    from trialid.workflow.read_trials import align_trials

    wanted = asked.model_copy(
        update={"trials": tuple(t for t in asked.trials if not only or t.name in only)}
    )
    with progress_bar(shown=not quiet and sys.stderr.isatty()) as progress:
        trials = align_trials(wanted, progress)
        export.write(out, trials, provenance(wanted, trials, quantities_of(wanted)))
    for trial in () if quiet else trials:
        names = ", ".join(trial.signals)
        say(f"{trial.name}: {trial.samples} samples, {trial.period:g} s apart: {names}")
    if not quiet:
        say(f"Written: {out}")


def look_into(
    logs: Sequence[Path], template: Path | None, dbc: Path | None, zone: str | None
) -> list["Inspection"]:
    """What the logs hold; a folder of several trials is several."""
    from trialid.ingest import Aids
    from trialid.ingest.times.local_time import known_zone
    from trialid.inspection import inspect_trials

    for file in (template, dbc):
        if file is not None and not file.is_file():
            raise TrialidError(f"{file}: no such file")
    if zone is not None:
        try:
            known_zone(zone)
        except ValueError as error:
            raise TrialidError(f"--zone: {error}") from error
    aids = Aids(template, dbc, zone)
    with progress_bar(shown=sys.stderr.isatty()) as progress:
        found: list[Inspection] = []
        left_out: list[str] = []
        for place, path in enumerate(logs):
            progress(f"reading {path.name}", place / len(logs))
            found += inspect_trials(path, aids, left_out.append)
    for words in left_out:
        note(f"Left out: {words}")
    return found


def _print_plain(surveys: Sequence["Inspection"]) -> None:
    """One log: its survey; several: a list of them."""
    from trialid.report.files.log_data import plain

    data = [plain(one) for one in surveys]
    say(json.dumps(data[0] if len(data) == 1 else data, indent=2, allow_nan=False))


def _print_tables(surveys: Sequence["Inspection"], everything: bool) -> None:
    from trialid.report.terminal.log_contents import inspection

    for place, one in enumerate(surveys):
        gap = ("",) if place else ()
        say(render(*gap, *inspection(one, everything=everything), width=file_width()))


def check_new_pipeline(
    pipeline: Path | None,
    ship: Path | None,
    speed: float | None,
    given: "Given",
    option: str = "--init",
) -> None:
    """Refuse, before the logs are read, what cannot be written; `option` asked for it."""
    _check_said(pipeline, ship, speed, [*option_names(given), *water_option(given)])
    if pipeline is None:
        return
    _check_given(f"{option} {pipeline}", given)
    if pipeline.suffix != ".toml":
        raise TrialidError(f"{option} {pipeline}: a pipeline file ends in .toml")
    if not pipeline.parent.is_dir():
        raise TrialidError(
            f"{option} {pipeline}: there is no folder {pipeline.parent}; make it first"
        )
    temporary.check_writable(pipeline.parent, option)
    from trialid.workflow.first_pipeline import begun_ship

    for file in (pipeline, *([begun_ship(pipeline)] if ship is None else [])):
        if file.exists():
            raise TrialidError(f"{option} {pipeline}: {file} exists; name another pipeline")


def _check_said(
    pipeline: Path | None, ship: Path | None, speed: float | None, of_her: Sequence[str]
) -> None:
    """Refuse what makes no sense together."""
    beside = {"--ship": ship, "--speed": speed}
    said = [*of_her, *(name for name, value in beside.items() if value is not None)]
    if pipeline is None and said:
        raise click.UsageError(f"{said[0]} goes with --init")
    if ship is not None and of_her:
        raise click.UsageError(f"{of_her[0]} is for a new ship file; that of --ship has its own")


def _check_given(place: str, given: "Given") -> None:
    """Refuse a ship that cannot be; where nothing is known of her, the logs are read first."""
    from trialid.errors import ShipError
    from trialid.ship.estimate.all_numbers import refusal
    from trialid.ship.estimate.impossible import complaints

    if (wrong := complaints(given)) and option_names(given):
        raise ShipError(f"{place}: {refusal(wrong)}")


def _begin(
    surveys: Sequence["Inspection"], pipeline: Path, ship: Path | None, speed: float | None,
    given: "Given",
) -> None:  # fmt: skip
    """Write the starter, and say what is left to do, on stderr."""
    begun = begin_pipeline(surveys, pipeline, ship, speed, given)
    for path in begun.files:
        note(f"Written: {path}")
    for words in begun.left_out:
        note(f"Left out: {words}")
    for words in begun.to_fill:
        note(f"To fill in: {words}")
    if not begun.to_fill:
        from trialid.pipeline_file import load

        load(pipeline)
        note(f"Read its comments, then: trialid run {pipeline}")


def begin_pipeline(
    surveys: Sequence["Inspection"],
    pipeline: Path,
    ship: Path | None,
    speed: float | None,
    given: "Given",
) -> "Starter":
    """Write the pipeline to begin with; each manoeuvre that a long log holds is a trial."""
    from trialid.pipeline_file import load
    from trialid.workflow.first_pipeline import starter
    from trialid.workflow.first_pipeline.long_log import manoeuvre_windows

    stated = None if speed is None else speed * KNOT
    begun = starter(surveys, pipeline, ship, given, stated)
    write_new(begun.files)
    if begun.to_fill:
        return begun
    windows = manoeuvre_windows(load(pipeline), [one.survey for one in begun.trials])
    if not any(windows):
        return begun
    cut = starter(surveys, pipeline, ship, given, stated, windows)
    with temporary.replace_whole(pipeline) as draft:  # which stands there since a moment ago
        draft.write_text(cut.files[pipeline], encoding="utf-8")
    return cut


def write_new(files: Mapping[Path, str]) -> None:
    """Write new files, and replace none."""
    for path, text in files.items():
        try:
            temporary.write_new(path, text)
        except OSError as error:
            raise TrialidError(f"{path}: {(error.strerror or str(error)).lower()}") from error


def _draft_template(logs: Sequence[Path], template: Path) -> None:
    """Write what a table's layout seems to be, for the user to review."""
    from trialid import ingest

    if len(logs) != 1:
        raise click.UsageError("--template drafts the layout of one table; name one LOG")
    draft: Callable[[Path], str] | None = getattr(ingest, "draft_template", None)
    if draft is None:
        raise TrialidError("--template: this version drafts no templates")
    if template.exists():
        raise TrialidError(f"--template {template}: exists; name another file")
    temporary.check_writable(template.parent, "--template")
    write_new({template: draft(logs[0])})
    note(f"Written: {template}")
    note(f"Review it, then: trialid inspect {logs[0]} --with-template {template}")
