"""The run on one screen of a terminal: at most 40 lines of 100 columns."""

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from trialid.report import labels, wording
from trialid.report.shape import Run, whole
from trialid.report.terminal import (
    Words,
    add_row,
    new_table,
    number,
    percent,
    percents,
    plain,
    times,
)

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

TRIALS = 5
PARAMETERS = 10
WORST = 8
CANDIDATES = 4
FINDINGS = 3
"""How many rows each part may have; together they keep the summary under 40 lines."""


def summary(result: Mapping[str, Any]) -> "RenderableType":
    """What a run found, for a rich console; all the rest is in the report page."""
    from rich.console import Group
    from rich.text import Text

    run = whole(result)
    title = Words(run["pipeline"] or "trialid", 1, "bold")
    return Group(
        title,
        _errors(run),
        Words(_made_of(run), 2),
        *_where(run),
        Text(),
        *_parameters(run),
        *_ranking(run),
        *_verdict(run),
        Words(_change(run), 2, "bold"),
    )


def _errors(run: Run) -> "Table":
    """Error by trial and output; what was held out is marked."""
    fit = run["fit"]
    outputs = list(fit["eps_rmsn_by_output"])[:6]
    letters = map(labels.symbol, outputs)
    table = new_table("error, share of measured RMS", "use", *letters, "all", words=2)
    trials = run["trials"]
    shown = trials if len(trials) <= TRIALS else trials[: TRIALS - 1]
    for trial in shown:
        use = "held out" if trial["use"] == "check" else "fitted"
        add_row(table, trial["name"], use, *percents(map(trial["eps_rmsn"].get, outputs)), "")
    if len(shown) < len(trials):
        add_row(table, f"... and {len(trials) - len(shown)} more trials")
    by_output = percents(fit["eps_rmsn_by_output"][name] for name in outputs)
    add_row(table, "all fitted trials", "", *by_output, percent(fit["eps_rmsn"]), style="bold")
    if fit["eps_rmsn_check"] is not None:
        blanks = [""] * len(outputs)
        add_row(table, "all held-out trials", "", *blanks, percent(fit["eps_rmsn_check"]))
    return table


def _made_of(run: Run) -> str:
    split = run["split"]
    if split["noise"] is None:
        why = split["why"] or split["method"] or "no route to the noise was open"
        return f"noise and model not told apart: {why}"
    return (
        f"made of noise {_part(split, 'noise')} and model {_part(split, 'undermodelling')}"
        f", told apart by {split['method']}"
    )


def _where(run: Run) -> "Iterable[RenderableType]":
    """The largest findings of where the model fails, a line each; the page has them in full."""
    for finding in run["where"][:FINDINGS]:
        if finding["sentence"]:
            yield Words(f"fails: {finding['sentence']}", 1)


def _part(split: Run, part: str) -> str:
    ends = plain(wording.percent_range((split["interval"] or {}).get(part)))
    return percent(split[part]) + (f" ({ends})" if ends else "")


def _parameters(run: Run) -> "Iterable[RenderableType]":
    """Every physical parameter, or the least certain ones when there are many."""
    from rich.text import Text

    rows = [row for row in run["accuracy"]["parameters"] if row["kind"] != "nuisance"]
    if not rows:
        return
    short = len(rows) > PARAMETERS
    shown = sorted(rows, key=_doubt, reverse=True)[:WORST] if short else rows
    table = new_table(
        "parameter", "unit", "value", "+-", "R_i", "Eq. 14", "noise", "model <=", words=2
    )
    for row in shown:
        unit, factor = wording.shown(row["unit"])
        value, error = times(row["value"], factor), times(row["standard_error"], factor)
        parts = (row["relative_error"], row["noise_error"], row["undermodelling_error"])
        cells = (unit, number(value, 5), number(error, 2), number(row["R_i"], 3))
        add_row(table, row["name"], *cells, *percents(parts))
    yield table
    if short:
        yield Text(f"... and {len(rows) - len(shown)} more, all less uncertain", style="dim")
    if doubt := wording.doubtful(rows):
        yield Words(doubt, 2)


def _doubt(row: Mapping[str, Any]) -> float:
    error: float | None = row["relative_error"]
    return float("inf") if error is None else error


def _ranking(run: Run) -> "Iterable[RenderableType]":
    from rich.text import Text

    if not run["missing"]:
        return
    yield Text()
    headings = ("effect tried", "verdict", "would leave", "refitted", "held out", "p")
    table = new_table(*headings, words=2)
    for row in run["missing"][:CANDIDATES]:
        errors = (row["eps_rmsn_predicted"], row["eps_rmsn_refitted"], row["eps_rmsn_check"])
        effect = f"{row['rank'] or ''} {row['effect']}".strip()
        p_value = number(row["p_value"], 2)
        add_row(table, effect, row["verdict"] or "", *percents(errors), p_value)
    yield table


def _verdict(run: Run) -> "Iterable[RenderableType]":
    from rich.text import Text

    verdict = run["verdict"]
    styles = {"missing": "bold yellow", "nothing missing": "bold green"}
    yield Text()
    sentence = verdict["sentence"] or verdict["kind"] or "No verdict."
    yield Words(sentence, 3, styles.get(verdict["kind"], "bold"))
    following = (verdict["next_trial"] or {}).get("sentence")
    if following:
        yield Words(f"Next: {following}", 2)


def _change(run: Run) -> str:
    """The error before and after, fitted and held out."""
    pair = run["before_after"]
    if pair is None and run["verdict"]["kind"] == "not in catalogue":
        return "No effect is proposed; --draft FILE writes the force that is missing, to be edited."
    if pair is None:
        return "No effect is proposed."
    check = pair["eps_rmsn_check"]
    held_out = f"held out {_pair(check)}" if check else "nothing held out"
    return f"With {pair['effect']}: fitted {_pair(pair['eps_rmsn'])}, {held_out}"


def _pair(errors: Sequence[float | None] | None) -> str:
    before, after = errors or (None, None)
    return f"{percent(before)} -> {percent(after)}"
