"""What a record tells of the side to which a ship answers her rudder."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Turning:
    """How the ship answers a rudder: to which side, and what tells it.

    `sign` is 1.0 where a positive rudder turns her to starboard, -1.0 to port, 0.0 where the
    record does not tell.
    """

    sign: float
    correlation: float
    words: str
