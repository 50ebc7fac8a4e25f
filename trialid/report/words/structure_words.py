"""What comparing structures found, in sentences: the choice, and how far it can be relied on."""

from collections import Counter
from collections.abc import Iterator
from typing import Final

import numpy as np

from trialid.diagnosis.search.carry_over import WHOLE
from trialid.result.structure_rows import StructureRow, Structures

NOT_ARRIVED: Final = ("did not converge", "does not arrive")
"""What is said of a search that did not, with all trials and without one."""


def sentences(found: Structures) -> tuple[str, ...]:
    """The choice first; then what limits it."""
    told = (_unforetold, _not_compared, _stability, _few)
    return (_choice(found), *(words for tell in told for words in tell(found)))


def _choice(found: Structures) -> str:
    if found.best is None or found.chosen is None:
        return "No structure can be chosen: none could be fitted with every trial left out in turn."
    best, chosen = found.row(found.best), found.row(found.chosen)
    if sum(row.why_not is None for row in found.rows) == 1:
        return f"{_told(chosen)} is the only structure that stands, so there was no choice."
    if chosen == best:
        return f"{_told(best)} is the best, and none that is simpler is as good{_not_sure(found)}."
    return (
        f"{_told(chosen)} is the simplest that is as good as the best, {_told(best)}: "
        f"{_points(chosen)} percentage points behind{_not_sure(found)}."
    )


def _not_sure(found: Structures) -> str:
    """What most choices without one trial are, where they are another; else empty."""
    again = found.chosen_without
    [(name, times)] = Counter(again.values()).most_common(1) or [(None, 0)]
    if name in (None, found.chosen) or 2 * times <= len(again):
        return ""
    return f"; but that is not sure: with one trial left out, {times} of {len(again)} are {name}"


def _unforetold(found: Structures) -> Iterator[str]:
    lost = found.row(found.chosen).unforetold if found.chosen else ()
    if lost:
        yield (
            f"But from the other trials it foretells {' and '.join(lost)} worse than no model at "
            "all would: look at signs, units and speed; where they agree, she moves there as in no "
            "other trial, and no choice holds there before there are more like it."
        )


def _not_compared(found: Structures) -> Iterator[str]:
    """Structures whose search did not arrive: they may be better than all that were compared."""
    out = [
        f"`{row.name}`"
        for row in found.rows
        if any(words in (row.why_not or "") for words in NOT_ARRIVED)
    ]
    if out and found.chosen is not None:
        yield (
            f"Not compared, as their searches did not arrive: {' and '.join(out)}; with more "
            "[identify] max_iterations or starts they may stand, and be better."
        )


def _told(row: StructureRow) -> str:
    """A structure with its size and its error."""
    parameters = f"{row.parameters} free parameters"
    return f"{row.name} ({parameters}, {row.eps_rmsn_left_out or 0.0:.2%} on trials left out)"


def _points(row: StructureRow) -> str:
    """How far behind the best, with one standard error; in percentage points."""
    behind, error = row.behind or 0.0, row.behind_standard_error or 0.0
    return f"{100.0 * behind:.2f} +- {100.0 * error:.2f}"


def _stability(found: Structures) -> Iterator[str]:
    again = found.chosen_without
    others = [f"; without {n}: {x or 'none'}" for n, x in again.items() if x != found.chosen]
    if again and found.chosen is not None:
        yield (
            f"Without any use of one trial, each in turn, {len(again) - len(others)} of "
            f"{len(again)} choices are the same{''.join(others)}."
        )
    elif len(found.trials) == 2:
        yield "With two trials nobody can tell how stable that is."


def _few(found: Structures) -> Iterator[str]:
    count = len(found.trials)
    if found.best is not None and count < WHOLE:
        off = 1.0 / np.sqrt(2.0 * (count - 1))
        yield (
            f"{count} trials are few: a standard error from {count} differences is itself off by "
            f"{off:.0%}."
        )
