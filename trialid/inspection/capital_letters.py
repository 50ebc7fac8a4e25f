"""Columns of capital letters without a unit: U, V, R, Psi, Delta as simulations save them.

A capital may mean anything; the letters of a ship's motion that stand together mean that motion.
"""

import dataclasses
from collections.abc import Mapping
from typing import Final

from trialid.inspection.channel_names import is_column
from trialid.inspection.inspected import ChannelInspection, Guess
from trialid.inspection.speed_letters import smaller_beside

LETTERS: Final = frozenset(("u", "v", "p", "r", "phi", "psi", "delta"))


def with_capitals(channels: Mapping[str, ChannelInspection]) -> dict[str, ChannelInspection]:
    """The channels, such letters with what they mean beside a rudder's and a turn's.

    A speed along the ship has that across it beside it, and that is smaller.
    """
    letters = {one.name.lower(): one for one in channels.values() if _capital(one)}
    if "delta" not in letters or not letters.keys() & {"psi", "r"}:
        return dict(channels)
    if not ({"u", "v"} <= letters.keys() and smaller_beside(letters["v"], letters["u"])):
        letters = {name: one for name, one in letters.items() if name not in ("u", "v")}
    words = f"by its letter, beside {', '.join(sorted(one.name for one in letters.values()))}"
    known = {
        one.key: dataclasses.replace(one, guess=Guess(name, "name", words))
        for name, one in letters.items()
    }
    return {**channels, **known}


def _capital(one: ChannelInspection) -> bool:
    """Whether a column's whole name is such a letter, and nothing says in which unit it is."""
    lower = one.name.lower()
    plain = is_column(one.name) and one.guess is None and one.stated_unit is None
    return plain and not one.constant and lower in LETTERS and lower != one.name
