"""The shape of `result.json`: what a reader of it may ask for, whether known in this run or not."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

Run = dict[str, Any]


@dataclass(frozen=True)
class Maybe:
    """An object that is null as a whole when there is nothing to say."""

    inner: Any


@dataclass(frozen=True)
class Each:
    """A mapping whose keys are the run's own: outputs, parameters."""

    inner: Any = None


def _keys(text: str) -> dict[str, Any]:
    return dict.fromkeys(text.split())


_PARTS = _keys("noise undermodelling")
_SPLIT = _PARTS | {"interval": Maybe(_PARTS)}
_TRIAL = _keys("name use samples period duration") | {
    "logs": [_keys("path sha256 adapter")],
    "remarks": [None],
    "eps_rmsn": Each(),
}
_FIT = _keys("eps_rmsn eps_rmsn_check V converged reason samples weighting") | {
    "eps_rmsn_by_output": Each(),
    "iterations": [_keys("V eps_rmsn step")],
    "step_halving": Each(),
    "y_rms": Each(),
}
_PARAMETER = _keys(
    "name value unit S_i S_imin R_i relative_error noise_error undermodelling_error"
    " standard_error kind"
)
_ACCURACY = _keys("S_min S_max R n_effective weighting scaling") | {
    "parameters": [_PARAMETER],
    "stability": Maybe(
        _keys("L_r L_v margin standard_error stable")
        | {"roll_coupled": Maybe(_keys("L_r L_v margin standard_error stable"))}
    ),
    "weak": [_keys("sentence relative_error") | {"parameters": [None], "moves": Each()}],
}
_MISSING = _keys(
    "rank effect equation sentence eps_rmsn_predicted eps_rmsn_refitted eps_rmsn_check p_value"
    " visibility verdict"
) | {
    "family": [None],
    "cosines": Each(),
    "parameters": Each(_keys("expected refitted unit low high")),
}
_CHANGE = _keys(
    "step effect equation eps_rmsn eps_rmsn_check noise undermodelling undermodelling_interval"
    " eps_rmsn_foreseen not_foreseen"
) | {
    "by_output": Each(),
    "by_output_check": Each(),
    "verdict": [None],
    "named": [None],
    "taken_out": [None],
    "parameters": [
        _keys(
            "name unit before after standard_error standard_error_before move move_in_errors"
            " move_foreseen after_foreseen"
        )
    ],
}
"""An effect that was added or dropped; of one that is only proposed, less is known."""

_STEP = _keys("step added dropped eps_rmsn noise undermodelling eps_rmsn_check verdict version") | {
    "effects": [None],
    "free": [None],
    "logs": [None],
    "undermodelling_interval": None,
}
_FINDING = _keys("output finding doing share excess p_value t_start t_end trial sentence picture")
_FORCE = _keys("named sentence") | {
    "possible": [None],
    "effects": [None],
    "equations": [
        _keys(
            "equation unit explains log_likelihood_ratio p_value symmetry shape_explains"
            " terms_tried sentence"
        )
        | {
            "signals": [None],
            "shape": [
                _keys("name term coefficient standard_error share p_value symmetry")
                | {"rivals": [None]}
            ],
        }
    ],
}

SHAPE: dict[str, Any] = _keys("schema version pipeline file") | {
    "trials": [_TRIAL],
    "model": {"states": [None], "effects": [None], "free": [None], "inputs": [None]},
    "fit": _FIT,
    "split": _SPLIT
    | _keys("method why")
    | {"by_output": Each(_SPLIT), "routes": [_SPLIT | _keys("method available why")]},
    "accuracy": _ACCURACY,
    "where": [_FINDING],
    "where_else": {
        "by_output": [_keys("output share sentence")],
        "rest": [_keys("output sentence picture")],
        "not_examined": [None],
        "questions": None,
    },
    "missing": [_MISSING],
    "not_tried": Each(),
    "verdict": _keys("kind effect sentence") | {"family": [None], "next_trial": Maybe({})},
    "imo": Maybe(
        {
            "speed_simulated": None,
            "measures": [_keys("name unit value interval allowed kept manoeuvre")],
            "overshoots": [_keys("trial t rudder measured predicted")],
        }
    ),
    "history": [_STEP],
    "history_remark": None,
    "sources": [_keys("path sha256")],
    "signals": [_keys("trial signal channel")],
    "before_after": Maybe(_CHANGE),
    "change": Maybe(_CHANGE),
    "missing_force": Maybe(_FORCE),
}


def whole(result: Mapping[str, Any]) -> Run:
    """The result with every key of the schema present: absent knowledge is None, never an error.

    >>> run = whole({"fit": {"eps_rmsn": 0.1}})
    >>> run["fit"]["eps_rmsn"], run["fit"]["V"], run["trials"], run["before_after"]
    (0.1, None, [], None)
    """
    return _filled(SHAPE, result)


def _filled(shape: Any, value: Any) -> Any:
    match shape:
        case Maybe(inner):
            return None if value is None else _filled(inner, value)
        case Each(inner):
            return {key: _filled(inner, each) for key, each in (value or {}).items()}
        case [row]:
            return [_filled(row, each) for each in value or ()]
        case dict():
            given = value or {}
            return {**given, **{key: _filled(each, given.get(key)) for key, each in shape.items()}}
        case _:
            return value
