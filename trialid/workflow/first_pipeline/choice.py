"""Which channel a starter pipeline takes for each signal, how it is read, and why."""

import dataclasses
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trialid.identification.approach import APPROACH
from trialid.inspection import channel_names, name_words
from trialid.inspection.drives import of_some_steering
from trialid.inspection.inspected import ChannelInspection, Inspection
from trialid.inspection.own_scale import why_no_angle
from trialid.inspection.positions import approach_by_positions
from trialid.inspection.relations import side, slope_agreement, unit_of_rate, unit_of_speed
from trialid.inspection.speed_letters import of_either
from trialid.names import units
from trialid.names.quantities import SIGNALS
from trialid.workflow.first_pipeline.chosen import (
    AS_RADIANS,
    ASK_COUNTS,
    ASK_FULL,
    ASK_PERCENT,
    ASK_SIDE,
    ASK_STEERING,
    ASK_UNIT,
    BY_NAME,
    CONVENTION,
    OF_FULL,
    OPEN,
    UNSAID,
    Chosen,
    Reason,
    Signal,
)
from trialid.workflow.first_pipeline.not_begun import no_signal

RUDDERS: Final = ("delta", "delta_order")
SURE: Final = 0.9
"""Correlation from which a rate of turn and a heading tell each other's side."""
BY_OTHERS: Final = "no unit is stated, but its size, jumps or turns, here or elsewhere, leave"
BY_SPEED: Final = "no unit is stated, but her positions or approach speed, here or elsewhere, leave"
GROUND: Final = "over ground"


def choose_signals(survey: Inspection, speed: float | None) -> Chosen:
    """What to take from a log; `speed` [m/s] is the user's own word for the approach speed.

    Raises
    ------
    TooLittle
        It holds no rudder, or no motion; the message names the channels to map by hand.
    """
    live = {name: live_sources(survey, name) for name in SIGNALS}
    rudder = next((name for name in RUDDERS if live[name]), None)
    motions = [name for name in ("r", "psi", "phi") if live[name]]
    if rudder is None or not {"r", "psi"} & {*motions}:
        missing = RUDDERS if rudder is None else ("r", "psi")
        raise no_signal(survey, missing)
    r = rate_signal(live) if live["r"] else None
    signals = [rudder_signal(rudder, live, r)]
    signals += [r] if r else [plain_signal("psi", live, "no yaw rate is logged")]
    signals += [plain_signal("phi", live, "")] if live["phi"] else []
    known, words = approach_speed(survey, live, speed)
    if ahead := choose_speed(survey, live, known, words):
        signals.append(ahead)
    return Chosen(
        survey=survey, path=survey.path, signals=tuple(signals), speed=known, speed_words=words
    )


PUSHES: Final = frozenset(("azimuth", "pod", "outboard", "drive", "jet", "motor", "nozzle"))
"""Words of an angle to which a push is turned, where a rudder's force goes as her speed squared."""
AS_RUDDER: Final = (
    "read as a rudder; a push that is turned, with its revolutions, is an azimuth of `trialid "
    "guide actuators`"
)


Live = dict[str, tuple[ChannelInspection, ...]]


STANDS: Final = ("h",)  # a trial has one depth of water, and the next may have another


def live_sources(survey: Inspection, quantity: str) -> tuple[ChannelInspection, ...]:
    """Sources that move, or may stand, and of which most is there."""
    moves = (c for c in survey.sources(quantity) if quantity in STANDS or not c.constant)
    return tuple(c for c in moves if c.mostly_there)


def plain_signal(quantity: str, live: Live, why: str) -> Signal:
    """The first source of a quantity as a signal, its unit as stated, or as it must be."""
    source, *others = live[quantity]
    unit, of_unit = _unit(source, quantity)
    taken = ", ".join(word for word in (source.guess.words if source.guess else "", why) if word)
    return Signal(
        quantity=quantity,
        source=source,
        unit=unit,
        taken=taken,
        of_unit=of_unit,
        others=tuple(others),
    )


