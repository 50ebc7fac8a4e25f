"""The files of a design: its data, the page for the bridge, the orders, a pipeline for the log."""

import json
import os
from pathlib import Path
from typing import Any

from trialid import plan as plans
from trialid.design.search import Outcome
from trialid.plan import Plan
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
        for test, passage in zip(told["programme"], rated.outcome.passages, strict=True):
            sheets.append(bridge.sheet(test, passage, plan.limits))
            stem = file_name(test["name"] or rated.name, taken)
            (folder / f"{stem}.csv").write_text(bridge.order_csv(passage), encoding="utf-8")
        pipeline = _pipeline(plan.recipe, folder, rated.name, rated.outcome)
        (folder / f"{file_name(rated.name, set())}.toml").write_text(pipeline, encoding="utf-8")
    page = bridge.page(data, sheets, bridge.aborts(plan.limits))
    (folder / "bridge.html").write_text(page, encoding="utf-8")
    return data


def _pipeline(recipe: DesignRecipe, folder: Path, name: str, outcome: Outcome) -> str:
    """A pipeline for the log that will come back: only the channels are left to be named."""
    lines = [
        f"# The pipeline for {name}: name the log and its channels, then: trialid run THIS FILE",
        "# `trialid inspect LOG` lists what channels there are.",
        f"name = {json.dumps(name)}",
    ]
    if recipe.ship is not None:
        ship = os.path.relpath(recipe.ship.resolve(), folder.resolve())
        lines.append(f"ship = {json.dumps(ship)}")
    taken: set[str] = set()
    for passage in outcome.passages:
        stem = file_name(passage.trial.name, taken)
        log = LOG.format(stem)
        lines += ["", "[[trial]]", f"name = {json.dumps(passage.trial.name)}",
                  f"logs = [{json.dumps(log)}]"]  # fmt: skip
    lines += ["", "[signals]"]
    wanted = ["delta", *recipe.identify.outputs, *recipe.at_sea.constant]
    for signal in dict.fromkeys([*wanted, "u"]):
        side = ', positive = "starboard"' if signal == "delta" else ""
        unit = design_data.shown_unit(signal)
        lines.append(f'{signal} = {{ channel = "NAME IT", unit = "{unit}"{side} }}')
    period = recipe.at_sea.period
    lines += ["", "[align]", f"period = {period:g}", "", *_sections(recipe, folder)]
    return "\n".join(lines) + "\n"


def _sections(recipe: DesignRecipe, folder: Path) -> list[str]:
    """Model and identify, as the design has them."""
    model, identify = recipe.model, recipe.identify
    lines = ["[model]", f"states = {json.dumps(list(model.states))}",
             f"effects = {json.dumps(list(model.effects))}"]  # fmt: skip
    if model.effects_from:
        own = [os.path.relpath(f.resolve(), folder.resolve()) for f in model.effects_from]
        lines.append(f"effects_from = {json.dumps(own)}")
    for name, given in model.values.items():
        unit = "" if given.unit is None else f", unit = {json.dumps(given.unit)}"
        lines.append(f"values.{name} = {{ value = {given.value!r}{unit} }}")
    lines += ["", "[identify]", f"free = {json.dumps(list(identify.free))}",
              f"outputs = {json.dumps(list(identify.outputs))}",
              f"nuisance = {json.dumps(list(identify.nuisance))}"]  # fmt: skip
    return lines
