"""What stands on the screen: one model as pieces of HTML, as plain numbers and as curves.

Numbers are written by the report's own filters, so that screen, report and terminal show the same
digits. What is known only of the model before the last change is marked as such.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

import numpy as np

from trialid.names import labels
from trialid.report.pages import page as report
from trialid.report.pictures import bars
from trialid.report.pictures.panels import encode_floats, trial_panels
from trialid.report.pictures.track_picture import track_picture
from trialid.report.tables import use_tables
from trialid.report.words import advice, ranking
from trialid.result.finding_rows import FindingRow
from trialid.result.json_file import finite
from trialid.result.schema import Result
from trialid.result.series import TrialSeries
from trialid.workbench import error_number, model_rows
from trialid.workbench.shown import Shown
from trialid.workbench.steps import step_rows
from trialid.workflow.origin import signals_of
from trialid.workflow.outcome import Outcome

if TYPE_CHECKING:
    import jinja2

Plain = dict[str, Any]

PARTS = (
    "title", "tabs", "about", "track", "where", "error", "history", "verdict", "now", "missing",
    "model", "use",
)  # fmt: skip
"""The pieces, each under the name of its place on the page and of its template."""

LONGEST_NAME = 24
"""Characters of a trial's name that its tab has room for."""


@cache
def environment() -> "jinja2.Environment":
    """The workbench's templates, with the report's filters and its small pictures."""
    import jinja2

    own = jinja2.PackageLoader("trialid.workbench", "templates")
    theirs = jinja2.PackageLoader("trialid", "report")
    return report.environment().overlay(loader=jinja2.ChoiceLoader([own, theirs]))


def page(shown: Shown) -> str:
    """The page, empty but for its title: its script asks for the parts."""
    return environment().get_template("index.html.j2").render(title=shown.pipeline.name)


def parts(shown: Shown) -> dict[str, str]:
    """Every piece of the screen by its name."""
    told = _context(shown)
    return {name: environment().get_template(f"{name}.html.j2").render(told) for name in PARTS}


def facts(shown: Shown) -> Plain:
    """Plain numbers of the model shown; None where not known yet, never those of another model."""
    run = shown.run.result if shown.run else None
    found = error_number.error_number(shown)
    return finite(
        {
            "eps_rmsn": found.eps,
            "eps_rmsn_check": found.check,
            "noise": run.split.noise if run else None,
            "undermodelling": run.split.undermodelling if run else None,
            "effects": list(shown.pipeline.model.effects),
            "free": list(shown.pipeline.identify.free),
            "verdict": run.verdict.kind if run else None,
            "named": run.verdict.effect if run else None,
        }
    )


def panels(shown: Shown, index: int) -> Plain:
    """A trial's panels; `before` is what the model before predicts, where the model was changed."""
    trial = shown.series[index]
    drawn = trial_panels([trial], _told(shown.run))[0]
    earlier = _before(shown, trial)
    for panel, name in zip(_outputs(drawn), (o.name for o in trial.outputs), strict=True):
        if name in earlier:
            panel["before"] = encode_floats(earlier[name] * labels.shown_factor(name))
    return drawn


def _outputs(drawn: Plain) -> list[Plain]:
    return [panel for panel in drawn["panels"] if panel["kind"] == "output"]


def _before(shown: Shown, trial: TrialSeries) -> dict[str, np.ndarray[Any, Any]]:
    """What the model before predicts of a trial, by output; on another clock it is of no use."""
    if not is_changed(shown) or shown.before is None:
        return {}
    same = [s for s in shown.before.series if s.name == trial.name and np.array_equal(s.t, trial.t)]
    return {o.name: o.predicted for s in same for o in s.outputs}


def is_changed(shown: Shown) -> bool:
    """Whether there is a model before, and it is another one."""
    return shown.before is not None and shown.before.pipeline.content != shown.pipeline.content


def _told(run: Outcome | None) -> Result:
    return run.result if run else Result()


def _context(shown: Shown) -> Plain:
    """All that the templates ask for; `run` is the model's own, or that of the one before."""
    known = shown.run or shown.before
    run = _told(known)
    return {
        "shown": shown,
        "pipeline": shown.pipeline,
        "stage": shown.stage,
        "known": known is not None,
        "stale": shown.run is None,
        "run": run,
        "error": error_number.error_number(shown),
        "split": replace(bars.split_bars(run)[0], length=100.0),
        "trials": list(_trials(shown, run)),
        "steps": step_rows.steps(shown, run),
        "heading": report.heading(run),
        "advised": _advised(run),
        "several": ()
        if {*run.verdict.together} & {*shown.pipeline.model.effects}
        else run.verdict.together,
        "ranked": ranking.ranking(run),
        "effects": model_rows.effects(shown),
        "masses": model_rows.masses(shown),
        "nuisance": run.nuisance,
        "kinds": use_tables.kinds_of(run.model),
        "addable": sorted(set(shown.catalogue) - set(shown.pipeline.model.effects)),
        "equations": {name: effect.equation for name, effect in shown.catalogue.items()},
    }


def _advised(run: Result) -> list[advice.Advice]:
    """What to do next, without what a button of the screen does."""
    return [each for each in advice.advice(run) if not each.command.startswith("trialid add ")]


def _trials(shown: Shown, run: Result) -> Iterator[Plain]:
    """Each trial in the order of its curves: name, use, error, remarks, signals, findings."""
    written = {trial.name: trial for trial in shown.pipeline.trials}
    names = list(dict.fromkeys([*(s.name for s in shown.series), *written]))
    tracks = {s.name: s.track for s in shown.series}
    for place, name in enumerate(names):
        errors = error_number.by_output(shown, name, run)
        yield {
            "place": place,
            "name": name,
            "short": _shortened(name),
            "track": track_picture(tracks.get(name), _particulars(shown, run)),
            "use": written[name].use if name in written else "fit",
            "errors": errors,
            "error": error_number.pool_errors(errors),
            "remarks": _remarks(shown, name),
            "signals": [row for row in signals_of(shown.pipeline) if row.trial == name],
            "findings": _findings(run.where, name),
        }


def _shortened(name: str) -> str:
    """A name that a tab has room for: both its ends, as names of trials differ there."""
    return name if len(name) <= LONGEST_NAME else f"{name[:10]}…{name[-13:]}"


def _particulars(shown: Shown, run: Result) -> Mapping[str, float]:
    return run.model.particulars if shown.model is None else shown.model.ship.particulars


def _remarks(shown: Shown, name: str) -> Sequence[str]:
    rows = shown.run.result.trials if shown.run else ()
    said = next((row.remarks for row in rows if row.name == name), None)
    return said or [words for t in shown.trials if t.name == name for words in t.remarks]


def _findings(where: Sequence[FindingRow], name: str) -> list[FindingRow]:
    """Findings of a trial, its own first; those of all trials together belong to each."""
    own = [finding for finding in where if finding.trial == name]
    return own + [finding for finding in where if finding.trial is None]
