"""The missing force as plain data, as a table of time series, and as what the page draws of it."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from trialid.diagnosis.force_shape import ShapeTerm
from trialid.diagnosis.missing_force import Equation, MissingForce
from trialid.trial import Vector

UNITS = {"X": "N", "Y": "N", "K": "N m", "N": "N m"}


@dataclass(frozen=True)
class ForceSeries:
    """One trial's missing force by equation [SI], its standard error, its terms, and signals."""

    trial: str
    t: Vector
    force: Mapping[str, Vector]
    error: Mapping[str, Vector]
    terms: Mapping[str, Vector]
    signals: Mapping[str, Vector]


def missing_force_data(found: MissingForce) -> dict[str, Any]:
    """What goes into `result.json`."""
    return {
        "equations": [_equation(e) for e in found.equations],
        "named": found.named,
        "possible": list(found.possible),
        "effects": list(found.effects),
        "sentence": found.sentence,
    }


def _equation(e: Equation) -> dict[str, Any]:
    return {
        "equation": e.row,
        "unit": UNITS[e.row],
        "explains": e.explains,
        "log_likelihood_ratio": 0.5 * e.gain,
        "p_value": e.p_value,
        "shape": [_term(t) for t in e.shape.terms],
        "symmetry": e.shape.symmetry if e.shape.terms else None,
        "signals": list(e.shape.signals),
        "shape_explains": e.shape.explains if e.shape.terms else None,
        "terms_tried": len(e.shape.tried),
        "sentence": e.shape.sentence if e.shape.tried else "no more than noise would show",
    }


def _term(t: ShapeTerm) -> dict[str, Any]:
    return {
        "name": t.name,
        "term": t.term.words,
        "coefficient": t.coefficient,
        "standard_error": t.error,
        "share": t.share,
        "p_value": t.p_value,
        "symmetry": t.term.mirror,
        "rivals": [r.words for r in t.rivals],
    }
