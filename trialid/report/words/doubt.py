"""How far parameters are to be believed, in words."""

import math
from collections.abc import Sequence
from typing import Final

from trialid.accuracy.ranges import ANOTHER_GM, IN_TIME, LOG_SCALES, USUAL_FORCES
from trialid.names import wording
from trialid.names.wording import named_together
from trialid.result.finding_rows import VerdictPart
from trialid.result.fit_rows import LeversPart, ParameterRow, WeakRow
from trialid.result.schema import Result

HALF: Final = 0.5
"""A parameter that may be off by more than this share of its value is not to be believed."""

NAMED: Final = 10
"""Doubtful parameters a sentence names before it only counts them."""


WIDENED: Final = {
    "": "by the numbers held fixed (how sure those are: [uncertainty] in the ship file)",
    ANOTHER_GM: "as the record does not tell GM",
    USUAL_FORCES: "as all forces that a hull usually has, each small, may be there at once",
    IN_TIME: "as no sensor is early",
    LOG_SCALES: "as logs may read a little too much or too little in all trials alike",
}
"""Why a range is wide, but for an effect that may be missing."""


def doubtful(parameters: Sequence[ParameterRow]) -> str:
    """Which of the physical parameters are not to be believed, in a sentence; none, no words.

    By the likely range, where there is one, else by noise alone.

    >>> rows = [ParameterRow(name=n, value=2.0, likely=(low, 2.5))
    ...         for n, low in (("Yv", 1.2), ("Nr", 0.9))]
    >>> doubtful(rows)
    'Not to be believed: Nr; it may be off by more than half of its value.'
    >>> doubtful(rows[:1])
    ''
    >>> doubtful([ParameterRow(name="z_slip", S_i=0.0)])
    'z_slip moves nothing that is fitted here.'
    """
    rows = [row for row in parameters if row.kind != "nuisance"]
    idle = [row.name for row in rows if is_idle(row)]
    verb = "move" if len(idle) > 1 else "moves"
    said = f"{', '.join(idle)} {verb} nothing that is fitted here." if idle else ""
    return f"{_disbelieved([row for row in rows if not is_idle(row)])} {said}".strip()


def records_doubt(verdict: VerdictPart) -> str:
    """That what the records leave in doubt about themselves is in the numbers; else empty.

    >>> records_doubt(VerdictPart(kind="cannot tell", doubts=("r comes 3.9 s late",)))
    'What the records leave in doubt may be in all numbers here, and in their ranges.'
    >>> records_doubt(VerdictPart(kind="cannot tell"))
    ''
    """
    if not verdict.doubts:
        return ""
    return "What the records leave in doubt may be in all numbers here, and in their ranges."


def missing_words(verdict: VerdictPart) -> str:
    """What the verdict says the model lacks, for who uses it; empty where it says nothing of that.

    >>> missing_words(VerdictPart(kind="missing", effect="static_list"))
    'The run says that static_list is missing; this is the model without it.'
    >>> missing_words(VerdictPart(kind="cannot tell", together=("a", "b")))
    'The run says that more is missing, as a and b together; this is the model without them.'
    """
    if verdict.together:
        several = named_together(verdict.together)
        said = f"The run says that more is missing, as {several} together"
        return f"{said}; this is the model without them."
    if verdict.kind not in ("missing", "not in catalogue"):
        return ""
    what = verdict.effect or "something outside the catalogue"
    return f"The run says that {what} is missing; this is the model without it."


def stability_words(levers: LeversPart) -> str:
    """Whether she is stable on her course, as far as the record tells it.

    >>> stability_words(LeversPart(stable=True)), stability_words(LeversPart())
    ('Stable.', 'Stable or not: this record does not tell.')
    """
    if levers.stable is None:
        return "Stable or not: this record does not tell."
    return "Stable." if levers.stable else "Unstable."


def is_idle(row: ParameterRow) -> bool:
    """Whether no output follows a parameter, as an arm to the roll axis where no roll is fitted."""
    return row.S_i == 0.0


def _disbelieved(rows: Sequence[ParameterRow]) -> str:
    names = [row.name for row in rows if not _share(row) <= HALF]
    if not names:
        return ""
    told = any(row.likely for row in rows)
    by = "" if told else " (by noise alone; what may be missing is not known)"
    left = len(names) - NAMED
    listed = ", ".join(names[:NAMED]) + (f" and {left} more" if left > 0 else "")
    each = "it may be off by more than half of its value"
    each = each if len(names) == 1 else each.replace("it", "each", 1)
    return f"Not to be believed: {listed}; {each}{by}."


def _share(row: ParameterRow) -> float:
    """How far a parameter may be off, as a share of its value; not a number where nobody knows."""
    off = row.off_by_noise if row.likely is None else row.may_be_off
    return math.nan if off is None else off


def widest(parameters: Sequence[ParameterRow]) -> str:
    """Which likely range is the widest beside its value, and what widens it.

    >>> widest([ParameterRow(name="Kp", value=-2.0, likely=(-3.0, -1.5), widened_by="static_list")])
    'Least known: Kp, as static_list may be missing.'
    """
    known = [(r.may_be_off, r) for r in parameters if r.may_be_off is not None]
    if not known:
        return ""
    _, row = max(known, key=lambda pair: pair[0])
    why = WIDENED.get(row.widened_by or "", f"as {row.widened_by} may be missing")
    return f"Least known: {row.name}, {why}."


def trust(run: Result) -> str:
    """What the accuracy table comes to, beside those not to be believed."""
    known = [(r.may_be_off, r.name) for r in run.physical if r.may_be_off is not None]
    if not known or run.verdict.kind == "no fit":
        return ""
    least, name = min(known)
    best = f"Best known is {name}, to {wording.percent(least, 2)}. " if least <= HALF else ""
    words = f"{best}{widest_range(run)}"
    if run.verdict.effect and run.before_after:
        words += f" With {run.verdict.effect} in the model the ranges are others: add it first."
    return words


def widest_range(run: Result) -> str:
    """Which likely range is the widest, what makes it so, and the trial that would narrow it.

    Nothing without a fit: then no effect may be spoken of.
    """
    if run.verdict.kind == "no fit":
        return ""
    return f"{widest(run.physical)} {run.accuracy.narrowed_by or ''}".strip()


def moves(weak: WeakRow) -> str:
    """How far a weak direction's parameters go together unseen, in words.

    >>> moves(WeakRow(moves={"Nr": 0.108, "Nv": 0.157})).replace(wording.THIN, " ")
    'Nr by 11 % and Nv by 16 % of their size, both up or both down'
    """
    found = {name: move for name, move in weak.moves.items() if move is not None}
    if len(found) < 2:
        return ""
    sizes = [f"{name} by {wording.percent(abs(move), 2)}" for name, move in found.items()]
    listed = ", ".join(sizes[:-1]) + " and " + sizes[-1]
    signs = {move > 0.0 for move in found.values()}
    if len(signs) == 1:
        word = "both up or both down" if len(found) == 2 else "all up or all down"
    else:
        up = [name for name, move in found.items() if move > 0.0]
        down = [name for name, move in found.items() if move <= 0.0]
        word = f"{', '.join(up)} up while {', '.join(down)} down, or the reverse"
    return f"{listed} of their size, {word}"
