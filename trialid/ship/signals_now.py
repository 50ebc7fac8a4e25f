"""Signals of one instant: as they act on the ship, and as an effect sees them."""

from collections.abc import Mapping

from trialid.maths import Number, sqrt
from trialid.ship.effect import Delayed, Effect, Force, Steered
from trialid.ship.model import STANDSTILL, ShipModel, late, slope
from trialid.ship.prime import prime_parameter, prime_signal


def signals_now(
    model: ShipModel, recorded: Mapping[str, Number], theta: Mapping[str, Number]
) -> dict[str, Number]:
    """States and inputs as they act on the ship, particulars and the speed U; SI."""
    return through_gear(model, inputs_now(model, recorded, theta), theta)


def inputs_now(
    model: ShipModel, recorded: Mapping[str, Number], theta: Mapping[str, Number]
) -> dict[str, Number]:
    """What is recorded, with inputs that act later than they are as they come to the gear; SI."""
    signals = dict(recorded)
    for name, tau in _late_by(model, signals, theta).items():
        # the record comes shifted by the current delay: the value stands, and so does the slope
        signals[name] = signals[name] + (tau - signals[late(name)]) * signals[slope(name)]
    return signals


def through_gear(
    model: ShipModel, arrived: Mapping[str, Number], theta: Mapping[str, Number]
) -> dict[str, Number]:
    """What comes to the gear, as the gear lets it act on the ship, and the speed U; SI."""
    signals = dict(arrived)
    # what follows by a law of its own does before what is added to it: a play, then an offset
    for effect in sorted(model.effects, key=lambda e: not e.states):
        if Steered in effect.forms:
            for part in effect({**signals, **theta}):
                if isinstance(part, Steered):
                    signals |= {n: signals[n] + x for n, x in part.items()}
    u, v = signals["u"], signals.get("v", 0.0)
    signals["U"] = sqrt(u * u + v * v + STANDSTILL**2)
    return signals


def _late_by(
    model: ShipModel, signals: Mapping[str, Number], theta: Mapping[str, Number]
) -> dict[str, Number]:
    """By how much each late input is late [s]."""
    total: dict[str, Number] = {}
    for effect in model.effects if model.late_inputs else ():
        if Delayed in effect.forms and set(effect.acts_on(Delayed)) & set(model.late_inputs):
            for part in effect({**signals, **theta}):
                if isinstance(part, Delayed):
                    total |= {n: total.get(n, 0.0) + x for n, x in part.items()}
    return {n: x for n, x in total.items() if n in model.late_inputs}


def values_for(
    model: ShipModel, effect: Effect, signals: Mapping[str, Number], theta: Mapping[str, Number]
) -> dict[str, Number]:
    """Signals and parameters in the effect's own system."""
    if effect.system == "SI":
        return {**signals, **theta}
    L, U = model.ship.particulars["L"], signals["U"]
    values = {s: prime_signal(s, signals[s], L, U) for s in effect.signals}
    return values | {n: prime_parameter(effect, n, theta[n], L, U) for n in effect.parameters}


def measured_by(
    effect: Effect, known: Mapping[str, Number], acting: Mapping[str, Number]
) -> Mapping[str, Number]:
    """What an effect sees: forces the acting rudder, others the one that is known to them.

    Sensors know it as it is recorded, steering gear as it comes there.
    """
    return acting if Force in effect.forms else {**known, "U": acting["U"]}
