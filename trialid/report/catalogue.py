"""The catalogue of effects as a person reads it in a terminal, and as plain data."""

import inspect
import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from trialid.report.wording import number
from trialid.ship.effect import Effect, Parameter

if TYPE_CHECKING:
    from rich.table import Table


def listing(effects: Mapping[str, Effect]) -> "Table":
    """One row an effect: its name, its equation, its parameters."""
    table = _table("effect", "equation", "parameters")
    for name, effect in effects.items():
        table.add_row(name, effect.equation, ", ".join(effect.parameters))
    return table


def sheet(effect: Effect) -> Sequence[Any]:
    """Everything about one effect, as lines and tables to print in order."""
    told = inspect.getdoc(effect.function) or ""
    paragraphs = [" ".join(p.split()) for p in told.split("\n\n")]
    about = [
        f"{effect.name}: {paragraphs[0]}",
        *paragraphs[1:],
        f"source: {effect.source}",
        f"reads: {', '.join(effect.signals) or 'nothing'} ({_system(effect)})",
        f"gives: {', '.join(form.__name__ for form in effect.forms)}",
    ]
    if effect.states:
        about.append(f"adds the states: {', '.join(effect.states)}")
    return ("\n".join(about), _parameters(effect))


def _system(effect: Effect) -> str:
    return "primed" if effect.system == "prime" else "SI"


def _parameters(effect: Effect) -> "Table":
    table = _table("parameter", "unit", "typical", "range", "absent at")
    for name, p in effect.parameters.items():
        table.add_row(name, p.unit, number(p.start), _range(p), number(p.null))
    return table


def _range(p: Parameter) -> str:
    low = "" if math.isinf(p.low) else number(p.low)
    high = "" if math.isinf(p.high) else number(p.high)
    return f"{low} .. {high}" if low or high else "any"


def plain(effect: Effect) -> dict[str, Any]:
    """One effect as plain data; an open end of a range is None."""
    return {
        "name": effect.name,
        "equation": effect.equation,
        "source": effect.source,
        "system": effect.system,
        "signals": list(effect.signals),
        "states": list(effect.states),
        "forms": [form.__name__ for form in effect.forms],
        "parameters": {
            n: {
                "typical": p.start,
                "unit": p.unit,
                "low": None if math.isinf(p.low) else p.low,
                "high": None if math.isinf(p.high) else p.high,
                "null": p.null,
            }
            for n, p in effect.parameters.items()
        },
    }


def _table(*headings: str) -> "Table":
    from rich.table import Table

    table = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="dim")
    for heading in headings:
        table.add_column(heading, overflow="fold")
    return table
