"""Arrays out of an archive of NumPy's (`np.savez`), no more of them than it can hold.

Each is read by its own header, which says how many numbers follow: a damaged one takes no other
with it, objects (pickles, which may run anything) are never opened, and of an array with named
fields each field is one.
"""

import struct
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.lib import format as npy
from numpy.typing import NDArray

from trialid.errors import LogError, reason_of
from trialid.ingest.tables.mat_arrays import MOST_BYTES, Arrays

MEMBER: Final = struct.Struct("<H")
"""Length of the first member's name, which stands 26 bytes behind the beginning of a zip."""
SUFFIX: Final = ".npy"
HEADERS: Final = {(1, 0): npy.read_array_header_1_0, (2, 0): npy.read_array_header_2_0}
NUMBERS: Final = "fiubM"
"""Kinds of numbers, and of dates."""


def recognises(start: bytes) -> bool:
    """A zip whose first member is an array."""
    if not start.startswith(b"PK\x03\x04") or len(start) < 30:
        return False
    (length,) = MEMBER.unpack_from(start, 26)
    return start[30 : 30 + length].endswith(SUFFIX.encode())


def of_npz(path: Path) -> Arrays:
    """All arrays of numbers by name; LogError where not one can be read."""
    plain, opaque, lost = dict[str, Any](), list[str](), list[str]()
    try:
        with zipfile.ZipFile(path) as archive:
            for member in _members(path, archive):
                name = member.filename.removesuffix(SUFFIX)
                try:
                    found = _read(archive, member)
                except (ValueError, KeyError, OSError, EOFError, zipfile.BadZipFile, zlib.error):
                    lost.append(name)
                    continue
                plain |= dict(_named(name, found))
                opaque += [] if _is_plain(found) else [name]
    except (zipfile.BadZipFile, OSError, NotImplementedError, RuntimeError) as error:
        raise LogError(
            f"{path}: is no archive of arrays that can be read ({reason_of(error)}); copy it again"
        ) from error
    if not plain and lost:
        raise LogError(f"{path}: no array in it can be read ({lost[0]}); save it anew")
    kept = f"recovered {len(plain)} of {len(plain) + len(lost)} arrays, the others are damaged"
    texts = f"no numbers, left out: {', '.join(opaque[:5])}" if opaque else ""
    return Arrays(plain, (), tuple(filter(None, (kept if lost else "", texts))))


def _members(path: Path, archive: zipfile.ZipFile) -> list[zipfile.ZipInfo]:
    members = [one for one in archive.infolist() if one.filename.endswith(SUFFIX)]
    size = sum(one.file_size for one in members)
    if size > MOST_BYTES:
        raise LogError(
            f"{path}: {size / 1e6:.0f} MB of arrays; up to {MOST_BYTES / 1e6:.0f} MB are read: "
            "save less of it, or Parquet"
        )
    return members


def _read(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> NDArray[Any] | None:
    """One array; None for objects; ValueError where its header and its size do not agree."""
    with archive.open(member) as stream:
        shape, by_columns, dtype = HEADERS[npy.read_magic(stream)](stream)
        if dtype.hasobject:
            return None
        body = stream.read()
    if int(np.prod(shape, dtype=object)) * dtype.itemsize != len(body):
        raise ValueError("an array of another size than its header says")
    return np.frombuffer(body, dtype).reshape(shape, order="F" if by_columns else "C")


def _is_plain(found: NDArray[Any] | None) -> bool:
    return found is not None and (found.dtype.kind in NUMBERS or found.dtype.names is not None)


def _named(name: str, found: NDArray[Any] | None) -> Iterator[tuple[str, NDArray[Any]]]:
    """Arrays of numbers with their names."""
    if found is None:
        return
    fields: Mapping[str, Any] = found.dtype.fields or {}
    parts = {f"{name}.{field}": found[field] for field in fields} or {name: found}
    yield from ((one, y) for one, y in parts.items() if y.dtype.kind in NUMBERS)
