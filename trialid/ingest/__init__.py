"""Log file to Recording: `read(path)` finds the adapter by what the file contains."""

import difflib
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

from trialid import user_files
from trialid.errors import LogError
from trialid.ingest import fix_quality, gzipped, ulog_log
from trialid.ingest.adapter import NO_AIDS, Adapter, Aids, Wanted, is_wanted
from trialid.ingest.can import can_log, canboat_log
from trialid.ingest.mavlink import dataflash_log, tlog_log
from trialid.ingest.mcap import mcap_log
from trialid.ingest.nmea0183 import nmea0183_log
from trialid.ingest.ros import bag_log, db3_log
from trialid.ingest.signalk import signalk_deltas, signalk_log
from trialid.ingest.tables import csv_log, json_log, mat_log, parquet_log
from trialid.ingest.tables.excel import excel_log
from trialid.ingest.tables.templates import template_draft
from trialid.plugins import plugins
from trialid.recording import Recording

__all__ = [
    "ADAPTERS",
    "Aids",
    "LogFile",
    "adapter_of",
    "draft_template",
    "files_of",
    "read",
    "read_together",
]

ADAPTERS: tuple[Adapter, ...] = (
    mcap_log.ADAPTER,
    db3_log.ADAPTER,
    bag_log.ADAPTER,
    dataflash_log.ADAPTER,
    tlog_log.ADAPTER,
    *can_log.ADAPTERS,
    *canboat_log.ADAPTERS,
    nmea0183_log.ADAPTER,
    signalk_log.ADAPTER,
    signalk_deltas.ADAPTER,
    ulog_log.ADAPTER,
    excel_log.ADAPTER,
    parquet_log.ADAPTER,
    *mat_log.ADAPTERS,
    json_log.ADAPTER,
    csv_log.ADAPTER,
    *plugins("trialid.adapters").values(),
)

FORMATS = (
    "MCAP, MAVLink, ROS bags, ULog, CAN and NMEA 2000, NMEA 0183, Signal K, CSV, Excel, "
    "Parquet, MATLAB, NumPy, JSON"
)
"""What messages call all of them."""
OF_ANOTHER_LAYOUT = (
    "a table of another layout needs a template (trialid inspect LOG --template FILE)"
)
HEAD = 4096
"""Bytes an adapter may look at to recognise a file."""


@dataclass(frozen=True)
class LogFile:
    """One log of a trial: a file or a folder of files, and what the user adds to it."""

    path: Path
    aids: Aids = NO_AIDS


def read(path: str | Path, wanted: Wanted = None, aids: Aids = NO_AIDS) -> Recording:
    """Read a log of any known format; `wanted` are channel names or their beginnings, None all.

    Raises LogError when there is no such file, when not exactly one adapter recognises it, when
    that adapter cannot read it, and when it can make no use of an aid. A position that its receiver
    calls no fix is `not available`.
    """
    place = user_files.path_of(path, "ti.read")
    found = adapter_of(place, aids).read(place, fix_quality.with_quality(wanted), aids)
    return fix_quality.without_poor_fixes(found, wanted)


def read_together(logs: Sequence[LogFile], wanted: Wanted = None) -> tuple[Recording, ...]:
    """Read the logs of one trial; the wanted channels may lie in any of them.

    When a wanted channel is in none of the logs they are read in full, so that whoever looks for
    it can name the channels there are.
    """
    files = [LogFile(path, log.aids) for log in logs for path in files_of(log)]
    recordings = tuple(read(file.path, wanted, file.aids) for file in files)
    names = [name for recording in recordings for name in recording.channels]
    missing = [want for want in wanted or () if not any(is_wanted(name, [want]) for name in names)]
    return tuple(read(file.path, None, file.aids) for file in files) if missing else recordings


def files_of(log: LogFile) -> tuple[Path, ...]:
    """The file itself, or the logs in a folder, by name; hidden files are left out.

    Raises LogError for a folder in which no file is a log.
    """
    if not log.path.is_dir():
        return (log.path,)
    files = sorted(child for child in log.path.iterdir() if _visible(child))
    logs = tuple(
        child
        for child in files
        if not _is_aid(child, log.aids) and _able(child, _inside(child), log.aids)
    )
    if not logs:
        raise LogError(f"{log.path}: no file in this folder is a log; {_instead(log.path, files)}")
    return logs


