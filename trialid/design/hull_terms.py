"""The hull of a fitted ship in terms that simulators of vehicles take, and what those leave out.

Gazebo's Hydrodynamics plugin knows forces that are linear and quadratic in the velocities, nothing
that goes by heel, by rudder or by the speed in another way. Each effect of the hull is projected on
such terms by least squares, over velocities drawn evenly from what the trials hold; what an effect
has in those terms already is found as it is.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.prediction.seen_range import SeenRange
from trialid.maths import Number
from trialid.names.quantities import PARTICULARS
from trialid.ship.effect import Effect, Force
from trialid.ship.model import ShipModel
from trialid.ship.motion import effect_parts

Term = tuple[str, str, bool]
"""Two velocities of a product, the first by its size where told so; `("", "p", False)` is p."""

EVEN: Final = tuple((a, b, a == b == "u") for a, b in ("uu", "vv", "vr", "rr"))
ODD: Final = (
    *((a, b, True) for a, b in ("uv", "ur", "up", "vv", "rv", "vr", "rr", "pp")),
    ("", "p", False),
)
ROWS: Final[Mapping[str, tuple[str, tuple[Term, ...]]]] = {
    "X": ("u", EVEN),
    "Y": ("v", ODD),
    "K": ("p", ODD),
    "N": ("r", ODD),
}
"""Force to the motion that it drives and its terms: fore and aft forces do not know sides."""
HULL: Final = frozenset({"u", "v", "p", "r", "phi", *PARTICULARS})
"""What an effect may read and still be of the hull."""
NUMBER: Final = 4000
KEPT: Final = 0.01
"""Share of an effect's force that may be left out of it and still count as whole."""
RESTORING: Final = "GM"
"""Parameter of the moment that a buoyant hull has by itself in a simulator."""


@dataclass(frozen=True)
class HullTerms:
    """The hull in linear and quadratic terms.

    Attributes
    ----------
    values
        By force, then term [SI].
    left_out
        Share of each effect's force that is in none of them, by name, heel apart.
    heeled
        Effects whose part that goes by heel is left out.
    elsewhere
        Effects that act on the ship and are no part of the hull: rudder, propeller, wind.
    """

    values: Mapping[str, Mapping[Term, float]]
    left_out: Mapping[str, float]
    heeled: tuple[str, ...]
    elsewhere: tuple[str, ...]


def hull_terms(
    model: ShipModel, seen: Mapping[str, SeenRange], constants: Mapping[str, float]
) -> HullTerms:
    """Every effect of the hull of a fitted ship in terms of her velocities.

    Parameters
    ----------
    seen
        What the trials hold of motions and inputs [SI].
    constants
        What inputs beside the speed are held at while the hull's are looked at.
    """
    drawn = _drawn(model, seen)
    forces = _forces(model, {**constants, **drawn, "phi": np.zeros(NUMBER)})
    heel = seen["phi"].high if "phi" in seen else 0.0
    heeled = _forces(model, {**constants, **drawn, "phi": np.full(NUMBER, heel)})
    values: dict[str, dict[Term, float]] = {row: {} for row in ROWS}
    left_out = dict[str, float]()
    for name, by_row in forces.items():
        whole = rest = 0.0
        for row, force in by_row.items():
            found = _projected(row, force, drawn, model.states)
            for term, value in found.items():
                values[row][term] = values[row].get(term, 0.0) + value
            scale = float(np.sqrt(np.mean(_sum(found, drawn) ** 2))) or 1.0
            whole += float(np.mean(force**2)) / scale**2
            rest += float(np.mean((force - _sum(found, drawn)) ** 2)) / scale**2
        left_out[name] = float(np.sqrt(rest / whole)) if whole else 0.0
    by_heel = [n for n in forces if _differs(forces[n], heeled[n]) and not _restores(model, n)]
    acting = [e.name for e in model.effects if Force in e.forms and e.name not in forces]
    return HullTerms(values, left_out, tuple(by_heel), tuple(acting))


def is_hull(effect: Effect) -> bool:
    """Whether an effect's forces follow from the ship's own motion."""
    return Force in effect.forms and not {*effect.signals} - HULL


