"""A digest of the package's own source, for what is kept from one run to the next."""

import hashlib
from functools import cache
from pathlib import Path
from typing import Final

SOURCES: Final = Path(__file__).parents[1]


@cache
def source_digest() -> str:
    """Of every source file of this package."""
    made = hashlib.sha256()
    for path in sorted(SOURCES.rglob("*.py")):
        made.update(f"{path.relative_to(SOURCES)}\0".encode())
        made.update(path.read_bytes())
    return made.hexdigest()
