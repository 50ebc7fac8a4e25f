"""The catalogue of effects as a person reads it in a terminal, and as plain data."""

import inspect
import math
import re
import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from trialid.effects.coverage import Row, Seen, left_out, rows, rows_of, trial_results
from trialid.names.quantities import ACCELERATIONS
from trialid.names.wording import count_of, percent
from trialid.ship.effect import SENSORS, Effect, Parameter, Steered

if TYPE_CHECKING:
    from rich.table import Table
    from rich.text import Text

GIVEN = {"L", "rho", "g", "nabla", "U0", "U", "t", *ACCELERATIONS}
"""What every ship file, clock and simulation has, so that no record needs it."""

NEEDS_WIDTH = 13
"""Room for what the record must hold; the longer ones are in an effect's own sheet."""

WIDE = 120
"""Columns from which on the list has room for equations."""

KINDS = {
    "linear": "by its derivative where it is absent, all in one simulation",
    "scanned": "not linear where it is absent, so that a few values of it are tried",
    "no": "never absent: made to be put into a model, not to be sought",
}


def kind(effect: Effect) -> str:
    """How the search for a missing effect treats it, one of `KINDS`."""
    if effect.scanned:
        return "scanned"
    nulls = [p.null for p in effect.parameters.values()]
    return "linear" if 0.0 in nulls else "no"


def part(effect: Effect) -> str:
    """The part of the ship it belongs to, by its file."""
    return effect.function.__module__.rpartition(".")[2].replace("_", " ")


def needs(effect: Effect) -> tuple[str, ...]:
    """What a record, a simulation or, of T and B, the ship file must hold for it."""
    wanted = (*effect.signals, *effect.states.values(), *effect.acts_on(Steered, *SENSORS))
    own = {*effect.states} - set(effect.states.values())
    return tuple(dict.fromkeys(s for s in wanted if s and s not in GIVEN | own))


def list_effects(effects: Mapping[str, Effect], width: int) -> Sequence[Any]:
    """One line an effect, by part of the ship; then what is left out, with the reason.

    What each is; on `width` columns from `WIDE` on its equation too, and what it needs.
    """
    from rich.text import Text

    room = max(map(len, effects))
    lines = _with_equations if width >= WIDE else _with_meanings
    shown: list[Any] = [lines((), room)]
    for title in dict.fromkeys(map(part, effects.values())):
        heading = Text(f"{title}: {_purpose(title)}".removesuffix(": "), style="bold")
        shown += ["", heading, lines([e for e in effects.values() if part(e) == title], room)]
    return (*shown, "", _count(effects), "", "Left out, and why:", *_reasons())


def _with_meanings(group: Sequence[Effect], name_width: int) -> "Text":
    """Effects on a line each, a name never cut; without any the headings."""
    from rich.text import Text

    if not group:
        return Text(f"{'effect':<{name_width}}  what it is", style="dim")
    lines = "\n".join(f"{e.name:<{name_width}}  {meaning(e)}" for e in group)
    return Text(lines, no_wrap=True, overflow="ellipsis")


def _with_equations(group: Sequence[Effect], name_width: int) -> "Table":
    table = _table("effect", "equation", "scored", "needs")
    table.expand, table.show_header = True, not group
    widths = (name_width, None, max(map(len, KINDS)), NEEDS_WIDTH)
    for column, width in zip(table.columns, widths, strict=True):
        column.no_wrap, column.overflow, column.width = True, "ellipsis", width
        column.ratio = None if width else 1  # the equation takes what the others leave
    for e in group:
        table.add_row(e.name, e.equation, kind(e), " ".join(needs(e)) or "-")
    return table


def meaning(effect: Effect) -> str:
    """What an effect is, without its equation: what follows the colon outside of brackets.

    >>> from trialid.effects import CATALOGUE
    >>> meaning(CATALOGUE["righting_arm_cubic"])
    'the righting arm hardens or softens'
    """
    depth = 0
    for place, letter in enumerate(effect.equation):
        depth += (letter == "(") - (letter == ")")
        if depth == 0 and effect.equation.startswith(": ", place):
            return effect.equation[place + 2 :].removesuffix(".")
    return effect.equation.removesuffix(".")


def _purpose(title: str) -> str:
    """What a file of effects says of itself, to its first stop."""
    file = title.replace(" ", "_")
    places = (f"trialid.effects.{file}", f"trialid.effects.actuators.{file}")
    module = next((sys.modules[place] for place in places if place in sys.modules), None)
    said = (inspect.getdoc(module) or "").partition("\n")[0] if module else ""
    return re.split("[:;]", said)[0].removesuffix(".")