def _drawn(model: ShipModel, seen: Mapping[str, SeenRange]) -> dict[str, Vector]:
    """Velocities drawn evenly from what the trials hold; none that is not simulated, but u."""
    rng = np.random.default_rng(0)
    speed = model.ship.particulars["U0"]
    found = {}
    for name in ("u", "v", "p", "r"):
        known = seen.get(name, SeenRange(speed, speed) if name == "u" else SeenRange(0.0, 0.0))
        found[name] = rng.uniform(known.low, known.high, NUMBER)
    return found


def _forces(model: ShipModel, signals: Mapping[str, Number]) -> dict[str, dict[str, Vector]]:
    """Forces of every effect of the hull on what is simulated [SI], by effect and row."""
    theta = {n: model.value(n) for n in model.parameters}
    states = {s: signals.get(s, 0.0) for s in model.all_states}
    inputs = {n: signals.get(n, 0.0) for n in model.recorded}
    rows = [row for row, (state, _) in ROWS.items() if state in model.states]
    return {
        effect.name: {
            row: np.broadcast_to(np.asarray(getattr(part, row), dtype=np.float64), NUMBER)
            for row in rows
        }
        for effect, part in effect_parts(model, states, inputs, theta)
        if isinstance(part, Force) and is_hull(effect)
    }


def _projected(
    row: str, force: Vector, drawn: Mapping[str, Vector], states: Sequence[str]
) -> dict[Term, float]:
    """Coefficients of the terms that a force has; those that are nothing are left out."""
    known = {"u", *states}
    terms = [t for t in ROWS[row][1] if {*t[:2]} - {""} <= known]
    columns = np.column_stack([product(t, drawn) for t in terms])
    sizes = np.sqrt(np.mean(columns**2, axis=0))
    sizes = np.where(sizes > 0.0, sizes, 1.0)
    found, *_ = np.linalg.lstsq(columns / sizes, force, rcond=1e-9)
    least = 1e-9 * float(np.max(np.abs(force), initial=0.0))
    return {
        t: float(x / size) for t, x, size in zip(terms, found, sizes, strict=True) if abs(x) > least
    }


def product(term: Term, signals: Mapping[str, Number]) -> Number:
    """A term of the velocities."""
    first, second, by_size = term
    if not first:
        return signals[second]
    return (abs(signals[first]) if by_size else signals[first]) * signals[second]


def _sum(values: Mapping[Term, float], drawn: Mapping[str, Vector]) -> Vector:
    total = np.zeros(NUMBER)
    for term, value in values.items():
        total += value * np.asarray(product(term, drawn))
    return total


def _differs(one: Mapping[str, Vector], other: Mapping[str, Vector]) -> bool:
    """Whether heel changes a force."""
    return any(not np.allclose(other[row], one[row], rtol=1e-9, atol=0.0) for row in one)


def _restores(model: ShipModel, name: str) -> bool:
    """Whether what goes by heel in an effect is the righting moment of a hull afloat."""
    return RESTORING in next(e for e in model.effects if e.name == name).parameters


def in_hull_terms(model: ShipModel, terms: HullTerms) -> ShipModel:
    """The ship with her hull in these terms; rudder, propeller and sensors as they are."""
    righting = model.value(RESTORING) if RESTORING in model.parameters else 0.0
    hull = [e for e in model.effects if is_hull(e)]
    kept = model
    for effect in hull:
        kept = kept - effect.name
    return kept + _as_effect(terms, righting, "phi" in model.states)


def _as_effect(terms: HullTerms, righting: float, rolls: bool) -> Effect:
    signals = {s for by in terms.values.values() for t in by for s in t[:2] if s}
    signals |= {"u", *({"phi", "rho", "g", "nabla"} if rolls else ())}

    def hull(**values: Number) -> Force:
        """The hull, linear and quadratic in the velocities."""
        totals: dict[str, Number] = {}
        for row, by in terms.values.items():
            total: Number = 0.0
            for term, value in by.items():
                total = total + value * product(term, values)
            totals[row] = total
        if rolls:
            weight = values["rho"] * values["g"] * values["nabla"]
            totals["K"] = totals["K"] - weight * righting * values["phi"]
        return Force(**totals)

    return Effect(
        name="hull_terms",
        function=hull,
        signals=tuple(sorted(signals)),
        parameters={},
        states={},
        forms=(Force,),
        system="SI",
        source="projection of the fitted hull",
    )
