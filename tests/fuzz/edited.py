"""Plain data and texts changed by somebody's hand: a key gone, a number far out, another kind."""

import copy
from collections.abc import Iterator
from typing import Any

import numpy as np

VALUES: tuple[Any, ...] = (
    None, True, -1, 0, 2**70, -0.0, 1e308, -1e308, 5e-324, "", "a", "\x1b[31m", "\ud800", "1",
    "x" * 3000, "\u202e", [], {}, [[]], {"a": 1}, [None], "<script>", "nan", 1e-3, 7,
)  # fmt: skip


def places(data: Any, at: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Where every value stands."""
    items = data.items() if isinstance(data, dict) else enumerate(data)
    for key, value in items:
        yield (*at, key)
        if isinstance(value, dict | list):
            yield from places(value, (*at, key))


def edited(data: Any, rng: np.random.Generator) -> Any:
    """The same data with one to three changes."""
    made = copy.deepcopy(data)
    for _ in range(int(rng.integers(1, 4))):
        every = list(places(made))
        if not every:
            return made
        _change(made, every[int(rng.integers(len(every)))], rng)
    return made


def _change(data: Any, place: tuple[Any, ...], rng: np.random.Generator) -> None:
    for key in place[:-1]:
        data = data[key]
    key, kind = place[-1], int(rng.integers(6))
    value = data[key]
    if kind == 0:
        del data[key]
    elif kind == 1 and isinstance(value, list):
        value[:] = value * 2 if rng.random() < 0.5 else value[: len(value) // 2]
    elif kind == 2 and isinstance(value, int | float) and not isinstance(value, bool):
        data[key] = value * float(rng.choice([-1.0, 0.0, 1e3, 1e200, 1e-200]))
    elif kind == 3 and isinstance(value, str):
        data[key] = value + str(rng.choice(["x", "\x1b[31m", "<b>", "\n", "\\", "_" * 500]))
    else:
        data[key] = copy.deepcopy(VALUES[int(rng.integers(len(VALUES)))])
