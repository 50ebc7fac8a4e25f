"""The rating of tests for a terminal."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Final

from trialid.accuracy.weak import coefficient_label
from trialid.names.wording import DASH
from trialid.report.terminal.terminal import Words, add_row, new_table, number, percent
from trialid.result.imo_rows import MeasureRow

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

Design = Mapping[str, Any]

ALIKE = 1e-9
"""Share of the outputs below which the full model and the fitted one do not differ."""

MEANING: Final = (
    "S_imin: what the outputs tell of the parameter beside all others; R_i: how many times more "
    "they would tell if the others were known, 1 at best; R: largest over least of what they tell, "
    "over all directions; error: noise and model part of Eq. 14; partner: the likest one, by cosine"
)
"""Letters of the tables in a clause each."""


def tables(design: Design) -> list["RenderableType"]:
    """Everything a design says, in reading order: the best test first."""
    tests, wanted = design["tests"], design["wanted"]
    best = next((t for t in tests if t["name"] == design["best"]), None)
    doubt = design.get("error_doubt", "")
    first = _best(best, len(tests), wanted, doubt)
    shown: list[RenderableType] = [first, _tests(tests, wanted), ""]
    for test in tests:
        shown += _broken(test)
        shown += [Words(f"{test['name']}: {remark}", 3, "yellow") for remark in test["remarks"]]
    if best is not None:
        shown += [
            Words(f"{best['name']}, parameter by parameter, what to expect of a fit:", 2, "bold"),
            _parameters(best["rating"], wanted),
            *([Words(doubt, 4, "yellow")] if doubt else []),
            Words(MEANING, 4, "dim"),
            "",
        ]
    if design["separation"]:
        shown += [Words(design["separation"]["sentence"] + ".", 4), ""]
    if measures := [MeasureRow(**row) for row in design["imo"]]:
        doubt = design["imo_doubt"]
        shown += [_measures(measures), Words(design["imo_sailed"], 3)]
        shown += [Words(doubt, 2, "red"), ""] if doubt else [""]
    return shown


def _best(best: Mapping[str, Any] | None, of: int, wanted: Sequence[str], doubt: str) -> Words:
    """Which test to sail, before all figures."""
    if best is None:
        return Words("No test keeps the limits.", 1, "bold red")
    error, name = _worst(best["rating"], wanted)
    complete = ", were the model complete" if doubt else ""
    rank = f"Best of {of}: " if of > 1 else ""
    said = f"{rank}{best['name']}; largest error to expect: {error}, of {name}{complete}"
    return Words(said, 2, "bold")


def _worst(rating: Mapping[str, Any], wanted: Sequence[str]) -> tuple[str, str]:
    """Error and name of the wanted parameter that is least known."""
    errors = {p["name"]: p["relative_error"] for p in rating["parameters"] if p["name"] in wanted}
    name = max(errors, key=lambda name: errors[name] or float("inf"))
    return percent(errors[name]), coefficient_label(name)


def _tests(tests: Sequence[Mapping[str, Any]], wanted: Sequence[str]) -> "Table":
    table = new_table("test", "numbers", "R", "S_min", "largest error", "of", words=2)
    for test in tests:
        rating = test["rating"]
        if rating is None:
            add_row(table, test["name"], numbers_of(test), "not feasible", "", "", "", style="red")
            continue
        known = number(rating["R"], 4), number(rating["S_min"], 2)
        add_row(table, test["name"], numbers_of(test), *known, *_worst(rating, wanted))
    return table


def numbers_of(test: Mapping[str, Any]) -> str:
    """The numbers of a programme's tests, short."""
    return "; ".join(_short(one) for one in test["programme"])


_SHORT: Final = {"deg": "\N{DEGREE SIGN}", "s": " s", "deg/s": " deg/s"}
"""Units beside numbers in a narrow column; a rudder angle needs no further word."""


def _short(test: Mapping[str, Any]) -> str:
    told = []
    for name in ("angle", "heading", "angles", "rates", "period", "turn", "differences", "turning"):
        value = test["numbers"].get(name)
        if isinstance(value, list):
            told.append(f"{len(value)} {name}")
        elif value is not None:
            unit = _SHORT.get(test.get("units", {}).get(name, "1"), "")
            told.append(f"{name} {value:.4g}{unit}".removeprefix("angle "))
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
