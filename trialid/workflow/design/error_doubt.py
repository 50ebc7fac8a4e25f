"""What the errors that a design promises rest on: that the model holds all that the ship has."""

from collections.abc import Sequence

from trialid.design.rating import Rating
from trialid.names import wording
from trialid.names.wording import named_together
from trialid.pipeline_file.finished_run import FinishedRun


def error_doubt(rating: Rating | None, wanted: Sequence[str], run: FinishedRun) -> str:
    """How far parameters may be off in the run that is built on, by more than is promised here.

    Noise is what a better trial makes less of. What the model may lack goes on: of a ship with drag
    that her run had not found `Nv` was promised to 4 %, and was 23 % off.
    """
    if rating is None:
        return ""
    beyond = {n: run.model_errors.get(n, 0.0) for n in wanted}
    beyond = {n: off for n, off in beyond.items() if off > rating.of(n).error}
    if not beyond:
        return ""
    listed = named_together(
        [f"{n} by up to {wording.percent(off, 2)}" for n, off in beyond.items()]
    )
    said = f" (its verdict: {run.verdict})" if run.verdict else ""
    return (
        f"In the run it builds on{said} what the model lacks may move {listed}: no trial mends "
        "that before it is in the model, and these errors know of no more than [full] states."
    )
