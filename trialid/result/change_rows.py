"""Rows of `result.json` about the steps of a model and what a change did to it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from trialid.result.fit_rows import (
    Interval,
)

Pair = tuple[float | None, float | None]
"""Before and after."""


@dataclass(frozen=True, kw_only=True)
class GrownRow:
    """An effect that the loop added: what leaving it out costs, and whether it has a name."""

    effect: str
    left_out_with_it: tuple[str, ...] = ()
    costs: float | None = None
    named: bool = False


@dataclass(frozen=True, kw_only=True)
class StepRow:
    """One step of the model's history; `proposed` is one that was only tried."""

    step: Literal["as written", "added", "dropped", "proposed"]
    effects: tuple[str, ...] = ()
    added: str | None = None
    dropped: str | None = None
    eps_rmsn: float | None = None
    noise: float | None = None
    undermodelling: float | None = None
    undermodelling_interval: Interval | None = None
    eps_rmsn_check: float | None = None
    verdict: str | None = None
    free: tuple[str, ...] = ()
    logs: tuple[str, ...] = ()
    version: str | None = None

    @property
    def joined(self) -> tuple[str, ...]:
        """Names of what was added, or set free."""
        return names_in(self.added)

    @property
    def sign(self) -> str:
        """What stands before what was added: `free` where these were numbers that it held."""
        held = self.joined and {*self.joined} <= {*self.free} - {*self.effects}
        return "free" if held else "+"


def names_in(added: str | None) -> tuple[str, ...]:
    """Names of what was added at once; two stand with a comma.

    >>> names_in("sway_drag_var, rudder_slipstream"), names_in(None)
    (('sway_drag_var', 'rudder_slipstream'), ())
    """
    return tuple(added.split(", ")) if added else ()


@dataclass(frozen=True, kw_only=True)
class MovedRow:
    """A parameter before and after; moves in its unit, or in standard errors of the fit before."""

    name: str
    unit: str
    before: float | None = None
    after: float | None = None
    standard_error_before: float | None = None
    standard_error: float | None = None
    move: float | None = None
    move_in_errors: float | None = None
    move_foreseen: float | None = None
    after_foreseen: float | None = None


@dataclass(frozen=True, kw_only=True)
class ChangePart:
    """A model before and after one effect; of one that is only proposed, less is known."""

    step: str | None = None
    effect: str
    equation: str = ""
    eps_rmsn: Pair | None = None
    eps_rmsn_check: Pair | None = None
    by_output: Mapping[str, Pair] = field(default_factory=dict)
    by_output_check: Mapping[str, Pair] = field(default_factory=dict)
    noise: Pair | None = None
    undermodelling: Pair | None = None
    undermodelling_interval: Interval | None = None
    verdict: tuple[str | None, ...] = ()
    named: tuple[str | None, ...] = ()
    eps_rmsn_foreseen: float | None = None
    not_foreseen: str | None = None
    parameters: tuple[MovedRow, ...] = ()
    taken_out: tuple[str, ...] = ()
