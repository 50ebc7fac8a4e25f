"""What may be wrong with one actuator of several, each a candidate with its name in it.

All act on the recorded signal before it reaches the ship, so that one fault fits every kind. The
ranges keep them apart: what is weak has lost a share of its force, what is reversed all and more;
its partner may not be the stronger for it, which is how port and starboard are told apart.
"""

import math
from collections.abc import Callable, Collection, Iterator
from itertools import combinations

from trialid.effects.actuators.instances import (
    GAIN_UNITS,
    NOWHERE,
    make_effect,
    typical_drive,
    typical_gain,
)
from trialid.effects.actuators.push_kinds import Driven, Push, thrust
from trialid.effects.actuators.pushes import turned
from trialid.maths import Number, sqrt
from trialid.ship.actuators import COMMANDS, Actuator
from trialid.ship.effect import Delayed, Effect, Force, Parameter, Steered
from trialid.ship.particulars import Ship

SOURCE = "by its letters: a share, a time, an angle; ranges by judgement"
_REVERSED = Parameter(2.0, low=1.2, high=3.0, scan=(2.0,), by_meaning=True)
_STUCK = Parameter(1.0, low=0.8, high=1.2, scan=(1.0,), by_meaning=True)
_HELD = Parameter(0.05, "rad", low=-1.6, high=1.6, null=None)
_HELD_BUCKET = Parameter(0.5, low=-0.2, high=1.2, null=None)  # open and closed are inside
_HELD_THRUST = Parameter(0.25, low=-10.0, high=10.0, null=None)
_EXCHANGED = Parameter(1.0, low=0.7, high=1.3, scan=(1.0,), by_meaning=True)


def fault_effects(ship: Ship, ordered: Collection[str]) -> Iterator[Effect]:
    """Each of a ship's actuators weak, reversed, late, misaligned, stuck; alike ones exchanged.

    Parameters
    ----------
    ordered
        Signals of which the order is recorded.
    """
    for one in ship.actuators:
        yield _weak(one)
        yield _reversed(one)
        yield _late(one, ordered)
        yield _turned_angle(one) if one.angle else _turned_thrust(ship, one)
        for signal in (*one.signals, *_buckets(one)):
            yield _stuck(ship, one, signal)
    for one, other in combinations(ship.actuators, 2):
        if one.kind == other.kind and one.command == other.command:
            yield _exchanged(one, other)


def _scaled(one: Actuator, parameter: str) -> Callable[..., Steered]:
    """The signal scaled so that the force is 1 - parameter of what it was; of a share the share.

    Of revolutions thrust goes with the square. Of a share of full nobody knows with which power of
    it: an outsider's boat whose thrust goes with the share itself had one thruster weak by 0.51
    where 0.30 of its force was lost.
    """
    square = one.kind != "rudder" and one.command == "revolutions"

    def scale(**values: Number) -> Steered:
        left = 1.0 - values[parameter]
        factor = left / sqrt(abs(left) + NOWHERE) if square else left
        return Steered(**{one.name: (factor - 1.0) * values[one.name]})

    return scale


def _what(one: Actuator) -> str:
    """What of it is scaled."""
    by_share = one.kind != "rudder" and one.command == "share"
    return f"{'share of full' if by_share else 'force'} of {one.name}"


def _weak(one: Actuator) -> Effect:
    return make_effect(
        _scaled(one, f"weak_{one.name}"),
        name=f"{one.name}_weak",
        equation=f"{_what(one)} times 1 - weak_{one.name}: weak, dead at 1",
        source=SOURCE,
        signals=[one.name],
        parameters={f"weak_{one.name}": Parameter(0.2, low=0.0, high=1.0, by_meaning=True)},
    )


def _reversed(one: Actuator) -> Effect:
    return make_effect(
        _scaled(one, f"reversed_{one.name}"),
        name=f"{one.name}_reversed",
        equation=f"{_what(one)} times 1 - reversed_{one.name}: the other way round at 2",
        source=SOURCE,
        signals=[one.name],
        parameters={f"reversed_{one.name}": _REVERSED},
    )


def _late(one: Actuator, ordered: Collection[str]) -> Effect:
    """Whatever drives or turns it, and its order, which is all there is where a lag follows it."""
    tau = f"tau_{one.name}"
    late_signals = [*one.signals, *(f"{s}_order" for s in one.signals if s in ordered)]

    def late(**values: Number) -> Delayed:
        return Delayed(**dict.fromkeys(late_signals, values[tau]))

    return make_effect(
        late,
        name=f"{one.name}_late",
        equation=f"{one.name} acts at t what is recorded at t - {tau}: a late gear or clock",
        source=SOURCE,
        signals=[],
        parameters={tau: Parameter(0.5, "s", low=0.0, high=5.0)},
    )


