"""The history of a model: one line for each step, in a file beside the pipeline.

`zigzag.toml` has `zigzag.history.jsonl`. Lines are only ever appended, so that a step that cannot
be read is never lost; it is told and passed over. `trialid run` reads the file and writes nothing.

A step is a row of `history` in `result.json`: `step` says how the model came about
(`as written` in the file, `added`, `dropped`; `proposed` for one that was only tried).
"""

import json
import math
import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Final

from trialid import user_files
from trialid.errors import PipelineError, TrialidError
from trialid.result.change_rows import StepRow
from trialid.result.json_file import plain, row_of

SAME: Final = 1e-4
"""Relative difference of two errors that are the same: another processor rounds differently."""


def place(pipeline: Path) -> Path:
    """The history file of a pipeline.

    >>> place(Path("trials/zigzag.toml")).as_posix()
    'trials/zigzag.history.jsonl'
    """
    return pipeline.with_name(f"{pipeline.stem}.history.jsonl")


def read(pipeline: Path) -> tuple[tuple[StepRow, ...], str]:
    """The steps so far, and words about lines that are none (empty when all are).

    Raises
    ------
    PipelineError
        The file is there and cannot be read.
    """
    path = place(pipeline)
    try:
        lines = user_files.content(path).decode("utf-8", errors="replace").splitlines()
    except FileNotFoundError:
        return (), ""
    except OSError as error:
        raise PipelineError(f"{path}: cannot be read ({error.strerror})") from error
    steps, torn = [], []
    for number, line in enumerate(lines, start=1):
        step = _step(line)
        if step is not None:
            steps.append(step)
        elif line.strip():
            torn.append(str(number))
    if not torn:
        return tuple(steps), ""
    which = f"line {torn[0]}" if len(torn) == 1 else f"lines {', '.join(torn)}"
    return tuple(steps), f"{path}: {which}: no step of a history; passed over, and kept"


def _step(line: str) -> StepRow | None:
    try:
        step = row_of(StepRow, json.loads(line, parse_constant=_refuse))
    except (ValueError, RecursionError, TrialidError):
        return None
    return step if step.step != "proposed" and step.eps_rmsn is not None else None


def _refuse(constant: str) -> None:
    raise ValueError(constant)


def continue_steps(steps: Sequence[StepRow], present: StepRow) -> tuple[StepRow, ...]:
    """The steps, ending with the present model: a hand may have changed it since the last.

    Where the last step is the present model, it keeps how it came about.
    """
    if not steps or not same(steps[-1], present):
        return (*steps, present)
    last = steps[-1]
    return (*steps[:-1], replace(present, step=last.step, added=last.added, dropped=last.dropped))


def same(one: StepRow, other: StepRow) -> bool:
    """Whether two steps are the same model on the same logs, with the same errors."""
    alike = (one.effects, one.free, one.logs) == (other.effects, other.free, other.logs)
    return (
        alike
        and _close(one.eps_rmsn, other.eps_rmsn)
        and _close(one.eps_rmsn_check, other.eps_rmsn_check)
    )


def _close(one: float | None, other: float | None) -> bool:
    if one is None or other is None:
        return one is other
    return math.isclose(one, other, rel_tol=SAME)


def free_before(
    steps: Sequence[StepRow], effect: str, parameters: Sequence[str]
) -> tuple[str, ...]:
    """Which of an effect's parameters were free when the model last had it; all if it never had."""
    for step in reversed(steps):
        if effect in step.effects:
            return tuple(n for n in parameters if n in step.free)
    return tuple(parameters)


def has_joined(steps: Sequence[StepRow], effects: Sequence[str]) -> bool:
    """Whether one of the effects was added: the model has grown."""
    return not {n for step in steps for n in step.joined}.isdisjoint(effects)


def text_of(steps: Sequence[StepRow]) -> str:
    """The steps as the file has them."""
    return "".join(json.dumps(plain(step), allow_nan=False) + "\n" for step in steps)


@contextmanager
def append_steps(pipeline: Path, steps: Sequence[StepRow]) -> Iterator[None]:
    """Add steps at the end of the file; taken back if what follows fails.

    Raises
    ------
    PipelineError
        It cannot be written.
    """
    path = place(pipeline)
    there = path.exists()
    text = text_of(steps)
    try:
        with path.open("ab+") as stream:
            size = stream.seek(0, os.SEEK_END)
            if size:
                stream.seek(-1, os.SEEK_END)
                text = text if stream.read(1) == b"\n" else "\n" + text  # a torn line stays apart
            stream.write(text.encode())
    except OSError as error:
        raise PipelineError(f"{path}: cannot be written ({error.strerror})") from error
    try:
        yield
    except BaseException:
        os.truncate(path, size)
        if not there:
            path.unlink()
        raise
