"""Compared structures for a terminal: a row each, those that fail with their reasons below."""

from collections.abc import Iterator
from typing import Any

from trialid.names.wording import DASH
from trialid.report.terminal.terminal import Words, add_row, new_table, percent
from trialid.result.structure_rows import StructureRow, Structures

REASON_LINES = 2


def structure_table(found: Structures) -> Iterator[Any]:
    """The table, the reasons, the sentences: what a terminal prints."""
    yield f"{found.pipeline}: {len(found.trials)} trials, each left out in turn"
    sound = [row for row in found.rows if row.why_not is None]
    check = any(row.eps_rmsn_check is not None for row in sound)
    headings = ["free", "fitted", "left out", "behind", *["held out"] * check]
    table = new_table("structure", *headings, "", words=1)
    for row in sound:
        held_out = [percent(row.eps_rmsn_check)] * check
        errors = [percent(row.eps_rmsn), percent(row.eps_rmsn_left_out), _behind(row, found)]
        style = "bold" if row.name == found.chosen else None
        cells = [row.name, str(row.parameters), *errors, *held_out, _mark(row, found)]
        add_row(table, *cells, style=style)
    if sound:
        yield table
    for row in found.rows:
        if row.why_not is not None:
            yield Words(f"{row.name}: no fit: {row.why_not}", REASON_LINES)
    for name, why in found.not_tried.items():
        yield Words(f"{name}: left out: {why}", REASON_LINES)
    yield ""
    for sentence in found.sentences:
        yield Words(sentence, 4)


def _behind(row: StructureRow, found: Structures) -> str:
    if row.behind is None or row.behind_standard_error is None or row.name == found.best:
        return DASH
    return f"{100.0 * row.behind:.2f} +- {100.0 * row.behind_standard_error:.2f}"


def _mark(row: StructureRow, found: Structures) -> str:
    if row.name == found.chosen:
        return "chosen"
    if row.name == found.best:
        return "best"
    return "close" if row.as_good else ""
