"""The run on one screen of a terminal: at most 40 lines of 100 columns."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from trialid.names import labels, wording
from trialid.report.terminal.terminal import (
    Words,
    add_row,
    new_table,
    number,
    percent,
    percents,
    plain,
    times,
)
from trialid.report.words import advice, beforehand, doubt
from trialid.result.fit_rows import ParameterRow, Part, SplitPart
from trialid.result.schema import Result

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

TRIALS = 5
PARAMETERS = 10
WORST = 7
CANDIDATES = 4
FINDINGS = 3
"""How many rows each part may have; together they keep the summary under 40 lines."""


def summary(run: Result) -> "RenderableType":
    """What a run found, for a rich console; all the rest is in the report page."""
    from rich.console import Group
    from rich.text import Text

    title = Words(run.pipeline or "trialid", 1, "bold")
    if run.verdict.kind == "no fit":  # before everything: none of what follows may be relied on
        return Group(*_verdict(run), title, _errors(run), Text(), *_parameters(run))
    return Group(
        title,
        _errors(run),
        Words(_made_of(run), 2),
        *_band(run),
        *_where(run),
        Text(),
        *_parameters(run),
        *_ranking(run),
        *_verdict(run),
        Words(_change(run), 2, "bold"),
    )


def _errors(run: Result) -> "Table":
    """Error by trial and output; what was held out is marked."""
    fit = run.fit
    outputs = list(fit.eps_rmsn_by_output)[:6]
    letters = map(labels.symbol, outputs)
    table = new_table("error, share of measured RMS", "use", *letters, "all", words=2)
    trials = run.trials
    shown = trials if len(trials) <= TRIALS else trials[: TRIALS - 1]
    for trial in shown:
        use = "held out" if trial.use == "check" else "fitted"
        add_row(table, trial.name, use, *percents(map(trial.eps_rmsn.get, outputs)), "")
    if len(shown) < len(trials):
        add_row(table, f"... and {len(trials) - len(shown)} more trials")
    by_output = percents(fit.eps_rmsn_by_output[name] for name in outputs)
    add_row(table, "all fitted trials", "", *by_output, percent(fit.eps_rmsn), style="bold")
    if fit.eps_rmsn_check is not None:
        blanks = [""] * len(outputs)
        add_row(table, "all held-out trials", "", *blanks, percent(fit.eps_rmsn_check))
    return table


def _made_of(run: Result) -> str:
    split = run.split
    if split.noise is None:
        why = split.why or split.method or "no route to the noise was open"
        return f"noise and model not told apart: {why}"
    return (
        f"made of noise {_part(split, 'noise')} and model {_part(split, 'undermodelling')}"
        f", told apart by {split.method}"
    )


def _band(run: Result) -> "Iterable[RenderableType]":
    """How far a measurement may lie from a prediction, and how the held-out trials kept to it."""
    if not run.fit.band:
        return
    halves = (f"{labels.symbol(n)} +-{labels.shown_text(n, x)}" for n, x in run.fit.band.items())
    said = f"95 % band of a trial not fitted: {', '.join(halves)}"
    checks = [t for t in run.trials if t.use == "check"]
    shares = [x for t in checks for x in t.inside.values() if x is not None]
    if shares:
        said += f"; of the held-out samples {_shares(shares)} lie inside"
    yield Words(plain(said), 2)


def _shares(shares: list[float]) -> str:
    low, high = (f"{100.0 * x:.0f} %" for x in (min(shares), max(shares)))
    return low if low == high else f"{low} to {high}"


def _where(run: Result) -> "Iterable[RenderableType]":
    """The largest findings of where the model fails, a line each; the page has them in full."""
    for finding in run.where[:FINDINGS]:
        if finding.sentence:
            yield Words(f"fails: {finding.sentence}", 1)


def _part(split: SplitPart, part: Part) -> str:
    ends = plain(wording.percent_range(split.ends(part)))
    return percent(getattr(split, part)) + (f" ({ends})" if ends else "")


def _parameters(run: Result) -> "Iterable[RenderableType]":
    """Every physical parameter, or the least certain ones when there are many."""
    from rich.text import Text

    rows = run.physical
    if not rows:
        return
    short = len(rows) > PARAMETERS
    shown = sorted(rows, key=_doubt, reverse=True)[:WORST] if short else rows
    table = new_table(
        "parameter", "unit", "value", "+-", "likely from", "to", "off by", "Eq. 14", words=2
    )
    for row in shown:
        unit, factor = wording.shown_unit(row.unit)
        value, error = times(row.value, factor), times(row.standard_error, factor)
        ends = (number(times(end, factor), 3) for end in row.likely or (None, None))
        cells = (unit, number(value, 5), number(error, 2), *ends)
        add_row(table, row.name, *cells, *percents((row.may_be_off, row.relative_error)))
    yield table
    if short:
        yield Text(f"... and {len(rows) - len(shown)} more, all better known", style="dim")
    if said := f"{doubt.doubtful(rows)} {advice.widest_range(run)}".strip():
        yield Words(said, 2)
    if known := beforehand.prior_words(rows):
        yield Words(plain(known), 3)


def _doubt(row: ParameterRow) -> float:
    return float("inf") if row.may_be_off is None else row.may_be_off


def _ranking(run: Result) -> "Iterable[RenderableType]":
    from rich.text import Text

    if not run.missing:
        return
    yield Text()
    headings = ("effect tried", "verdict", "would leave", "refitted", "held out", "p")
    table = new_table(*headings, words=2)
    for row in run.missing[:CANDIDATES]:
        errors = (row.eps_rmsn_predicted, row.eps_rmsn_refitted, row.eps_rmsn_check)
        effect = f"{row.rank or ''} {row.effect}".strip()
        p_value = number(row.p_value, 2)
        add_row(table, effect, row.verdict or "", *percents(errors), p_value)
    yield table


def _verdict(run: Result) -> "Iterable[RenderableType]":
    from rich.text import Text

    verdict = run.verdict
    styles = {"no fit": "bold red", "missing": "bold yellow", "nothing missing": "bold green"}
    yield Text()
    sentence = verdict.sentence or verdict.kind or "No verdict."
    yield Words(sentence, 3, styles.get(verdict.kind or "", "bold"))
    if verdict.next_trial and verdict.next_trial.sentence:
        yield Words(f"Next: {verdict.next_trial.sentence}", 2)


def _change(run: Result) -> str:
    """The error before and after, fitted and held out."""
    pair = run.before_after
    if pair is None and run.verdict.kind == "not in catalogue":
        return "No effect is proposed; --draft FILE writes the force that is missing, to be edited."
    if pair is None:
        return "No effect is proposed."
    check = pair.eps_rmsn_check
    held_out = f"held out {_pair(check)}" if check else "nothing held out"
    return f"With {pair.effect}: fitted {_pair(pair.eps_rmsn)}, {held_out}"


def _pair(errors: Sequence[float | None] | None) -> str:
    before, after = errors or (None, None)
    return f"{percent(before)} -> {percent(after)}"
