"""The candidates as the page tells of them: who leads, who is ruled out, and why."""

import itertools
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from trialid.names import wording
from trialid.result.finding_rows import CandidateParameterRow, CandidateRow
from trialid.result.schema import Result

LEADING: Final = 5
"""Candidates told of in full."""

OFF: Final = 0.2
"""Share by which a refit may miss what was foreseen before the page says why."""

FOLLOWING: Final = 6
"""Candidates in the table below them, of those the record speaks for."""

BEST_OF_NONE: Final = 3
"""Candidates shown where the record speaks for none."""

WORTH: Final = ("stands out", "lowers the error")
NOTHING: Final = "no evidence"
HIDDEN: Final = "not visible"
IMPOSSIBLE: Final = "unphysical"

MEANS: Final = {
    "missing": "named by the verdict",
    "same family": "this record cannot tell it from the one named",
    "stands out": "there against the noise, and the error falls where it was not fitted",
    "lowers the error": "a tenth of the squared error goes where it was not fitted, blocks alike, "
    "though no test against the noise shows it",
    "significant and small": "there against the noise, of a size that nobody would notice",
    "not in most blocks": "there against the noise, but where it was not fitted the error falls in "
    "half of the blocks or fewer",
    "does not carry over": "there against the noise, but where it was not fitted the error rises",
    "no evidence": "no more than chance would do",
}
"""What the verdicts on candidates mean; each trial left out in turn is a block, of few trials a
stretch of time."""


@dataclass(frozen=True)
class ErrorBar:
    """An error with a candidate in the model; `drop` is how far it lies below the present one."""

    label: str
    eps: float | None
    drop: float | None
    length: float
    kind: str


@dataclass(frozen=True)
class Alike:
    """A member of a family: |cos| to the candidate, None where it is as likely but not parallel.

    `told_apart` where the verdict names the one and does not name the other beside it.
    """

    effect: str
    cosine: float | None
    differs: float | None
    told_apart: bool


@dataclass(frozen=True)
class Leader:
    """A candidate told of in full."""

    row: CandidateRow
    bars: tuple[ErrorBar, ...]
    family: tuple[Alike, ...]
    remark: str


@dataclass(frozen=True, kw_only=True)
class Ranking:
    """Every candidate once: in full, in a table, behind a fold, ruled out, invisible, or not tried.

    Followers are what the record speaks for beside the leaders.
    """

    leaders: tuple[Leader, ...]
    followers: tuple[CandidateRow, ...]
    others: tuple[CandidateRow, ...]
    ruled_out: tuple[tuple[CandidateRow, str], ...]
    hidden: tuple[CandidateRow, ...]
    not_tried: tuple[tuple[str, tuple[str, ...]], ...]
    standing: tuple[tuple[str, str], ...]


def ranking(run: Result) -> Ranking:
    """The candidates of a result, in its order.

    Those that were fitted lead; where none was, the first three that stand out do.
    """
    rows = run.missing
    able = [row for row in rows if row.verdict not in (HIDDEN, IMPOSSIBLE)]
    fitted = [row for row in able if row.eps_rmsn_refitted is not None][:LEADING]
    heads = fitted or [row for row in able if row.verdict in WORTH][:3]
    rest = [row for row in able if not any(row is head for head in heads)]
    followers = [row for row in rest if row.verdict != NOTHING][:FOLLOWING]
    if not heads and not followers:
        followers = rest[:BEST_OF_NONE]
    return Ranking(
        leaders=tuple(_leader(row, run) for row in heads),
        followers=tuple(followers),
        others=tuple(row for row in rest if not any(row is each for each in followers)),
        ruled_out=tuple((row, reason(row)) for row in rows if row.verdict == IMPOSSIBLE),
        hidden=tuple(row for row in rows if row.verdict == HIDDEN),
        not_tried=tuple(_by_reason(run.not_tried)),
        standing=tuple(_standing(heads, rest)),
    )


def _standing(*groups: Sequence[CandidateRow]) -> Iterable[tuple[str, str]]:
    """What the verdicts mean that are shown."""
    shown = {row.verdict for rows in groups for row in rows}
    return ((word, meaning) for word, meaning in MEANS.items() if word in shown)


def _leader(row: CandidateRow, run: Result) -> Leader:
    return Leader(row, tuple(_bars(row, run)), tuple(_family(row, run)), remark(row, run))


