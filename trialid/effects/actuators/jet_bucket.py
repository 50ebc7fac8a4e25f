"""The bucket of a waterjet: what it takes from the jet and throws ahead."""

from collections.abc import Iterator

from trialid.effects.actuators.instances import GAIN_UNITS, make_effect, own_name, typical_gain
from trialid.effects.actuators.push_kinds import Push, thrust
from trialid.effects.actuators.pushes import driven, total, turned
from trialid.maths import Number, cos, sin
from trialid.ship.effect import Effect, Force, Parameter
from trialid.ship.particulars import Ship

ALLISON = "Allison (1993), Marine waterjet propulsion, SNAME Transactions 101: reversing buckets"
GAIN = "k_bucket"


def bucket_effects(ship: Ship) -> Iterator[Effect]:
    """One for all jets whose bucket is on record: b of 0 leaves the jet, 1 turns all of it.

    With k_bucket as large as k_jet_ahead a closed bucket takes all thrust away, with more of it she
    goes astern.
    """
    jets = [one for one in ship.actuators if one.kind == "waterjet"]
    if not jets:
        return

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
    yield make_effect(
        bucket,
        name="waterjets_bucket",
        equation="T = -k_bucket b n^2, n ahead: what the bucket, closed at b = 1, throws ahead",
        source=ALLISON,
        signals=[s for one in jets for s in (*one.signals, one.bucket)],
        parameters=parameters,
    )
