"""Two results side by side: what a change of the model did to errors, parts and parameters."""

from collections.abc import Iterable, Mapping, Sequence
from typing import Literal

from trialid.diagnosis.search.bias import Foreseen
from trialid.result.change_rows import ChangePart, MovedRow, Pair
from trialid.result.fit_rows import ParameterRow
from trialid.result.json_file import finite
from trialid.result.schema import Result
from trialid.ship.effect import Effect


def compare_models(
    step: Literal["added", "dropped"],
    effect: Effect,
    before: Result | None,
    after: Result,
    foreseen: Foreseen | str,
    taken_out: Sequence[str] = (),
) -> ChangePart:
    """An effect added or dropped: the results before and after side by side.

    `foreseen` is what linearisation had to say, or why it had nothing; `before` None where the old
    model could not be fitted.
    """
    ahead = None if isinstance(foreseen, str) else foreseen
    old = before or Result()
    fit, split = after.fit, after.split
    part: ChangePart = finite(
        ChangePart(
            step=step,
            effect=effect.name,
            equation=effect.equation,
            eps_rmsn=_pair(old.fit.eps_rmsn, fit.eps_rmsn),
            eps_rmsn_check=_pair(old.fit.eps_rmsn_check, fit.eps_rmsn_check),
            by_output=_pairs(old.fit.eps_rmsn_by_output, fit.eps_rmsn_by_output),
            by_output_check=_pairs(old.fit.eps_rmsn_check_by_output, fit.eps_rmsn_check_by_output),
            noise=_pair(old.split.noise, split.noise),
            undermodelling=_pair(old.split.undermodelling, split.undermodelling),
            undermodelling_interval=split.interval.undermodelling if split.interval else None,
            verdict=(old.verdict.kind, after.verdict.kind),
            named=(old.verdict.effect, after.verdict.effect),
            eps_rmsn_foreseen=ahead.eps_rmsn if ahead else None,
            not_foreseen=foreseen if isinstance(foreseen, str) else None,
            parameters=tuple(_moves(before, after, ahead)),
            taken_out=tuple(taken_out),
        )
    )
    return part


def _pair(old: float | None, new: float | None) -> Pair | None:
    """A pair of numbers, None where there is neither."""
    return None if old is None and new is None else (old, new)


def _pairs(
    old: Mapping[str, float | None] | None, new: Mapping[str, float | None] | None
) -> dict[str, Pair]:
    names = dict.fromkeys([*(old or {}), *(new or {})])
    return {n: ((old or {}).get(n), (new or {}).get(n)) for n in names}


def _moves(before: Result | None, after: Result, foreseen: Foreseen | None) -> Iterable[MovedRow]:
    """Every physical parameter, how far it moved, and how far it was to move.

    Moves are counted in standard errors of the fit before: that is what it had claimed.
    """
    old = {row.name: row for row in before.physical} if before else {}
    new = {row.name: row for row in after.physical}
    for name in dict.fromkeys([*old, *new]):
        yield _move(old.get(name), new.get(name), foreseen)


def _move(a: ParameterRow | None, b: ParameterRow | None, foreseen: Foreseen | None) -> MovedRow:
    shown = b or a
    assert shown is not None
    move = None
    if a and b and a.value is not None and b.value is not None:
        move = b.value - a.value
    error = a.standard_error if a else None
    moves, values = (foreseen.moves, foreseen.values) if foreseen else ({}, {})
    return MovedRow(
        name=shown.name,
        unit=shown.unit,
        before=a.value if a else None,
        after=b.value if b else None,
        standard_error_before=error,
        standard_error=shown.standard_error,
        move=move,
        move_in_errors=move / error if move is not None and error else None,
        move_foreseen=moves.get(shown.name) if move is not None else None,
        after_foreseen=None if a else values.get(shown.name),
    )
