"""A waterjet beside its jet: what its bucket throws ahead, and what its water takes in speed."""

from collections.abc import Iterator, Sequence

from trialid.effects.actuators.instances import (
    GAIN_UNITS,
    advance_gain,
    make_effect,
    own_name,
    typical_gain,
)
from trialid.effects.actuators.push_kinds import Push, thrust
from trialid.effects.actuators.pushes import driven, total, turned
from trialid.maths import Number, cos, sin
from trialid.ship.actuators import Actuator
from trialid.ship.effect import Effect, Force, Parameter
from trialid.ship.particulars import Ship

ALLISON = "Allison (1993), Marine waterjet propulsion, SNAME Transactions 101"
GAIN = "k_bucket"
TAKEN_IN = "k_jet_advance"


def jet_effects(ship: Ship) -> Iterator[Effect]:
    """Of all her waterjets: thrust lost to the speed, and the bucket."""
    jets = [one for one in ship.actuators if one.kind == "waterjet"]
    if jets:
        yield _advance(ship, jets)
        yield _bucket(ship, jets)


def _advance(ship: Ship, jets: Sequence[Actuator]) -> Effect:
    """The water that a jet takes in is brought to her speed: along her, however the jet points."""

    def advance(u: Number, **values: Number) -> Force:
        lost = {one: values[own_name(TAKEN_IN, one)] * abs(values[one.name]) * u for one in jets}
        return total([Force(X=-X, N=one.y * X) for one, X in lost.items()])

    return make_effect(
        advance,
        name="waterjets_advance",
        equation="X = -k_jet_advance |n| u: the water taken in is brought to her speed",
        source=ALLISON,
        signals=[*(one.name for one in jets), "u"],
        parameters={own_name(TAKEN_IN, one): advance_gain(ship, one) for one in jets},
    )


def _bucket(ship: Ship, jets: Sequence[Actuator]) -> Effect:
    """One for all jets whose bucket is on record: b of 0 leaves the jet, 1 turns all of it.

    With k_bucket as large as k_jet_ahead a closed bucket takes all thrust away, with more of it she
    goes astern.
    """

    def bucket(**values: Number) -> Force:
        forces = []
        for one in jets:
            by, k = driven(one, values), values[own_name(GAIN, one)]
            back = -values[one.bucket] * thrust(by, k, 0.0)
            forces.append(turned(one, Push(back * cos(by.angle), -back * sin(by.angle))))
        return total(forces)

    parameters = {
        own_name(GAIN, one): Parameter(
            1.5 * typical_gain(ship, one.command), GAIN_UNITS[one.command], low=0.0
        )
        for one in jets
    }
    return make_effect(
        bucket,
        name="waterjets_bucket",
        equation="T = -k_bucket b n^2, n ahead: what the bucket, closed at b = 1, throws ahead",
        source=ALLISON,
        signals=[s for one in jets for s in (*one.signals, one.bucket)],
        parameters=parameters,
    )
