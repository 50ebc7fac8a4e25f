"""What the guide's page `own_ship` says of how far ship files made of particulars are off."""

import textwrap
import tomllib
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, Final

ROOT: Final = Path(__file__).resolve().parents[3]
ESTIMATES: Final = ROOT / "tests" / "benchmarks" / "results" / "ship_estimates.toml"
WIDTH: Final = 100
BESIDE: Final = ("S-175", "naval")
"""Ships whose estimates stand beside what is published, as they are shipped."""


def ship_estimates() -> str:
    """How far estimates lie from published sets, and what fits that begin with them come to."""
    table = tomllib.loads(ESTIMATES.read_text(encoding="utf-8"))
    return "\n".join(
        [
            _held_out(table),
            _over_estimate(table),
            *(_beside(table, short) for short in BESIDE),
            _zigzags(table),
            _records(table),
        ]
    )


def _paragraph(words: str) -> str:
    return textwrap.fill(words, WIDTH, break_long_words=False, break_on_hyphens=False) + "\n"


def _table(headings: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A table of Markdown; without alignment, which would be a style in HTML."""
    names = list(headings)
    lines = [names, ["---"] * len(names), *rows]
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines) + "\n"


def _held_out(table: Mapping[str, Any]) -> str:
    held, ships = table["held_out"], table["ship"]
    judges = ", ".join(s["short"] for s in ships if not s["counted"])
    named = "; ".join(f"{s['short']}: {s['name']}, {s['source']}" for s in ships)
    return (
        _paragraph(
            f"Counted at commit `{table['commit']}`. Of the {held['numbers']} numbers that are "
            f"published of {judges}, on which nothing was counted, {held['within_one']} lie within "
            f"one standard deviation of the estimate and {held['within_two']} within two; these "
            "are full and slow ships, where formulas do well."
        )
        + "\n"
        + _paragraph(f"{named}.")
        + "\n"
        + _paragraph(
            "Published over estimated, from length, beam, draught, displacement, and speed, GM, "
            "rudder and propeller where they are known. In brackets: the estimate is a mean over "
            "this ship too. `Xvr_whole` is Xvr + Xvrm."
        )
    )


def _over_estimate(table: Mapping[str, Any]) -> str:
    shorts = [s["short"] for s in table["ship"]]
    rows = []
    for number in table["number"]:
        found = number["found"]
        share = max(row["share"] for row in found.values())
        ratios = [_ratio(found.get(short)) for short in shorts]
        rows.append([f"`{number['name']}`", f"{100.0 * share:.0f} %", *ratios])
    return _table(["number", "+-", *shorts], rows)


def _ratio(row: Mapping[str, Any] | None) -> str:
    if row is None:
        return ""
    text = f"{row['published'] / row['estimate']:.2f}"
    return f"({text})" if row["own"] else text


def _beside(table: Mapping[str, Any], short: str) -> str:
    name = next(s["name"] for s in table["ship"] if s["short"] == short)
    rows = [
        [
            f"`{number['name']}`",
            f"{row['estimate']:.3g}",
            f"{100.0 * row['share']:.0f} %",
            f"{row['published']:.3g}",
            f"{(row['published'] / row['estimate'] - 1.0) / row['share']:+.1f}",
        ]
        for number in table["number"]
        if (row := number["found"].get(short)) and not row["own"] and row["share"]
    ]
    words = f"{name}, number by number; off by: published less estimated, in the scatter."
    return (
        _paragraph(words[:1].upper() + words[1:])
        + "\n"
        + _table(["number", "estimated", "+-", "published", "off by"], rows)
    )


def _zigzags(table: Mapping[str, Any]) -> str:
    rows = table["zigzag"]
    arrived = sum(row["converged"] for row in rows)
    errors = [row["error_with_priors"] for row in rows]
    return _paragraph(
        f"Zig-zags of 10 and 20 degrees, simulated with what is published of each ship and 2 % of "
        f"noise, and fitted from the written file as `--init` begins: {arrived} of {len(rows)} "
        f'converge, with `priors = "ship"` and without; {100.0 * min(errors):.1f} to '
        f"{100.0 * max(errors):.1f} % are left, as masses and nonlinear terms stay as estimated."
    )


def _records(table: Mapping[str, Any]) -> str:
    found: dict[str, dict[str, Mapping[str, Any]]] = {}
    for row in table["record"]:
        found.setdefault(row["record"], {})[row["ship"]] = row
    kinds = list(dict.fromkeys(row["ship"] for row in table["record"]))
    rows = [
        [record, *(_errors(by_ship.get(kind)) for kind in kinds)]
        for record, by_ship in found.items()
    ]
    words = (
        "Records begun by `--init`, error of the fitted trials and of the one held out, with the "
        "file of the container ship S-175 scaled to the length, as it was before, with the file "
        'from the length alone and `priors = "ship"`, and with all that is known of the ship:'
    )
    return _paragraph(words) + "\n" + _table(["record", *kinds], rows)


def _errors(row: Mapping[str, Any] | None) -> str:
    if row is None:
        return ""
    held = "" if row["held_out"] < 0.0 else f", {100.0 * row['held_out']:.1f}"
    return f"{100.0 * row['error']:.1f}{held} %"
