"""Arrays of numbers out of MATLAB and HDF5 files, no more of them than the file can hold.

Of version 5 every variable is read for itself, so that a damaged one takes no other with it. Of
HDF5 only what lies in the file itself: links to other files are not followed.
"""

import struct
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from trialid.errors import LogError, reason_of
from trialid.ingest.packages import require
from trialid.ingest.tables.mat_elements import MATRIX, Damaged, Variable, variable

OLD = b"MATLAB 5.0 MAT-file"
HEADER = 128
COMPRESSED = 15
MOST_BYTES = 300_000_000
"""Of all arrays together."""
MOST_FILE = 2 * 10**9
"""Bytes of a file before version 7.3, which is read whole; a variable of it has 2 GB at most."""
EXPANSION = 1100
"""What deflation can at most make of a byte, and a little."""
DEEPEST = 12
"""Groups in groups."""


@dataclass(frozen=True)
class Arrays:
    """Arrays of numbers by dotted name, names of objects only MATLAB can read, remarks."""

    plain: Mapping[str, Any]
    opaque: tuple[str, ...] = ()
    remarks: tuple[str, ...] = ()


def of_version_5(path: Path) -> Arrays:
    """Arrays of a MAT-file before version 7.3; LogError when not one variable is intact."""
    size = path.stat().st_size
    if size > MOST_FILE:
        raise LogError(f"{path}: {size / 1e9:.0f} GB; save it with -v7.3, or less of it")
    raw = path.read_bytes()
    order = {b"IM": "<", b"MI": ">"}.get(raw[126:128])
    if order is None:
        raise LogError(f"{path}: its header is damaged (no byte order); copy it again")
    plain: dict[str, Any] = {}
    opaque: list[str] = []
    intact = lost = 0
    for one in _variables(raw, order):
        intact, lost = intact + (one is not None), lost + (one is None)
        if one is not None:
            plain |= one.plain
            opaque += one.opaque
    if not intact:
        raise LogError(f"{path}: no variable in it is intact; copy it again, or save it anew")
    words = f"recovered {intact} of about {intact + lost} variables, the others are damaged"
    return Arrays(plain, tuple(opaque), (words,) if lost else ())


def _variables(raw: bytes, order: str) -> Iterator[Variable | None]:
    """The variables in turn; None for one that is damaged, and after one that is cut short."""
    offset, left = HEADER, MOST_BYTES
    while offset + 8 <= len(raw):
        kind, size = struct.unpack_from(f"{order}II", raw, offset)
        body = memoryview(raw)[offset : offset + 8 + size]
        offset += 8 + size + (0 if kind == COMPRESSED else -size % 8)
        if len(body) < 8 + size or kind not in (COMPRESSED, MATRIX):
            yield None
            return
        try:
            element = body if kind == MATRIX else _inflated(body[8:], order, left)
            left -= len(element)
            yield variable(element, order)
        except (Damaged, zlib.error, struct.error):
            yield None


def _inflated(body: memoryview, order: str, left: int) -> bytes:
    """A packed variable; Damaged where it declares more than may be left."""
    inflate = zlib.decompressobj()
    head = inflate.decompress(body, 8)
    size = struct.unpack(f"{order}II", head)[1]
    if size > left:
        raise Damaged(f"a variable of {size} bytes")
    rest = inflate.decompress(inflate.unconsumed_tail, size + 8)
    if not inflate.eof:
        raise Damaged("a packed variable that is cut short, or longer than it says")
    return head + rest


def of_hdf5(path: Path) -> Arrays:
    """Arrays of an HDF5 file or a MAT-file of version 7.3; LogError when it cannot be opened."""
    h5py = require("h5py", path, "MATLAB v7.3 and HDF5")
    try:
        with h5py.File(path, "r") as file:
            matlab = file.userblock_size > 0 and b"MATLAB 7.3" in _start(path)
            walk = _Walk(h5py, path.stat().st_size, matlab)
            walk.group(file, "", 0)
    except (OSError, RuntimeError, ValueError, KeyError, TypeError, OverflowError) as error:
        raise LogError(
            f"{path}: is no HDF5 file that can be read ({reason_of(error)}); copy it again, or "
            "save it anew with save -v7"
        ) from error
    lost = len(walk.lost)
    read = len(walk.plain)
    if not read and walk.lost:
        raise LogError(f"{path}: no array in it can be read ({walk.lost[0]}); save it anew")
    words = (f"recovered {read} of {read + lost} arrays; {walk.lost[0]}",) if lost else ()
    return Arrays(walk.plain, tuple(walk.opaque), words)


def _start(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(HEADER)


class _Walk:
    """Through the groups of a file, as far as they lie in it, noting arrays of numbers."""

    def __init__(self, h5py: Any, size: int, matlab: bool) -> None:
        self.h5py = h5py
        self.most = min(MOST_BYTES, size * EXPANSION)
        self.matlab = matlab
        self.plain: dict[str, Any] = {}
        self.opaque: list[str] = []
        self.lost: list[str] = []
        self.seen: set[Any] = set()

    def group(self, group: Any, prefix: str, depth: int) -> None:
        """Note what lies in a group; MATLAB's own bookkeeping is passed over."""
        if depth > DEEPEST or group.id in self.seen:
            return
        self.seen.add(group.id)
        for name in group:
            hard = isinstance(group.get(name, getlink=True), self.h5py.HardLink)
            if name.startswith("#") or not hard:
                continue
            try:
                self._one(group[name], f"{prefix}{name}", depth)
            except (OSError, RuntimeError, ValueError, KeyError, TypeError, MemoryError) as error:
                self.lost.append(f"{prefix}{name}: {reason_of(error)}")

    def _one(self, item: Any, name: str, depth: int) -> None:
        if isinstance(item, self.h5py.Group):
            self.group(item, f"{name}.", depth + 1)
        elif isinstance(item, self.h5py.Dataset):
            if "MATLAB_object_decode" in item.attrs:
                self.opaque.append(name)
            elif self._numeric(item):
                self._array(item, name)

    def _numeric(self, item: Any) -> bool:
        text = self.matlab and item.attrs.get("MATLAB_class") == b"char"
        here = not item.is_virtual and not item.external
        return here and not text and item.dtype.kind in "fiu" and item.size not in (None, 0, 1)

    def _array(self, item: Any, name: str) -> None:
        size = int(item.size) * max(item.dtype.itemsize, 8)
        if size > self.most or item.ndim > 2 or size > 8 * EXPANSION * item.id.get_storage_size():
            self.lost.append(f"{name} declares {size} bytes, more than is there or can be read")
            return
        self.most -= size
        y = item[()]
        self.plain[name] = y.T if self.matlab else y
