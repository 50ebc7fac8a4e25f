"""What cables, cards, disks, power cuts and ill will do to a log, each by a seed."""

from collections.abc import Callable

import numpy as np

Rng = np.random.Generator
Way = Callable[[bytes, Rng], bytes]

HUGE = (2**31 - 1, 2**32 - 1, 2**40, 2**63 - 1, 2**64 - 1, 10**8)
SIGNS = b'$!*\\,;"\n\r\0-+.0A'
"""Bytes that mean something in texts."""
LENGTHS = (1, 3, 50, 400, 5000)


def damaged(
    log: bytes, rng: Rng, keep: int = 0, likeness: bytes = b"", other: bytes = b""
) -> bytes:
    """The log after one to four accidents, never empty; its first `keep` bytes stay.

    `likeness` looks like a record of the format and gets into the log too; `other` is a log that
    may be spliced into it.
    """
    ways = (*WAYS, _with(likeness or b"\0"), _spliced(other or log))
    for _ in range(int(rng.choice((1, 1, 2, 4)))):
        log = log[:keep] + ways[int(rng.integers(len(ways)))](log, rng)[keep:]
    return log or b"x"


def cut(log: bytes, rng: Rng) -> bytes:
    return log[: _place(log, rng)]


def flip(log: bytes, rng: Rng) -> bytes:
    content = bytearray(log)
    for _ in range(int(rng.choice((1, 1, 3, 10, 40)))):
        if content:
            content[int(rng.integers(len(content)))] ^= 1 << int(rng.integers(8))
    return bytes(content)


def noise(log: bytes, rng: Rng) -> bytes:
    a, b = _stretch(log, rng)
    return log[:a] + rng.bytes(b - a) + log[b:]


def insert(log: bytes, rng: Rng) -> bytes:
    a, b = _stretch(log, rng)
    return log[:a] + rng.bytes(b - a) + log[a:]


def lose(log: bytes, rng: Rng) -> bytes:
    a, b = _stretch(log, rng)
    return log[:a] + log[b:]


def double(log: bytes, rng: Rng) -> bytes:
    a, b = _stretch(log, rng)
    return log[:b] + log[a:b] + log[b:]


def double_much(log: bytes, rng: Rng) -> bytes:
    a, b = sorted((_place(log, rng), _place(log, rng)))
    return log[:b] + log[a:b] + log[b:]


def swap(log: bytes, rng: Rng) -> bytes:
    a, b, c = sorted(_place(log, rng) for _ in range(3))
    return log[:a] + log[b:c] + log[a:b] + log[c:]


def swap_near(log: bytes, rng: Rng) -> bytes:
    a, b = _stretch(log, rng)
    c = min(len(log), b + 200)
    return log[:a] + log[b:c] + log[a:b] + log[c:]


def overlay(log: bytes, rng: Rng) -> bytes:
    """A piece of the log over another place, as a disk gives back a wrong block."""
    a, b = _stretch(log, rng)
    at = _place(log, rng)
    return log[:at] + log[a:b] + log[at + b - a :]


def rejoin(log: bytes, rng: Rng) -> bytes:
    return log[: _place(log, rng)] + log[_place(log, rng) :]


def blank(log: bytes, rng: Rng) -> bytes:
    """Zeros or ones, as cards leave what was never written."""
    a, b = _stretch(log, rng)
    return log[:a] + bytes([int(rng.choice((0, 255)))]) * (b - a) + log[b:]


def boast(log: bytes, rng: Rng) -> bytes:
    """A length, wherever it may be, that is huge."""
    at, size = _place(log, rng), int(rng.choice((4, 8)))
    order = "little" if rng.random() < 0.8 else "big"
    huge = HUGE[int(rng.integers(len(HUGE)))] % 256**size
    return log[:at] + huge.to_bytes(size, order) + log[at + size :]


def digits(log: bytes, rng: Rng) -> bytes:
    """A number in the text that is huge."""
    at = _place(log, rng)
    return log[:at] + b"9" * int(rng.choice((1, 5, 20, 400))) + log[at:]


def signs(log: bytes, rng: Rng) -> bytes:
    """Signs that mean something, where they mean nothing."""
    at = _place(log, rng)
    some = rng.choice(np.frombuffer(SIGNS, np.uint8), int(rng.integers(1, 40)))
    return log[:at] + some.tobytes() + log[at:]


WAYS: tuple[Way, ...] = (
    cut, flip, flip, noise, insert, lose, double, double_much, swap, swap_near, overlay, rejoin,
    blank, boast, digits, signs,
)  # fmt: skip


def _with(likeness: bytes) -> Way:
    def like(log: bytes, rng: Rng) -> bytes:
        at = _place(log, rng)
        return log[:at] + likeness * int(rng.choice((1, 30))) + log[at:]

    return like


def _spliced(other: bytes) -> Way:
    def splice(log: bytes, rng: Rng) -> bytes:
        at = _place(log, rng)
        a, b = sorted((_place(other, rng), _place(other, rng)))
        end = log[at:] if rng.random() < 0.5 else b""
        return log[:at] + other[a:b] + end

    return splice


def _place(log: bytes, rng: Rng) -> int:
    return int(rng.integers(len(log) + 1))


def _stretch(log: bytes, rng: Rng) -> tuple[int, int]:
    a = _place(log, rng)
    longest = LENGTHS[int(rng.integers(len(LENGTHS)))]
    return a, min(len(log), a + int(rng.integers(1, longest + 1)))
