"""Two results side by side: what a change of the model did to errors, parts and parameters."""

from collections.abc import Mapping, Sequence
from typing import Any

from trialid.diagnosis.bias import Foreseen
from trialid.result import Plain, finite
from trialid.ship.effect import Effect


def compared(
    step: str,
    effect: Effect,
    before: Mapping[str, Any] | None,
    after: Mapping[str, Any],
    foreseen: Foreseen | str,
    taken_out: Sequence[str] = (),
) -> Plain:
    """An effect added or dropped: the results before and after side by side.

    `foreseen` is what linearisation had to say, or why it had nothing; `before` None where the old
    model could not be fitted.
    """
    words = foreseen if isinstance(foreseen, str) else None
    old, new = _errors(before), _errors(after)
    return finite(
        {
            "step": step,
            "effect": effect.name,
            "equation": effect.equation,
            **{key: _beside(old.get(key), new[key]) for key in new},
            "undermodelling_interval": (after["split"]["interval"] or {}).get("undermodelling"),
            "verdict": [before["verdict"]["kind"] if before else None, after["verdict"]["kind"]],
            "named": [before["verdict"]["effect"] if before else None, after["verdict"]["effect"]],
            "eps_rmsn_foreseen": None if isinstance(foreseen, str) else foreseen.eps_rmsn,
            "not_foreseen": words,
            "parameters": _moves(before, after, None if isinstance(foreseen, str) else foreseen),
            "taken_out": list(taken_out),
        }
    )


def _errors(result: Mapping[str, Any] | None) -> Plain:
    if result is None:
        return {}
    fit, split = result["fit"], result["split"]
    return {
        "eps_rmsn": fit["eps_rmsn"],
        "eps_rmsn_check": fit["eps_rmsn_check"],
        "by_output": fit["eps_rmsn_by_output"],
        "by_output_check": fit["eps_rmsn_check_by_output"],
        "noise": split["noise"],
        "undermodelling": split["undermodelling"],
    }


def _beside(old: Any, new: Any) -> Any:
    """A pair of numbers, None where there is neither; of tables, entry by entry."""
    if isinstance(old, Mapping) or isinstance(new, Mapping):
        names = dict.fromkeys([*(old or {}), *(new or {})])
        return {n: [(old or {}).get(n), (new or {}).get(n)] for n in names}
    return None if old is None and new is None else [old, new]


def _moves(
    before: Mapping[str, Any] | None, after: Mapping[str, Any], foreseen: Foreseen | None
) -> list[Plain]:
    """Every physical parameter, how far it moved, and how far it was to move.

    Moves are counted in standard errors of the fit before: that is what it had claimed.
    """
    old, new = _physical(before), _physical(after)
    moves = foreseen.moves if foreseen else {}
    rows = []
    for name in dict.fromkeys([*old, *new]):
        a, b = old.get(name), new.get(name)
        move = b["value"] - a["value"] if a and b else None
        error = a["standard_error"] if a else None
        shown = b or a or {}
        rows.append(
            {
                "name": name,
                "unit": shown["unit"],
                "before": a["value"] if a else None,
                "after": b["value"] if b else None,
                "standard_error_before": error,
                "standard_error": shown["standard_error"],
                "move": move,
                "move_in_errors": move / error if move is not None and error else None,
                "move_foreseen": moves.get(name) if move is not None else None,
                "after_foreseen": foreseen.values.get(name) if foreseen and not a else None,
            }
        )
    return rows


def _physical(result: Mapping[str, Any] | None) -> dict[str, Plain]:
    rows = result["accuracy"]["parameters"] if result else ()
    return {row["name"]: row for row in rows if row["kind"] == "physical"}
