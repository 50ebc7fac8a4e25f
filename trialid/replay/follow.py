"""A log that is still being written, read again whenever it has grown."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

from trialid.errors import TrialidError
from trialid.trial import Trial

EVERY: Final = 1.0
"""Shortest time between two readings [s]."""

REST: Final = 4.0
"""Times as long as a reading took until the next: a long log is read whole each time."""

Seen = tuple[tuple[str, int, int], ...]


class Follower:
    """Reads the trial again when its logs have grown.

    Parameters
    ----------
    paths
        Files and folders of the logs.
    read
        Reads and aligns what is there.
    idle
        Without growth for so long [s] the log is taken to be whole.
    now
        The wall clock [s].

    Attributes
    ----------
    trouble
        Why the last reading failed, empty where it did not: half a message at the end is no
        reason to stop.
    """

    def __init__(
        self, paths: Sequence[Path], read: Callable[[], Trial], idle: float,
        now: Callable[[], float],
    ) -> None:  # fmt: skip
        self._paths, self._read, self._idle, self._now = tuple(paths), read, idle, now
        self._seen = _sizes(self._paths)
        self._unread = False
        self._grew = self._next = now()
        self.trouble = ""

    def first(self, wait: Callable[[float], None]) -> Trial:
        """The trial as soon as there is enough of it.

        Raises
        ------
        TrialidError
            There was not enough of it, and it grew no more.
        """
        while True:
            try:
                return self._reading()
            except TrialidError:
                if self._over(self._now()):
                    raise
            wait(EVERY)

    def poll(self, now: float) -> tuple[Trial | None, bool]:
        """A longer trial, None where there is none yet; and whether the log is whole."""
        if now < self._next:
            return None, False
        over = self._over(now)
        if not self._unread:
            return None, over
        try:
            return self._reading(), over
        except TrialidError as error:
            self.trouble = str(error)
            return None, over

    def _over(self, now: float) -> bool:
        """Whether nothing was written for long."""
        sizes = _sizes(self._paths)
        if sizes != self._seen:
            self._seen, self._grew, self._unread = sizes, now, True
        return now - self._grew >= self._idle

    def _reading(self) -> Trial:
        begun = self._now()
        seen = _sizes(self._paths)
        try:
            trial = self._read()
        finally:
            done = self._now()
            self._next = done + max(EVERY, REST * (done - begun))
        self._seen, self._unread, self.trouble = seen, False, ""
        return trial


def _sizes(paths: Sequence[Path]) -> Seen:
    """Name, size and time of every file."""
    files = [f for p in paths for f in (sorted(p.iterdir()) if p.is_dir() else [p]) if f.is_file()]
    return tuple((str(f), f.stat().st_size, f.stat().st_mtime_ns) for f in files)
