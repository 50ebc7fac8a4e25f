"""Faults of actuators put into the truths of the ships: what acts of what the log shows."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Final

import three_ships as truth
from jets import JETS, SIDES
from three_models import CARGO, FERRY, SUPPLY, Case

from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.verdict import Verdict
from trialid.effects import CATALOGUE
from trialid.effects.actuators import actuator_effects

HELD: Final = (0.1, -0.07, 0.15, -0.12)
"""Angles [rad] at which something sticks, by its number."""
TURNING: Final = (0.6, -0.5, 0.4, 0.7)
"""Revolutions at which something sticks, over the most that are ordered ahead, by its number."""
BUCKETS: Final = (0.7, 0.0)
"""Where a bucket sticks, open or nearly closed, by its number."""
TWO_PODS: Final = (("pod_1", "pod_2"), ("pod_3", "pod_4"), ("pod_1", "pod_3"), ("pod_2", "pod_4"))


@dataclass(frozen=True, kw_only=True)
class Fault:
    """One fault of a ship: whose it is goes by the seed, so that each side has its turn.

    Attributes
    ----------
    of
        The actuators that have it in turn; several names in one where they are exchanged.
    act
        What is done of what the log shows, by whose fault it is and its number in `of`.
    called
        Its name in the catalogue, without the actuator's.
    """

    ship: Case
    words: str
    called: str = ""
    of: tuple[tuple[str, ...], ...] = ((),)
    act: Callable[[truth.Row, tuple[str, ...], int], Mapping[str, float]] = lambda *_: {}

    def wanted(self, seed: int) -> str | None:
        """The name that is right; None where nothing is wrong."""
        return "_".join((*self.of[seed % len(self.of)], self.called)) if self.called else None

    def verdict(self, seed: int) -> Verdict:
        """What is said of the record of this seed."""
        number = seed % len(self.of)

        def push(now: truth.Row, u: float, v: float, r: float) -> tuple[float, float, float]:
            done = {**now, **self.act(now, self.of[number], number)}
            return self.ship.push(done, u, v, r)

        known = {**CATALOGUE, **actuator_effects(self.ship.ship)}
        fit = replace(self.ship, push=push).fitted(seed)
        return diagnose(fit, DiagnoseSettings(candidates=known)).verdict


def _lost(share: float) -> Callable[[truth.Row, tuple[str, ...], int], Mapping[str, float]]:
    """Its thrust less this share; it goes with the square of its revolutions."""
    return lambda now, who, _: {who[0]: now[who[0]] * (1.0 - share) ** 0.5}


def _turned_over(now: truth.Row, who: tuple[str, ...], _: int) -> Mapping[str, float]:
    return {who[0]: -now[who[0]]}


def _stuck(now: truth.Row, who: tuple[str, ...], number: int) -> Mapping[str, float]:
    return {who[0]: HELD[number]}


def _stuck_pod(now: truth.Row, who: tuple[str, ...], number: int) -> Mapping[str, float]:
    return {f"{who[0]}_angle": HELD[number]}


def _stuck_bucket(_: truth.Row, who: tuple[str, ...], number: int) -> Mapping[str, float]:
    return {f"{who[0]}_bucket": BUCKETS[number]}


def _kept(most: float) -> Callable[[truth.Row, tuple[str, ...], int], Mapping[str, float]]:
    """Its revolutions stay at a share of the most that are ordered."""
    return lambda _, who, number: {who[0]: most * TURNING[number]}


def _exchanged(now: truth.Row, who: tuple[str, ...], _: int) -> Mapping[str, float]:
    one, other = who
    ends = [n.removeprefix(one) for n in now if n in (one, f"{one}_angle")]
    swapped = {f"{one}{end}": now[f"{other}{end}"] for end in ends}
    return swapped | {f"{other}{end}": now[f"{one}{end}"] for end in ends}


SCREW_KEPT, POD_KEPT, MAIN_KEPT, BOW_KEPT = DRIVES_KEPT = tuple(
    map(_kept, (18.0, 22.0, 10.0, 25.0))
)
"""Revolutions of each ship's drives that stay, whatever is ordered."""
RUDDERS, SCREWS, MAINS, BOTH_JETS, PODS = (
    tuple((n,) for n in names)
    for names in (
        ("rudder_port", "rudder_stbd"),
        ("screw_port", "screw_stbd"),
        ("main_port", "main_stbd"),
        SIDES,
        truth.PODS,
    )
)
"""The fourth pod has a gain of its own, which is free: that it has lost some nobody can tell."""
FAULTS: Final = (
    Fault(ship=CARGO, words="nothing"),
    Fault(ship=CARGO, words="screw 20 % weak", called="weak", of=SCREWS, act=_lost(0.2)),
    Fault(ship=CARGO, words="screw stuck", called="stuck", of=SCREWS, act=SCREW_KEPT),
    Fault(ship=CARGO, words="rudder stuck", called="stuck", of=RUDDERS, act=_stuck),
    Fault(
        ship=CARGO,
        words="rudders exchanged",
        called="exchanged",
        of=(("rudder_port", "rudder_stbd"),),
        act=_exchanged,
    ),
    Fault(ship=FERRY, words="nothing"),
    Fault(ship=FERRY, words="pod 20 % weak", called="weak", of=PODS[:3], act=_lost(0.2)),
    Fault(ship=FERRY, words="pod stuck", called="stuck", of=PODS, act=_stuck_pod),
    Fault(
        ship=FERRY,
        words="pod's revolutions stuck",
        called="revolutions_stuck",
        of=PODS,
        act=POD_KEPT,
    ),
    Fault(ship=FERRY, words="pod reversed", called="reversed", of=PODS, act=_turned_over),
    Fault(ship=FERRY, words="pods exchanged", called="exchanged", of=TWO_PODS, act=_exchanged),
    Fault(ship=SUPPLY, words="nothing"),
    Fault(ship=SUPPLY, words="screw 20 % weak", called="weak", of=MAINS, act=_lost(0.2)),
    Fault(ship=SUPPLY, words="screw stuck", called="stuck", of=MAINS, act=MAIN_KEPT),
    Fault(ship=SUPPLY, words="bow stuck", called="stuck", of=(("bow",),), act=BOW_KEPT),
    Fault(ship=SUPPLY, words="screw reversed", called="reversed", of=MAINS, act=_turned_over),
    Fault(
        ship=SUPPLY,
        words="screws exchanged",
        called="exchanged",
        of=(("main_port", "main_stbd"),),
        act=_exchanged,
    ),
    Fault(ship=SUPPLY, words="bow reversed", called="reversed", of=(("bow",),), act=_turned_over),
    Fault(ship=JETS, words="nothing"),
    Fault(ship=JETS, words="jet 20 % weak", called="weak", of=BOTH_JETS, act=_lost(0.2)),
    Fault(ship=JETS, words="nozzle stuck", called="stuck", of=BOTH_JETS, act=_stuck_pod),
    Fault(ship=JETS, words="bucket stuck", called="bucket_stuck", of=BOTH_JETS, act=_stuck_bucket),
)
