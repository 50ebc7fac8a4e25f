"""What a pipeline that is begun frees, and how well that was known."""

from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trialid.ship.particulars import Ship
from trialid.toml_text import array

COUPLING: Final = ("Kvdot", "Ypdot")
"""Moments and forces of the water where sway and roll accelerate each other."""


def free_lines(free: Sequence[str], ship: Ship) -> Iterator[str]:
    """Lines of `[identify]`: these, and masses of the roll that are known less well than GM."""
    if "GM" in free and _surer_of_GM(ship):
        yield "# GM is known, and a roll tells its ratio to I_xx: so both, each as well as known."
        free = [*free, "I_xx"]
    if "GM" in free and "Kv" in free and (coupled := _known_less_than_GM(COUPLING, ship)):
        yield f"# {' and '.join(coupled)} weigh roll moments against GM: no formula is sure of it."
        free = [*free, *coupled]
    yield f"free = {array(free)}"
    if any(name in ship.uncertainty for name in free):
        yield 'priors = "ship"  # held about her file\'s numbers, as far as it says they scatter'


def _known_less_than_GM(names: Sequence[str], ship: Ship) -> list[str]:
    """Those that the file says scatter, and by more than GM."""
    known = ship.uncertainty
    return [n for n in names if known.get(n, 0.0) > known.get("GM", np.inf)]


def _surer_of_GM(ship: Ship) -> bool:
    """Whether GM is known twice as well as the inertia in roll."""
    known = ship.uncertainty
    return known.get("GM", np.inf) < 0.5 * known.get("I_xx", 0.0)
