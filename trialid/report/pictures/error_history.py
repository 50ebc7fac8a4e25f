"""The error falling step by step, as geometry for inline SVG; units are px of the view box.

Each step of the history has two bars, noise and model, since their squares add up to the error's
and they cannot stand on one another; a dot marks the error of the fitted trials, a diamond that of
the held-out ones. A whisker is the interval of the model part, where the run knows it.
"""

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

from trialid.names import wording
from trialid.result.change_rows import StepRow
from trialid.result.schema import Result

MOST: Final = 13
"""Steps drawn: the last ones; the table has all."""

OWN: Final = "this report"
"""What stands under the step that is this report's own model."""

LEFT, RIGHT = 52.0, 12.0
TOP, FLOOR = 34.0, 204.0
BAR, GAP = 30.0, 6.0
LINE: Final = 13.0
"""Height of a line of a label."""
BESIDE, ABOVE = 10.0, 6.0
"""How far a number stands from its mark."""


@dataclass(frozen=True)
class Bar:
    """A part of the error: a rectangle, its number below it, its interval."""

    x: float
    y: float
    height: float
    number: str
    title: str
    whisker: tuple[float, float] | None = None


@dataclass(frozen=True)
class Column:
    """One step; `noise` and `model` are None where they are not told apart, then there is `whole`.

    `y` and `check` are the heights of the error of the fitted and of the held-out trials, and their
    numbers stand at `error_y` and `check_y`, to the left or to the right.
    """

    x: float
    words: tuple[str, ...]
    said: str
    y: float
    error: str
    noise: Bar | None
    model: Bar | None
    whole: Bar | None
    check: float | None
    check_error: str
    present: bool
    proposed: bool
    error_y: float = 0.0
    check_y: float = 0.0
    to_the_left: bool = False

    @property
    def label_x(self) -> float:
        """Where its numbers end, or begin."""
        return self.x - BESIDE if self.to_the_left else self.x + BESIDE


@dataclass(frozen=True)
class ErrorHistory:
    """What the template draws; the lines join the errors of neighbouring steps."""

    width: float
    height: float
    columns: tuple[Column, ...]
    ticks: tuple[tuple[float, str], ...]
    line: str
    check_line: str
    left_out: int
    said: str


def error_history(run: Result) -> ErrorHistory | None:
    """The picture of a run's history, None where no step has an error."""
    known = [row for row in run.comparable if is_number(row.eps_rmsn)]
    shown = known[-MOST:]
    if not shown:
        return None
    top = max(_reach(row, run) for row in shown) or 1.0
    step = max(76.0, min(190.0, (1100.0 - LEFT - RIGHT) / len(shown)))
    present = _present(shown)
    columns = _lettered(
        _column(row, run, LEFT + (k + 0.5) * step, top, _words(row, row is present, step))
        for k, row in enumerate(shown)
    )
    lines = max(len(column.words) for column in columns)
    return ErrorHistory(
        width=LEFT + RIGHT + step * len(shown),
        height=FLOOR + 20.0 + LINE * (lines + 1),
        columns=columns,
        ticks=tuple(_ticks(top)),
        line=_joined([(c.x, c.y) for c in columns]),
        check_line=_joined([(c.x, c.check) for c in columns if c.check is not None]),
        left_out=len(known) - len(shown),
        said="; ".join(c.said for c in columns),
    )


def is_number(value: Any) -> bool:
    """Whether a value is there, and finite."""
    return isinstance(value, int | float) and math.isfinite(value)


def _present(rows: Sequence[StepRow]) -> StepRow | None:
    """The step that is this report's own model."""
    own = [row for row in rows if row.step != "proposed"]
    return own[-1] if own else None


def interval(row: StepRow, run: Result) -> tuple[float, float] | None:
    """The interval of a step's model part: its own, or what the run says of that model."""
    found = row.undermodelling_interval
    if found is None and row.step == "proposed":
        found = run.before_after.undermodelling_interval if run.before_after else None
    elif found is None and row is _present(run.history):
        found = run.split.ends("undermodelling")
    return (found[0], found[1]) if found and all(map(is_number, found)) else None


def _reach(row: StepRow, run: Result) -> float:
    """The largest error of a step."""
    ends = interval(row, run) or ()
    return max(e for e in (row.eps_rmsn, row.eps_rmsn_check, *ends) if is_number(e))


def _height(value: float, top: float) -> float:
    return (FLOOR - TOP) * value / top


