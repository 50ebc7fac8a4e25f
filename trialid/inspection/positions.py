"""Which channels of a log are her position, by what they are called."""

from collections.abc import Iterable, Mapping
from typing import Final

from trialid.inspection.channel_names import words
from trialid.inspection.inspected import ChannelInspection

PAIRS: Final[tuple[Mapping[str, frozenset[str]], ...]] = (
    {
        "lat": frozenset(("lat", "latitude", "breite", "breitengrad", "bredde", "breedte")),
        "lon": frozenset(
            (
                *("lon", "lng", "long", "longitude", "laenge", "länge", "lengde", "lengte"),
                *("laengengrad", "längengrad"),
            )
        ),
    },
    {"x": frozenset(("northing", "hochwert")), "y": frozenset(("easting", "rechtswert"))},
)
"""Words of channels that are a position; one without the other is none: `Breite` is a beam too."""


def positions(channels: Iterable[ChannelInspection]) -> dict[str, ChannelInspection]:
    """The first pair of channels that moves and is called a position, by signal; or nothing."""
    moving = [one for one in channels if not one.constant]
    for pair in PAIRS:
        found: dict[str, ChannelInspection] = {}
        for name, called in pair.items():
            told = [c for c in moving if called & _told(c)]
            found |= {name: told[0]} if told else {}
        if len(found) == len(pair):
            return found
    return {}


def _told(one: ChannelInspection) -> set[str]:
    return {*words(one.name.rpartition(":")[2]), *words(one.description)}


def position_words(channels: Iterable[ChannelInspection]) -> list[str]:
    """What a person is told of them: one sentence, or none."""
    found = positions(channels)
    if not found:
        return []
    named = ", ".join(f"{name} = {one.name}" for name, one in found.items())
    return [f"a position is here ({named}): `trialid guide track` says what to do with it"]