def _bars(row: CandidateRow, run: Result) -> Iterable[ErrorBar]:
    """Fitted and held-out errors, now and with the candidate, on one scale."""
    now, check = run.fit.eps_rmsn, run.fit.eps_rmsn_check
    found = [
        ("now", now, now, "before"),
        ("foreseen with it", row.eps_rmsn_predicted, now, "foreseen"),
        ("fitted with it", row.eps_rmsn_refitted, now, "after"),
        ("held out, now", check, check, "before"),
        ("held out, with it", row.eps_rmsn_check, check, "after"),
    ]
    longest = max((eps for _, eps, _, _ in found if eps is not None), default=0.0) or 1.0
    for label, eps, whole, kind in found:
        drop = None if kind == "before" or eps is None or whole is None else whole - eps
        yield ErrorBar(label, eps, drop, 100.0 * (eps or 0.0) / longest, kind)


def _family(row: CandidateRow, run: Result) -> Iterable[Alike]:
    """Those alike in trace; with the named effect also those that are as likely."""
    named = row.effect == run.verdict.effect
    names = [*row.family, *(run.verdict.family if named else ())]
    for name in dict.fromkeys(n for n in names if n != row.effect):
        cosine = row.cosines.get(name)
        differs = None if cosine is None else max(1.0 - cosine**2, 0.0) ** 0.5
        yield Alike(name, cosine, differs, named and name not in run.verdict.family)


def remark(row: CandidateRow, run: Result) -> str:
    """What came out otherwise than foreseen: the gain by more than a fifth, a sign, a limit."""
    turned = [
        name
        for name, p in row.parameters.items()
        if p.expected and p.refitted and p.expected * p.refitted < 0.0
    ]
    said = [_gain(row, run)]
    ends = [name for name, p in row.parameters.items() if _at_an_end(p)]
    if ends:
        word = "stops" if len(ends) == 1 else "stop"
        said.append(f"{' and '.join(ends)} {word} at the end of the physical range.")
    if turned:
        word = "changes its sign" if len(turned) == 1 else "change their signs"
        names = " and ".join(turned)
        said.append(f"{names} {word} when fitted: that part of it this record does not settle.")
    return " ".join(filter(None, said))


def _at_an_end(p: CandidateParameterRow) -> bool:
    """Whether a fitted value lies on a limit that the search may not cross."""
    value = p.refitted
    ends = [end for end in (p.low, p.high) if end is not None]
    return value is not None and any(math.isclose(value, end, rel_tol=1e-6) for end in ends)


def _gain(row: CandidateRow, run: Result) -> str:
    """Why the fall achieved is not the one foreseen, empty where the two agree within a fifth."""
    now = run.fit.eps_rmsn
    foreseen, fitted = row.eps_rmsn_predicted, row.eps_rmsn_refitted
    if now is None or foreseen is None or fitted is None or now <= foreseen:
        return ""
    ratio = (now - fitted) / (now - foreseen)
    if abs(ratio - 1.0) <= OFF:
        return ""
    if ratio > 1.0:
        return (
            f"The fit gains {wording.number(ratio, 2)} times what was foreseen: the effect is too "
            "strong for a straight line, or the other parameters were biased without it."
        )
    return (
        f"The fit gains only {wording.percent(max(ratio, 0.0), 2)} of what was foreseen: the "
        "effect is too strong for a straight line, or it is not the one that is missing."
    )


def reason(row: CandidateRow) -> str:
    """Why a candidate is ruled out: the value it would need, and the range it may have."""
    beyond = [
        f"{name} would have to be {_value(p.expected, p.unit)}, {_limit(p)}"
        for name, p in row.parameters.items()
        if p.expected is not None and _limit(p)
    ]
    return "; ".join(beyond) or "no value that it may physically have lowers the error"


def _limit(p: CandidateParameterRow) -> str:
    """The end of the range that the expected value lies beyond, empty where it lies within."""
    end, word = None, "below"
    if p.expected is not None and p.low is not None and p.expected < p.low:
        end = p.low
    elif p.expected is not None and p.high is not None and p.expected > p.high:
        end, word = p.high, "above"
    if end is None:
        return ""
    return "the wrong sign" if end == 0.0 else f"{word} its physical limit of {_value(end, p.unit)}"


def _value(value: float, unit: str | None) -> str:
    name, factor = wording.shown_unit(unit)
    return f"{wording.number(value * factor)} {'' if name == '1' else name}".rstrip()


def _by_reason(not_tried: Mapping[str, Any]) -> Iterable[tuple[str, tuple[str, ...]]]:
    """Reasons with the effects they hold for, the commonest first."""
    ordered = sorted(not_tried.items(), key=lambda each: str(each[1]))
    grouped = [
        (str(why or "no reason is recorded"), tuple(name for name, _ in rows))
        for why, rows in itertools.groupby(ordered, key=lambda each: each[1])
    ]
    return sorted(grouped, key=lambda each: (-len(each[1]), each[0]))
