"""Tests as plain data: a kind of manoeuvre, its numbers, and how long it lasts.

A number may be left open between two limits; a search then chooses it.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from trialid.design import drive_steps, manoeuvres, signals
from trialid.design.helm import Instructions, Passage, Vessel, carry_out
from trialid.errors import DesignError, nearest

Value = float | tuple[float, ...]
"""One number, or one for each step; SI."""


@dataclass(frozen=True)
class Variable:
    """A number of a kind: its unit in files, whether it is a list, its default, its least value.

    With `positive` it must be more than 0; a time is never less.
    """

    unit: str
    many: bool = False
    default: Value | None = None
    positive: bool = False

    def wrong(self, value: float) -> str:
        """What is wrong with a value, empty where nothing is."""
        if self.positive and value <= 0.0:
            return f"must be more than 0, got {value:g}"
        return f"must not be less than 0, got {value:g}" if self.unit == "s" and value < 0.0 else ""


@dataclass(frozen=True)
class Waters:
    """What a builder of instructions may need to know beside the numbers of the test."""

    period: float
    duration: float
    roll_frequency: float
    thrusters: drive_steps.Pair | None = None

    @property
    def samples(self) -> int:
        """Of the test without its approach."""
        return round(self.duration / self.period) + 1


Builder = Callable[[Mapping[str, Value], Waters], Instructions]


@dataclass(frozen=True)
class Kind:
    """A kind of manoeuvre: what it is called in sentences, its numbers, how it is steered."""

    words: str
    variables: Mapping[str, Variable]
    build: Builder


@dataclass(frozen=True)
class Test:
    """A test to be rated, or with `open` numbers, one to be optimised.

    Attributes
    ----------
    values
        Numbers of the kind by name; SI.
    open
        Numbers left to the search, between two limits.
    approach, duration
        Straight run before it, and all of it [s].
    """

    __test__ = False  # no test of ours

    kind: str
    values: Mapping[str, Value]
    duration: float
    approach: float = 0.0
    open: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    name: str = ""


def sail(test: Test, vessel: Vessel, roll_frequency: float) -> Passage:
    """Carry a test out on a vessel."""
    kind = KINDS[test.kind]
    values = {n: test.values.get(n, v.default) for n, v in kind.variables.items()}
    missing = [n for n, value in values.items() if value is None]
    if missing:
        raise DesignError(f"test {test.name or test.kind!r}: {missing[0]!r} is not given")
    told = {n: value for n, value in values.items() if value is not None}
    pair = drive_steps.thruster_pair(vessel.model.ship.actuators)
    waters = Waters(vessel.period, test.duration - test.approach, roll_frequency, pair)
    return carry_out(
        vessel, kind.build(told, waters), test.approach, test.duration, test.name or test.kind
    )


def kind_of(name: str) -> Kind:
    """The kind of this name; DesignError names the nearest."""
    if name not in KINDS:
        raise DesignError(f"there is no manoeuvre {name!r}; {nearest(name, KINDS)}")
    return KINDS[name]


def _one(value: Value) -> float:
    return float(value if isinstance(value, float | int) else value[0])


def _many(value: Value) -> Sequence[float]:
    return (value,) if isinstance(value, float | int) else value


def _zigzag(v: Mapping[str, Value], w: Waters) -> Instructions:
    return manoeuvres.zigzag(_one(v["angle"]), _one(v["heading"]))


def _circle(v: Mapping[str, Value], w: Waters) -> Instructions:
    return manoeuvres.turning_circle(_one(v["angle"]), _one(v["turn"]))


def _pull_out(v: Mapping[str, Value], w: Waters) -> Instructions:
    return manoeuvres.pull_out(_one(v["angle"]), _one(v["turn"]), w.duration)


def _spiral(v: Mapping[str, Value], w: Waters) -> Instructions:
    return manoeuvres.spiral(_many(v["angles"]), _one(v["settle"]), _one(v["hold"]))


def _reversed_spiral(v: Mapping[str, Value], w: Waters) -> Instructions:
    return manoeuvres.reversed_spiral(
        _many(v["rates"]), _one(v["gain"]), _one(v["reset"]), _one(v["largest"]),
        _one(v["hold"]), _one(v["watch"]),
    )  # fmt: skip


def _modified_spiral(v: Mapping[str, Value], w: Waters) -> Instructions:
    return manoeuvres.modified_spiral(_many(v["angles"]), _one(v["period"]))


def _square_wave(v: Mapping[str, Value], w: Waters) -> Instructions:
    return manoeuvres.square_wave(_one(v["angle"]), _one(v["period"]))


def _roll(v: Mapping[str, Value], w: Waters) -> Instructions:
    roll_period = 2.0 * np.pi / w.roll_frequency
    return manoeuvres.roll_excitation(
        _one(v["angle"]), roll_period * _one(v["detuning"]), round(_one(v["swings"])),
        _one(v["decay"]),
    )  # fmt: skip


def _steps(v: Mapping[str, Value], w: Waters) -> Instructions:
    angles = _many(v["angles"])
    lengths = np.asarray(v.get("lengths", (1.0,)), dtype=np.float64)
    shares = np.resize(lengths, len(angles))
    return manoeuvres.step_sequence(angles, w.duration * shares / shares.sum())


def _multisine(v: Mapping[str, Value], w: Waters) -> Instructions:
    t = np.asarray(np.arange(w.samples) * w.period)
    omega = 2.0 * np.pi / np.asarray(_many(v["periods"]))
    sizes, phases = _many(v["sizes"]), np.resize(_many(v["phases"]), len(omega))
    wave = signals.multisine(t, 1.0, np.resize(sizes, len(omega)), omega, phases)
    largest = float(np.abs(wave).max()) or 1.0
    return manoeuvres.order_list(_one(v["angle"]) / largest * wave)


def _binary(v: Mapping[str, Value], w: Waters) -> Instructions:
    numbers = signals.lines(w.duration, w.roll_frequency).numbers
    sizes, phases = (np.resize(_many(v[n]), len(numbers)) for n in ("sizes", "phases"))
    hold = max(1, round(_one(v["switching"]) / w.period))
    return manoeuvres.multi_frequency_binary(
        angle=_one(v["angle"]),
        numbers=numbers,
        sizes=sizes,
        phases=phases,
        duration=w.duration,
        period=w.period,
        hold=hold,
    )


def _differential(v: Mapping[str, Value], w: Waters) -> Instructions:
    return drive_steps.differential_steps(
        w.thrusters, _many(v["ahead"]), _many(v["differences"]), _many(v["lengths"]), w.samples
    )


def _spins(v: Mapping[str, Value], w: Waters) -> Instructions:
    return drive_steps.spins(w.thrusters, _many(v["turning"]), _many(v["lengths"]), w.samples)


ANGLE: Final = Variable("deg")
PERIOD: Final = Variable("s", positive=True)
SHARES: Final = Variable("1", many=True)
LENGTHS: Final = Variable("1", many=True, default=(1.0,), positive=True)
TURN: Final = Variable("deg", default=3.0 * np.pi)

KINDS: Final[Mapping[str, Kind]] = {
    "zigzag": Kind("zig-zag", {"angle": ANGLE, "heading": Variable("deg")}, _zigzag),
    "turning_circle": Kind("turning circle", {"angle": ANGLE, "turn": TURN}, _circle),
    "pull_out": Kind("pull-out", {"angle": ANGLE, "turn": TURN}, _pull_out),
    "spiral": Kind(
        "Dieudonne's spiral",
        {
            "angles": Variable("deg", many=True),
            "settle": Variable("s", default=30.0, positive=True),
            "hold": Variable("s", default=300.0, positive=True),
        },
        _spiral,
    ),
    "reversed_spiral": Kind(
        "Bech's reversed spiral",
        {
            "rates": Variable("deg/s", many=True),
            "gain": Variable("s", default=20.0),
            "reset": Variable("s", default=60.0, positive=True),
            "largest": Variable("deg", default=0.35),
            "hold": Variable("s", default=150.0, positive=True),
            "watch": Variable("s", default=2.0, positive=True),
        },
        _reversed_spiral,
    ),
    "modified_spiral": Kind(
        "modified spiral",
        {"angles": Variable("deg", many=True), "period": PERIOD},
        _modified_spiral,
    ),
    "square_wave": Kind("square wave", {"angle": ANGLE, "period": PERIOD}, _square_wave),
    "roll": Kind(
        "roll excitation",
        {
            "angle": ANGLE,
            "detuning": Variable("1", default=1.0, positive=True),
            "swings": Variable("1", default=4.0, positive=True),
            "decay": Variable("s", default=100.0),
        },
        _roll,
    ),
    "steps": Kind(
        "step sequence",
        {
            "angles": Variable("deg", many=True),
            "lengths": LENGTHS,
        },
        _steps,
    ),
    "multisine": Kind(
        "multisine",
        {
            "angle": ANGLE,
            "periods": Variable("s", many=True, positive=True),
            "sizes": Variable("1", many=True, default=(1.0,)),
            "phases": Variable("deg", many=True, default=(0.0,)),
        },
        _multisine,
    ),
    "multi_frequency_binary": Kind(
        "multi-frequency binary test",
        {
            "angle": ANGLE,
            "sizes": Variable("1", many=True, default=(1.0,)),
            "phases": Variable("deg", many=True, default=(0.0,)),
            "switching": Variable("s", default=0.0),
        },
        _binary,
    ),
    "differential_steps": Kind(
        "differential steps",
        {
            "ahead": Variable("1", many=True, default=(0.5,)),
            "differences": SHARES,
            "lengths": LENGTHS,
        },
        _differential,
    ),
    "spins": Kind("spins", {"turning": SHARES, "lengths": LENGTHS}, _spins),
}
"""Every manoeuvre there is, by its name in files."""
