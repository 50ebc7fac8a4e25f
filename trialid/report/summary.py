"""The run on one screen of a terminal: at most 40 lines of 100 columns."""

import textwrap
from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

from trialid.report import labels, wording
from trialid.report.shape import Run, whole

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

WIDTH = 98
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
    title = Text(_cut(run["pipeline"] or "trialid", 1), style="bold")
    return Group(
        title,
        _errors(run),
        Text(_made_of(run)),
        *_where(run),
        Text(),
        *_parameters(run),
        *_ranking(run),
        *_verdict(run),
        Text(_change(run), style="bold"),
    )


def _errors(run: Run) -> "Table":
    """Error by trial and output; what was held out is marked."""
    fit = run["fit"]
    outputs = list(fit["eps_rmsn_by_output"])[:6]
    letters = map(labels.symbol, outputs)
    table = _table("error, share of measured RMS", "use", *letters, "all", words=2)
    trials = run["trials"]
    shown = trials if len(trials) <= TRIALS else trials[: TRIALS - 1]
    for trial in shown:
        use = "held out" if trial["use"] == "check" else "fitted"
        _row(table, trial["name"], use, *_percents(map(trial["eps_rmsn"].get, outputs)), "")
    if len(shown) < len(trials):
        _row(table, f"... and {len(trials) - len(shown)} more trials")
    by_output = _percents(fit["eps_rmsn_by_output"][name] for name in outputs)
    _row(table, "all fitted trials", "", *by_output, _percent(fit["eps_rmsn"]), style="bold")
    if fit["eps_rmsn_check"] is not None:
        blanks = [""] * len(outputs)
        _row(table, "all held-out trials", "", *blanks, _percent(fit["eps_rmsn_check"]))
    return table


def _made_of(run: Run) -> str:
    split = run["split"]
    if split["noise"] is None:
        why = split["why"] or split["method"] or "no route to the noise was open"
        return _cut(f"noise and model not told apart: {why}", 2)
    words = (
        f"made of noise {_part(split, 'noise')} and model {_part(split, 'undermodelling')}"
        f", told apart by {split['method']}"
    )
    return _cut(words, 2)


def _where(run: Run) -> "Iterable[RenderableType]":
    """The largest findings of where the model fails, a line each; the page has them in full."""
    from rich.text import Text

    for finding in run["where"][:FINDINGS]:
        if finding["sentence"]:
            yield Text(_cut(f"fails: {finding['sentence']}", 1))


def _part(split: Run, part: str) -> str:
    ends = _plain(wording.percent_range((split["interval"] or {}).get(part)))
    return _percent(split[part]) + (f" ({ends})" if ends else "")


def _parameters(run: Run) -> "Iterable[RenderableType]":
    """Every physical parameter, or the least certain ones when there are many."""
    from rich.text import Text

    rows = [row for row in run["accuracy"]["parameters"] if row["kind"] != "nuisance"]
    if not rows:
        return
    short = len(rows) > PARAMETERS
    shown = sorted(rows, key=_doubt, reverse=True)[:WORST] if short else rows
    table = _table(
        "parameter", "unit", "value", "+-", "R_i", "Eq. 14", "noise", "model <=", words=2
    )
    for row in shown:
        unit, factor = wording.shown(row["unit"])
        value, error = _times(row["value"], factor), _times(row["standard_error"], factor)
        parts = (row["relative_error"], row["noise_error"], row["undermodelling_error"])
        cells = (unit, _number(value, 5), _number(error, 2), _number(row["R_i"], 3))
        _row(table, row["name"], *cells, *_percents(parts))
    yield table
    if short:
        yield Text(f"... and {len(rows) - len(shown)} more, all less uncertain", style="dim")


def _doubt(row: Mapping[str, Any]) -> float:
    error: float | None = row["relative_error"]
    return float("inf") if error is None else error


def _ranking(run: Run) -> "Iterable[RenderableType]":
    from rich.text import Text

    if not run["missing"]:
        return
    yield Text()
    headings = ("effect tried", "verdict", "would leave", "refitted", "held out", "p")
    table = _table(*headings, words=2)
    for row in run["missing"][:CANDIDATES]:
        errors = (row["eps_rmsn_predicted"], row["eps_rmsn_refitted"], row["eps_rmsn_check"])
        effect = f"{row['rank'] or ''} {row['effect']}".strip()
        p_value = _number(row["p_value"], 2)
        _row(table, effect, row["verdict"] or "", *_percents(errors), p_value)
    yield table


def _verdict(run: Run) -> "Iterable[RenderableType]":
    from rich.text import Text

    verdict = run["verdict"]
    styles = {"missing": "bold yellow", "nothing missing": "bold green"}
    yield Text()
    sentence = verdict["sentence"] or verdict["kind"] or "No verdict."
    yield Text(_cut(sentence, 3), style=styles.get(verdict["kind"], "bold"))
    following = (verdict["next_trial"] or {}).get("sentence")
    if following:
        yield Text(_cut(f"Next: {following}", 2))


def _change(run: Run) -> str:
    """The error before and after, fitted and held out."""
    pair = run["before_after"]
    if pair is None:
        return "No effect was added."
    check = pair["eps_rmsn_check"]
    held_out = f"held out {_pair(check)}" if check else "nothing held out"
    return _cut(f"With {pair['effect']}: fitted {_pair(pair['eps_rmsn'])}, {held_out}", 2)


def _pair(errors: Sequence[float | None] | None) -> str:
    before, after = errors or (None, None)
    return f"{_percent(before)} -> {_percent(after)}"


def _table(*headings: str, words: int) -> "Table":
    """A table without rules: so many columns of words, the rest of numbers."""
    from rich.table import Table
    from rich.text import Text

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for place, heading in enumerate(headings):
        side: Literal["left", "right"] = "left" if place < words else "right"
        table.add_column(Text(heading), justify=side, no_wrap=True, overflow="ellipsis")
    return table


def _row(table: "Table", *cells: str, style: str | None = None) -> None:
    from rich.text import Text

    table.add_row(*(Text(cell) for cell in cells), style=style)


def _cut(words: str, lines: int) -> str:
    """Words on so many lines; the page has the rest."""
    return "\n".join(textwrap.wrap(words, WIDTH, max_lines=lines, placeholder=" ..."))


def _percents(values: Iterable[float | None]) -> list[str]:
    return [_percent(value) for value in values]


def _percent(value: float | None) -> str:
    return _plain(wording.percent(value))


def _number(value: float | None, digits: int) -> str:
    """A number as programs write it: it may be copied from here into a file."""
    return wording.DASH if value is None else f"{value:#.{digits}g}".rstrip(".")


def _times(value: float | None, factor: float) -> float | None:
    return None if value is None else value * factor


def _plain(words: str) -> str:
    return words.replace(wording.THIN, " ")