def _count(effects: Mapping[str, Effect]) -> str:
    kinds = [kind(e) for e in effects.values()]
    told = [f"  {kinds.count(k)} {k}: {meaning}" for k, meaning in KINDS.items()]
    said = f"they say {len(rows()) - len(left_out())} of {len(rows())} things that were considered"
    more = "All about one, its equation first: trialid effects NAME"
    return "\n".join([f"{count_of(len(effects), 'effect')}; {said}. Scored", *told, more])


def _reasons() -> Sequence[Any]:
    """What is left out, each with its reason on the lines below."""
    from rich.padding import Padding
    from rich.text import Text

    return [
        part
        for row in left_out()
        for part in (Text(row.what, style="bold"), Padding(Text(row.why_not), (0, 0, 0, 2)))
    ]


def sheet(effect: Effect) -> Sequence[Any]:
    """Everything about one effect, as lines and tables to print in order."""
    told = inspect.getdoc(effect.function) or ""
    paragraphs = [" ".join(p.split()) for p in told.split("\n\n")]
    about = [
        f"{effect.name}: {paragraphs[0]}",
        *paragraphs[1:],
        f"part: {part(effect)}",
        f"source: {effect.source}",
        f"reads: {', '.join(effect.signals) or 'nothing'} ({_system(effect)})",
        f"needs: {', '.join(needs(effect)) or 'nothing beyond the ship file'}",
        f"gives: {', '.join(form.__name__ for form in effect.forms)}",
        f"scored: {kind(effect)}; {KINDS[kind(effect)]}",
    ]
    if effect.states:
        about.append(f"adds the states: {', '.join(effect.states)}")
    about += [f"shows as: {row.seen}" for row in rows_of(effect.name) if row.seen]
    return ("\n".join(about), "", _parameters(effect), *_looks_like(trial_results(effect.name)))


def _system(effect: Effect) -> str:
    return "primed" if effect.system == "prime" else "SI"


def _parameters(effect: Effect) -> "Table":
    table = _table("parameter", "unit", "typical", "range", "absent at", "tried at")
    for name, p in effect.parameters.items():
        absent = "never" if p.null is None or p.scan else _number(p.null)
        tried = ", ".join(map(_number, p.scan)) or "-"
        table.add_row(name, p.unit, _number(p.start), _range(p), absent, tried)
    return table


def _looks_like(seen: Sequence[Seen]) -> Sequence[Any]:
    """What trials of a container ship showed: how much is visible, and what looks alike."""
    if not seen:
        return ()
    table = _table("trial", "visible", "looks like, by |cos|")
    for s in seen:
        alike = ", ".join(f"{n} {x:.2f}" for n, x in s.alike.items()) or "nothing above 0.7"
        table.add_row(s.trial, percent(s.visible, 2), alike)
    return (
        "",
        "Measured on a container ship, r and phi recorded, linear coefficients free:",
        table,
    )


def _range(p: Parameter) -> str:
    low = "" if math.isinf(p.low) else _number(p.low)
    high = "" if math.isinf(p.high) else _number(p.high)
    return f"{low} .. {high}" if low or high else "any"


def _number(value: float) -> str:
    """A number as it can be copied into a pipeline."""
    return f"{value:.6g}"


def plain(effect: Effect) -> dict[str, Any]:
    """One effect as plain data; an open end of a range is None."""
    return {
        "name": effect.name,
        "part": part(effect),
        "equation": effect.equation,
        "source": effect.source,
        "system": effect.system,
        "signals": list(effect.signals),
        "needs": list(needs(effect)),
        "states": list(effect.states),
        "forms": [form.__name__ for form in effect.forms],
        "scored": kind(effect),
        "parameters": {n: _plain_parameter(p) for n, p in effect.parameters.items()},
        "shows_as": {row.id: row.seen for row in rows_of(effect.name)},
        "looks_like": {
            s.trial: {"visible": s.visible, "cos": dict(s.alike)}
            for s in trial_results(effect.name)
        },
    }


def _plain_parameter(p: Parameter) -> dict[str, Any]:
    return {
        "typical": p.start,
        "unit": p.unit,
        "low": None if math.isinf(p.low) else p.low,
        "high": None if math.isinf(p.high) else p.high,
        "null": None if p.scan else p.null,
        "scan": list(p.scan),
    }


def plain_list(effects: Mapping[str, Effect]) -> dict[str, Any]:
    """The catalogue as plain data, with what is left out."""
    return {
        "effects": [plain(e) for e in effects.values()],
        "left_out": [_plain_row(row) for row in left_out()],
    }


def _plain_row(row: Row) -> dict[str, str]:
    return {"id": row.id, "what": row.what, "why": row.why_not}


def _table(*headings: str) -> "Table":
    from rich.table import Table

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for heading in headings:
        table.add_column(heading, overflow="fold")
    return table
