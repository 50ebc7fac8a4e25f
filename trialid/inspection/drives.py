"""Which channels drive a boat that steers by two thrusters."""

from typing import Final

from trialid.inspection.channel_names import STEERED, STEERING
from trialid.inspection.inspected import ChannelInspection, Inspection
from trialid.inspection.name_words import sides, words
from trialid.inspection.usual_units import to_si
from trialid.names.quantities import SIGNALS
from trialid.names.side_words import LETTERS, SIDES

DRIVES: Final = frozenset(
    words(
        "thr thrust thruster thrusters throttle pwm cmd motor motors engine engines prop props "
        "propeller propellers rpm esc outboard azimuththruster"
    )
)
"""Words of a channel that drives a boat, ..."""

NO_DRIVE: Final = frozenset(
    words(
        "rudder angle pos position joint temperature temp voltage current fuel oil pressure torque "
        "load hours trim tilt state status enable steer steering"
    )
)
"""... and of one that only is about what drives her."""

SHAFTS: Final = frozenset(("n_p", "n_s"))
ENGINES: Final = {"single engine or port": "n_p", "starboard engine": "n_s"}
"""Words by which NMEA 2000 says which of two engines it is."""


ENDS: Final = {
    "aft": frozenset(words("aft after rear stern achtern heck akter")),
    "fore": frozenset(words("fore fwd forward front bow vorn bug forut")),
}
"""Words by which the one of two drives of a ferry with a bow at either end says where it stands."""

NUMBERS: Final = ("1", "2")
"""Of two drives by number the first is tried as that to port; the turn has to say so."""


def drives_of(survey: Inspection) -> tuple[ChannelInspection, ...]:
    """The port and the starboard drive of a log; fewer where there is not one of each.

    Where none has a side, the first and the second of two that are numbered.
    """
    found: dict[str, list[ChannelInspection]] = {"n_p": [], "n_s": []}
    for one in filter(_drives, survey.channels.values()):
        of = sides(one.name) or _by_format(one)
        if len(of) == 1:
            found[of.pop()].append(one)
    if not any(found.values()):
        return _numbered(survey)
    return tuple(ones[0] for ones in found.values() if len(ones) == 1)


def drives_by_end(survey: Inspection) -> tuple[ChannelInspection, ...]:
    """The one drive aft and the one that stands fore of it; nothing where there is not one each."""
    found = {
        at: [one for one in survey.channels.values() if _drives(one) and end_of(one.name) == at]
        for at in ENDS
    }
    whole = all(len(ones) == 1 for ones in found.values())
    return tuple(one for ones in found.values() for one in ones) if whole else ()


def end_of(name: str) -> str:
    """At which end a drive stands by its name, `aft` or `fore`; empty where it says a side.

    >>> end_of("pod_fwd_rpm"), end_of("stern_azimuth_deg"), end_of("aft_port_rpm")
    ('fore', 'aft', '')
    """
    said = [at for at, ones in ENDS.items() if ones & {*words(name)}]
    return said[0] if len(said) == 1 and not sides(name) else ""


def lone_drive(survey: Inspection) -> ChannelInspection | None:
    """The one channel that drives her, moving or held; None where there is none, or another."""
    able = [one for one in survey.channels.values() if _is_called_drive(one) and one.mostly_there]
    return able[0] if len(able) == 1 and (able[0].low or able[0].high) else None


def drives_among(survey: Inspection) -> list[str]:
    """Names of all channels that seem to drive her; a lone shaft and its thrust steer nobody."""
    found = [
        one
        for one in survey.channels.values()
        if _drives(one) and (has_side(one) or not _force(one))
    ]
    called = any(DRIVES & {*words(one.name)} for one in found)
    return [one.name for one in found] if called or len(found) > 1 else []


def _force(one: ChannelInspection) -> bool:
    """Whether it is what a drive is measured to push with, and no order to it."""
    return to_si(one.stated_unit or "", "N") is not None


def has_side(drive: ChannelInspection) -> bool:
    """Whether a drive's name or format tells its side; else it has a number alone."""
    return bool(sides(drive.name) or _by_format(drive))


def _numbered(survey: Inspection) -> tuple[ChannelInspection, ...]:
    """Two drives whose names are alike but for their numbers; nothing where there are others."""
    pairs: dict[tuple[str, ...], dict[str, ChannelInspection]] = {}
    for one in filter(_drives, survey.channels.values()):
        told = words(one.name)
        numbers = [word for word in told if word in NUMBERS]
        if len(numbers) == 1:
            kind = tuple(word for word in told if word not in NUMBERS)
            pairs.setdefault(kind, {})[numbers[0]] = one
    whole = [pair for pair in pairs.values() if len(pair) == len(NUMBERS)]
    return tuple(whole[0][n] for n in NUMBERS) if len(whole) == 1 else ()


def _drives(one: ChannelInspection) -> bool:
    """Whether a channel drives a boat, and moves."""
    return _is_called_drive(one) and not one.constant and one.mostly_there


def _is_called_drive(one: ChannelInspection) -> bool:
    """Whether a channel drives a boat: by its words, or by the letter of a shaft.

    That needs a unit, or no more beside it than a side or a number: `n_left`, `n1`. A side alone is
    a drive's, too, `left` beside `right`, where nothing states a unit: the turn has to say so.
    """
    told = {*words(one.name)}
    turns = to_si(one.stated_unit or "", SIGNALS["n"].unit) is not None
    plain = one.stated_unit is None and set() < told - {"n"} <= {*SIDES, *LETTERS, *NUMBERS}
    shaft = "n" in told and (turns or plain)
    bare = one.stated_unit is None and set() < told <= SIDES.keys()
    return bool(DRIVES & told or shaft or bare) and not NO_DRIVE & told


def _by_format(one: ChannelInspection) -> set[str]:
    """The side that the format itself gives a shaft or an engine by its number."""
    if one.guess is not None and one.guess.how == "format" and one.guess.quantity in SHAFTS:
        return {one.guess.quantity}
    return {side for words_of_it, side in ENGINES.items() if f"({words_of_it})" in one.description}


def of_some_steering(one: ChannelInspection) -> bool:
    """Whether she is steered by it, and neither its unit nor that it is an angle is said."""
    field = {*words(one.name.rpartition(":")[2])} - {*SIDES}
    return one.stated_unit is None and bool(field & STEERING) and field <= STEERING | STEERED
