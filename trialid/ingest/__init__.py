"""Log file to Recording: `read(path)` finds the adapter by what the file contains."""

import difflib
from collections.abc import Sequence
from pathlib import Path

from trialid.errors import LogError
from trialid.ingest import csv_log, mcap_log
from trialid.ingest.adapter import Adapter, Wanted, asked
from trialid.recording import Recording

__all__ = ["ADAPTERS", "read", "read_together"]

ADAPTERS: tuple[Adapter, ...] = (mcap_log.ADAPTER, csv_log.ADAPTER)

HEAD = 4096
"""Bytes an adapter may look at to recognise a file."""


def read(path: Path, wanted: Wanted = None) -> Recording:
    """Read a log of any known format; `wanted` are channel names or their beginnings, None all.

    Raises LogError when there is no such file, when not exactly one adapter recognises it, and
    when that adapter cannot read it.
    """
    return _adapter(path, _head(path)).read(path, wanted)


def read_together(paths: Sequence[Path], wanted: Wanted = None) -> tuple[Recording, ...]:
    """Read the logs of one trial; the wanted channels may lie in any of them.

    When a wanted channel is in none of the logs they are read in full, so that whoever looks for
    it can name the channels there are.
    """
    recordings = tuple(read(path, wanted) for path in paths)
    names = [name for recording in recordings for name in recording.channels]
    missing = [want for want in wanted or () if not any(asked(name, [want]) for name in names)]
    return tuple(read(path) for path in paths) if missing else recordings


def _head(path: Path) -> bytes:
    if path.is_dir():
        files = _some(sorted(child.name for child in path.iterdir()))
        raise LogError(f"{path}: is a folder, not a log; name a file in it: {files}")
    if not path.exists():
        raise LogError(f"{path}: no such file; {_beside(path)}")
    try:
        with path.open("rb") as file:
            head = file.read(HEAD)
    except OSError as error:
        raise LogError(f"{path}: cannot be opened, {error.strerror}; check its rights") from error
    if not head:
        raise LogError(f"{path}: is empty (0 bytes); the recorder wrote nothing, copy it again")
    return head


def _beside(path: Path) -> str:
    """What lies where the file was looked for, the likeliest names first."""
    if not path.parent.is_dir():
        return f"nor is there a folder {path.parent}"
    names = sorted(child.name for child in path.parent.iterdir())
    close = difflib.get_close_matches(path.name, names, n=3)
    if close:
        return "did you mean " + " or ".join(repr(name) for name in close) + "?"
    return f"the folder holds: {_some(names)}"


def _some(names: Sequence[str]) -> str:
    more = f" and {len(names) - 5} more" if len(names) > 5 else ""
    return (", ".join(names[:5]) or "nothing") + more


def _adapter(path: Path, head: bytes) -> Adapter:
    """The one adapter that recognises the file."""
    able = [adapter for adapter in ADAPTERS if adapter.recognises(head)]
    if len(able) == 1:
        return able[0]
    verdict = "more than one adapter recognises it" if able else "no adapter recognises it"
    names = ", ".join(adapter.name for adapter in able or ADAPTERS)
    raise LogError(
        f"{path}: {verdict} (of {names}); it begins {head[:16]!r}; give the log as its recorder "
        "wrote it, or export it as CSV with a header row and a time column"
    )
