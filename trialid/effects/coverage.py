"""What the catalogue covers: the physics it says, what it leaves out and why, what looks alike."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Any


@dataclass(frozen=True)
class Row:
    """One thing that can be missing from a ship model.

    Attributes
    ----------
    effects
        Names of the effects that say it; none where it is left out.
    seen
        How it shows in a record.
    why_not
        Why no effect says it.
    """

    id: str
    what: str
    effects: tuple[str, ...] = ()
    seen: str = ""
    why_not: str = ""


@dataclass(frozen=True)
class Seen:
    """What one kind of trial shows of an effect.

    Attributes
    ----------
    visible
        Share of its trace that nine linear coefficients cannot take.
    alike
        Other effects with nearly the same trace, and |cos| between the two.
    """

    trial: str
    visible: float
    alike: Mapping[str, float]


@cache
def rows() -> tuple[Row, ...]:
    """Everything that was considered, in order."""
    return tuple(Row(**{**r, "effects": tuple(r.get("effects", ()))}) for r in _read()["row"])


@cache
def besides() -> Mapping[str, str]:
    """Effects that stand in no row, and what they are for."""
    return dict(_read()["besides"])


def rows_of(name: str) -> tuple[Row, ...]:
    """The rows an effect says something of."""
    return tuple(r for r in rows() if name in r.effects)


def left_out() -> tuple[Row, ...]:
    """What no effect says, with the reason."""
    return tuple(r for r in rows() if not r.effects)


@cache
def _alike() -> Mapping[str, Any]:
    return _toml("confusable.toml")


def trial_results(name: str) -> tuple[Seen, ...]:
    """What five kinds of trial showed of an effect; none where it was not measured."""
    found = _alike().items()
    return tuple(
        Seen(trial, part["visible"][name], dict(part["cos"].get(name, {})))
        for trial, part in found
        if name in part["visible"]
    )


@cache
def _read() -> Mapping[str, Any]:
    return _toml("coverage.toml")


def _toml(file: str) -> Mapping[str, Any]:
    text = (resources.files("trialid.effects") / file).read_text(encoding="utf-8")
    return tomllib.loads(text)