def _turned_angle(one: Actuator) -> Effect:
    skew = f"skew_{one.name}"

    def misaligned(**values: Number) -> Steered:
        return Steered(**{one.angle: values[skew]})

    return make_effect(
        misaligned,
        name=f"{one.name}_misaligned",
        equation=f"angle of {one.name} = angle + {skew}: its zero is not the ship's",
        source=SOURCE,
        signals=[],
        parameters={skew: Parameter(0.05, "rad", low=-0.7, high=0.7)},
    )


def _stuck(ship: Ship, one: Actuator, signal: str) -> Effect:
    """It stays, whatever the record shows: an order, or a feedback that is torn off."""
    name = _called(one, signal)
    stuck, held = f"stuck_{name}", f"held_{name}"
    if signal == one.drive:
        what, value, kept = _held_drive(ship, one, held)
    else:
        what, value, kept = f"{signal} = {held}", _itself, _held_as(one, signal)

    def stays(**values: Number) -> Steered:
        return Steered(**{signal: values[stuck] * (value(values[held]) - values[signal])})

    return make_effect(
        stays,
        name=f"{name}_stuck",
        equation=f"{what} at {stuck} = 1: {signal} does not change",
        source=SOURCE,
        signals=[signal],
        parameters={stuck: _STUCK, held: kept},
    )


def _buckets(one: Actuator) -> tuple[str, ...]:
    return (one.bucket,) if one.kind == "waterjet" else ()


def _called(one: Actuator, signal: str) -> str:
    """What is stuck, in its name: the actuator where it is steered, else the part with it."""
    if signal in _buckets(one):
        return one.bucket
    return one.name if signal == one.signals[-1] else f"{one.name}_{one.command}"


def _held_as(one: Actuator, signal: str) -> Parameter:
    return _HELD_BUCKET if signal in _buckets(one) else _HELD


def _itself(held: Number) -> Number:
    """What is held of an angle or a bucket."""
    return held


def _held_drive(
    ship: Ship, one: Actuator, held: str
) -> tuple[str, Callable[[Number], Number], Parameter]:
    """What is held of a drive: a share of its thrust, whose slope does not vanish at rest.

    Of a share of full, whose thrust goes with no known power of it, of its square.
    """
    full = one.limit if math.isfinite(one.limit) else typical_drive(ship, one.command)

    def drive(share: Number) -> Number:
        return full * (share if one.command == "thrust" else share / sqrt(abs(share) + NOWHERE))

    by_share = one.command == "share"
    unit = "" if by_share else f" {COMMANDS[one.command]}"
    what = "its square" if by_share else "thrust"
    return f"{what} = {held} of that at {full:.3g}{unit}", drive, _HELD_THRUST


def _turned_thrust(ship: Ship, one: Actuator) -> Effect:
    """A fixed one has no angle on record: what it pushes aside is a gain of its own."""
    aside = f"aside_{one.name}"

    def misaligned(**values: Number) -> Force:
        k = values[aside]
        return turned(one, Push(0.0, thrust(Driven(one.command, values[one.name], 0.0, 0.0), k, k)))

    size = typical_gain(ship, one.command)
    return make_effect(
        misaligned,
        name=f"{one.name}_misaligned",
        equation=f"T = {aside} n |n| to the right of {one.name}: a push askew",
        source=SOURCE,
        signals=[one.name],
        parameters={aside: Parameter(0.05 * size, GAIN_UNITS[one.command])},
    )


def _exchanged(one: Actuator, other: Actuator) -> Effect:
    e = f"swap_{one.name}_{other.name}"
    pairs = [*zip(one.signals, other.signals, strict=True)]

    def exchanged(**values: Number) -> Steered:
        moved = {a: values[e] * (values[b] - values[a]) for a, b in pairs}
        return Steered(**moved, **{b: -moved[a] for a, b in pairs})

    return make_effect(
        exchanged,
        name=f"{one.name}_{other.name}_exchanged",
        equation=f"{one.name} acts as {other.name} is recorded, and the other way round, at 1",
        source="channels or cables exchanged",
        signals=[s for pair in pairs for s in pair],
        parameters={e: _EXCHANGED},
    )
