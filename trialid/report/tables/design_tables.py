"""The rating of tests for a terminal."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from trialid.accuracy.weak import coefficient_label
from trialid.names.wording import DASH
from trialid.report.terminal.terminal import Words, add_row, new_table, number, percent
from trialid.result.finding_rows import MeasureRow

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

Design = Mapping[str, Any]

ALIKE = 1e-9
"""Share of the outputs below which the full model and the fitted one do not differ."""


def tables(design: Design) -> list["RenderableType"]:
    """Everything a design says, in reading order."""
    shown: list[RenderableType] = [_tests(design["tests"], design["wanted"]), ""]
    for test in design["tests"]:
        shown += _broken(test)
        shown += [Words(f"{test['name']}: {remark}", 3, "yellow") for remark in test["remarks"]]
    best = next((t for t in design["tests"] if t["name"] == design["best"]), None)
    if best is not None:
        shown += [
            Words(f"{best['name']}, parameter by parameter, what to expect of a fit:", 2, "bold"),
            _parameters(best["rating"], design["wanted"]),
            "",
        ]
    if design["separation"]:
        shown += [Words(design["separation"]["sentence"] + ".", 4), ""]
    if measures := [MeasureRow(**row) for row in design["imo"]]:
        doubt = design["imo_doubt"]
        shown += [_measures(measures), Words(design["imo_sailed"], 3)]
        shown += [Words(doubt, 2, "red"), ""] if doubt else [""]
    return shown


def _tests(tests: Sequence[Mapping[str, Any]], wanted: Sequence[str]) -> "Table":
    table = new_table("test", "numbers", "R", "S_min", "largest error", "of", words=2)
    for test in tests:
        rating = test["rating"]
        if rating is None:
            add_row(table, test["name"], _numbers(test), "not feasible", "", "", "", style="red")
            continue
        worst = max(
            (p for p in rating["parameters"] if p["name"] in wanted),
            key=lambda p: p["relative_error"] or float("inf"),
        )
        add_row(
            table, test["name"], _numbers(test), number(rating["R"], 4), number(rating["S_min"], 2),
            percent(worst["relative_error"]), coefficient_label(worst["name"]),
        )  # fmt: skip
    return table


def _numbers(test: Mapping[str, Any]) -> str:
    """The numbers of a programme's tests, short."""
    return "; ".join(_short(one) for one in test["programme"])


def _short(test: Mapping[str, Any]) -> str:
    told = []
    for name in ("angle", "heading", "angles", "rates", "period", "turn"):
        value = test["numbers"].get(name)
        if isinstance(value, list):
            told.append(f"{len(value)} {name}")
        elif value is not None:
            told.append(f"{name} {value:.3g}")
    return ", ".join(told[:3])


def _broken(test: Mapping[str, Any]) -> list["RenderableType"]:
    if test["feasible"]:
        return []
    first = test["limits"][0]
    return [Words(f"{test['name']}: {first['limit']} binds: {first['sentence']}", 3, "red")]


def _parameters(rating: Mapping[str, Any], wanted: Sequence[str]) -> "Table":
    alike = rating["undermodelling"] < ALIKE
    model = [] if alike else ["noise", "bias", "model <="]
    table = new_table("parameter", "S_imin", "R_i", *model, "error", "partner", words=1)
    for p in rating["parameters"]:
        if p["name"] not in wanted:
            continue
        partner = (
            DASH
            if p["partner"] is None
            else f"{coefficient_label(p['partner'])} {p['likeness']:+.2f}"
        )
        parts = [] if alike else [percent(p[key]) for key in ("noise_error", "bias", "bound")]
        name = coefficient_label(p["name"])
        add_row(
            table, name, number(p["S_imin"], 3), number(p["R_i"], 3), *parts,
            percent(p["relative_error"]), partner,
        )  # fmt: skip
    return table


def _measures(imo: Sequence[MeasureRow]) -> "Table":
    table = new_table("MSC.137(76)", "predicted", "95 %", "allowed", "", words=1)
    for row in imo:
        low, high = row.interval or (None, None)
        between = DASH if low is None else f"{number(low, 3)} to {number(high, 3)}"
        verdict = "" if row.kept is None else ("kept" if row.kept else "NOT KEPT")
        add_row(
            table, f"{row.name} [{row.unit}]", number(row.value, 3), between,
            number(row.allowed, 3), verdict or row.remark,
        )  # fmt: skip
    return table
