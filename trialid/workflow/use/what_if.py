"""The fitted ship with something changed, and what the record says of that."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Final

from trialid.design.following import sailed_ship
from trialid.design.helm import Vessel, vessel
from trialid.design.prediction.likely_spread import LikelySpread
from trialid.design.prediction.seen_range import SeenRange
from trialid.errors import TrialidError, nearest
from trialid.names import labels
from trialid.names.quantities import SIGNALS
from trialid.names.wording import shown_unit
from trialid.ship.model import ShipModel
from trialid.workflow.use.finished_model import FinishedModel

ROLL: Final = ("GM", "I_xx")
"""Righting moment and inertia, of which a ship that rolls tells the ratio."""

SPEED: Final = "speed"
"""What the approach speed [m/s] is called among changes."""
OTHER: Final = 50.0
"""Times her own speed, either way, that a changed one may be: beyond it no number of hers holds."""


@dataclass(frozen=True)
class WhatIf:
    """What is changed: numbers by name, and effects that are left out.

    `values` are parameters in the unit of the report, inputs that are held [SI], or `speed` [m/s].
    """

    values: Mapping[str, float] = field(default_factory=dict)
    without: tuple[str, ...] = ()


AS_FITTED: Final = WhatIf()


def read_changes(texts: Sequence[str], without: Sequence[str]) -> WhatIf:
    """Changes as they are written: `GM=0.8`.

    Raises
    ------
    TrialidError
        One is no name and number.
    """
    values = dict[str, float]()
    for text in texts:
        name, equals, number = text.partition("=")
        try:
            values[name.strip()] = float(number)
        except ValueError as error:
            raise TrialidError(
                f"--what-if {text!r}: expected a name and a number, as GM=0.8 or speed=5"
                + ("" if equals else "; there is no =")
            ) from error
        if not math.isfinite(values[name.strip()]):
            raise TrialidError(f"--what-if {text!r}: expected a finite number")
    return WhatIf(values, tuple(without))


def changed_ship(ship: Vessel, asked: WhatIf) -> Vessel:
    """The ship with the changes.

    Raises
    ------
    TrialidError
        She has nothing of that name, or it follows from something else.
    """
    if asked == AS_FITTED:
        return ship
    model, constants = ship.model, dict(ship.constants)
    for name in asked.without:
        model = model - name
    for name, value in asked.values.items():
        if name in (SPEED, "u"):
            model = _at_speed(model, value)
            constants |= {"u": value}
        elif name in model.parameters:
            model = model.with_values({name: value / _shown(model, name)[1]})
        elif name in constants and name in model.recorded:
            constants[name] = value
        else:
            known = [SPEED, *model.parameters, *(n for n in constants if n in model.recorded)]
            raise TrialidError(
                f"--what-if {name}: the model has no such parameter or input held; "
                f"{nearest(name, known)}"
            )
    return vessel(model, ship.period, constants, ship.rudder_rate)


def _shown(model: ShipModel, name: str) -> tuple[str, float]:
    """The unit in which a report shows a parameter, after a blank, and the factor to it."""
    unit, factor = shown_unit(model.parameters[name].unit)
    return ("" if unit == "1" else f" {unit}"), factor


def _at_speed(model: ShipModel, speed: float) -> ShipModel:
    """The model approaching at another speed; numbers in the prime system stay as they are."""
    usual = model.ship.particulars.get("U0", 0.0)
    if not speed > 0.0:
        raise TrialidError(f"--what-if speed={speed:g}: expected a speed above 0 [m/s]")
    if usual > 0.0 and not usual / OTHER < speed < usual * OTHER:
        raise TrialidError(
            f"--what-if speed={speed:g}: she sails at {usual:.3g} m/s; expected "
            f"{usual / OTHER:.2g} to {usual * OTHER:.3g} [m/s]"
        )
    if "u" in model.states:
        raise TrialidError(
            "--what-if speed: this model simulates the speed, which follows from the shaft; "
            "give the shaft speed instead, n=... [rad/s]"
        )
    particulars = {**model.ship.particulars, "U0": speed}
    return replace(model, ship=replace(model.ship, particulars=particulars))


def known_changes(spread: LikelySpread, asked: WhatIf) -> LikelySpread:
    """What is uncertain where numbers are stated: they are not."""
    stated = {*asked.values}
    fitted = tuple("" if n in stated else n for n in spread.fitted)
    return replace(spread, fitted=fitted, held=tuple("" if n in stated else n for n in spread.held))


def change_words(model: FinishedModel, asked: WhatIf) -> tuple[str, ...]:
    """What the record says of each change, a sentence each."""
    said = [_of_effect(model, name) for name in asked.without]
    said += [_of_value(model, name, value) for name, value in asked.values.items()]
    if any(name not in (SPEED, "u") and name not in SIGNALS for name in asked.values):
        said.append("All else is held as fitted, though in a ship it may change with that.")
        said += _of_roll(model.fit.model, asked.values)
    return tuple(said)


def _of_roll(model: ShipModel, values: Mapping[str, float]) -> list[str]:
    """That one of two is changed of which a roll tells the ratio alone."""
    changed = {*ROLL} & {*values}
    if "phi" not in model.states or len(changed) != 1 or not {*ROLL} <= {*model.parameters}:
        return []
    [name] = changed
    [held] = {*ROLL} - changed
    ratio = values[name] / _shown(model, name)[1] / model.value(name)
    times = ratio if name == "GM" else 1.0 / ratio
    return [
        f"{held} is held: of {' and '.join(ROLL)} a roll tells the ratio alone, which is now "
        f"{times:.3g} times the record's."
    ]


def _of_effect(model: FinishedModel, name: str) -> str:
    """Whether the record allows a ship without an effect of the model."""
    effect = next(e for e in model.fit.model.effects if e.name == name)
    rows = [row for row in model.result.physical if row.name in effect.parameters]
    apart = [r for r in rows if r.likely is not None and not r.likely[0] <= 0.0 <= r.likely[1]]
    if apart:
        listed = ", ".join(_likely(r.name, r.likely, r.unit) for r in apart)
        return f"What if without {name}: the record speaks against it ({listed})."
    if not rows:
        return f"What if without {name}: the record was not asked, its numbers were held fixed."
    return f"What if without {name}: the record cannot tell such a ship from this one."


def _of_value(model: FinishedModel, name: str, value: float) -> str:
    if name in (SPEED, "u") or name in SIGNALS:
        signal = "u" if name == SPEED else name
        return f"What if {name} = {labels.shown_text(signal, value)}: {_seen(model, signal, value)}"
    row = next((r for r in model.result.physical if r.name == name), None)
    own = name in model.fit.model.parameters
    sailed = model.fit.model if own else sailed_ship(model.fit).model
    unit, factor = _shown(sailed, name)
    stated = f"What if {name} = {value:g}{unit}"
    if row is None:
        before = f"{factor * sailed.value(name):.4g}{unit}"
        held = f"held at {before} in the fit, not asked of it"
        return f"{stated}: {held if own else f'{before} as in the trials, over all of them'}."
    if row.likely is None:
        fitted = factor * model.fit.value(name)
        return f"{stated}: fitted {fitted:.4g}{unit}, nobody knows how sure."
    within = row.likely[0] <= value / factor <= row.likely[1]
    says = "which the record allows" if within else "another ship or loading than the record's"
    return f"{stated}: {says} ({_likely(name, row.likely, row.unit)})."


def _seen(model: FinishedModel, signal: str, value: float) -> str:
    known: SeenRange | None = model.seen.get(signal)
    if known is None:
        return "no trial holds it."
    ends = " to ".join(labels.shown_text(signal, x) for x in (known.low, known.high))
    return f"{'within' if known.holds(value) else 'beyond'} what the trials hold, {ends}."


def _likely(name: str, ends: tuple[float, float] | None, unit: str) -> str:
    shown, factor = shown_unit(unit)
    low, high = (factor * x for x in ends or (float("nan"), float("nan")))
    return f"{name} likely {low:.4g} to {high:.4g}{'' if shown == '1' else f' {shown}'}"
