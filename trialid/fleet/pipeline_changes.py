"""The text of a run's pipeline: that of a template, with files, trials and model in their place."""

import json
import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import tomlkit

from trialid.pipeline_file import Pipeline
from trialid.pipeline_file.named_file import place_of

Document = dict[str, Any]
Change = Callable[[Document], None]
"""A change of what a pipeline says, in its place."""


def changed_text(content: bytes, name: str, changes: Sequence[Change]) -> bytes:
    """The text of a pipeline under a name of its own, with changes; comments are kept."""
    text = content.decode("utf-8-sig")
    document = tomlkit.parse(text)
    if "name" not in document:
        document = tomlkit.parse(f"name = {json.dumps(name)}\n{text}")
    document["name"] = name
    for change in changes:
        change(document)
    return tomlkit.dumps(document).encode()


def move_files(pipeline: Pipeline, place: Path) -> Change:
    """Files named from another folder: the same ones, seen from where the text will lie."""

    def seen(name: str) -> str:
        return relative(place_of(Path(name), pipeline.path), place.parent)

    def change(document: Document) -> None:
        if "ship" in document:
            document["ship"] = seen(document["ship"])
        model = document["model"]
        if "effects_from" in model:
            model["effects_from"] = [seen(each) for each in model["effects_from"]]
        for trial in document["trial"]:
            trial["logs"] = [_log_from(log, seen) for log in trial["logs"]]

    return change


def _log_from(log: Any, seen: Callable[[str], str]) -> Any:
    if isinstance(log, str):
        return seen(log)
    for key in ("path", "template", "dbc"):
        if key in log:
            log[key] = seen(log[key])
    return log


def relative(path: Path, folder: Path) -> str:
    """A path as a file in a folder writes it."""
    return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()


def put_files(ship: Path | None, logs: Mapping[str, Sequence[Path]], place: Path) -> Change:
    """Another ship, and other logs for each trial, by its name."""

    def change(document: Document) -> None:
        if ship is not None:
            document["ship"] = relative(ship, place.parent)
        for trial in document["trial"]:
            paths = [relative(path, place.parent) for path in logs[trial["name"]]]
            trial["logs"] = [
                path if isinstance(log, str) else {**log, "path": path}
                for log, path in zip(trial["logs"], paths, strict=True)
            ]

    return change


def hold_out(name: str) -> Change:
    """One trial that is not fitted."""

    def change(document: Document) -> None:
        for trial in document["trial"]:
            if trial["name"] == name:
                trial["use"] = "check"

    return change


def put_seed(seed: int) -> Change:
    """Another seed."""

    def change(document: Document) -> None:
        document["identify"]["seed"] = seed

    return change


def draw_trials(names: Sequence[str]) -> Change:
    """The fitted trials drawn anew: one drawn twice stands there twice, one not drawn is gone."""

    def change(document: Document) -> None:
        trials = document["trial"]
        by_name = {trial["name"]: trial for trial in trials}
        checked = [trial for trial in trials if trial.get("use") == "check"]
        made = tomlkit.aot()
        for place, name in enumerate(names):
            times = names[:place].count(name)
            again = f"{name} ({times + 1})" if times else name
            made.append(tomlkit.item({**by_name[name].unwrap(), "name": again}))
        for trial in checked:
            made.append(tomlkit.item(trial.unwrap()))
        document["trial"] = made
        diagnose = document.get("diagnose", {})
        if "quiet" in diagnose:
            kept = {*names} | {trial["name"] for trial in checked}
            diagnose["quiet"] = [each for each in diagnose["quiet"] if each["trial"] in kept]

    return change


def put_model(varied: Pipeline) -> Change:
    """The effects of a structure, with what is free, given, known or bounded in them."""
    model, identify = varied.model, varied.identify

    def change(document: Document) -> None:
        document["model"]["effects"] = list(model.effects)
        document["identify"]["free"] = list(identify.free)
        _keep_only(document["model"], "values", model.values)
        _keep_only(document["identify"], "bounds", identify.bounds)
        if not isinstance(document["identify"].get("priors"), str):
            _keep_only(document["identify"], "priors", identify.priors)

    return change


def _keep_only(table: Document, key: str, names: Mapping[str, object]) -> None:
    for name in [*table.get(key, {})]:
        if name not in names:
            del table[key][name]
