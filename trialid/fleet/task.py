"""One run of a fleet: what it is called, what goes into it, and the key of all that."""

import hashlib
import json
import os
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

from trialid.pipeline_file import Pipeline, sources
from trialid.result.fleet_rows import RunLabel
from trialid.version import VERSION
from trialid.workflow import history

PIPELINES: Final = "pipelines"
"""Where the pipelines that a fleet makes lie, below its folder."""
RUNS: Final = "runs"
"""Where the runs' folders lie."""

Hash = Callable[[Path], str]


@dataclass(frozen=True, kw_only=True)
class Task:
    """A run that is to be done, or why it cannot be.

    Attributes
    ----------
    pipeline, content
        The pipeline's place, and its text; it is written there where the fleet has `made` it.
    grown
        Whether the template that it was made of has grown: the steps of that are of other logs.
    files
        Every other file that the run reads.
    key
        SHA-256 of the version, the pipeline and those files, their names from there included.
    problem
        Why it cannot be begun, in one line; empty where it can.
    """

    label: RunLabel
    pipeline: Path
    content: bytes
    made: bool = False
    grown: bool = False
    files: tuple[Path, ...] = ()
    key: str = ""
    problem: str = ""


def files_of(pipeline: Pipeline) -> tuple[Path, ...]:
    """Every file that a run of the pipeline reads beside it: folders file by file, its history."""
    _, *others = sources(pipeline)
    told = history.place(pipeline.path)
    found = [file for path in others for file in _below(path)]
    return tuple(dict.fromkeys([*found, *([told] if told.is_file() else [])]))


def _below(path: Path) -> Iterator[Path]:
    if not path.is_dir():
        yield path
        return
    yield from sorted(child for child in path.rglob("*") if child.is_file())


def key_of(
    content: bytes, place: Path, files: tuple[Path, ...], hash_of: Hash, grown: bool = False
) -> str:
    """The key of a run: the same for the same bytes under the same names, and no other."""
    folder = place.parent.resolve()
    named = [[Path(os.path.relpath(f.resolve(), folder)).as_posix(), hash_of(f)] for f in files]
    whole = [VERSION, hashlib.sha256(content).hexdigest(), sorted(named)]
    whole += ["grown"] if grown else []
    return hashlib.sha256(json.dumps(whole).encode()).hexdigest()


def file_hash() -> Hash:
    """What gives the SHA-256 of a file, each read once."""

    @cache
    def hash_of(path: Path) -> str:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()

    return hash_of
