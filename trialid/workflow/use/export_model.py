"""A finished run's model written to files of a kind, all of them or none."""

from collections.abc import Mapping, Sequence
from math import inf, radians
from numbers import Real
from pathlib import Path
from typing import Final

from trialid import temporary
from trialid.errors import TrialidError, nearest
from trialid.names.model_kinds import KINDS
from trialid.workflow.use.finished_model import FinishedModel
from trialid.workflow.use.hand_over import WRITERS, Files
from trialid.workflow.use.steering import Wishes

FULL: Final = 90.0
"""deg beyond which no rudder goes."""


def export_model(model: FinishedModel, kind: str, places: Sequence[Path], wishes: Wishes) -> Files:
    """Write the files of a kind where `export_places` puts them; what was written, by suffix.

    Raises
    ------
    TrialidError
        The model is none of that kind, or a file cannot be written.
    """
    made = WRITERS[kind](model, places[0].stem, wishes)
    _write({place: _bytes(made[place.suffix]) for place in places})
    return made


def export_places(
    name: str, kind: str, out: Path | None, *, force: bool, by_command: bool = False
) -> list[Path]:
    """Where the files of a model go, by default called by its name and kind; checked before.

    `by_command`: a mistake is told in options of the command, else in arguments.

    Raises
    ------
    TrialidError
        There is no such kind, or one is there already, cannot be written, or is called by another
        ending.
    """
    from trialid.export import check_place

    if kind not in KINDS:
        raise TrialidError(f"export: {kind!r} is no kind of file; {nearest(str(kind), KINDS)}")
    first = out or Path(f"{name}_{kind}{KINDS[kind].suffixes[0]}")
    words = ("--out ", "add --force") if by_command else ("out = ", "say force=True")
    formats = KINDS[kind].suffixes[:1]
    places = [first.with_suffix(x) for x in KINDS[kind].suffixes] if first.name else []
    check_place(first, replace=force, formats=formats, more=places, words=words)
    return places


def wishes_of(
    bandwidth: float | None,
    full_rudder: float | None,
    full_command: float | None,
    *,
    by_command: bool = False,
) -> Wishes:
    """What is wished for of gains: a bandwidth [rad/s], a full rudder [deg], a full command.

    Raises
    ------
    TrialidError
        One is none.
    """
    asked = {"bandwidth": bandwidth, "full_rudder": full_rudder, "full_command": full_command}
    for name, value in asked.items():
        if value is not None and (isinstance(value, bool) or not isinstance(value, Real)):
            raise TrialidError(f"{name}={value!r}: expected a number")
    if full_rudder is not None and not 0.0 < full_rudder <= FULL:
        named = "--full-rudder" if by_command else "full_rudder"
        raise TrialidError(
            f"{named} {full_rudder:g}: expected an angle above 0 and at most {FULL:g} deg"
        )
    if full_command is not None and not 0.0 < full_command < inf:
        named = "--full-command" if by_command else "full_command"
        raise TrialidError(f"{named} {full_command:g}: expected a number above 0")
    return Wishes(bandwidth, None if full_rudder is None else radians(full_rudder), full_command)


def _write(contents: Mapping[Path, bytes]) -> None:
    """Write the files together.

    Raises
    ------
    TrialidError
        One of them cannot be written.
    """
    try:
        temporary.replace_all(contents)
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise TrialidError(f"{next(iter(contents))}: {why}") from error


def _bytes(content: str | bytes) -> bytes:
    return content if isinstance(content, bytes) else content.encode()
