"""Damage to text logs, with seeds: cuts, flipped bits, blocks spliced, doubled, swapped."""

import numpy as np


def damaged(data: bytes, rng: np.random.Generator) -> bytes:
    """One to three kinds of damage in one log."""
    kinds = (_cut, _flip, _splice, _double, _garbage, _swap, _stars)
    for kind in rng.choice(len(kinds), int(rng.integers(1, 4))):
        data = kinds[kind](data, rng)
    return data


def _place(data: bytes, rng: np.random.Generator) -> int:
    return int(rng.integers(0, len(data) + 1))


def _stretch(data: bytes, rng: np.random.Generator) -> tuple[int, int]:
    a = _place(data, rng)
    return a, min(len(data), a + int(rng.integers(1, 400)))


def _cut(data: bytes, rng: np.random.Generator) -> bytes:
    return data[: max(_place(data, rng), 1)]


def _flip(data: bytes, rng: np.random.Generator) -> bytes:
    changed = bytearray(data)
    for place in rng.integers(0, len(data), int(rng.integers(1, 40))):
        changed[place] ^= 1 << int(rng.integers(0, 8))
    return bytes(changed)


def _splice(data: bytes, rng: np.random.Generator) -> bytes:
    a, b = _stretch(data, rng)
    return data[:a] + data[b:] or b"$"


def _double(data: bytes, rng: np.random.Generator) -> bytes:
    a, b = _stretch(data, rng)
    return data[:b] + data[a:b] + data[b:]


def _garbage(data: bytes, rng: np.random.Generator) -> bytes:
    a = _place(data, rng)
    return data[:a] + rng.bytes(int(rng.integers(1, 300))) + data[a:]


def _swap(data: bytes, rng: np.random.Generator) -> bytes:
    a, b = _stretch(data, rng)
    c = min(len(data), b + 200)
    return data[:a] + data[b:c] + data[a:b] + data[c:]


def _stars(data: bytes, rng: np.random.Generator) -> bytes:
    """Signs that mean something, where they mean nothing."""
    a = _place(data, rng)
    signs = rng.choice(list(b"$!*\\,;\n\r0A"), int(rng.integers(1, 40)))
    return data[:a] + bytes(signs.tolist()) + data[a:]
