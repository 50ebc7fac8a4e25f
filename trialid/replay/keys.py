"""Keys pressed while a replay runs; none where there is no keyboard."""

import os
import select
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Final

NAMES: Final = {b" ": "space", b"q": "q", b"\x1b[C": "right", b"\x1b[D": "left"}
"""What a terminal sends for the keys of a replay."""

Keys = Callable[[], list[str]]


def key_names(sent: bytes) -> list[str]:
    r"""The keys in what a terminal sent; others are passed over.

    >>> key_names(b" x\x1b[C\x1b[Aq")
    ['space', 'right', 'q']
    """
    found = []
    while sent:
        for code, name in NAMES.items():
            if sent.startswith(code):
                found.append(name)
                sent = sent[len(code) :]
                break
        else:
            sent = sent[3 if sent.startswith(b"\x1b[") else 1 :]
    return found


@contextmanager
def keyboard() -> Iterator[Keys]:
    """Give the function that tells the keys pressed since it was last asked."""
    try:
        import termios
        import tty
    except ImportError:  # not on this system
        yield list
        return
    if not sys.stdin.isatty():
        yield list
        return
    place = sys.stdin.fileno()
    before = termios.tcgetattr(place)
    try:
        tty.setcbreak(place)
        yield lambda: key_names(_pending(place))
    finally:
        termios.tcsetattr(place, termios.TCSADRAIN, before)


def _pending(place: int) -> bytes:
    return os.read(place, 1024) if select.select([place], [], [], 0.0)[0] else b""
