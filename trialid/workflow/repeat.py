"""A run done again from its folder: same logs, same pipeline, and whether same numbers."""

import hashlib
import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from trialid import user_files
from trialid.errors import PipelineError, TrialidError
from trialid.pipeline_file import Pipeline, read
from trialid.progress import Progress
from trialid.result import json_file
from trialid.result.fit_rows import LogRow
from trialid.result.json_file import plain
from trialid.result.schema import Result, SourceRow
from trialid.workflow.outcome import Run
from trialid.workflow.run import run

FOUND: Final = (
    "model", "trials", "fit", "split", "accuracy", "where", "where_else", "missing", "not_tried",
    "missing_force", "verdict", "imo", "sailed", "before_after",
)  # fmt: skip
"""What a run finds out; the history and the versions are not of its finding."""

SAME: Final = 1e-6
"""Relative difference up to which numbers of another machine or library count as the same."""


@dataclass(frozen=True)
class Earlier:
    """A finished run: its folder and result, its pipeline as it was, and how it was judged.

    The pipeline's paths are resolved from where it stood, wherever that lies from the folder.
    """

    folder: Path
    result: Result
    pipeline: Pipeline
    force: bool
    grown: bool = False


@dataclass(frozen=True)
class Compared:
    """Two results beside one another.

    `worst` is the place of the largest relative difference with the number then and now; `other`
    the places where anything but a number differs.
    """

    numbers: int
    differing: int
    largest: float
    worst: tuple[str, float, float] | None
    other: tuple[str, ...]

    @property
    def same(self) -> bool:
        """Whether the run gave the same numbers, to `SAME`, and the same words."""
        return not self.other and self.largest <= SAME


def earlier(folder: Path) -> Earlier:
    """The run of a folder, its logs checked by their hashes.

    Raises
    ------
    TrialidError
        The folder holds no run that can be repeated, or a file it rests on is gone or another.
    """
    result = json_file.read(folder / json_file.NAME)
    origin = json_file.read_object(
        folder / "run.json",
        "the run was written by an older trialid, or from Python and is of no pipeline; run its "
        "pipeline itself, or use in Python what has none (run.export, run.simulate)",
    )
    copy = folder / "pipeline.toml"
    try:
        content = user_files.content(copy)
        place = folder / origin["pipeline"]
    except OSError as error:
        raise PipelineError(
            f"{copy}: cannot be read ({error.strerror}); no run to repeat"
        ) from error
    except (KeyError, TypeError) as error:
        raise PipelineError(f"{folder / 'run.json'}: names no pipeline; it was edited") from error
    if _hash(content) != origin.get("sha256"):
        raise PipelineError(f"{copy}: is not the pipeline the run was made from; it was edited")
    _check_files(folder, place.resolve().parent, result)
    force, grown = (bool(origin.get(key)) for key in ("force", "grown"))
    return Earlier(folder, result, read(content, place.resolve()), force, grown)


def _check_files(folder: Path, home: Path, result: Result) -> None:
    """Every log, the ship and own effects are where they were and hold what they held."""
    for row in _rests_on(result):
        path = home / row.path
        try:
            with path.open("rb") as stream:
                digest = hashlib.file_digest(stream, "sha256").hexdigest()
        except OSError as error:
            raise TrialidError(
                f"{folder}: {row.path}, which the run read, is not at {path} "
                f"({(error.strerror or str(error)).lower()}); put it back, or run the pipeline anew"
            ) from error
        if digest != row.sha256:
            raise TrialidError(
                f"{path}: has changed since the run in {folder}: SHA-256 {row.sha256[:12]} then,"
                f" {digest[:12]} now; put the old file back, or run the pipeline anew"
            )


def _rests_on(result: Result) -> Iterator[LogRow | SourceRow]:
    for trial in result.trials:
        yield from trial.logs
    yield from result.sources


def _hash(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()


def repeat(done: Earlier, progress: Progress) -> tuple[Run, Compared]:
    """The run once more, and how it compares with the first.

    Raises
    ------
    TrialidError
        As `workflow.run`.
    """
    fresh = run(done.pipeline, progress, force=done.force, grown=done.grown)
    return fresh, compare(plain(done.result), plain(fresh.result))


def compare(then: Mapping[str, Any], now: Mapping[str, Any]) -> Compared:
    """Everything two runs found, leaf by leaf.

    >>> found = compare({"fit": {"V": 1.0, "reason": "a"}}, {"fit": {"V": 1.5, "reason": "a"}})
    >>> found.numbers, found.worst, found.same
    (1, ('fit.V', 1.0, 1.5), False)
    """
    numbers, differing, largest, worst = 0, 0, 0.0, None
    other = []
    for place, a, b in _leaves(FOUND, then, now):
        if not (_number(a) and _number(b)):
            if a != b:
                other.append(place)
            continue
        numbers += 1
        if a != b:
            differing += 1
            share = abs(a - b) / max(abs(a), abs(b))
            if share > largest:
                largest, worst = share, (place, float(a), float(b))
    return Compared(numbers, differing, largest, worst, tuple(other))


def _leaves(
    keys: tuple[str, ...], then: Mapping[str, Any], now: Mapping[str, Any]
) -> Iterator[tuple[str, Any, Any]]:
    for key in keys:
        yield from _pairs(key, then.get(key), now.get(key))


def _pairs(place: str, a: Any, b: Any) -> Iterator[tuple[str, Any, Any]]:
    """Leaves at the same place; where one side has none, or a list another length, that differs."""
    if isinstance(a, dict) and isinstance(b, dict):
        for key in dict.fromkeys([*a, *b]):
            yield from _pairs(f"{place}.{key}", a.get(key), b.get(key))
    elif isinstance(a, list | tuple) and isinstance(b, list | tuple) and len(a) == len(b):
        for i, (x, y) in enumerate(zip(a, b, strict=True)):
            yield from _pairs(f"{place}[{i}]", x, y)
    else:
        yield place, a, b


def _number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def comparison_words(found: Compared, then: Result, now: Result) -> str:
    """In words: the same numbers, or the largest difference and what else differs."""
    if found.same and not found.differing:
        return f"same numbers: {found.numbers} compared, every digit"
    lines = []
    if found.worst is not None:
        place, a, b = found.worst
        head = f"same numbers to {SAME:g}" if found.same else "other numbers"
        lines.append(
            f"{head}: {found.differing} of {found.numbers} differ; the largest difference is "
            f"{100.0 * found.largest:.2g} %, {place}: {a:.8g} then, {b:.8g} now"
        )
    if found.other:
        more = f" and {len(found.other) - 5} more" if len(found.other) > 5 else ""
        lines.append(f"other words or lengths at {', '.join(found.other[:5])}{more}")
    if changed := _versions(then, now):
        lines.append(f"other versions: {changed}")
    return "\n".join(lines)


def _versions(then: Result, now: Result) -> str:
    old, new = ({"trialid": r.version, **r.versions} for r in (then, now))
    names = dict.fromkeys([*old, *new])
    return ", ".join(
        f"{n} {old.get(n)} then, {new.get(n)} now" for n in names if old.get(n) != new.get(n)
    )