def _column(row: StepRow, run: Result, x: float, top: float, words: Sequence[str]) -> Column:
    noise, model, error, check = _parts(row)
    apart = noise is not None and model is not None
    ends = interval(row, run)
    return Column(
        x=x,
        words=tuple(words),
        said=step_sentence(row),
        y=FLOOR - _height(error, top),
        error=_bare(error),
        noise=None if noise is None else _bar("noise", noise, x - BAR - 0.5 * GAP, top, None),
        model=None if model is None else _bar("model", model, x + 0.5 * GAP, top, ends),
        whole=None
        if apart
        else _bar("noise and model not told apart", error, x - 0.5 * BAR, top, None),
        check=None if check is None else FLOOR - _height(check, top),
        check_error="" if check is None else _bare(check),
        present=words[-1] == OWN,
        proposed=row.step == "proposed",
    )


def _lettered(columns: Iterable[Column]) -> tuple[Column, ...]:
    """The columns with their numbers where no line runs: away from a line that rises to the next.

    Lines come from the left and mostly from above; of two numbers that are near the upper one gives
    way.
    """
    drawn = list(columns)
    return tuple(map(_with_numbers, drawn, [*drawn[1:], None]))


def _with_numbers(column: Column, following: Column | None) -> Column:
    rises = following is not None and following.y < column.y
    error_y, check_y = column.y - ABOVE, (column.check or 0.0) - ABOVE
    if column.check is not None and abs(error_y - check_y) < LINE:
        if column.check < column.y:
            check_y = error_y - LINE
        else:
            error_y = check_y - LINE
    return replace(column, error_y=error_y, check_y=check_y, to_the_left=rises)


def _parts(row: StepRow) -> tuple[float | None, float | None, float, float | None]:
    """Noise and model, both or neither, the error and the held-out one."""
    noise, model = row.noise, row.undermodelling
    if not (is_number(noise) and is_number(model)):
        noise = model = None
    check = row.eps_rmsn_check if is_number(row.eps_rmsn_check) else None
    return noise, model, row.eps_rmsn or 0.0, check


def _bar(
    what: str, value: float, x: float, top: float, ends: tuple[float, float] | None
) -> Bar:  # fmt: skip
    height = _height(value, top)
    whisker = (
        None if ends is None else (FLOOR - _height(ends[1], top), FLOOR - _height(ends[0], top))
    )
    title = f"{what}: {wording.percent(value)}"
    if ends is not None:
        title += f", between {wording.percent_range(ends)}"
    return Bar(x, FLOOR - height, height, _bare(value), title, whisker)


def _bare(value: float) -> str:
    """A percentage whose sign stands on the axis."""
    return wording.percent(value).removesuffix(wording.THIN + "%")


def step_words(row: StepRow) -> str:
    """What was done to come to a step, in words."""
    match row.step:
        case "added" | "proposed" if row.added:
            return f"{row.sign} {row.added}"
        case "dropped" if row.dropped:
            return f"{wording.MINUS} {row.dropped}"
        case other:
            return str(other or "as written")


def _words(row: StepRow, present: bool, step: float) -> list[str]:
    """A label in short lines, broken at underscores."""
    whole = step_words(row)
    if row.added or row.dropped:
        whole = whole.replace(" ", "\N{NO-BREAK SPACE}", 1)
    lines = break_lines(whole, int(step / 6.8))
    if row.step == "proposed":
        lines.append("(proposed)")
    return [*lines, OWN] if present else lines


def break_lines(text: str, room: int) -> list[str]:
    """A text in lines of so many characters, broken after underscores and spaces.

    >>> break_lines("righting_arm_cubic", 11)
    ['righting_', 'arm_cubic']
    """
    first, *others = re.split("(?<=[_ ])", text)
    lines = [first]
    for piece in others:
        if len(lines[-1]) + len(piece.rstrip()) <= room:
            lines[-1] += piece
        else:
            lines.append(piece)
    return [line.rstrip() for line in lines]


def step_sentence(row: StepRow) -> str:
    """A step in one sentence, for who does not see the picture."""
    tried = " (proposed)" if row.step == "proposed" else ""
    said = f"{step_words(row)}{tried}: error {wording.percent(row.eps_rmsn)}"
    parts = (("noise", "noise"), ("model", "undermodelling"), ("held out", "eps_rmsn_check"))
    return said + "".join(f", {word} {wording.percent(getattr(row, key))}" for word, key in parts
                          if is_number(getattr(row, key)))  # fmt: skip


def _ticks(top: float) -> list[tuple[float, str]]:
    """Round percentages up the axis."""
    least = 25.0 * top
    if not math.isfinite(4.0 * least):
        return []
    power = 10.0 ** math.floor(math.log10(least))
    step = next(k * power for k in (1.0, 2.0, 5.0, 10.0) if k * power >= least)
    count = int(100.0 * top / step * 1.0001)
    return [(FLOOR - _height(k * step / 100.0, top), f"{k * step:g}") for k in range(count + 1)]


def _joined(points: Sequence[tuple[float, float]]) -> str:
    """A polyline; nothing joins a single point."""
    return "" if len(points) < 2 else " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
