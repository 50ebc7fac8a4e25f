"""How each kind of actuator pushes.

A kind is a function of what drives one instance and of its parameters: what it gives is the push
along the actuator's direction and to the right of it. Place, direction, the sum over instances and
shared or own parameters are the same for all (`pushes`).
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Final, NamedTuple

from trialid.maths import Number, cos, exp, sin
from trialid.ship.actuators import Command
from trialid.ship.effect import Parameter

F11: Final = "Fossen (2011), Handbook of Marine Craft Hydrodynamics and Motion Control"
BRIX: Final = "Brix (1993), Manoeuvring Technical Manual: tunnel thrusters fade with speed ahead"


class Driven(NamedTuple):
    """What drives one actuator: its revolutions, share or thrust, its angle, the speed ahead."""

    command: Command
    drive: Number
    angle: Number
    u: Number


class Push(NamedTuple):
    """Force of one actuator along its direction and to the right of it [N]."""

    along: Number
    aside: Number = 0.0


@dataclass(frozen=True, kw_only=True)
class PushKind:
    """One kind of actuator.

    Attributes
    ----------
    effect
        Name of the effect that holds all of the kind.
    gains
        Parameters that are gains of thrust; their start and unit follow from ship and command.
    shapes
        All other parameters.
    reads
        Motions it depends on.
    """

    effect: str
    equation: str
    source: str
    force: Callable[[Driven, Mapping[str, Number]], Push]
    gains: tuple[str, ...]
    shapes: Mapping[str, Parameter] = field(default_factory=dict)
    reads: tuple[str, ...] = ()


def thrust(by: Driven, ahead: Number, astern: Number) -> Number:
    """Gain times n |n|, ahead or astern; gain times a stated thrust."""
    forward, back = 0.5 * (by.drive + abs(by.drive)), 0.5 * (by.drive - abs(by.drive))
    if by.command == "thrust":
        return ahead * forward + astern * back
    return ahead * forward * forward - astern * back * back


def _thruster(by: Driven, p: Mapping[str, Number]) -> Push:
    return Push(thrust(by, p["k_ahead"], p["k_astern"]))


def _azimuth(by: Driven, p: Mapping[str, Number]) -> Push:
    pull = thrust(by, p["k_pod_ahead"], p["k_pod_astern"])
    return Push(pull * cos(by.angle), pull * sin(by.angle))


def _waterjet(by: Driven, p: Mapping[str, Number]) -> Push:
    jet = thrust(by, p["k_jet_ahead"], p["k_jet_astern"])
    return Push(jet * cos(by.angle), -jet * sin(by.angle))


def _tunnel(by: Driven, p: Mapping[str, Number]) -> Push:
    fade = exp(-by.u * by.u / (p["u_tunnel"] * p["u_tunnel"]))
    return Push(thrust(by, p["k_tunnel"], p["k_tunnel"]) * fade)


PUSHES: Final = {
    "thruster": PushKind(
        effect="thrusters",
        equation="T = k_ahead n^2 ahead, -k_astern n^2 astern: thrust of fixed propellers",
        source=F11,
        force=_thruster,
        gains=("k_ahead", "k_astern"),
    ),
    "azimuth": PushKind(
        effect="azimuths",
        equation="T = k_pod_ahead n^2, -k_pod_astern n^2: thrust where each pod points",
        source=F11,
        force=_azimuth,
        gains=("k_pod_ahead", "k_pod_astern"),
    ),
    "waterjet": PushKind(
        effect="waterjets",
        equation="T = k_jet_ahead n^2, -k_jet_astern n^2: thrust of jets, turned by their nozzles",
        source=F11,
        force=_waterjet,
        gains=("k_jet_ahead", "k_jet_astern"),
    ),
    "tunnel": PushKind(
        effect="tunnels",
        equation="T = k_tunnel n |n| exp(-(u / u_tunnel)^2): tunnel thrusters, fading with speed",
        source=BRIX,
        force=_tunnel,
        gains=("k_tunnel",),
        shapes={"u_tunnel": Parameter(1.5, "m/s", low=0.1, high=20.0, null=None)},
        reads=("u",),
    ),
}
"""Kinds by their name; a rudder pushes across the flow, which makes it an effect of its own."""
