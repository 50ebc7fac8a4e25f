"""Arrays of numbers out of MATLAB and HDF5 files, no more of them than the file can hold.

Of version 5 every variable is read for itself, so that a damaged one takes no other with it. Of
HDF5 only what lies in the file itself: links to other files are not followed.
"""

import io
import struct
import zlib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from trialid.errors import LogError, said
from trialid.ingest.packages import needed

OLD = b"MATLAB 5.0 MAT-file"
HEADER = 128
COMPRESSED, MATRIX = 15, 14
MOST_BYTES = 300_000_000
"""Of all arrays together."""
MOST_FILE = 2 * 10**9
"""Bytes of a file before version 7.3, which is read whole; a variable of it has 2 GB at most."""
EXPANSION = 1100
"""What deflation can at most make of a byte, and a little."""
DEEPEST = 12
"""Structs in structs, groups in groups."""
CONTAINERS = 1, 2, 3
"""Classes cell, struct, object: an element of theirs takes a tag of eight bytes at least."""


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
    for one in _files(raw, order):
        variables = None if one is None else _variables(one)
        intact, lost = intact + (variables is not None), lost + (variables is None)
        for name, value in (variables or {}).items():
            _collect(name, value, plain, opaque)
    if not intact:
        raise LogError(f"{path}: no variable in it is intact; copy it again, or save it anew")
    said = f"recovered {intact} of about {intact + lost} variables, the others are damaged"
    return Arrays(plain, tuple(opaque), (said,) if lost else ())


def _files(raw: bytes, order: str) -> Iterator[bytes | None]:
    """A file for each variable, unpacked; None for one that is cut short or packed badly."""
    offset, left = HEADER, MOST_BYTES
    while offset + 8 <= len(raw):
        kind, size = struct.unpack_from(f"{order}II", raw, offset)
        body = memoryview(raw)[offset : offset + 8 + size]
        offset += 8 + size + (0 if kind == COMPRESSED else -size % 8)
        if len(body) < 8 + size or kind not in (COMPRESSED, MATRIX):
            yield None
            return
        parts = _inflated(body[8:], order, left) if kind == COMPRESSED else (body,)
        file = b"".join((raw[:HEADER], *parts))
        left -= len(file)
        yield file if _believable(file, order) else None


def _inflated(body: memoryview, order: str, left: int) -> tuple[bytes, ...]:
    """A variable in pieces; none where it is damaged, or declares more than may be left."""
    inflate = zlib.decompressobj()
    try:
        head = inflate.decompress(body, 8)
        size = struct.unpack(f"{order}II", head)[1]
        if size > left:
            return ()
        rest = inflate.decompress(inflate.unconsumed_tail, size + 8)
    except (zlib.error, struct.error):
        return ()
    return (head, rest) if inflate.eof else ()


def _believable(file: bytes, order: str) -> bool:
    """False for a variable that declares more elements than it has bytes."""
    size_here = len(file) - HEADER
    if size_here < 32:
        return False
    kind, size = struct.unpack_from(f"{order}II", file, HEADER)
    flags = struct.unpack_from(f"{order}I", file, HEADER + 16)[0]
    dims_size = struct.unpack_from(f"{order}I", file, HEADER + 28)[0]
    if kind != MATRIX or size > size_here - 8 or not 8 <= dims_size <= 128:
        return kind == MATRIX and (flags & 0xFF) == 17  # an object: has no dimensions there
    if size_here < 32 + dims_size:
        return False
    dims = np.frombuffer(file, f"{order}i4", dims_size // 4, HEADER + 32).astype(object)
    count = int(np.prod(dims))
    least = 8 if flags & 0xFF in CONTAINERS else 1
    return bool((dims >= 0).all()) and count * least <= 2 * size_here


def _variables(file: bytes) -> dict[str, Any] | None:
    """Variables of a file of one; None for a damaged one."""
    from scipy.io import loadmat
    from scipy.io.matlab import MatReadError

    read: Callable[..., dict[str, Any]] = loadmat  # its types do not know of files in memory

    try:
        found = read(io.BytesIO(file), simplify_cells=True, verify_compressed_data_integrity=True)
    except (
        MatReadError, ValueError, TypeError, IndexError, KeyError, OSError,
        MemoryError, AttributeError, NotImplementedError, UnboundLocalError, zlib.error,
        ArithmeticError,
    ):  # fmt: skip
        return None
    return {name: value for name, value in found.items() if not name.startswith("__")}


def _collect(
    name: str, value: Any, plain: dict[str, Any], opaque: list[str], depth: int = 0
) -> None:
    """Numbers below a value; an object that only MATLAB can read is noted by name."""
    if isinstance(value, dict):
        for key, one in value.items() if depth < DEEPEST else ():
            _collect(f"{name}.{key}", one, plain, opaque, depth + 1)
        return
    if type(value).__name__ in ("MatlabOpaque", "MatlabFunction", "MatlabObject"):
        opaque.append(_object_name(name, value))
        return
    array = np.asarray(value) if isinstance(value, np.ndarray) else None
    if array is not None and array.dtype.kind in "fiu" and array.size > 1:
        plain[name] = array


def _object_name(name: str, value: Any) -> str:
    """MATLAB's own name of it: scipy files objects under `None`."""
    fields = getattr(getattr(value, "dtype", None), "names", None) or ()
    if "s0" not in fields or not np.size(value):
        return name
    first = np.ravel(value)[0]
    inside = first["s0"]
    text = inside.decode("ascii", "replace") if isinstance(inside, bytes) else str(inside)
    return text if name == "None" else name


def of_hdf5(path: Path) -> Arrays:
    """Arrays of an HDF5 file or a MAT-file of version 7.3; LogError when it cannot be opened."""
    h5py = needed("h5py", path, "MATLAB v7.3 and HDF5")
    try:
        with h5py.File(path, "r") as file:
            matlab = file.userblock_size > 0 and b"MATLAB 7.3" in _start(path)
            walk = _Walk(h5py, path.stat().st_size, matlab)
            walk.group(file, "", 0)
    except (OSError, RuntimeError, ValueError, KeyError, TypeError, OverflowError) as error:
        raise LogError(
            f"{path}: is no HDF5 file that can be read ({said(error)}); copy it again, or save it "
            "anew with save -v7"
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
                self.lost.append(f"{prefix}{name}: {said(error)}")

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
