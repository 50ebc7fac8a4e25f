"""From the pulse width an ArduPilot autopilot sends to a servo or a motor to its share of full.

No log holds a rudder angle: the autopilot orders a pulse width and never learns what became of it.
Its parameters say how the width came about, so the share of the full deflection can be had back;
how many degrees the full deflection is, only the user knows. A throttle is ordered the same way.
Source: ArduPilot, SRV_Channel::pwm_from_angle, AP_MotorsUGV::setup_servo_output.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from trialid.recording import Channel

STEERING = {26: "GroundSteering", 21: "Rudder"}
"""SERVOn_FUNCTION of an output that moves a rudder."""
THROTTLE = {70: "Throttle", 73: "ThrottleLeft", 74: "ThrottleRight"}
FIELD = {70: "throttle", 73: "throttle_left", 74: "throttle_right"}
"""What the channel of a motor's output is called behind its number; `deflection` of a rudder's."""
PWM_TYPE, BY_RELAY = "MOT_PWM_TYPE", 3
"""Motors that a relay turns round: their pulse width has no sign."""
CALIBRATION = ("MIN", "TRIM", "MAX", "REVERSED")
OUTPUTS = 32
NO_OUTPUT = (0, 65535)
"""Pulse widths that stand for none."""

CHANGING = ("STAT_", "COMPASS_OFS", "BARO", "SYS_NUM_RESETS")
"""Parameters the autopilot itself keeps changing; no remark is due."""

EVER, NEVER = -(2**62), 2**62
"""Times [ns] of what held before all messages, and of what was only said after them."""

Times = NDArray[np.int64]
Values = NDArray[np.float64]


@dataclass(frozen=True)
class History:
    """What a parameter was, by time [ns]; (N,) both."""

    t: Times
    value: Values

    def at(self, t: Times) -> Values:
        """The value in force at each time; before the log first states it, the first; (M,)."""
        return self.value[np.maximum(np.searchsorted(self.t, t, "right") - 1, 0)]


Parameters = Mapping[str, History]


def parameters(names: Sequence[str], t: Times, values: Values) -> dict[str, History]:
    """Histories by name, from statements in any order."""
    order = np.argsort(t, kind="stable")
    texts = np.array(names, dtype=np.str_)[order]
    found = {}
    by_name = np.argsort(texts, kind="stable")
    edges = np.flatnonzero(texts[by_name][1:] != texts[by_name][:-1]) + 1
    for rows in np.split(by_name, edges) if len(texts) else ():
        found[str(texts[rows[0]])] = History(t[order][rows], values[order][rows])
    return found


@dataclass(frozen=True)
class Output:
    """What one output moves: the name of its function, its channel's field, SERVOn_FUNCTION."""

    function: str
    field: str
    numbers: tuple[int, ...]

    @property
    def steers(self) -> bool:
        """Whether it moves a rudder, and not a motor."""
        return self.numbers == tuple(STEERING)

    def channel(self, name: str, t: Times, pwm: Values, n: int, known: Parameters) -> Channel:
        """Its share of full as a channel, of its pulse widths (N,) at times (N,)."""
        return Channel(
            name=name,
            t=t,
            y=deflection(pwm, t, n, known, self.numbers),
            unit=None if self.steers else "1",
            description=description(n, self),
            quantity="delta_order" if self.steers else None,
            positive="starboard" if self.steers else None,
        )


def outputs(known: Parameters) -> dict[int, Output]:
    """Outputs that move a rudder or a motor at some time, by number; a rudder before a motor."""
    found: dict[int, Output] = {}
    for n, f in _functions(known):
        if f in STEERING:
            found[n] = Output(STEERING[f], "deflection", tuple(STEERING))
        elif f in THROTTLE and not _by_relay(known):
            found.setdefault(n, Output(THROTTLE[f], FIELD[f], (f,)))
    return found


def _by_relay(known: Parameters) -> bool:
    return PWM_TYPE in known and bool((known[PWM_TYPE].value == BY_RELAY).any())


