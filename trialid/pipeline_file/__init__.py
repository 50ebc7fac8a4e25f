"""The pipeline file: TOML in, frozen plain data out, every mistake named by file and key.

Checked here: form, files, quantities, units, contradictions. Names of effects and parameters are
checked by the model, which knows them; it says where with `where(pipeline, key)`.
"""

import tomllib
from itertools import chain
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from trialid import user_files
from trialid.errors import PipelineError, list_names
from trialid.pipeline_file.complaints import dotted_key, own_mistakes, problem, refusal
from trialid.pipeline_file.contradictions import contradictions
from trialid.pipeline_file.form import (
    Pipeline,
    SignalSource,
    TrialSection,
    Written,
)
from trialid.pipeline_file.mistaken_file import Kind, check_kind, log_hint, neighbours
from trialid.pipeline_file.named_file import Origin

__all__ = [
    "Pipeline",
    "SignalSource",
    "TrialSection",
    "load",
    "read",
    "signal_key",
    "sources",
    "where",
]


Form = TypeVar("Form", bound=Written)


def load(path: Path) -> Pipeline:
    """Give the pipeline in a TOML file.

    Raises
    ------
    PipelineError
        In one line: the file, the key's full path, what is wrong, the nearest valid names.
    """
    return read(content_of(path), path)


def read(content: bytes, path: Path) -> Pipeline:
    """Give the pipeline that stands, or is to stand, in a file.

    Raises
    ------
    PipelineError
        As `load`.
    """
    table = table_of(content, path, "pipeline")
    pipeline = check_form(Pipeline, table, Origin(path, content))
    if problems := list(contradictions(pipeline)):
        raise refusal(path, problems)
    return _with_shared_signals(pipeline)


def check_form(form: type[Form], table: dict[str, Any], origin: Origin) -> Form:
    """What a file holds, held against the form it must have.

    Raises
    ------
    PipelineError
        As `load`.
    """
    try:
        return form.model_validate({"name": origin.path.stem, **table}, context=origin)
    except ValidationError as error:
        found = [problem(one, form) for one in own_mistakes(error)]
        raise refusal(origin.path, found) from error


def where(pipeline: Written, key: str) -> str:
    """Words that begin an error about a key: `pipelines/zigzag.toml: model.effects`."""
    return f"{pipeline.path}: {key}"


def signal_key(pipeline: Pipeline, trial: TrialSection, quantity: str) -> str:
    """Where a trial's signal is written: `trial[0].signals.u`, or `signals.u` when it is shared."""
    if trial.signals.get(quantity) is pipeline.signals.get(quantity, trial):
        return dotted_key("signals", quantity)
    place = [other.name for other in pipeline.trials].index(trial.name)
    return dotted_key("trial", place, "signals", quantity)


def sources(pipeline: Pipeline) -> tuple[Path, ...]:
    """Every file or folder of logs the pipeline reads, itself first."""
    logs = [log for trial in pipeline.trials for log in trial.logs]
    files = chain.from_iterable((log.path, log.template, log.dbc) for log in logs)
    ship = () if pipeline.ship is None else (pipeline.ship,)
    return (pipeline.path, *ship, *pipeline.model.effects_from, *(f for f in files if f))


def table_of(content: bytes, path: Path, wanted: Kind) -> dict[str, Any]:
    """The TOML in a file; PipelineError when it is none, or plainly of another kind."""
    try:
        text = content.decode("utf-8-sig")  # some editors write a byte-order mark
    except UnicodeDecodeError as error:
        said = f"not UTF-8 text (byte {error.start})"
        raise PipelineError(f"{path}: not TOML: {said}{log_hint(path)}") from error
    try:
        table = user_files.toml(text)
    except tomllib.TOMLDecodeError as error:
        last = f"at line {text.count(chr(10)) + 1}, the end of the file"
        said = str(error).replace("at end of document", last)
        raise PipelineError(f"{path}: not TOML: {said}{log_hint(path)}") from error
    check_kind(table, path, wanted)
    return table


def content_of(path: Path, wanted: Kind = "pipeline") -> bytes:
    """What a file of the user's holds; PipelineError when it cannot be read."""
    try:
        return user_files.content(path)
    except FileNotFoundError as error:
        raise PipelineError(f"{path}: no such {wanted} file ({neighbours(path)})") from error
    except IsADirectoryError as error:
        names = sorted(other.name for other in path.glob("*.toml"))
        inside = f"; there are {list_names(names)}" if names else ""
        raise PipelineError(f"{path}: is a folder; name a file in it{inside}") from error
    except OSError as error:
        raise PipelineError(f"{path}: cannot be read ({error.strerror})") from error


def _with_shared_signals(pipeline: Pipeline) -> Pipeline:
    trials = tuple(
        trial.model_copy(update={"signals": {**pipeline.signals, **trial.signals}})
        for trial in pipeline.trials
    )
    return pipeline.model_copy(update={"trials": trials})
