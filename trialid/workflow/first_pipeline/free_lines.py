"""What a pipeline that is begun frees, and how well that was known."""

from collections.abc import Iterator, Sequence

import numpy as np

from trialid.ship.particulars import Ship
from trialid.toml_text import array


def free_lines(free: Sequence[str], ship: Ship) -> Iterator[str]:
    """Lines of `[identify]`: these, and the inertia in roll beside a GM that is known."""
    if "GM" in free and _surer_of_GM(ship):
        yield "# GM is known, and a roll tells its ratio to I_xx: so both, each as well as known."
        free = [*free, "I_xx"]
    yield f"free = {array(free)}"
    if any(name in ship.uncertainty for name in free):
        yield 'priors = "ship"  # held about her file\'s numbers, as far as it says they scatter'


def _surer_of_GM(ship: Ship) -> bool:
    """Whether GM is known twice as well as the inertia in roll."""
    known = ship.uncertainty
    return known.get("GM", np.inf) < 0.5 * known.get("I_xx", 0.0)
