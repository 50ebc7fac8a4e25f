"""Templates of pages, compiled once on a machine: that takes a third of a second a page."""

import contextlib
import hashlib
from pathlib import Path
from typing import Any

import jinja2
from jinja2.bccache import Bucket

from trialid.cache import cache_folder, is_ours_alone, source_digest


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
            if is_ours_alone(Path(self.directory)):
                super().load_bytecode(bucket)

    def dump_bytecode(self, bucket: Bucket) -> None:
        """Keep what is in the bucket, where that can be."""
        with contextlib.suppress(OSError):
            Path(self.directory).mkdir(parents=True, exist_ok=True, mode=0o700)
            super().dump_bytecode(bucket)
