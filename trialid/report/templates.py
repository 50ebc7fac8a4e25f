"""Templates of pages, compiled once on a machine: that takes a third of a second a page."""

import contextlib
import hashlib
import os
from pathlib import Path
from typing import Any

import jinja2
from jinja2.bccache import Bucket

from trialid.simulation.kernel import cache_folder
from trialid.source_digest import source_digest


def environment(package: str, folder: str, **more: Any) -> jinja2.Environment:
    """The templates of a package's folder; every word is escaped, and no name may be unknown."""
    return jinja2.Environment(
        loader=jinja2.PackageLoader(package, folder),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        bytecode_cache=_Compiled(cache_folder()),
        **more,
    )


class _Compiled(jinja2.FileSystemBytecodeCache):
    """Compiled templates beside the compiled kernels, each in a file that the next one replaces.

    Filters of constants are worked out by the compiler: what was compiled with another source of
    this package is compiled again. Where nothing can be written that is done each time, and what
    somebody else may have written is not run.
    """

    def __init__(self, folder: Path) -> None:
        super().__init__(str(folder), "%s.template")

    def get_source_checksum(self, source: str) -> str:
        """Of a template, and of what its filters and the environment are made of."""
        known = f"{jinja2.__version__} {source_digest()} {source}"
        return hashlib.sha256(known.encode()).hexdigest()

    def load_bytecode(self, bucket: Bucket) -> None:
        """Fill the bucket, where its file is ours alone."""
        with contextlib.suppress(OSError):
            if _ours_alone(Path(self.directory)):
                super().load_bytecode(bucket)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep what is in the bucket, where that can be."""
        with contextlib.suppress(OSError):
            Path(self.directory).mkdir(parents=True, exist_ok=True, mode=0o700)
            super().dump_bytecode(bucket)


def _ours_alone(folder: Path) -> bool:
    """Whether the folder is this user's, and nobody else may write into it."""
    if not hasattr(os, "getuid"):
        return True  # Windows: the home folder is the user's
    found = folder.stat()
    return found.st_uid == os.getuid() and not found.st_mode & 0o022