def adapter_of(path: Path, aids: Aids = NO_AIDS) -> Adapter:
    """The one adapter that recognises the file; LogError as `read`."""
    head = _head(path)
    if not head:
        raise LogError(f"{path}: is empty (0 bytes); the recorder wrote nothing, copy it again")
    packed = gzipped.is_packed(head)
    head = gzipped.head(path, HEAD) if packed else head
    able = _able(path, head, aids)
    if len(able) == 1:
        return gzipped.unpack_beside(able[0]) if packed else able[0]
    if able:
        names = ", ".join(adapter.name for adapter in able)
        verdict = f"more than one adapter recognises it (of {names})"
    else:
        none = f"is none of the formats that are read ({FORMATS})"
        verdict = "; ".join([none, *_nearly(head)])
    raise LogError(
        f"{path}: {verdict}; it begins {head[:16]!r}; give the log as recorded, or "
        f"export it as CSV with a header and a time column; {OF_ANOTHER_LAYOUT}"
    )


def _nearly(head: bytes) -> Iterator[str]:
    """What a file lacks to be of a format, in words."""
    for adapter in ADAPTERS:
        if adapter.nearly is not None and (words := adapter.nearly(head)) is not None:
            yield words


def _able(path: Path, head: bytes, aids: Aids) -> list[Adapter]:
    """The adapters that recognise the file and can use the aids; a general one only alone."""
    able = [adapter for adapter in ADAPTERS if adapter.recognises(head)]
    if aids.template is not None:  # whoever gives one knows that the file is a table
        able = [one for one in ADAPTERS if one.by_template and one.by_template(head)] or able
    special = [adapter for adapter in able if not adapter.general] or able
    using = [adapter for adapter in special if adapter.aids.issuperset(aids.given)]
    if special and not using:
        useless = next(name for name in aids.given if name not in special[0].aids)
        able_names = [adapter.name for adapter in ADAPTERS if useless in adapter.aids]
        for_what = f"is for {', '.join(able_names)}" if able_names else "is for no format yet"
        raise LogError(f"{path}: is {special[0].name}, where {useless} {for_what}; leave it out")
    return using


def _is_aid(path: Path, aids: Aids) -> bool:
    """True for a file that says how the logs beside it are read."""
    given = (aid for aid in (aids.template, aids.dbc) if aid is not None and aid.exists())
    return any(aid.samefile(path) for aid in given)


def _instead(folder: Path, files: Sequence[Path]) -> str:
    """What a folder without a log holds, and what to do: its folders may each be a trial."""
    folders = sorted(c.name for c in folder.iterdir() if c.is_dir() and not c.name.startswith("."))
    if folders and not files:
        return f"it holds folders: {_some(folders)}; name those, a trial each"
    return f"it holds: {_some([child.name for child in files])}; {OF_ANOTHER_LAYOUT}"


def _visible(path: Path) -> bool:
    return path.is_file() and not path.name.startswith(".")


def _head(path: Path) -> bytes:
    if path.is_dir():
        files = _some(sorted(child.name for child in path.iterdir()))
        raise LogError(f"{path}: is a folder, not a log; name a file in it: {files}")
    if not path.exists():
        raise LogError(f"{path}: no such file; {_beside(path)}")
    if not path.is_file():
        raise LogError(f"{path}: is no file but a device or a pipe; save what it gives to a file")
    try:
        with path.open("rb") as file:
            return file.read(HEAD)
    except OSError as error:
        raise LogError(f"{path}: cannot be opened, {error.strerror}; check its rights") from error


def _inside(path: Path) -> bytes:
    """The first bytes of a log, packed or not; none of one that cannot be unpacked."""
    head = _head(path)
    if not gzipped.is_packed(head):
        return head
    try:
        return gzipped.head(path, HEAD)
    except LogError:
        return b""


def draft_template(path: Path) -> str:
    """A first template of a table, packed or not; LogError for what is no table."""
    if not gzipped.is_packed(_head(path)):
        return template_draft.draft(path)
    with gzipped.unpack_bytes(path) as (there, _):
        return template_draft.draft(there)


def _beside(path: Path) -> str:
    """What lies where the file was looked for, the likeliest names first."""
    if not path.parent.is_dir():
        return f"nor is there a folder {path.parent}"
    names = sorted(c.name for c in path.parent.iterdir() if not c.name.startswith("."))
    close = difflib.get_close_matches(path.name, names, n=3)
    if close:
        return "did you mean " + " or ".join(repr(name) for name in close) + "?"
    return f"the folder holds: {_some(names)}"


def _some(names: Sequence[str]) -> str:
    more = f" and {len(names) - 5} more" if len(names) > 5 else ""
    return (", ".join(names[:5]) or "nothing") + more
