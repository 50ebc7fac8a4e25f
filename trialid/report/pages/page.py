"""The report page: one HTML file with everything inside, made from the result and the series."""

from collections.abc import Sequence
from functools import cache
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any

from trialid.names import labels, wording
from trialid.report.pictures import bars, error_history, force_plots, panels, where_pictures
from trialid.report.pictures.track_picture import track_picture
from trialid.report.script import script
from trialid.report.tables import imo_tables, run_tables, use_tables
from trialid.report.words import advice, beforehand, doubt, fall, ranking
from trialid.result.change_rows import ChangePart
from trialid.result.finding_rows import CandidateRow
from trialid.result.fit_rows import TrialRow
from trialid.result.force_series import ForceSeries
from trialid.result.schema import Result
from trialid.result.series import TrialSeries

if TYPE_CHECKING:
    import jinja2
    import markupsafe

VERDICTS = {
    "no fit": "The fit does not carry a verdict",
    "missing": "An effect is missing",
    "nothing missing": "Nothing is missing that this record could show",
    "not in catalogue": "Something is missing that the catalogue does not hold",
    "cannot tell": "This record cannot tell",
}
"""What the kinds of verdict are called at the top of the page."""

FOLLOWS = "No effect stands out, and what is left follows the rudder"
"""... and of a record that shows no effect, where an output says so."""

HELD = "The record asks for another value of a coefficient that is held"
"""... and where what is named is of an effect that the model has."""


def heading(run: Result) -> str:
    """What the verdict is called at the top of a page."""
    named = _named(run)
    if named is not None and named.held is not None:
        return HELD
    if run.verdict.kind == "nothing missing" and advice.what_follows(run):
        return FOLLOWS
    return VERDICTS.get(run.verdict.kind or "", "No verdict")


def write_page(
    path: str | Path,
    run: Result,
    series: Sequence[TrialSeries],
    forces: Sequence[ForceSeries] = (),
) -> None:
    """`report.html`: opens offline, asks the network for nothing."""
    Path(path).write_text(page(run, series, forces), encoding="utf-8")


def page(run: Result, series: Sequence[TrialSeries], forces: Sequence[ForceSeries] = ()) -> str:
    """The page as text."""
    axis, range_bars = bars.range_bars(run.physical)
    return (
        environment()
        .get_template("page.html.j2")
        .render(
            run=run,
            no_check=_no_check(run),
            named=_named(run),
            heading=heading(run),
            done=_done(run),
            proposed=_proposed(run),
            descent=error_history.error_history(run),
            fell=fall.fell(run),
            ranked=ranking.ranking(run),
            advised=advice.advice(run),
            first=advice.first_step(run),
            trust=doubt.trust(run),
            split=bars.split_bars(run),
            physical=list(zip(run.physical, range_bars, strict=True)),
            nuisance=run.nuisance,
            axis=axis,
            equations=list(use_tables.equations(run)),
            commands=list(use_tables.commands(run)),
            outputs=run_tables.outputs_of(run),
            shown_trials=_shown_trials(run, series),
            imo_found=imo_tables.further_tables(run),
            corrections=imo_tables.corrections(run),
            tracks=[track_picture(each.track, run.model.particulars) for each in series],
            plots=panels.trial_panels(series, run),
            forces=force_plots.pictures(run, forces),
            assets=assets(),
        )
    )


Compared = tuple[ChangePart, list[bars.Change], str, str]
"""A model before and after: the pair, its bars, the heading, and the section's id."""


def _done(run: Result) -> Compared | None:
    """What this command did to the model."""
    pair = run.change
    if pair is None:
        return None
    titles = {"added": "Before and after adding", "dropped": "Before and after dropping"}
    title = titles.get(pair.step or "", "Before and after")
    return pair, bars.changes(pair), title, "change"


def _proposed(run: Result) -> Compared | None:
    """What the verdict proposes, tried."""
    pair = run.before_after
    if pair is None:
        return None
    title = "What adding this would change:" if run.change else "Before and after adding"
    return pair, bars.changes(pair), title, "proposed"


@cache
def environment() -> "jinja2.Environment":
    """The templates and what they write numbers with; every word is escaped."""
    from trialid.report import templates

    environment = templates.environment("trialid", "report", finalize=_finalized)
    environment.filters |= _filters()
    return environment


def _filters() -> dict[str, Any]:
    """What the templates write numbers and names with."""
    return {
        "number": wording.number,
        "count_of": wording.count_of,
        "percent": wording.percent,
        "percent_range": wording.percent_range,
        "by_error": wording.by_error,
        "doubtful": doubt.doubtful,
        "records_doubt": doubt.records_doubt,
        "stability_words": doubt.stability_words,
        "prior_words": beforehand.prior_words,
        "likely": run_tables.likely,
        "criterion": imo_tables.criterion,
        "breakable": _breakable,
        "prose": wording.prose,
        "shown": wording.shown_unit,
        "short_hash": wording.short_hash,
        "signed": wording.sign_text,
        "points": wording.points,
        "model_interval": error_history.interval,
        "moves": doubt.moves,
        "foreseen_in_errors": bars.foreseen_in_errors,
        "labelled": labels.label,
        "symbol": labels.symbol,
        "picture": where_pictures.picture,
        "in_shown_unit": labels.shown_text,
    }


def _finalized(value: object) -> object:
    """Absent knowledge is an en dash, wherever the template prints it."""
    return wording.DASH if value is None else value


def _breakable(name: str | None) -> "markupsafe.Markup":
    """A name that breaks after an underscore where it is too long for its line."""
    from markupsafe import Markup

    return Markup("_<wbr>").join((name or wording.DASH).split("_"))


def assets() -> dict[str, str]:
    """The style and script that go into the page as they are, uPlot with its licence."""
    files = resources.files("trialid.report")
    names = {
        "style": ("uplot/uPlot.min.css", "page.css"),
        "licence": ("uplot/LICENSE",),
        "library": ("uplot/uPlot.iife.min.js",),
    }
    texts = {
        asset: "\n".join(files.joinpath(name).read_text(encoding="utf-8") for name in each)
        for asset, each in names.items()
    }
    return {**texts, "script": script()}


def _no_check(run: Result) -> str:
    """Why there is no error on held-out trials, where that is known."""
    uses = {trial.use for trial in run.trials}
    return "no trial was held out" if uses == {"fit"} else ""


def _named(run: Result) -> CandidateRow | None:
    """The candidate the verdict names, as ranked."""
    effect = run.verdict.effect
    return next((row for row in run.missing if effect and row.effect == effect), None)


def _shown_trials(run: Result, series: Sequence[TrialSeries]) -> list[TrialRow]:
    """What the result says of each trial that has a series; its name and use at least."""
    said = {row.name: row for row in run.trials}
    return [said.get(each.name, TrialRow(name=each.name, use=each.use)) for each in series]
