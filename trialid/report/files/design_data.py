"""A plan as plain data, schema `trialid-design/1`; SI unless a unit stands beside a number."""

import math
from typing import Any, Final

import numpy as np

from trialid.design.helm import Passage
from trialid.design.kinds import KINDS, Test, Value
from trialid.design.rating import ParameterRating, Rating
from trialid.design.search import Outcome
from trialid.design.separation import Separation
from trialid.report.pages import bridge_orders, drive_orders

SCHEMA: Final = "trialid-design/1"


def of_outcome(outcome: Outcome) -> dict[str, Any]:
    """What came of a programme: what it breaks, what it is worth, what the ship does."""
    return {
        "feasible": not outcome.excesses,
        "limits": [
            {
                "limit": e.limit,
                "found": finite(e.found),
                "allowed": finite(e.allowed),
                "t": e.t,
                "sentence": e.sentence,
            }
            for e in outcome.excesses
        ],
        "rating": None if outcome.rating is None else of_rating(outcome.rating),
        "expected": [_expected(p) for p in outcome.passages],
    }


def of_rating(rating: Rating) -> dict[str, Any]:
    """Eq. 8 to 14 of a programme."""
    return {
        "S_min": rating.S_min,
        "S_max": rating.S_max,
        "R": finite(rating.R),
        "noise": rating.noise,
        "undermodelling": rating.undermodelling,
        "parameters": [_of_parameter(p) for p in rating.parameters],
    }


def _of_parameter(p: ParameterRating) -> dict[str, Any]:
    return {
        "name": p.name,
        "unit": p.unit,
        "value": p.value,
        "S_i": p.S_i,
        "S_imin": p.S_imin,
        "R_i": finite(p.R_i),
        "relative_error": finite(p.error),
        "noise_error": finite(p.noise_error),
        "bias": finite(p.bias),
        "bound": finite(p.bound),
        "partner": p.partner,
        "likeness": p.likeness,
    }


def _expected(passage: Passage) -> dict[str, Any]:
    """What the crew may expect to see."""
    signals, trial = passage.trial.signals, passage.trial
    largest = {n: float(np.abs(signals[n]).max()) for n in ("r", "phi", "delta") if n in signals}
    return {
        "test": trial.name,
        "duration": trial.duration,
        "largest": largest,
        "slowest": float(signals["u"].min()) if "u" in signals else None,
        "room": {
            "ahead": float(passage.x.max()),
            "astern": float(-passage.x.min()),
            "starboard": float(passage.y.max()),
            "port": float(-passage.y.min()),
        },
        "orders": _orders(passage),
    }


def _orders(passage: Passage) -> list[dict[str, Any]]:
    """Every change of what is ordered: an angle [rad] of the rudder, or of each drive [SI]."""
    if passage.driven:
        return [
            {"t": o.t, "drives": dict(o.drives), "heading": o.heading, "words": o.words}
            for o in drive_orders.orders(passage)
        ]
    signals, trial = passage.trial.signals, passage.trial
    return [
        {
            "t": o.t,
            "angle": o.angle,
            "heading": o.heading,
            "words": bridge_orders.order_words(o.angle),
        }
        for o in bridge_orders.orders(trial.t, signals["delta_order"], signals["psi"])
    ]


def of_test(test: Test) -> dict[str, Any]:
    """A test with its numbers in the units of design files."""
    variables = KINDS[test.kind].variables
    numbers = {
        n: _shown(test.values.get(n, v.default), v.unit)
        for n, v in variables.items()
        if test.values.get(n, v.default) is not None
    }
    return {
        "name": test.name,
        "kind": test.kind,
        "what": KINDS[test.kind].words,
        "numbers": numbers,
        "units": {n: variables[n].unit for n in numbers},
        "approach": test.approach,
        "duration": test.duration,
    }


def _shown(value: Value | None, unit: str) -> Any:
    factor = math.degrees(1.0) if unit.startswith("deg") else 1.0
    if isinstance(value, tuple):
        return [x * factor for x in value]
    return None if value is None else float(value) * factor


def of_separation(found: Separation | None) -> dict[str, Any] | None:
    """Two effects, and the test that tells them apart."""
    if found is None:
        return None
    return {
        "effects": list(found.names),
        "separate": found.separate,
        "cosine": found.after.cosine,
        "cosine_before": None if found.before is None else found.before.cosine,
        "odds": list(found.after.odds),
        "programme": [of_test(t) for t in found.programme],
        "sentence": found.sentence,
    }


def finite(number: float) -> float | None:
    """A number, None where it is not one: JSON has no infinity."""
    return float(number) if math.isfinite(number) else None
