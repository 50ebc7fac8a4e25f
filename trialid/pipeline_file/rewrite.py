"""A file replaced at one stroke: whoever reads it finds the old one or the new one, whole."""

import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

from trialid import temporary
from trialid.errors import PipelineError


@contextmanager
def rewriting(path: Path, old: bytes, new: bytes) -> Iterator[Callable[[], None]]:
    """Give the stroke that replaces a file; nothing happens to the file before, or without it.

    The new content lies ready in the file's own folder, so that the stroke can hardly fail.
    Permissions are kept, and a symbolic link stays one.

    Raises
    ------
    PipelineError
        The place cannot be written, or the file is no longer the old one.
    """
    target = path.resolve()
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


def _check_unchanged(path: Path, old: bytes) -> None:
    if not path.is_file() or path.read_bytes() != old:
        raise PipelineError(f"{path}: was changed meanwhile and is left as it is; start again")
