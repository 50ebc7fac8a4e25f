"""A test in words for the bridge: what is ordered when, and what to expect."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from trialid.names.wording import DASH

STEADY: Final = 1e-6
"""rad by which an order may differ and still be the same."""
MOST: Final = 400
"""Orders beyond which words help nobody: the CSV file has them all."""


@dataclass(frozen=True)
class Order:
    """One order: when, which angle [rad, starboard positive], and the heading expected then."""

    t: float
    angle: float
    heading: float
    until: str = ""


def orders(t: Any, ordered: Any, psi: Any) -> list[Order]:
    """Every change of the order, in time."""
    ordered, psi = np.asarray(ordered), np.asarray(psi)
    changes = np.flatnonzero(np.abs(np.diff(ordered)) > STEADY) + 1
    return [Order(float(t[k]), float(ordered[k]), float(psi[k])) for k in changes]


def order_words(angle: float) -> str:
    """An order as it is called out.

    >>> order_words(np.deg2rad(10.0)), order_words(np.deg2rad(-7.5)), order_words(0.0)
    ('starboard 10', 'port 7.5', 'midships')
    """
    degrees = abs(float(np.rad2deg(angle)))
    if degrees < 0.05:
        return "midships"
    return f"{'starboard' if angle > 0 else 'port'} {degrees:.3g}"


def clock(seconds: float) -> str:
    """Minutes and seconds.

    >>> clock(0.0), clock(75.0), clock(3671.5)
    ('0:00', '1:15', '61:12')
    """
    whole = round(seconds)
    return f"{whole // 60}:{whole % 60:02d}"


def sentences(kind: str, numbers: Mapping[str, Any]) -> Iterator[str]:
    """What the helmsman does, in sentences; numbers in deg and s."""
    say = _SENTENCES.get(kind, _by_the_clock)
    yield from say(numbers)


def _zigzag(v: Mapping[str, Any]) -> Iterator[str]:
    angle, heading = _said(v["angle"]), _said(v["heading"])
    yield f"Order starboard {angle} and hold it until the heading has changed {heading} deg."
    yield f"Order port {angle} and hold it until the heading is {heading} deg to port."
    yield f"Then starboard {angle} again, and so on to the end."


def _circle(v: Mapping[str, Any]) -> Iterator[str]:
    side = "starboard" if v["angle"] > 0 else "port"
    yield f"Order {side} {_said(abs(v['angle']))} and hold it."
    yield f"When the heading has changed {_said(v['turn'])} deg: midships."


def _spiral(v: Mapping[str, Any]) -> Iterator[str]:
    listed = ", ".join(_side(a) for a in v["angles"])
    yield f"Order in turn: {listed}."
    yield (
        f"Hold each until the rate of turn has been steady for {_said(v['settle'])} s, at most "
        f"{_said(v['hold'])} s."
    )


def _reversed_spiral(v: Mapping[str, Any]) -> Iterator[str]:
    listed = ", ".join(_said(r) for r in v["rates"])
    yield f"Steer to these rates of turn, in deg/s, in turn: {listed}."
    yield f"Keep each for {_said(v['hold'])} s with as little rudder as it takes."


def _by_the_clock(v: Mapping[str, Any]) -> Iterator[str]:
    del v
    yield "Order by the clock, as listed; what the ship does changes nothing."


_SENTENCES = {
    "zigzag": _zigzag,
    "turning_circle": _circle,
    "pull_out": _circle,
    "spiral": _spiral,
    "reversed_spiral": _reversed_spiral,
}


def _said(number: float | None) -> str:
    return DASH if number is None else f"{number:.3g}"


def _side(degrees: float) -> str:
    return order_words(float(np.deg2rad(degrees)))
