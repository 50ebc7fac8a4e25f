"""The steps of the model as rows whose bars grow shorter as the error falls."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from trialid.names.wording import MINUS
from trialid.report.pictures import error_history
from trialid.report.pictures.bars import SplitBar
from trialid.result.change_rows import StepRow
from trialid.result.schema import Result
from trialid.workbench import error_number
from trialid.workbench.shown import Shown

SHOWN: Final = 6
"""Steps shown at once: the last ones; those before are folded."""


@dataclass(frozen=True)
class ShownStep:
    """A step: what was done, its error with its parts, and whether it is the model shown.

    `kind` is `step`, `present`, `proposed`, or `pending` for one that is being computed.
    """

    words: str
    bar: SplitBar
    check: float | None
    verdict: str
    kind: str


@dataclass(frozen=True)
class Steps:
    """The last steps, those folded away, and the fall in words."""

    earlier: tuple[ShownStep, ...]
    rows: tuple[ShownStep, ...]
    said: str


def steps(shown: Shown, run: Result) -> Steps:
    """The history as rows; `run` is that of the model before while this one is computed."""
    known = [row for row in run.history if row.eps_rmsn is not None]
    if shown.run is None:
        known = [row for row in known if row.step != "proposed"]
    sizes = [row.eps_rmsn or 0.0 for row in known]
    now = error_number.error_number(shown).eps
    longest = max([*sizes, now or 0.0], default=0.0) or 1.0
    rows = [*_rows(known, longest, shown.run is not None)]
    if shown.run is None and (known or shown.fit):
        rows.append(_pending(shown, longest))
    said = error_history.fell(run) if shown.run else ""
    return Steps(tuple(rows[:-SHOWN]), tuple(rows[-SHOWN:]), said)


def _rows(known: Sequence[StepRow], longest: float, own: bool) -> Iterator[ShownStep]:
    kept = [row for row in known if row.step != "proposed"]
    for row in known:
        tried = row.step == "proposed"
        kind = "proposed" if tried else "present" if own and row is kept[-1] else "step"
        bar = _bar(row, longest)
        yield ShownStep(
            error_history.step_words(row), bar, row.eps_rmsn_check, row.verdict or "", kind
        )


def _bar(row: StepRow, longest: float) -> SplitBar:
    eps, noise = row.eps_rmsn or 0.0, row.noise
    share = None
    if noise is not None and row.undermodelling is not None and eps:
        share = 100.0 * min((noise / eps) ** 2, 1.0)
    return SplitBar(
        label="",
        eps=row.eps_rmsn,
        noise=noise,
        model=row.undermodelling,
        length=100.0 * eps / longest,
        noise_share=share,
        whisker=None,
    )


def _pending(shown: Shown, longest: float) -> ShownStep:
    """The model that is being computed: its error a second before what it is made of."""
    found = error_number.error_number(shown)
    length = 100.0 * (found.eps or 0.0) / longest
    bar = SplitBar(
        label="",
        eps=found.eps,
        noise=None,
        model=None,
        length=length,
        noise_share=None,
        whisker=None,
    )
    return ShownStep(difference(shown), bar, found.check, "", "pending")


def difference(shown: Shown) -> str:
    """What sets the model shown apart from the one before, in few words."""
    if shown.before is None:
        return "as written"
    old, new = shown.before.pipeline.model.effects, shown.pipeline.model.effects
    added = [f"+ {name}" for name in new if name not in old]
    dropped = [f"{MINUS} {name}" for name in old if name not in new]
    return ", ".join([*added, *dropped]) or "as edited"
