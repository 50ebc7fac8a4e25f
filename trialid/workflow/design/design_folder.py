"""The files of a design: its data, the page for the bridge, the orders, a pipeline for the log."""

import json
import os
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from trialid import own_files
from trialid.names.quantities import SIGNALS
from trialid.pipeline_file.design_file import DesignFile
from trialid.report.pages import bridge
from trialid.report.pages.bridge import file_name
from trialid.result.change_rows import StepRow
from trialid.result.json_file import row_of
from trialid.ship.actuators import actuator_quantities
from trialid.toml_text import quote
from trialid.workflow import history
from trialid.workflow.design import plan_data
from trialid.workflow.design.design_run import Plan, Rated

LOG = "log-of-{}.mcap"
"""Where the pipeline that is handed over looks for the log: the name is the crew's to give."""


def write(plan: Plan, folder: Path) -> dict[str, Any]:
    """Write everything into a folder; the plain data of the design."""
    data = plan_data.plain(plan)
    with own_files.replacing(folder) as work:
        for name, text in _texts(plan, data, folder).items():
            (work / name).write_text(text, encoding="utf-8")
    return data


def _texts(plan: Plan, data: Mapping[str, Any], folder: Path) -> dict[str, str]:
    """Every file by its name."""
    texts = {"design.json": json.dumps(data, indent=2, allow_nan=False) + "\n"}
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
            texts[f"{stem}.csv"] = bridge.order_csv(passage)
        own = stems[0] if len(stems) == 1 else file_name(rated.name, taken)
        texts[f"{own}.toml"] = _pipeline(plan, folder, rated, stems)
        if plan.run.steps:  # a model that has grown is a grown one for its next log, too
            steps = [row_of(StepRow, row) for row in plan.run.steps]
            texts[history.place(Path(f"{own}.toml")).name] = history.text_of(steps)
    texts["bridge.html"] = bridge.page(data, sheets, bridge.aborts(plan.limits))
    return texts


def _pipeline(plan: Plan, folder: Path, rated: Rated, stems: Sequence[str]) -> str:
    """A pipeline for the log that will come back: only the channels are left to be named."""
    pipeline = plan.pipeline
    lines = [
        f"# The pipeline for {quote(rated.name)}: name the log and its channels, then:",
        "# trialid run THIS FILE; `trialid inspect LOG` lists what channels there are.",
        f"name = {quote(rated.name)}",
    ]
    if pipeline.ship is not None:
        lines.append(f"ship = {quote(_from(folder, pipeline.ship))}")
    for test, stem in zip(rated.programme, stems, strict=True):
        lines += [
            "",
            "[[trial]]",
            f"name = {quote(test.name)}",
            f"logs = {toml([LOG.format(stem)])}",
        ]
    lines += ["", "[signals]"]
    model = plan.ship.vessel.model
    known = SIGNALS | actuator_quantities(model.ship.actuators)
    # what is ordered of a drive stands for what it does where the model has no lag
    moving = [n for n in plan_data.steering(plan) if n in model.recorded] or ["delta"]
    wanted = [*moving, *pipeline.identify.outputs, *plan.ship.vessel.constants]
    # sensors that are fitted beside her read what no vessel does: a heading that parts a current
    read = plan.ship.goal.simulator.model.recorded
    wanted += [n for n in read if n in known and not known[n].steers]
    for signal in dict.fromkeys([*wanted, "u"]):
        side = ', positive = "starboard"' if known[signal].steers else ""
        unit = known[signal].shown
        lines.append(f'{signal} = {{ channel = "NAME IT", unit = "{unit}"{side} }}')
    lines += [
        "",
        "[align]",
        f"period = {pipeline.at_sea.period:g}",
        "",
        *_sections(pipeline, folder),
    ]
    return "\n".join(lines) + "\n"


def _sections(pipeline: DesignFile, folder: Path) -> list[str]:
    """Model and identify, as the design has them."""
    model = pipeline.model.model_dump(exclude_defaults=True)
    if pipeline.model.effects_from:
        model["effects_from"] = [_from(folder, f) for f in pipeline.model.effects_from]
    if pipeline.model.values:
        given = {n: v.model_dump(exclude_defaults=True) for n, v in pipeline.model.values.items()}
        model["values"] = given
    identify = pipeline.identify
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
        return quote(value)
    return str(value).lower() if isinstance(value, bool) else repr(value)


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else quote(name)
