"""Ways in which a log gets damaged, each by a seed: for tests that no damage is read silently."""

from collections.abc import Callable

import numpy as np

Rng = np.random.Generator


def cut(log: bytes, rng: Rng) -> bytes:
    return log[: _place(log, rng)]


def flip(log: bytes, rng: Rng) -> bytes:
    content = bytearray(log)
    for _ in range(int(rng.integers(1, 4))):
        content[_place(log, rng)] ^= 1 << int(rng.integers(8))
    return bytes(content)


def overwrite(log: bytes, rng: Rng) -> bytes:
    at, some = _place(log, rng), rng.bytes(int(rng.integers(1, 400)))
    return log[:at] + some + log[at + len(some) :]


def insert(log: bytes, rng: Rng) -> bytes:
    at = _place(log, rng)
    return log[:at] + rng.bytes(int(rng.integers(1, 400))) + log[at:]


def remove(log: bytes, rng: Rng) -> bytes:
    at = _place(log, rng)
    return log[:at] + log[at + int(rng.integers(1, 2000)) :]


def duplicate(log: bytes, rng: Rng) -> bytes:
    at, to = sorted((_place(log, rng), _place(log, rng)))
    return log[:to] + log[at:to] + log[to:]


def swap(log: bytes, rng: Rng) -> bytes:
    a, b, c = sorted(_place(log, rng) for _ in range(3))
    return log[:a] + log[b:c] + log[a:b] + log[c:]


def splice(log: bytes, rng: Rng) -> bytes:
    return log[: _place(log, rng)] + log[_place(log, rng) :]


def boast(log: bytes, rng: Rng) -> bytes:
    """A length, wherever it may be, that is huge."""
    at, size = _place(log, rng), int(rng.choice([4, 8]))
    huge = int(rng.choice([2**31 - 1, 2**32 - 1, 2**40, 2**63 - 1, 2**64 - 1, 10**8]))
    return log[:at] + (huge % 256**size).to_bytes(size, "little") + log[at + size :]


WAYS: tuple[Callable[[bytes, Rng], bytes], ...] = (
    cut, flip, overwrite, insert, remove, duplicate, swap, splice, boast,
)  # fmt: skip


def mutilated(log: bytes, seed: int) -> bytes:
    """The log damaged in one way, or in two; its first 16 bytes stay."""
    rng = np.random.default_rng(seed)
    for _ in range(1 + (seed % 5 == 0)):
        log = log[:16] + WAYS[int(rng.integers(len(WAYS)))](log, rng)[16:]
    return log


def _place(log: bytes, rng: Rng) -> int:
    return int(rng.integers(16, len(log)))
