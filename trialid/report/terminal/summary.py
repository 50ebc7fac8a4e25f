"""The run on one screen of a terminal: the verdict first, then what it rests on."""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Final

import numpy as np

from trialid.names import labels, wording
from trialid.names.quantities import POSITION, SIGNALS
from trialid.report.terminal.terminal import (
    SCREEN,
    FirstThatFits,
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
from trialid.result.change_rows import ChangePart
from trialid.result.fit_rows import ParameterRow, Part, SplitPart, TrialRow
from trialid.result.schema import Result

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table


@dataclass(frozen=True)
class Rows:
    """How many rows the parts of a screen may have."""

    trials: int
    parameters: int
    candidates: int
    findings: int


TO_CHECK: Final = re.compile(
    r"; left as (it is|they are)\b|: only \[.*\] s is used|\bstuck\?|\bheels inward in turns\b"
    rf"|\b{wording.SET_BACK}\b"
)
"""What a remark says of values that a person has to judge: a jump, a record that is used in part, a
roll that may be positive to port, a clock that was set back."""

ROWS: Final = (
    Rows(trials=8, parameters=12, candidates=4, findings=3),
    Rows(trials=5, parameters=10, candidates=4, findings=3),
    Rows(trials=5, parameters=7, candidates=4, findings=2),
    Rows(trials=5, parameters=6, candidates=4, findings=1),
    Rows(trials=5, parameters=5, candidates=3, findings=1),
    Rows(trials=4, parameters=4, candidates=2, findings=1),
    Rows(trials=3, parameters=3, candidates=1, findings=0),
    Rows(trials=3, parameters=3, candidates=0, findings=0),
)
"""From what a short run shows in full to what a crowded one is left with."""


def summary(run: Result, file: str = "", lines: int = SCREEN[0] - 1) -> "RenderableType":
    """What a run found, for a rich console; all the rest is in the report page.

    `file` is the pipeline as the user named it, for the command to give next.
    """
    forms = [partial(_screen, run, file, rows) for rows in ROWS]
    return FirstThatFits(forms, lines)


def _screen(run: Result, file: str, rows: Rows) -> "RenderableType":
    from rich.console import Group
    from rich.text import Text

    title = Words(run.pipeline or "trialid", 1, "dim")
    if run.verdict.kind == "no fit":  # before everything: none of what follows may be relied on
        begun = (title, *_verdict(run), Text(), _errors(run, rows))
        return Group(*begun, *_parameters(run, rows), *_to_check(run))
    return Group(
        title,
        *_verdict(run),
        *next_lines(run, file),
        Text(),
        _errors(run, rows),
        Words(_made_of(run), 2),
        *_band(run),
        *_ranking(run, rows),
        *_parameters(run, rows),
        *_where(run, rows),
        *_to_check(run),
    )


def _verdict(run: Result) -> "Iterable[RenderableType]":
    verdict = run.verdict
    styles = {"no fit": "bold red", "missing": "bold yellow", "nothing missing": "bold green"}
    sentence = verdict.sentence or verdict.kind or "No verdict."
    yield Words(sentence, 4, styles.get(verdict.kind or "", "bold"))
    if run.fit.converged is False and verdict.kind != "no fit":
        yield Words("The fit did not converge: rely on nothing here before it does.", 1, "bold red")


def next_lines(run: Result, file: str) -> "Iterable[RenderableType]":
    """What to do about the verdict, and the trial that would tell more."""
    verdict = run.verdict
    if file and verdict.kind == "missing" and verdict.effect:
        yield Words(f"Next: {advice.command_on(file, 'add', verdict.effect)}", 2)
    if file and verdict.together:
        yield Words(f"Next: {advice.command_on(file, 'run', '--auto')}  # adds them, goes on", 2)
    if file and verdict.kind == "not in catalogue":
        yield Words(
            f"Next: {advice.command_on(file, 'run', '--draft', 'my_effect.py')}  # writes the "
            "missing force, to be edited",
            2,
        )
    open_still = verdict.kind == "cannot tell" and not verdict.together
    first = advice.first_step(run) if open_still or verdict.kind == "nothing missing" else None
    if first is not None:
        yield Words(f"Next: {plain(f'{first.words} {first.command}'.rstrip())}", 3)
    if run.before_after is not None and verdict.kind != "missing":
        yield Words(_change(run.before_after), 2)
    if verdict.next_trial and verdict.next_trial.sentence:
        yield Words(f"{verdict.next_trial.heading}: {verdict.next_trial.sentence}", 3)


def _errors(run: Result, rows: Rows) -> "Table":
    """Error by trial and output; what was held out is marked."""
    fit = run.fit
    outputs = list(fit.eps_rmsn_by_output)[:6]
    letters = map(labels.symbol, outputs)
    tracked = {*POSITION} & {*outputs}
    share = "error by RMS; x, y by length" if tracked else "error by RMS of fitted trials"
    table = new_table(share, "use", *letters, "all", words=2)
    trials = run.trials
    shown = trials if len(trials) <= rows.trials else _worst(trials, rows.trials - 1)
    for trial in shown:
        use = "held out" if trial.use == "check" else "fitted"
        add_row(table, trial.name, use, *percents(map(trial.eps_rmsn.get, outputs)), "")
    if len(shown) < len(trials):
        add_row(table, f"... {wording.count_of(len(trials) - len(shown), 'trial')} with less")
    by_output = percents(fit.eps_rmsn_by_output[name] for name in outputs)
    add_row(table, "all fitted trials", "", *by_output, percent(fit.eps_rmsn), style="bold")
    check = percent(fit.eps_rmsn_check) if _holds_out(run) else "none"
    add_row(table, "all held-out trials", "", *[""] * len(outputs), check)
    return table


def _worst(trials: Sequence[TrialRow], count: int) -> list[TrialRow]:
    """Those of the largest error of an output, or that were lost, in their own order."""
    errors = [[np.inf if x is None else x for x in t.eps_rmsn.values()] for t in trials]
    largest = [max(own, default=0.0) for own in errors]
    places = sorted(np.argsort(largest, kind="stable")[len(trials) - count :].tolist())
    return [trials[i] for i in places]


def _holds_out(run: Result) -> bool:
    """Whether any trial is held out."""
    return any(trial.use == "check" for trial in run.trials)


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
    halves = ", ".join(_half(name, x) for name, x in run.fit.band.items())
    said = f"95 % band of a trial like these: {halves}"
    untold = run.fit.untold_band
    checks = [t for t in run.trials if t.use == "check"]
    held = [x for t in checks for n, x in t.inside.items() if x is not None and n not in untold]
    if untold:
        wide = " and ".join(map(labels.symbol, untold))
        said += f"; {wide}: as wide as with no model, too few trials tell it, or too unlike"
    if held:
        said += f"; of the held-out samples {_shares(held)} lie inside"
    yield Words(plain(said), 2)


def _half(name: str, half: float) -> str:
    """Half the band of an output, or that an angle may be any."""
    if name in SIGNALS and SIGNALS[name].angle and half >= np.pi:
        return f"{labels.symbol(name)} anywhere"
    return f"{labels.symbol(name)} +-{labels.shown_text(name, half)}"


def _shares(shares: list[float]) -> str:
    low, high = (f"{100.0 * x:.0f} %" for x in (min(shares), max(shares)))
    return low if low == high else f"{low} to {high}"


def _where(run: Result, rows: Rows) -> "Iterable[RenderableType]":
    """The largest findings of where the model fails; what the sign is like is on the page."""
    said = [finding.sentence for finding in run.where if finding.sentence]
    for sentence in said[: rows.findings]:
        yield Words(f"Fails: {sentence.partition(';')[0]}", 2)


def _to_check(run: Result) -> "Iterable[RenderableType]":
    """What in a record may be no measurement and was left in it, of one trial."""
    said = [(t.name, r) for t in run.trials for r in t.remarks if TO_CHECK.search(r)]
    for name, remark in said[:1]:
        more = f" ({len(said) - 1} more on the page)" if len(said) > 1 else ""
        yield Words(f"To check, in {name}: {plain(remark)}{more}", 2)


def _part(split: SplitPart, part: Part) -> str:
    ends = plain(wording.percent_range(split.ends(part)))
    return percent(getattr(split, part)) + (f" ({ends})" if ends else "")


def _parameters(run: Result, rows: Rows) -> "Iterable[RenderableType]":
    """Every physical parameter, or the least certain ones when there are many."""
    from rich.text import Text

    found = run.physical
    if not found:
        return
    yield Text()
    short = len(found) > rows.parameters
    shown = sorted(found, key=_doubt, reverse=True)[: rows.parameters] if short else found
    headings = ("parameter", "unit", "value", "+-", "likely from", "to", "may be off")
    table = new_table(*headings, words=2)
    for row in shown:
        unit, factor = wording.shown_unit(row.unit)
        value, error = times(row.value, factor), times(row.standard_error, factor)
        ends = (number(times(end, factor), 3) for end in row.likely or (None, None))
        cells = (unit, number(value, 5), number(error, 2), *ends)
        add_row(table, row.name, *cells, percent(row.may_be_off))
    yield table
    if short:
        yield Text(f"... and {len(found) - len(shown)} more, all better known", style="dim")
    first, second = doubt.records_doubt(run.verdict), doubt.doubtful(found)
    if said := " ".join(filter(None, (first, second, doubt.widest_range(run)))):
        yield Words(said, 3)
    if known := beforehand.prior_words(found):
        yield Words(plain(known), 3)
    if run.fit.remarks:
        yield Words(f"{'; '.join(run.fit.remarks)}.", 3)


def _doubt(row: ParameterRow) -> float:
    if doubt.is_idle(row):
        return -1.0
    return float("inf") if row.may_be_off is None else row.may_be_off


def _ranking(run: Result, rows: Rows) -> "Iterable[RenderableType]":
    from rich.text import Text

    if not run.missing[: rows.candidates]:
        return
    yield Text()
    held_out = ("held out",) * _holds_out(run)  # no column of dashes that costs names their ends
    table = new_table(
        *("effect tried", "verdict", "would leave", "refitted", *held_out, "p"), words=2
    )
    for row in run.missing[: rows.candidates]:
        errors = [row.eps_rmsn_predicted, row.eps_rmsn_refitted, row.eps_rmsn_check]
        errors = errors[: 2 + len(held_out)]
        effect = f"{row.rank or ''} {row.effect}".strip()
        p_value = number(row.p_value, 2)
        add_row(table, effect, row.verdict or "", *percents(errors), p_value)
    yield table


def _change(pair: ChangePart) -> str:
    """The error before and after, fitted and held out."""
    check = pair.eps_rmsn_check
    held_out = f"held out {_pair(check)}" if check else "nothing held out"
    return f"With {pair.effect}: fitted {_pair(pair.eps_rmsn)}, {held_out}"


def _pair(errors: Sequence[float | None] | None) -> str:
    before, after = errors or (None, None)
    return f"{percent(before)} -> {percent(after)}"
