"""Letters that are a speed along or across the ship by what stands beside them: U, V, VX and VY.

A `V` is her speed to as many people as it is her sway; two speeds along axes may be the ship's or
the earth's, which a turn tells.
"""

import dataclasses
from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from trialid.inspection.channel_names import is_column
from trialid.inspection.inspected import ChannelInspection, Guess
from trialid.inspection.name_words import bare_words
from trialid.inspection.sketch import on_one_clock
from trialid.inspection.usual_units import to_si

SMALLER: Final = 0.5
"""Share of the forward speed that a sway stays below in the median: half of it is a drift of 27 deg
all the time, more than ships have in a steady turn under full rudder."""
TURNED: Final = np.deg2rad(60.0)
"""[rad] Change of heading from which axes of the ship and of the earth are told apart, ..."""
DRIFT: Final = np.deg2rad(40.0)
"""... and the largest angle off the bow of a speed along the ship's axes: yachts under full rudder
drift by 30 deg, and over a turn of `TURNED` a speed along the earth's leaves it."""
MOVING: Final = 0.2
"""Share of the fastest below which a speed has no direction: the ship is stopped."""
MOST: Final = 0.95
"""Share of the samples that must agree; a lost target makes a few that do not."""

Channels = Mapping[str, ChannelInspection]


def with_speed_letters(channels: Channels) -> dict[str, ChannelInspection]:
    """The channels, each such letter with what is beside it as its guess, or with none."""
    found = dict(channels)
    forward = next((c for c in channels.values() if _of(c, "u")), None)
    capital = next((c for c in channels.values() if _of(c, "U") and _letter(c) == "u"), None)
    for one in channels.values():
        if _of(one, "v") and _letter(one) == "v" and one.name != "v":
            along = forward or capital
            if along is None or not _small_beside(one, along):
                found[one.key] = dataclasses.replace(one, guess=None)
            elif forward is None and capital is not None:
                guess = Guess("u", "name", f"by its name, with {one.name} beside it")
                found[capital.key] = dataclasses.replace(capital, guess=guess)
    pair = _pair(channels)
    if pair is None or forward is not None or not _of_ship(*pair):
        return found
    for quantity, one in zip("uv", pair[:2], strict=True):
        guess = Guess(quantity, "name", "by its name; along her own axes, as her turns tell")
        found[one.key] = dataclasses.replace(one, guess=guess)
    return found


def of_either(one: ChannelInspection) -> bool:
    """Whether a lone `U` or `V` is her speed, of which it does not say relative to what."""
    letter = "u" if _of(one, "U") else "v" if one.guess is None and one.name != "v" else None
    y = one.sketch.y
    ahead = len(y) > 0 and float(y.min()) > -MOVING * float(np.median(y))
    return ahead and _size(one) is not None and letter is not None and _letter(one) == letter


def axes_words(channels: Channels) -> Iterator[str]:
    """One line on two speeds along axes that nothing settles."""
    pair = _pair(channels)
    if pair is None or pair[0].guess is not None:
        return
    x, y, _ = pair
    yield (
        f"{x.name} and {y.name} are speeds along axes that may be hers or the earth's: where they "
        "are hers, map them by hand as u and v; else they are no speed through the water"
    )


def _of(one: ChannelInspection, quantity: str) -> bool:
    return one.guess is not None and one.guess.quantity == quantity and not one.constant


def _letter(one: ChannelInspection) -> str | None:
    """A column's name where that is one word and its unit."""
    told = bare_words(one.name)
    return told[0] if len(told) == 1 and is_column(one.name) else None


def _size(one: ChannelInspection) -> float | None:
    return to_si(one.stated_unit or "", "m/s")


def _small_beside(sway: ChannelInspection, along: ChannelInspection) -> bool:
    """Whether a speed is as small beside the forward one as a sway is."""
    sizes = _size(sway), _size(along)
    if sizes == (None, None) and not (sway.stated_unit or along.stated_unit):
        return smaller_beside(sway, along)  # of one recorder: the same
    if sizes[0] is None or sizes[1] is None:
        return False
    return smaller_beside(sway, along, sizes[0] / sizes[1])


def smaller_beside(sway: ChannelInspection, along: ChannelInspection, size: float = 1.0) -> bool:
    """The same of two in units of which one is `size` times the other."""
    v, u = (float(np.median(np.abs(one.sketch.y))) for one in (sway, along))
    return v * size < SMALLER * u


Pair = tuple[ChannelInspection, ChannelInspection, ChannelInspection | None]


def _pair(channels: Channels) -> Pair | None:
    """Columns VX and VY, speeds, and the heading beside them."""
    able = [one for one in channels.values() if not one.stated_unit or _size(one) is not None]
    by_letter = {_letter(one): one for one in able if not one.constant}
    if not {"vx", "vy"} <= by_letter.keys():
        return None
    heading = next((c for c in channels.values() if _of(c, "psi")), None)
    return by_letter["vx"], by_letter["vy"], heading


def _of_ship(x: ChannelInspection, y: ChannelInspection, heading: ChannelInspection | None) -> bool:
    """Whether two speeds keep to the bow while the heading turns: along axes of the ship."""
    if heading is None:
        return False
    common = on_one_clock(x.sketch, y.sketch, heading.sketch)
    size = to_si(heading.stated_unit or "", "rad")
    if common is None or size is None:
        return False
    _, (u, v, psi), whole = common
    speed = np.hypot(u, v)
    moving = whole & (speed > MOVING * speed.max(initial=0.0))
    if not moving.any() or np.ptp(psi[moving]) * size < TURNED:
        return False
    off = np.abs(np.arctan2(v[moving], u[moving]))
    return float(np.mean(off < DRIFT)) >= MOST
