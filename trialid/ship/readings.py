"""What the sensors make of a motion, as the simulator and the reader see it."""

from collections.abc import Mapping
from dataclasses import dataclass

from trialid.errors import EffectError
from trialid.maths import Number, arctan, cos, sin, sqrt
from trialid.names.quantities import ACCELERATIONS, POSITION
from trialid.ship.effect import SENSORS, Delayed, Effect, Lagged, Measured
from trialid.ship.model import STANDSTILL, ShipModel
from trialid.ship.signals_now import measured_by, signals_now, values_for


@dataclass(frozen=True)
class Readings:
    """What the sensors make of a motion, on any kind of number.

    Attributes
    ----------
    measured
        Signal to what is recorded of it, before delay and low-pass.
    delay
        Output to its delay [s].
    lags
        Output to the time constants of its sensor's low-passes [s].
    """

    measured: Mapping[str, Number]
    delay: Mapping[str, Number]
    lags: Mapping[str, tuple[Number, ...]]


def readings(
    model: ShipModel,
    states: Mapping[str, Number],
    inputs: Mapping[str, Number],
    theta: Mapping[str, Number],
    rates: Mapping[str, Number],
) -> Readings:
    """What is recorded of one instant; `rates` are the time derivatives of the states."""
    recorded: dict[str, Number] = {**model.ship.particulars, **inputs, **states}
    recorded |= {a: rates.get(a[0], 0.0) for a in ACCELERATIONS}
    recorded |= {f"{a}_dot": rates[a] for a in POSITION if a in rates}
    signals = signals_now(model, recorded, theta)
    measured = {**recorded, "U": signals["U"]} | _felt(recorded, rates)
    measured |= dict.fromkeys(_from_reference(model), 0.0)
    delay, lags = dict[str, Number](), dict[str, tuple[Number, ...]]()
    for effect in model.effects:
        if not set(SENSORS) & set(effect.forms):
            continue
        seen = measured_by(effect, recorded, signals)
        for part in effect(values_for(model, effect, seen, theta)):
            match part:
                case Measured():
                    _check_known(effect, part, measured)
                    measured |= {n: measured[n] + x for n, x in part.items()}
                case Delayed():
                    delay |= {n: delay.get(n, 0.0) + x for n, x in part.items()}
                case Lagged():
                    lags |= {n: (*lags.get(n, ()), x) for n, x in part.items()}
    return Readings(measured | _course(measured), delay, lags)


def _felt(recorded: Mapping[str, Number], rates: Mapping[str, Number]) -> dict[str, Number]:
    """What accelerometers at the origin feel, gravity with it; of one elsewhere an effect tells."""
    felt = dict[str, Number]()
    if {"v", "r"} <= {*recorded} and "u" in rates:
        felt["a_x"] = rates["u"] - recorded["v"] * recorded["r"]
    if {"r", "phi"} <= {*recorded} and "v" in rates:
        turning = recorded["u"] * recorded["r"]
        felt["a_y"] = rates["v"] + turning - recorded["g"] * sin(recorded["phi"])
    return felt


def _course(measured: Mapping[str, Number]) -> dict[str, Number]:
    """Speed and course over ground; the course goes on with the heading beyond 180 deg.

    It has no number where she drives straight astern over the ground.
    """
    if not {"x_dot", "y_dot", "psi"} <= {*measured}:
        return {}
    north, east, psi = (measured[n] for n in ("x_dot", "y_dot", "psi"))
    sog = sqrt(north * north + east * east + STANDSTILL**2)
    ahead, aside = north * cos(psi) + east * sin(psi), east * cos(psi) - north * sin(psi)
    return {"sog": sog, "cog": psi + 2.0 * arctan(aside / (sog + ahead))}


def _from_reference(model: ShipModel) -> tuple[str, ...]:
    """Signals that a reference sensor gives alone: their record is what is to be explained."""
    return tuple(
        n
        for e in model.effects
        for n in e.acts_on(Measured)
        if f"{n}_ref" in e.signals and n not in model.all_states
    )


def _check_known(effect: Effect, part: Measured, measured: Mapping[str, Number]) -> None:
    """Refuse what is added to a record that nothing gives."""
    for name in part:
        if name not in measured:
            raise EffectError(
                f"{effect.place} adds to the measurement of {name!r}, which the model neither "
                f"simulates nor reads; leave the effect out, or simulate {name!r}"
            )
