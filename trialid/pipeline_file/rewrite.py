"""A file replaced at one stroke: whoever reads it finds the old one or the new one, whole."""

import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from trialid import temporary
from trialid.errors import PipelineError
from trialid.pipeline_file.named_file import stood_at


@contextmanager
def rewriting(path: Path, old: bytes, new: bytes) -> Iterator[Callable[[], None]]:
    """Give the stroke that replaces a file; nothing happens to the file before, or without it.

    The new content lies ready in the file's own folder, so that the stroke can hardly fail.
    Permissions are kept, and a symbolic link stays one.

    Raises
    ------
    PipelineError
        The place cannot be written, or the file is a run's copy or no longer the old one.
    """
    target = path.resolve()
    check_is_no_copy(path)
    _check_unchanged(path, old)
    try:
        if not os.access(target, os.W_OK):
            raise PermissionError(13, "Permission denied")
        temporary.sweep(target.parent)
        handle, name = tempfile.mkstemp(prefix=temporary.prefix(), dir=target.parent)
    except OSError as error:
        raise PipelineError(f"{path}: cannot be written ({error.strerror})") from error
    ready = Path(name)

    def replace() -> None:
        _check_unchanged(path, old)
        ready.replace(target)

    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(new)
            stream.flush()
            os.fsync(stream.fileno())
        ready.chmod(target.stat().st_mode & 0o7777)
        yield replace
    finally:
        ready.unlink(missing_ok=True)


def check_is_no_copy(path: Path) -> None:
    """Refuse to change the pipeline in a run's folder: it is what the run was made from.

    Raises
    ------
    PipelineError
        It is one.
    """
    if (stood := stood_at(path)) is not None:
        raise PipelineError(
            f"{path}: is what a finished run was made from, and stays as it is; copy it, or change "
            f"{os.path.relpath(stood)}"
        )


def _check_unchanged(path: Path, old: bytes) -> None:
    if not path.is_file() or path.read_bytes() != old:
        raise PipelineError(f"{path}: was changed meanwhile and is left as it is; start again")
