"""The history of a model: one line for each step, in a file beside the pipeline.

`zigzag.toml` has `zigzag.history.jsonl`. Lines are only ever appended, so that a step that cannot
be read is never lost; it is told and passed over. `trialid run` reads the file and writes nothing.

A step is a row of `history` in `result.json`, as plain data: `step` says how the model came about
(`as written` in the file, `added`, `dropped`; `proposed` for one that was only tried).
"""

import json
import math
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

from trialid.errors import RecipeError

Step = Mapping[str, Any]

SAME: Final = 1e-4
"""Relative difference of two errors that are the same: another processor rounds differently."""

_NUMBERS: Final = ("eps_rmsn", "eps_rmsn_check", "noise", "undermodelling")


def place(pipeline: Path) -> Path:
    """The history file of a pipeline.

    >>> place(Path("trials/zigzag.toml")).as_posix()
    'trials/zigzag.history.jsonl'
    """
    return pipeline.with_name(f"{pipeline.stem}.history.jsonl")


def read(pipeline: Path) -> tuple[tuple[Step, ...], str]:
    """The steps so far, and words about lines that are none (empty when all are).

    Raises
    ------
    RecipeError
        The file is there and cannot be read.
    """
    path = place(pipeline)
    try:
        lines = path.read_text(encoding="utf-8", errors="replace").splitlines()
    except FileNotFoundError:
        return (), ""
    except OSError as error:
        raise RecipeError(f"{path}: cannot be read ({error.strerror})") from error
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


def _step(line: str) -> Step | None:
    try:
        found = json.loads(line, parse_constant=_refuse)
    except ValueError:
        return None
    return found if isinstance(found, dict) and _is_step(found) else None


def _refuse(constant: str) -> None:
    raise ValueError(constant)


def _is_step(found: Step) -> bool:
    names = [found.get("effects"), found.get("free")]
    numbers = [type(found.get(key, "")) for key in _NUMBERS]
    return (
        all(isinstance(n, list) and all(isinstance(x, str) for x in n) for n in names)
        and all(kind in (int, float, type(None)) for kind in numbers)
        and found["eps_rmsn"] is not None
        and all(isinstance(found.get(key), str | None) for key in ("added", "dropped", "verdict"))
        and found.get("step") in ("as written", "added", "dropped")
    )


def continued(steps: Sequence[Step], present: Step) -> tuple[Step, ...]:
    """The steps, ending with the present model: a hand may have changed it since the last.

    Where the last step is the present model, it keeps how it came about.
    """
    if not steps or not same(steps[-1], present):
        return (*steps, present)
    came = {key: steps[-1][key] for key in ("step", "added", "dropped")}
    return (*steps[:-1], {**present, **came})


def same(one: Step, other: Step) -> bool:
    """Whether two steps are the same model on the same logs, with the same errors."""
    alike = all(one.get(key) == other.get(key) for key in ("effects", "free", "logs"))
    return alike and all(_close(one.get(k), other.get(k)) for k in ("eps_rmsn", "eps_rmsn_check"))


def _close(one: float | None, other: float | None) -> bool:
    if one is None or other is None:
        return one is other
    return math.isclose(one, other, rel_tol=SAME)


def free_before(steps: Sequence[Step], effect: str, parameters: Sequence[str]) -> tuple[str, ...]:
    """Which of an effect's parameters were free when the model last had it; all if it never had."""
    for step in reversed(steps):
        if effect in step["effects"]:
            return tuple(n for n in parameters if n in step["free"])
    return tuple(parameters)


@contextmanager
def appended(pipeline: Path, steps: Sequence[Step]) -> Iterator[None]:
    """Add steps at the end of the file; taken back if what follows fails.

    Raises
    ------
    RecipeError
        It cannot be written.
    """
    path = place(pipeline)
    there = path.exists()
    text = "".join(json.dumps(step, allow_nan=False) + "\n" for step in steps)
    try:
        with path.open("ab+") as stream:
            size = stream.seek(0, os.SEEK_END)
            if size:
                stream.seek(-1, os.SEEK_END)
                text = text if stream.read(1) == b"\n" else "\n" + text  # a torn line stays apart
            stream.write(text.encode())
    except OSError as error:
        raise RecipeError(f"{path}: cannot be written ({error.strerror})") from error
    try:
        yield
    except BaseException:
        os.truncate(path, size)
        if not there:
            path.unlink()
        raise
