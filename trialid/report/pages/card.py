"""A run as a card in a notebook: the verdict, the error and its parts, the parameters."""

from trialid.report.pages.page import environment, heading
from trialid.report.pictures import bars
from trialid.report.tables import run_tables
from trialid.report.words import doubt
from trialid.result.schema import Result


def card(run: Result) -> str:
    """HTML that needs nothing beside it: no script, no network."""
    template = environment().get_template("card.html.j2")
    return template.render(
        run=run,
        heading=heading(run),
        bar=bars.split_bars(run)[0],
        outputs=run_tables.outputs_of(run),
        doubt=doubt.doubtful(run.physical),
    )
