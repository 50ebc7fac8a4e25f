"""Gains of an autopilot as files: ArduPilot's steering parameters, and PID as JSON.

ArduPilot Rover (libraries/APM_Control/AR_AttitudeControl, documentation of ATC_STR_RAT_*): FF, P
and I turn a rate [rad/s], its error and the integral of that into a steering output from -1 to 1.
One is full rudder, or full command of two thrusters (`order_words`).
"""

import textwrap
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field
from typing import Final, Literal

import numpy as np

from trialid.design.steering.gains import Gains
from trialid.export.model.fitted_model import FittedModel
from trialid.export.model.order_words import ardupilot_output, limits_words, order_words
from trialid.result.json_file import finite

SCHEMA: Final[Literal["trialid-pid/1"]] = "trialid-pid/1"
DOCUMENTED: Final = {"FF": 3.0, "P": 2.0, "I": 2.0}
"""Largest value of each in ArduPilot's documentation."""
WIDE: Final = 96


def ardupilot_text(made: FittedModel, gains: Gains, full: float) -> str:
    """A `.param` file of steering rate gains.

    Parameters
    ----------
    full
        Rudder angle at a steering output of one [rad], or command of a thruster [SI].
    """
    output = ardupilot_output(gains, full)
    values = {n: x / output.share for n, x in gains.values.items()}
    lines = [*_wrapped(f"{made.name}: steering of ArduPilot Rover, for the model that was fitted")]
    for key, words in made.origin.items():
        lines += _wrapped(f"{key.replace('_', ' ')}: {words}")
    for words in made.words:
        lines += _wrapped(f"NOTE {words}")
    lines += _wrapped(
        f"{output.words} For a bandwidth of {gains.bandwidth:.3g} rad/s at "
        f"{gains.ship.speed:.3g} m/s."
    )
    for words in promises(gains, "turn rate"):
        lines += _wrapped(words)
    for name, most in DOCUMENTED.items():
        if values[name] > most:
            lines += _wrapped(
                f"NOTE ATC_STR_RAT_{name} lies beyond the 0 to {most:g} of ArduPilot's "
                "documentation, which is for small vehicles; a ground station may warn."
            )
    lines += [f"ATC_STR_RAT_{name},{value:.6g}" for name, value in values.items()]
    lines += ["ATC_STR_RAT_D,0", *(f"{n},{x:g}" for n, x in output.parameters.items())]
    return "\n".join(lines) + "\n"


def promises(gains: Gains, what: str) -> Iterator[str]:
    """What the gains promise, a sentence each."""
    fitted, ends = gains.promise.fitted, gains.promise.ranges
    yield (
        f"A small step of {what} overshoots by {fitted.overshoot:.1%} "
        f"(likely {ends['overshoot'][0]:.1%} to {ends['overshoot'][1]:.1%}) and stays within 5 % "
        f"after {_seconds(fitted.settling)} (likely {_seconds(ends['settling'][0])} to "
        f"{_seconds(ends['settling'][1])})."
    )
    yield (
        f"Phase margin {np.rad2deg(fitted.phase_margin):.0f} deg, at least "
        f"{np.rad2deg(ends['phase_margin'][0]):.0f} likely; gear, sensor and computer may be late "
        f"by less than {_seconds(ends['delay_margin'][0])} together."
    )
    yield limits_words(gains.ship)


def _seconds(value: float) -> str:
    return f"{value:.3g} s" if np.isfinite(value) else "any time"


def _wrapped(words: str) -> list[str]:
    clean = " ".join(words.split())
    return textwrap.wrap(
        clean,
        WIDE,
        initial_indent="# ",
        subsequent_indent="#   ",
        break_on_hyphens=False,
        break_long_words=False,
    )


@dataclass(frozen=True, kw_only=True)
class Margin:
    """A number of the loop, for the ship as fitted and over 95 of 100 that the record leaves open.

    None is any time, or endless.
    """

    value: float | None
    likely: tuple[float | None, float | None]


@dataclass(frozen=True, kw_only=True)
class PidFile:
    """delta = Kp (psi_d - psi) + Ki integral (psi_d - psi) - Kd r; SI, delta to starboard.

    `order` says what delta is; `cruise` and `range` are commands of two thrusters [SI], where those
    steer. `promise` holds overshoot [share of a small step], settling to 5 % [s], phase margin
    [rad] and delay margin [s].
    """

    schema: Literal["trialid-pid/1"] = SCHEMA
    name: str
    verdict: str
    words: tuple[str, ...] = ()
    origin: Mapping[str, str] = field(default_factory=dict)
    speed: float
    bandwidth: float
    order: str
    cruise: float | None = None
    range: float | None = None
    Kp: float
    Ki: float
    Kd: float
    promise: Mapping[str, Margin] = field(default_factory=dict)


def pid_file(made: FittedModel, gains: Gains, full: float) -> PidFile:
    """The content of the file, for a rudder angle (full is 1) or a share of a full command [SI]."""
    twin = bool(gains.ship.steered_by.thrusters)
    values = {n: x / full for n, x in gains.values.items()}
    fitted = asdict(gains.promise.fitted)
    promise = {n: Margin(value=fitted[n], likely=r) for n, r in gains.promise.ranges.items()}
    whole: PidFile = finite(
        PidFile(
            name=made.name,
            verdict=made.verdict,
            words=(*made.words, *promises(gains, "heading")),
            origin=dict(made.origin),
            speed=gains.ship.speed,
            bandwidth=gains.bandwidth,
            order=order_words(gains.ship, full),
            cruise=gains.ship.held if twin else None,
            range=full if twin else None,
            Kp=values["Kp"],
            Ki=values["Ki"],
            Kd=values["Kd"],
            promise=promise,
        )
    )
    return whole