def rate_signal(live: Live) -> Signal:
    """The yaw rate; a heading settles its side and, where the log states none, its unit."""
    plain = plain_signal("r", live, "")
    heading = next((h for h in live["psi"] if not h.constant), None)
    found = slope_agreement(plain.source, heading) if heading else 0.0
    unit, of_unit, of_side = plain.unit, plain.of_unit, UNSAID
    if heading and unit == OPEN and (measured := unit_of_rate(plain.source, heading)):
        unit, of_unit = measured, Reason(f"unit by the slope of {heading.key}", "measured")
    by_convention = plain.source.guess.positive if plain.source.guess else None
    positive = "port" if by_convention == "port" else None
    if heading and abs(found) > SURE:
        upside_down = _side_of(heading, plain.source) == "port"
        positive = "port" if (found < 0) != upside_down else None
        told = f"side by the slope of {heading.key} (correlation {found:+.2f})"
        of_side = Reason(told, "measured")
    return dataclasses.replace(
        plain, unit=unit, positive=positive, of_unit=of_unit, of_side=of_side
    )


def _side_of(heading: ChannelInspection, rate: ChannelInspection) -> str | None:
    """The side that a heading counts to by its name, or as the rate of its message does by its own.

    Of one message of ROS both count to port, though the heading alone says nothing of it.
    """
    own = heading.guess.positive if heading.guess else None
    message = [one.key.rpartition(".")[0].rpartition(".")[0] for one in (heading, rate)]
    if own is None and rate.guess is not None and message[0] == message[1] != "":
        return rate.guess.positive
    return own


def rudder_signal(name: str, live: Live, rate: Signal | None) -> Signal:
    """The rudder or its order, its side measured where the motion tells it."""
    plain = plain_signal(name, live, "")
    if PUSHES.intersection(name_words.words(plain.source.name)):
        plain = dataclasses.replace(plain, further=(*plain.further, AS_RUDDER))
    witness = rate.source if rate else live["psi"][0]
    plain = _on_own_scale(plain, witness)
    towards = (rate.positive or "starboard") if rate else None
    found = side(plain.source, witness, towards)
    convention = plain.source.guess.positive if plain.source.guess else None
    if found is not None:
        by = f"correlation with {found.by}, of {witness.key}, {found.strength:+.2f}"
        words = f"side measured: {by}"
        if convention is not None and convention != found.side:
            words += f", though the format says {convention}"
        measured = Reason(words, "measured")
        return dataclasses.replace(plain, positive=found.side, of_side=measured)
    if convention is not None:
        return dataclasses.replace(plain, positive=convention, of_side=CONVENTION)
    return dataclasses.replace(plain, positive=OPEN, of_side=ASK_SIDE)


def _on_own_scale(rudder: Signal, turning: ChannelInspection) -> Signal:
    """The rudder, and what to fill in where its numbers are no angle from amidships."""
    why = why_no_angle(rudder.source, turning)
    if not why:
        return rudder
    said = f"{rudder.source.low:.4g} to {rudder.source.high:.4g} {why}"
    if rudder.source.stated_unit is not None:
        told = f"CAREFUL: {said}; offset = less what that is"
        return dataclasses.replace(rudder, further=(*rudder.further, told))
    ask = Reason(f"{ASK_COUNTS}: {said}", "counts")
    return dataclasses.replace(rudder, unit=OPEN, of_unit=ask)


def is_counted(rudder: Signal) -> bool:
    """Whether it is on a scale of its own."""
    return rudder.of_unit.rests_on("counts")


def choose_speed(survey: Inspection, live: Live, known: float | None, told: str) -> Signal | None:
    """The speed through the water, else another; see `through_water` and `other_speed`."""
    if live["u"]:
        return through_water(live, known, told)
    return other_speed(survey, known, told)


def through_water(live: Live, known: float | None, told: str) -> Signal:
    """The speed through the water; where the log states no unit, a known speed settles it."""
    plain = plain_signal("u", live, "")
    unit = unit_of_speed(plain.source, known) if known and plain.unit == OPEN else None
    if known is None or unit is None:
        return plain
    return dataclasses.replace(plain, unit=unit, of_unit=_by_speed(known, told))


def _by_speed(known: float, told: str) -> Reason:
    return Reason(f"unit by a speed of {known:.3g} m/s, {told}")


