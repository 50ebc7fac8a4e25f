"""A model before and after one effect was added or dropped, side by side on a terminal."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import zip_longest
from typing import TYPE_CHECKING, Final

from trialid.diagnosis.search.carried import FALL
from trialid.names import labels, wording
from trialid.report.pictures.bars import foreseen_in_errors
from trialid.report.terminal import steps
from trialid.report.terminal.summary import next_lines
from trialid.report.terminal.terminal import (
    SCREEN,
    FirstThatFits,
    Words,
    add_row,
    new_table,
    number,
    percent,
    plain,
    times,
)
from trialid.result.change_rows import ChangePart, MovedRow
from trialid.result.schema import Result

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table


@dataclass(frozen=True)
class Rows:
    """How many rows the parts of a screen may have; errors by output or of all outputs alone."""

    parameters: int
    steps: int
    by_output: bool


ROWS: Final = (
    Rows(12, 8, by_output=True),
    Rows(10, 5, by_output=True),
    Rows(8, 4, by_output=True),
    Rows(6, 3, by_output=True),
    Rows(8, 3, by_output=False),
    Rows(5, 2, by_output=False),
    Rows(3, 1, by_output=False),
)
"""From what a short change shows in full to what a crowded one is left with."""


def before_after(run: Result, file: str = "", lines: int = SCREEN[0] - 1) -> "RenderableType":
    """The change of a result, for a rich console; the page has all of it.

    `file` is the pipeline as the user named it, for the command to give next.
    """
    return FirstThatFits([partial(_screen, run, file, rows) for rows in ROWS], lines)


def _screen(run: Result, file: str, rows: Rows) -> "RenderableType":
    from rich.console import Group
    from rich.text import Text

    change = run.change
    assert change is not None, "shown where a model was changed"
    done = f"{change.effect or 'an effect'} {change.step or 'changed'}"
    title = f"{run.pipeline or 'trialid'}: {done}"
    return Group(
        Words(title, 1, "dim"),
        Words(_verdicts(change), 2, "bold"),
        Words(run.verdict.sentence or run.verdict.kind or "No verdict.", 4, "bold"),
        *next_lines(run, file),
        Words(change.equation or "", 2, "dim"),
        Text(),
        _errors(change, rows),
        Words(_foreseen(change), 3),
        Text(),
        *_parameters(change, rows),
        Text("\n".join(steps.rows(run, rows.steps)), no_wrap=True, overflow="ellipsis"),
    )


def _errors(change: ChangePart, rows: Rows) -> "Table":
    """Errors on fit and check trials by output, and what they are made of."""
    table = new_table("error, share of measured RMS", "", "before", "after", words=2)
    pairs = (
        ("fitted trials", change.eps_rmsn, change.by_output),
        ("held-out trials", change.eps_rmsn_check, change.by_output_check),
    )
    for name, both, by_output in pairs:
        if both is not None:
            add_row(table, name, "all", *_pair(both), style="bold")
            for output, each in by_output.items() if rows.by_output else ():
                add_row(table, "", labels.symbol(output), *_pair(each))
    for name, key in (("noise part", "noise"), ("model part", "undermodelling")):
        add_row(table, name, "all", *_pair(getattr(change, key)))
    return table


def _pair(pair: Sequence[float | None] | None) -> tuple[str, str]:
    before, after = pair or (None, None)
    return percent(before), percent(after)


def _verdicts(change: ChangePart) -> str:
    """The verdict before and after, with what was named."""
    pairs = zip_longest(change.verdict, change.named)
    words = "Verdict: " + " -> ".join(
        f"{kind or wording.DASH} ({name})" if name else str(kind or wording.DASH)
        for kind, name in pairs
    )
    before, after = change.eps_rmsn_check or (None, None)
    if change.step == "added" and before and after and after**2 > FALL * before**2:
        falls = "hardly falls" if after < before else "does not fall"
        words += f"; the held-out error {falls}: no trial speaks for this effect"
    return words


def _foreseen(change: ChangePart) -> str:
    """What linearisation foresaw against what came of it, in words."""
    if change.not_foreseen:
        return f"nothing foreseen by linearisation: {change.not_foreseen}"
    if change.eps_rmsn_foreseen is None:
        return ""
    after = (change.eps_rmsn or (None, None))[1]
    words = f"foreseen by linearisation: error {percent(change.eps_rmsn_foreseen)}"
    words += f", fitted {percent(after)}"
    for row in change.parameters:
        if row.after_foreseen is not None:
            unit, factor = wording.shown_unit(row.unit)
            ahead, came = (
                plain(number(times(getattr(row, key), factor), 3))
                for key in ("after_foreseen", "after")
            )
            words += f"; {row.name} {ahead}, fitted {came} {'' if unit == '1' else unit}".rstrip()
    return words


def _parameters(change: ChangePart, rows: Rows) -> "Iterable[RenderableType]":
    """Before, after, and the move in standard errors of the fit before, next to the foreseen."""
    from rich.text import Text

    shown = sorted(change.parameters, key=_distance, reverse=True)[: rows.parameters]
    if not shown:
        return
    table = new_table(
        "parameter", "unit", "before", "+-", "after", "+-", "moved", "foreseen", words=2
    )
    for row in (r for r in change.parameters if r in shown):
        unit, factor = wording.shown_unit(row.unit)
        values = [
            times(getattr(row, key), factor) for key in ("before", "standard_error_before", "after")
        ]
        error = times(row.standard_error, factor) if row.after is not None else None
        add_row(
            table, row.name, unit, number(values[0], 5), number(values[1], 2),
            number(values[2], 5), number(error, 2), *_moved(row),
        )  # fmt: skip
    yield table
    left = len(change.parameters) - len(shown)
    more = f"; {wording.count_of(left, 'more parameter')} moved less" if left else ""
    yield Words(f"moved, foreseen: in standard errors (+-) of the fit before{more}", 2, "dim")
    yield Text()


def _distance(row: MovedRow) -> float:
    """How far a parameter moved; one that came or went is always shown."""
    move: float | None = row.move_in_errors
    return float("inf") if move is None else abs(move)


def _moved(row: MovedRow) -> tuple[str, str]:
    if row.before is None or row.after is None:
        return ("new" if row.before is None else "gone"), ""
    moves = (row.move_in_errors, foreseen_in_errors(row))
    one, other = (wording.sign_text(move).replace(wording.MINUS, "-") for move in moves)
    return one, other
