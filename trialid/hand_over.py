"""The files of a design: its data, the page for the bridge, the orders, a pipeline for the log."""

import json
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from trialid import plan as plans
from trialid.plan import Plan, Rated
from trialid.recipe.design import DesignRecipe
from trialid.report import bridge, design_data
from trialid.report.bridge import file_name

LOG = "log-of-{}.mcap"
"""Where the pipeline that is handed over looks for the log: the name is the crew's to give."""


def write(plan: Plan, folder: Path) -> dict[str, Any]:
    """Write everything into a folder; the plain data of the design."""
    folder.mkdir(parents=True, exist_ok=True)
    data = plans.plain(plan)
    (folder / "design.json").write_text(json.dumps(data, indent=2, allow_nan=False) + "\n")
    sheets = []
    taken: set[str] = set()
    for rated, told in zip(plan.rated, data["tests"], strict=True):
        if rated.outcome.excesses:
            continue
        stems = [file_name(test["name"], taken) for test in told["programme"]]
        for test, stem, passage in zip(
            told["programme"], stems, rated.outcome.passages, strict=True
        ):
            sheets.append(bridge.sheet(test, passage, plan.limits))
            (folder / f"{stem}.csv").write_text(bridge.order_csv(passage), encoding="utf-8")
        own = stems[0] if len(stems) == 1 else file_name(rated.name, taken)
        pipeline = _pipeline(plan.recipe, folder, rated, stems)
        (folder / f"{own}.toml").write_text(pipeline, encoding="utf-8")
    page = bridge.page(data, sheets, bridge.aborts(plan.limits))
    (folder / "bridge.html").write_text(page, encoding="utf-8")
    return data


def _pipeline(recipe: DesignRecipe, folder: Path, rated: Rated, stems: Sequence[str]) -> str:
    """A pipeline for the log that will come back: only the channels are left to be named."""
    lines = [
        f"# The pipeline for {quoted(rated.name)}: name the log and its channels, then:",
        "# trialid run THIS FILE; `trialid inspect LOG` lists what channels there are.",
        f"name = {quoted(rated.name)}",
    ]
    if recipe.ship is not None:
        lines.append(f"ship = {quoted(_from(folder, recipe.ship))}")
    for test, stem in zip(rated.programme, stems, strict=True):
        lines += [
            "",
            "[[trial]]",
            f"name = {quoted(test.name)}",
            f"logs = {toml([LOG.format(stem)])}",
        ]
    lines += ["", "[signals]"]
    wanted = ["delta", *recipe.identify.outputs, *recipe.at_sea.constant]
    for signal in dict.fromkeys([*wanted, "u"]):
        side = ', positive = "starboard"' if signal == "delta" else ""
        unit = design_data.shown_unit(signal)
        lines.append(f'{signal} = {{ channel = "NAME IT", unit = "{unit}"{side} }}')
    lines += ["", "[align]", f"period = {recipe.at_sea.period:g}", "", *_sections(recipe, folder)]
    return "\n".join(lines) + "\n"


def _sections(recipe: DesignRecipe, folder: Path) -> list[str]:
    """Model and identify, as the design has them."""
    model = recipe.model.model_dump(exclude_defaults=True)
    if recipe.model.effects_from:
        model["effects_from"] = [_from(folder, f) for f in recipe.model.effects_from]
    if recipe.model.values:
        given = {n: v.model_dump(exclude_defaults=True) for n, v in recipe.model.values.items()}
        model["values"] = given
    identify = recipe.identify
    asked = identify.model_dump(exclude_defaults=True) | {"nuisance": identify.nuisance}
    lines = [f"{key} = {toml(value)}" for key, value in model.items()]
    return ["[model]", *lines, "", "[identify]", *(f"{k} = {toml(v)}" for k, v in asked.items())]


def _from(folder: Path, file: Path) -> str:
    return os.path.relpath(file.resolve(), folder.resolve())


def toml(value: Any) -> str:
    """A value as TOML writes it, on one line.

    >>> toml({"Nr": (-0.01, float("inf")), "odd name": ["a", True]})
    '{ Nr = [-0.01, inf], "odd name" = ["a", true] }'
    """
    if isinstance(value, Mapping):
        entries = (f"{_key(k)} = {toml(v)}" for k, v in value.items())
        return "{ " + ", ".join(entries) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, str):
        return quoted(value)
    return str(value).lower() if isinstance(value, bool) else repr(value)


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else quoted(name)


def quoted(text: str) -> str:
    r"""A TOML string on one line: what JSON writes, but with no pairs of surrogates.

    >>> print(quoted('a "b"\n'))
    "a \"b\"\n"
    """
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