def other_speed(survey: Inspection, known: float | None, told: str) -> Signal | None:
    """Another speed in the place of that through the water: it falls in turns as that does.

    Of one without a unit a known approach speed [m/s] settles it; `told` is where that is from.
    """
    unsaid = "of which its name does not say relative to what"
    for sources, words in ((_over_ground(survey), GROUND), (_some_speed(survey), unsaid)):
        for source in sources:
            why = (
                f"CAREFUL: a speed {words}, for want of one through the water; a current adds to it"
            )
            unit, of_unit = source.stated_unit, UNSAID
            if unit is None and (unit := source.unit_by_size) is not None:
                of_unit = Reason(f"{BY_SPEED} {unit}")
            elif unit is None and known is not None:
                unit, of_unit = unit_of_speed(source, known), _by_speed(known, told)
            if unit is not None:
                return Signal(
                    quantity="u",
                    source=source,
                    unit=unit,
                    taken=why,
                    of_unit=of_unit,
                    over_ground=words == GROUND,
                )
    return None


def approach_speed(
    survey: Inspection, live: Live, stated: float | None
) -> tuple[float | None, str]:
    """The approach speed [m/s], None where nothing tells it, and where it is from.

    In turns she loses up to two thirds of it: the middle of a turning circle is no approach.
    """
    if stated is not None:
        return stated, "as stated"
    through = [(c, "speed through the water") for c in live["u"]]
    ground = [(c, "speed over ground") for c in _over_ground(survey)]
    unsaid = [(c, "a speed, through water or over ground unsaid") for c in _some_speed(survey)]
    for source, words in (*through, *ground, *unsaid):
        if (unit := source.stated_unit or source.unit_by_size) is not None:
            fast = float(np.quantile(np.abs(source.sketch.y), APPROACH))
            said = f"what {source.key} seldom exceeds, {words}"
            return fast * units.factor(unit, "m/s"), said
    if (sailed := approach_by_positions(survey.channels.values())) is not None:
        return sailed, "over ground, by her positions"
    return None, ""


def speeds_of(survey: Inspection) -> Iterator[ChannelInspection]:
    """All that may be her speed: through the water, over ground, or unsaid."""
    yield from live_sources(survey, "u")
    yield from _over_ground(survey)
    yield from _some_speed(survey)


def _over_ground(survey: Inspection) -> Iterator[ChannelInspection]:
    for one in survey.channels.values():
        unit = one.stated_unit or "m/s"  # the name tells, where there is no unit
        told = (one.name, one.description)  # a format knows what its `Spd` is
        if not one.constant and any(channel_names.over_ground(w, unit) for w in told):
            yield one


def _some_speed(survey: Inspection) -> Iterator[ChannelInspection]:
    for one in survey.channels.values():
        unit = one.stated_unit or "m/s"
        if not one.constant and (of_either(one) or channel_names.of_some_speed(one.name, unit)):
            yield one


def _unit(source: ChannelInspection, quantity: str) -> tuple[str | None, Reason]:
    """The unit to write, and words of doubt; None for an angle of a quaternion."""
    if source.angle is not None:
        return None, UNSAID
    stated = source.stated_unit
    if stated == "%" and quantity in RUDDERS:
        return OPEN, ASK_PERCENT
    if stated is not None:
        return stated, UNSAID if source.unit else BY_NAME
    if quantity in RUDDERS:
        return _unit_of_rudder(source)
    unit = source.unit_by_size
    by = BY_SPEED if quantity in ("u", "v") else BY_OTHERS
    return (unit, Reason(f"{by} {unit}")) if unit is not None else (OPEN, ASK_UNIT)


def _unit_of_rudder(source: ChannelInspection) -> tuple[str, Reason]:
    """The unit of one whose log states none."""
    if of_some_steering(source):
        return OPEN, ASK_STEERING
    largest = max(abs(source.low), abs(source.high))
    if largest > 1.6:
        return "deg", Reason(f"no unit is stated, but up to {largest:.3g} can only be deg", "size")
    share = OF_FULL in source.description
    return (OPEN, ASK_FULL) if share else ("rad", AS_RADIANS)


def shared_signals(trials: Sequence[Chosen]) -> frozenset[str]:
    """Quantities that every log holds."""
    return frozenset.intersection(*(one.quantities for one in trials))
