"""MATLAB, HDF5 and NumPy logs: vectors of one length beside a time vector, in a struct or group.

A channel is called by its variable, `roll` or `trial.roll`; a matrix with as many rows gives
`name[0]`, `name[1]`. MATLAB's own objects (datetime, table, timeseries) are secret even to MATLAB's
documentation: they are left out, and plain arrays asked for.
"""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.errors import LogError
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted
from trialid.ingest.tables import npz_arrays
from trialid.ingest.tables.mat_arrays import OLD, Arrays, of_hdf5, of_version_5
from trialid.ingest.tables.table import Head, Table, blank_out
from trialid.ingest.tables.table_channels import recording
from trialid.ingest.tables.table_names import is_time
from trialid.ingest.tables.templates import template
from trialid.ingest.tables.templates.template import Template, Time
from trialid.recording import Recording

HDF5 = b"\x89HDF\r\n\x1a\n"
PLAIN = "save plain arrays, as in t = seconds(T.Time - T.Time(1)); save('log.mat', 't', 'roll')"
NAMED_AT_MOST = 5


def recognises(start: bytes) -> bool:
    """The headers of MATLAB's versions 5 and 7.3, and of HDF5, of which 7.3 is one."""
    return start.startswith((OLD, HDF5)) or start[512:].startswith(HDF5)


def read_with(
    name: str, arrays: Callable[[Path], Arrays]
) -> Callable[[Path, Wanted, Aids], Recording]:
    """Reading of the wanted vectors; LogError for a damaged file and for what cannot be read."""

    def read(path: Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
        told = None if aids.template is None else template.load(aids.template)
        return recording(_table(path, arrays(path), told), name, wanted, aids, told)

    return read


def arrays(path: Path) -> Arrays:
    """All arrays of numbers in a file of MATLAB's or HDF5 by name; LogError as `read_with`."""
    with path.open("rb") as file:
        old = file.read(len(OLD)) == OLD
    return of_version_5(path) if old else of_hdf5(path)


@dataclass(frozen=True)
class Vector:
    """One column, its name as it stands in its struct or group."""

    head: Head
    y: NDArray[Any]


def vectors(found: Arrays, group: str | None) -> tuple[Vector, ...]:
    """The columns in a group (None: all), in the order of the file."""
    prefix = f"{group}." if group else ""
    inside = {n: y for n, y in found.plain.items() if n.startswith(prefix)}
    flat = (
        one for name, y in inside.items() for one in _flat(name.removeprefix(prefix), np.asarray(y))
    )
    return tuple(flat)


def _flat(name: str, y: NDArray[Any]) -> Iterator[Vector]:
    """A vector as it is, a matrix by the columns along its longer side."""
    y = np.squeeze(y)
    if y.ndim == 1:
        yield Vector(Head(name, name, None), y)
    if y.ndim == 2:
        for i, column in enumerate((y if y.shape[0] >= y.shape[1] else y.T).T):
            yield Vector(Head(f"{name}[{i}]", f"{name}[{i}]", None), column)


def _table(path: Path, found: Arrays, told: Template | None) -> Table:
    group = told.group if told else None
    inside = vectors(found, group)
    if told is None:
        time, inside = _timed(path, inside, found)
        length = len(time.y)
    else:
        length = _length(path, inside, told.time, found)
    held = [one for one in inside if len(one.y) == length]
    others = tuple(dict.fromkeys(one.head.name for one in inside if len(one.y) != length))
    if told is not None:
        template.check_header(path, [one.head.text for one in held], told)
    if not length:
        raise LogError(f"{path}: a time vector without samples; check that the log was saved")
    remarks = [*found.remarks, *_left_out(others)]
    columns = tuple(_missing(one.y, told) for one in held)
    heads = tuple(one.head for one in held)
    return Table(path, heads, columns, lambda row: f"sample {row}", remarks=tuple(remarks))


def _missing(y: NDArray[Any], told: Template | None) -> NDArray[Any]:
    """The numbers, NaN for those that are none; a time of 32 bits stays one."""
    y = np.ascontiguousarray(y)
    if y.dtype.kind == "M":
        return y
    return blank_out(y if y.dtype == np.float32 else y.astype(np.float64), _texts(told))


def _texts(told: Template | None) -> tuple[str, ...]:
    return told.missing if told else ()


def _timed(
    path: Path, inside: tuple[Vector, ...], found: Arrays
) -> tuple[Vector, tuple[Vector, ...]]:
    """The one time vector, and the vectors of its group."""
    times = [one for one in inside if is_time(_parts(one)[1])]
    if len(times) == 1:
        group = _parts(times[0])[0]
        return times[0], tuple(one for one in inside if _parts(one)[0] == group)
    if not times and found.opaque:
        raise _opaque(path, found.opaque)
    what = "several time vectors" if times else "no time vector"
    names = _some([one.head.name for one in times or inside]) or "no vectors"
    raise LogError(
        f"{path}: {what} among {names}; name exactly one of them t or time, or say in a template "
        "which group and which vector (trialid inspect LOG --template FILE)"
    )


def _parts(one: Vector) -> tuple[str, str]:
    group, _, name = one.head.name.rpartition(".")
    return group, name


def _length(path: Path, inside: tuple[Vector, ...], time: Time, found: Arrays) -> int:
    """Samples of the template's time vector; of an index the length most vectors have."""
    if not time.columns:
        lengths = Counter(len(one.y) for one in inside)
        return lengths.most_common(1)[0][0] if lengths else 0
    by_name: Mapping[str, Vector] = {one.head.text: one for one in inside}
    if time.columns[0] in by_name:
        return len(by_name[time.columns[0]].y)
    if found.opaque:
        raise _opaque(path, found.opaque)
    names = _some(list(by_name)) or "none"
    raise LogError(
        f"{path}: has no vector {time.columns[0]!r}, which the template takes the time from; "
        f"vectors there: {names}"
    )


def _opaque(path: Path, names: tuple[str, ...]) -> LogError:
    return LogError(f"{path}: {_some(list(names))} can only be read by MATLAB itself; {PLAIN}")


def _left_out(names: tuple[str, ...]) -> Iterator[str]:
    if names:
        yield f"not as long as the time, left out: {_some(list(names))}"


def _some(names: list[str]) -> str:
    more = f" and {len(names) - NAMED_AT_MOST} more" if len(names) > NAMED_AT_MOST else ""
    return ", ".join(names[:NAMED_AT_MOST]) + more


AIDS = frozenset({"template", "zone"})
MATLAB = Adapter("mat", recognises, read_with("mat", arrays), AIDS, by_template=recognises)
NUMPY = Adapter(
    "npz",
    npz_arrays.recognises,
    read_with("npz", npz_arrays.of_npz),
    AIDS,
    by_template=npz_arrays.recognises,
)
ADAPTERS = (MATLAB, NUMPY)
