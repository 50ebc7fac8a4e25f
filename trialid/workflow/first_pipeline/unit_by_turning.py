"""Units of headings, yaw rates and small rudders that no log states, by how fast a ship turns."""

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from trialid.inspection.inspected import ChannelInspection, Inspection
from trialid.inspection.name_words import words
from trialid.inspection.relations import RATES
from trialid.names import units
from trialid.workflow.first_pipeline.chosen import OPEN, Chosen, Reason, Signal

TURNING: Final = (0.05, 2.5)
"""Rate of turn of a ship in a manoeuvre, in her own lengths and speed; rates in other units lie
further apart than this range is wide."""

TURNED: Final = 0.1
"""Rate of turn, in her own lengths and speed, over the rudder in radians: ships, boats and models
have 0.3 to 3 once they turn, in a fast zig-zag less. Degrees taken for radians give 0.005 to 0.05.
At half of it a ferry that is hardly steered is read in degrees still (0.02), as a cargo ship in a
sea is (0.04), and at twice; a fast zig-zag (0.2 and more) at twice no longer in radians."""


def with_headings(surveys: Sequence[Inspection], seconds: float | None) -> list[Inspection]:
    """The logs, headings that may be in degrees or radians in the unit in which she can turn so.

    `seconds` is the time in which she goes her own length, where it is known.
    """
    if seconds is None:
        return [*surveys]
    return [
        dataclasses.replace(
            survey, channels={key: _turned(c, seconds) for key, c in survey.channels.items()}
        )
        for survey in surveys
    ]


def _turned(one: ChannelInspection, seconds: float) -> ChannelInspection:
    stated = one.stated_unit or one.unit_by_size or one.angle
    if stated or one.guess is None or one.guess.quantity != "psi" or len(one.sketch.t) < 2:
        return one
    t = (one.sketch.t - one.sketch.t[0]) / 1e9
    before = t <= t[-1] - seconds
    turned = np.interp(t[before] + seconds, t, one.sketch.y) - one.sketch.y[before]
    most = float(np.quantile(np.abs(turned), 0.99)) if len(turned) else 0.0
    return dataclasses.replace(
        one, unit_by_size=_one_fitting(most, {u: units.factor(u, "rad") for u in ("rad", "deg")})
    )


def _one_fitting(most: float, sizes: Mapping[str, float]) -> str | None:
    """The one unit in which the ship turns as fast as ships do, with r L / U in it over in 1."""
    fitting = [unit for unit, size in sizes.items() if TURNING[0] < most * size < TURNING[1]]
    return fitting[0] if len(fitting) == 1 else None


def with_rate_units(trials: Sequence[Chosen], length: float, speed: float) -> list[Chosen]:
    """The trials, yaw rates in the unit that the heading of another log measures, or their size.

    A ship in a manoeuvre turns with r L / U between 0.05 and 2.5, her own length [m] and speed
    [m/s]: faster she would spin about herself, slower is no manoeuvre. Units lie further apart. A
    log in which she goes straight on has the unit of those of the recorder in which she turns.
    """
    rates = [(s, one.path.name) for one in trials for s in one.signals if s.quantity == "r"]
    known, most = dict[str, dict[str, str]](), dict[str, float]()
    for rate, log in rates:
        name = rate.source.name
        largest = float(np.quantile(np.abs(rate.source.sketch.y), 0.99))
        most[name] = max(most.get(name, 0.0), largest)
        if rate.unit not in (None, OPEN):
            known.setdefault(name, {}).setdefault(str(rate.unit), log)
    seconds = length / speed
    return [
        dataclasses.replace(
            one, signals=tuple(_with_unit(s, known, most, seconds) for s in one.signals)
        )
        for one in trials
    ]


def _with_unit(
    signal: Signal,
    known: Mapping[str, Mapping[str, str]],
    most: Mapping[str, float],
    seconds: float,
) -> Signal:
    """A rate as measured elsewhere, or by the largest that a log of it has."""
    if signal.quantity != "r" or signal.unit != OPEN:
        return signal
    measured = known.get(signal.source.name, {})
    if len(measured) == 1:
        [(elsewhere, log)] = measured.items()
        return _answered(signal, elsewhere, f"unit as in {log}, of the same name")
    sizes = {u: most[signal.source.name] * units.factor(u, "rad/s") * seconds for u in RATES}
    unit = _one_fitting(1.0, sizes)
    if measured or unit is None or _turns(signal):
        return signal
    told = ", ".join(f"{size:.2g} in {u}" for u, size in sizes.items())
    return _answered(signal, unit, f"unit by its size: r L / U would be {told}")


def _answered(signal: Signal, unit: str, words: str) -> Signal:
    return dataclasses.replace(signal, unit=unit, of_unit=Reason(words))


def _turns(signal: Signal) -> bool:
    """Whether its name ends with `rps`, radians or turns a second, which no size tells apart."""
    return "rps" in words(signal.source.name)


def with_rudder_units(trials: Sequence[Chosen], length: float, speed: float) -> list[Chosen]:
    """The trials, a rudder of small numbers in degrees where another log or her turning says so.

    Up to 1.6 may be radians, or degrees of a ship that is hardly steered.
    """
    known = _by_size(trials)
    return [_told(one, known, length / speed) for one in trials]


def _by_size(trials: Sequence[Chosen]) -> Mapping[str, str]:
    """Logs whose numbers leave degrees alone, by the name of the channel."""
    return {
        s.source.name: one.path.name
        for one in trials
        for s in one.signals
        if s.unit == "deg" and s.of_unit.rests_on("size")
    }


def _told(trial: Chosen, known: Mapping[str, str], seconds: float) -> Chosen:
    """`seconds` is the time in which she goes her own length."""
    rate = next((s for s in trial.signals if s.quantity == "r" and not s.open), None)
    signals = []
    for one in trial.signals:
        if not one.of_unit.rests_on("small"):
            signals.append(one)
        elif one.source.name in known:
            signals.append(_in_degrees(one, f"deg as in {known[one.source.name]}"))
        elif rate is not None and (size := _answer(one, rate) * seconds) < TURNED:
            words = f"deg, for of radians she would turn by r L / U = {size:.2g} a radian only"
            signals.append(_in_degrees(one, words))
        else:
            signals.append(one)
    return dataclasses.replace(trial, signals=tuple(signals))


def _answer(rudder: Signal, rate: Signal) -> float:
    """How fast she turns [rad/s] by the rudder as logged, both by what is root mean square."""
    r = rate.source.sketch.y * units.factor(rate.unit or "rad/s", "rad/s")
    most = float(np.sqrt(np.mean(rudder.source.sketch.y**2)))
    return float(np.sqrt(np.mean(r**2))) / max(most, 1e-9)


def _in_degrees(rudder: Signal, words: str) -> Signal:
    return dataclasses.replace(rudder, unit="deg", of_unit=Reason(f"no unit is stated: {words}"))
