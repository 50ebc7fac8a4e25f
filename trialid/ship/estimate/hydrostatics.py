"""Where a hull floats: waterplane, buoyancy and metacentre from beam, draught and fullness."""

from typing import Final

KEEL_SOURCE: Final = "Parsons (2003)"
"""KB by Morrish, BM by D'Arcangelo (1969), as there."""


def waterplane(block: float) -> float:
    """Waterplane coefficient (1 + 2 C_B) / 3 (Schneekluth & Bertram 1998)."""
    return (1.0 + 2.0 * block) / 3.0


def buoyancy_height(draught: float, block: float) -> float:
    """KB [m] above the keel: T (5/6 - C_B / (3 C_WP)), Morrish.

    >>> buoyancy_height(6.0, 1.0)  # a box
    3.0
    """
    return draught * (5.0 / 6.0 - block / (3.0 * waterplane(block)))


def metacentric_radius(beam: float, draught: float, block: float) -> float:
    """BM [m]: transverse inertia of the waterplane (0.1216 C_WP - 0.0410) L B^3 over the volume."""
    return (0.1216 * waterplane(block) - 0.0410) * beam**2 / (block * draught)


def metacentre(beam: float, draught: float, block: float) -> float:
    """KM [m] above the keel."""
    return buoyancy_height(draught, block) + metacentric_radius(beam, draught, block)
