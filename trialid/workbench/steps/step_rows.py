"""The steps of the model as rows whose bars grow shorter as the error falls."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

from trialid.report.pictures.bars import SplitBar
from trialid.report.words import fall
from trialid.result.change_rows import StepRow
from trialid.result.schema import Result
from trialid.workbench import error_number
from trialid.workbench.shown import Shown
from trialid.workbench.steps import step_names

NO_FIT: Final = "no fit"
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
    known = [*_known(shown, run)]
    pending = shown.run is None and bool(known or shown.fit)
    drawn = [row for row, _ in known[max(len(known) + pending - SHOWN, 0) :]]
    longest = _longest(drawn, error_number.error_number(shown).eps)
    rows = [*_rows(known, longest, shown.run is not None)]
    if pending:
        rows.append(_pending(shown, longest))
    said = fall.fell(run) if shown.run else ""
    return Steps(tuple(rows[:-SHOWN]), tuple(rows[-SHOWN:]), said)


def _known(shown: Shown, run: Result) -> Iterator[tuple[StepRow, str]]:
    """The steps that have an error, with what was done to come to them."""
    words = step_names.of_rows(run.history)
    for place, row in enumerate(run.history):
        if row.eps_rmsn is not None and (shown.run is not None or row.step != "proposed"):
            apart = "" if row in run.comparable else " (on other logs)"
            yield row, shown.named.get(place, words[place]) + apart


def _longest(drawn: Sequence[StepRow], now: float | None) -> float:
    """The error whose bar is the longest: no fit's may be any, and its bar ends there too."""
    sizes = [row.eps_rmsn or 0.0 for row in drawn if row.verdict != NO_FIT]
    return max(sizes, default=now or 0.0) or 1.0


def _rows(known: Sequence[tuple[StepRow, str]], longest: float, own: bool) -> Iterator[ShownStep]:
    kept = [row for row, _ in known if row.step != "proposed"]
    for row, words in known:
        tried = row.step == "proposed"
        kind = "proposed" if tried else "present" if own and row is kept[-1] else "step"
        yield ShownStep(words, _bar(row, longest), row.eps_rmsn_check, row.verdict or "", kind)


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
        length=min(100.0 * eps / longest, 100.0),
        noise_share=share,
        whisker=None,
    )


def _pending(shown: Shown, longest: float) -> ShownStep:
    """The model that is being computed: its error a second before what it is made of."""
    found = error_number.error_number(shown)
    length = min(100.0 * (found.eps or 0.0) / longest, 100.0)
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
    return step_names.change_words(shown.before.pipeline, shown.pipeline, shown.catalogue)