def _functions(known: Parameters) -> Iterator[tuple[int, int]]:
    for n in range(1, OUTPUTS + 1):
        history = known.get(f"SERVO{n}_FUNCTION")
        if history is not None:
            for value in dict.fromkeys(history.value[np.isfinite(history.value)].tolist()):
                yield n, round(value)


def missing_parameters(known: Parameters, n: int) -> list[str]:
    """Parameters without which the pulse width of output `n` says nothing."""
    return [name for name in _calibration(n) if name not in known]


def _calibration(n: int) -> list[str]:
    return [f"SERVO{n}_{name}" for name in CALIBRATION]


def deflection(
    pwm: Values, t: Times, n: int, known: Parameters, numbers: tuple[int, ...] = tuple(STEERING)
) -> Values:
    """Share of full that output `n` orders, 1 to starboard or ahead, -1 to port or astern; (N,).

    NaN where there is no output, where its function is none of these numbers, and where the
    parameters contradict each other. The two sides are scaled apart because the trim need not lie
    in the middle.
    """
    low, trim, high, flipped = (known[name].at(t) for name in _calibration(n))
    span = np.where(pwm > trim, high - trim, trim - low)
    sense = np.where(flipped == 1, -1.0, 1.0)
    moves = np.isin(known[f"SERVO{n}_FUNCTION"].at(t), list(numbers))
    good = moves & (span > 0) & ~np.isin(pwm, NO_OUTPUT)
    return np.where(good, sense * (pwm - trim) / np.where(span > 0, span, 1.0), np.nan)


def description(n: int, output: Output) -> str:
    """What the channel of output `n` is, in words."""
    of = f"servo output {n} ({output.function})"
    if output.steers:
        return (
            f"share of the full deflection that {of} orders, -1 to 1, by its parameters: "
            "give gain = the largest rudder angle; it is a command, not a measured rudder"
        )
    return f"share of full throttle that {of} orders, -1 astern to 1 ahead, by its parameters"


def remarks(known: Parameters, names: Mapping[int, str]) -> Iterator[str]:
    """What there is to say about outputs; `names` are their channels by output."""
    servos = outputs(known)
    for n, output in servos.items():
        lacking, of = missing_parameters(known, n), f"output {n} ({output.function})"
        none = "no deflection" if output.steers else "no share of full"
        if lacking:
            yield f"{of}: {none}, {', '.join(lacking)} not in the log"
        elif n in names:
            yield f"{of} moves the {'rudder' if output.steers else 'motor'}: {names[n]}"
        else:
            yield f"{of}: {none}, its pulse width is not in the log"
    if not any(output.steers for output in servos.values()):
        yield f"no deflection of a rudder servo: {_why_none(known)}"
    if _by_relay(known):
        yield f"{PWM_TYPE} = {BY_RELAY}: a relay turns the motors round, their share is not known"


def _why_none(known: Parameters) -> str:
    if not any(name.startswith("SERVO") and name.endswith("_FUNCTION") for name in known):
        return "the log holds no SERVOn_FUNCTION parameter"
    functions = " or ".join(f"{number} ({name})" for number, name in STEERING.items())
    return f"no SERVOn_FUNCTION parameter is {functions}"


def changes(known: Parameters) -> Iterator[str]:
    """A remark on parameters that changed while the log was written, those of servos first."""
    found = []
    for name, history in known.items():
        value = history.value
        during = (history.t[1:] > EVER) & (history.t[1:] < NEVER)
        at = np.flatnonzero((value[1:] != value[:-1]) & during) + 1
        if len(at) and not name.startswith(CHANGING) and np.isfinite(value).all():
            k = int(at[0])
            step = f"{value[k - 1]:g} to {value[k]:g} at {history.t[k] / 1e9:.1f} s"
            more = f" and {len(at) - 1} times more" if len(at) > 1 else ""
            found.append((not name.startswith("SERVO"), name, f"{name} {step}{more}"))
    found.sort()
    if found:
        rest = f", and {len(found) - 4} more" if len(found) > 4 else ""
        yield f"parameters changed: {', '.join(words for *_, words in found[:4])}{rest}"
