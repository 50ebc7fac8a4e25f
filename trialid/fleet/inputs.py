"""What a worker reads of a pipeline: from folders that it sees, too, or along by content."""

import os
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import Literal

from trialid.version import VERSION

Travel = Literal["path", "content"]
"""How files come to a worker."""


class OtherVersion(Exception):
    """A worker has another version than the one that asks."""


@dataclass(frozen=True, kw_only=True)
class Inputs:
    """A pipeline, and the files it reads.

    Attributes
    ----------
    root
        The folder that all other paths begin at: one that the worker sees, too, or None where the
        files come by content.
    pipeline
        The pipeline's place, from the root; it need not lie there.
    files
        Contents by place from the root; empty where they travel by path.
    """

    version: str
    root: str | None
    pipeline: str
    content: bytes
    files: Mapping[str, bytes] = field(default_factory=dict)


def pack_inputs(
    pipeline: Path,
    content: bytes,
    files: Sequence[Path],
    travel: Travel,
    beside: Sequence[Path] = (),
) -> tuple[Inputs, Path]:
    """What a worker needs, and the root; `beside` are further places below it."""
    place, *others = map(_absolute, (pipeline, *files, *beside))
    root = Path(os.path.commonpath([place.parent, *(other.parent for other in others)]))
    along = travel == "content"
    made = Inputs(
        version=VERSION,
        root=None if along else str(root),
        pipeline=from_root(pipeline, root),
        content=content,
        files={from_root(file, root): file.read_bytes() for file in files} if along else {},
    )
    return made, root


def from_root(path: Path, root: Path) -> str:
    """A path from the root of inputs."""
    return _absolute(path).relative_to(root).as_posix()


def _absolute(path: Path) -> Path:
    """Without `..`, and with symbolic links as they are: so the pipeline finds what it names."""
    return Path(os.path.abspath(path))  # noqa: PTH100


@contextmanager
def laid_out(inputs: Inputs) -> Iterator[Path]:
    """The folder that the inputs' paths begin at; contents laid out where they came along.

    Raises
    ------
    OtherVersion
        They are of another version of trialid than this.
    """
    if inputs.version != VERSION:
        raise OtherVersion(f"the worker has trialid {VERSION}, who asks {inputs.version}")
    if inputs.root is not None:
        yield Path(inputs.root)
        return
    with tempfile.TemporaryDirectory(prefix="trialid-") as folder:
        for name, content in inputs.files.items():
            _check_inside(name)
            place = Path(folder, name)
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(content)
        Path(folder, inputs.pipeline).parent.mkdir(parents=True, exist_ok=True)
        yield Path(folder)


def _check_inside(name: str) -> None:
    """Refuse a name that leads out of the folder."""
    path = PurePosixPath(name)
    if path.is_absolute() or ".." in path.parts:
        raise ValueError(f"{name}: leads out of the parcel's folder")
