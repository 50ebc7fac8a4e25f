"""All that the manoeuvres of a fit's trials come to; each trial is searched and sailed once."""

import functools
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.calm_air import sail_from_order
from trialid.design.imo.excursions import Indices
from trialid.design.imo.measured import READERS, heading_numbers, order_time
from trialid.design.imo.recognise import recognise, samples_a_length
from trialid.design.imo.recognition import Recognised
from trialid.design.imo.sailed_trial import has_wind, sail_trial
from trialid.design.imo.stop_numbers import stop_reader
from trialid.design.imo.track_numbers import Around, TrackReader, Water, track_numbers
from trialid.design.imo.trial_numbers import Manoeuvre, ManoeuvreNumber, TurnMeasure
from trialid.design.imo.turns import NEEDED, Turn, find_turns, is_seen, turn_reader
from trialid.design.imo.williamson_numbers import williamson_reader
from trialid.design.prediction.likely_spread import LikelySpread
from trialid.design.prediction.unexplained_motion import unexplained_motion
from trialid.effects.track import CURRENT, current_in_speed
from trialid.errors import DesignError
from trialid.identification.fit import Fit
from trialid.identification.trial_score import of_trial, own_start_error
from trialid.trial import Trial

FEWEST: Final = 3
"""Samples from which a speed has an error."""
KNOWN: Final = 0.1
"""Share of itself within which 95 % of an approach speed must lie for it to be told. By a receiver
of 1 m 7 m/s is known so after 3 samples of 2 s, or 22 of 0.1 s; by half of it after 5 and 34, by
twice after 3 and 14."""
NORMAL: Final = 1.96
IN_SPEED: Final = tuple(current_in_speed.parameters)
ON_TRACK: Final = ("turning circle", "Williamson turn", "stop")


@dataclass(frozen=True, kw_only=True)
class TrialMeasures:
    """What was recognised in the trials of a fit, to fit and to check, and its numbers."""

    manoeuvres: tuple[Manoeuvre, ...] = ()
    numbers: tuple[ManoeuvreNumber, ...] = ()
    turns: tuple[TurnMeasure, ...] = ()


def measure_trials(
    fit: Fit, errors: Mapping[str, float], spread: LikelySpread | None = None
) -> TrialMeasures:
    """The manoeuvres of every trial of a fit, and every number of them.

    Parameters
    ----------
    errors
        Standard errors of the unknowns by name, 1.96 of which are 95 %.
    spread
        What a prediction is uncertain by; without it there is none.
    """
    each = [_of_trial(fit, s.trial, errors, spread) for s in fit.scores]
    return TrialMeasures(
        manoeuvres=tuple(x for one in each for x in one.manoeuvres),
        numbers=tuple(x for one in each for x in one.numbers),
        turns=tuple(x for one in each for x in one.turns),
    )


def _of_trial(
    fit: Fit, trial: Trial, errors: Mapping[str, float], spread: LikelySpread | None
) -> TrialMeasures:
    size = fit.model.ship.particulars
    found = recognise(trial, size["L"], size["U0"])
    clock = samples_a_length(trial, size["L"], size["U0"])
    water = water_of(fit, trial, errors, spread) if found else None
    around = _around(fit, trial, water, spread, {m.kind for m in found})
    circles = [(turn, turn_reader(turn, clock)) for turn in find_turns(trial, found)]
    readers = [(m, r) for m in found if (r := _reader(trial, m, clock)) is not None]
    return TrialMeasures(
        manoeuvres=tuple(_manoeuvre(trial, m, clock, water) for m in found),
        numbers=(
            *heading_numbers(trial, found, around),
            *_track_numbers(fit, trial, readers, around),
        ),
        turns=tuple(_turn_measures(trial, circles, around)),
    )


def _manoeuvre(trial: Trial, one: Recognised, clock: int, water: Water | None) -> Manoeuvre:
    order = order_time(trial, one)
    last = max(int(order / trial.period), 0)
    speed, speed_by = approach_speed(trial, slice(max(last - clock, 0), last + 1), water)
    return Manoeuvre(
        trial=trial.name,
        kind=one.kind,
        t=order,
        end=min(one.end, trial.samples - 1) * trial.period,
        rudder=one.rudder,
        course=float(one.course % (2.0 * np.pi)) if "psi" in trial.signals else None,
        speed=speed,
        speed_by=speed_by,
        remark=one.remark,
    )


def approach_speed(trial: Trial, span: slice, water: Water | None) -> tuple[float | None, str]:
    """Speed [m/s] in a span and what tells it; None where neither a log nor positions tell it."""
    log, t = _seen(trial, ("u",), span), trial.t
    if len(log) >= FEWEST:
        u, words = trial.signals["u"][log], "log"
        if water is not None and water.in_log:
            psi, words = trial.signals["psi"][log], "log less the current"
            u = u - water.speed[0] * np.cos(psi) - water.speed[1] * np.sin(psi)
        return _known(float(np.mean(u)), float(np.std(u, ddof=1) / np.sqrt(len(u))), words)
    there = _seen(trial, ("x", "y"), span)
    if len(there) < FEWEST:
        return None, ""
    (north, sn), (east, se) = (_slope(t[there], trial.signals[n][there]) for n in ("x", "y"))
    drift = (0.0, 0.0) if water is None else water.speed
    ahead = north - drift[0], east - drift[1]
    speed = float(np.hypot(*ahead))
    error = float(np.hypot(ahead[0] * sn, ahead[1] * se)) / max(speed, 1e-9)
    words = "track over the ground" if water is None else "track less the current"
    return _known(speed, error, words)


def _known(speed: float, error: float, words: str) -> tuple[float | None, str]:
    return (speed, words) if NORMAL * error <= KNOWN * abs(speed) else (None, "")


def _slope(t: Vector, y: Vector) -> tuple[float, float]:
    """Of a line, and its standard error by what lies off it."""
    line, covariance = np.polyfit(t - np.mean(t), y, 1, cov=True)
    return float(line[0]), float(np.sqrt(covariance[0, 0]))


def _seen(trial: Trial, names: Sequence[str], span: slice) -> Indices:
    """Samples of a span at which all of these were recorded; none where one is no signal."""
    if not {*names} <= {*trial.signals}:
        return np.zeros(0, dtype=np.intp)
    return span.start + np.flatnonzero(np.all([trial.valid[n][span] for n in names], axis=0))


def _around(
    fit: Fit,
    trial: Trial,
    water: Water | None,
    spread: LikelySpread | None,
    kinds: set[str],
) -> Around:
    """What acts on a trial, as far as the manoeuvres in it need it."""
    if not kinds & {*ON_TRACK, *READERS}:
        return Around()
    sailed = None if spread is None else sail_trial(fit, trial, spread)
    calm = None
    if sailed is not None and has_wind(fit.model):
        calm = functools.partial(sail_from_order, fit, trial, sailed)
    size = fit.model.ship.particulars
    clock = samples_a_length(trial, size["L"], size["U0"])
    beyond = None if sailed is None else unexplained_motion(fit, clock)
    return Around(water=water, sailed=sailed, calm=calm, unexplained=beyond)


def water_of(
    fit: Fit, trial: Trial, errors: Mapping[str, float], spread: LikelySpread | None
) -> Water | None:
    """The current of a trial, or that in the speed of all; None where the fit looks for none."""
    values, _ = of_trial(fit, trial)
    names = next((each for each in (CURRENT, IN_SPEED) if {*each} <= {*values}), None)
    if names is None:
        return None
    north, east = (values[n] for n in names)
    own = [errors.get(f"{n} [{trial.name}]", errors.get(n)) for n in names]
    known = None if own[0] is None or own[1] is None else (own[0], own[1])
    return Water((north, east), known or _found_error(fit, trial, spread), names is IN_SPEED)


def _found_error(fit: Fit, trial: Trial, spread: LikelySpread | None) -> tuple[float, float] | None:
    """Of the current that a trial to check has found for itself."""
    found = own_start_error(fit, trial)
    if found is None or spread is None or not {*CURRENT} <= {*found.names}:
        return None
    places = [spread.fitted.index(c) for c in found.shared]
    by_ship = found.by @ spread.covariance[np.ix_(places, places)] @ found.by.T
    errors = np.sqrt(np.diag(found.noise @ found.noise.T + by_ship))
    north, east = (float(errors[found.names.index(n)]) for n in CURRENT)
    return north, east


def _reader(trial: Trial, one: Recognised, clock: int) -> TrackReader | None:
    """What reads a Williamson turn or a stop, where its track was seen."""
    if not {*NEEDED} <= {*trial.signals}:
        return None
    order = order_time(trial, one)
    reader = None
    if one.kind == "Williamson turn":
        reader = williamson_reader(one, order, clock)
    if one.kind == "stop":
        reader = stop_reader(one, order, clock, trial.samples)
    return reader if reader is not None and is_seen(trial, reader.span) else None


def _track_numbers(
    fit: Fit,
    trial: Trial,
    readers: Sequence[tuple[Recognised, TrackReader]],
    around: Around,
) -> Iterator[ManoeuvreNumber]:
    own_speed = "u" in fit.model.states
    for one, reader in readers:
        known = around if own_speed or one.kind != "stop" else Around(water=around.water)
        try:
            rows = track_numbers(reader, trial, known)
        except DesignError:
            continue  # the noise of the heading took the last degree
        for name, fields in rows.items():
            yield ManoeuvreNumber(
                trial=trial.name,
                kind=one.kind,
                t=reader.order,
                rudder=one.rudder,
                name=name,
                unit=reader.units[name],
                **fields,
            )


def _turn_measures(
    trial: Trial, circles: Sequence[tuple[Turn, TrackReader]], around: Around
) -> Iterator[TurnMeasure]:
    for turn, reader in circles:
        try:
            rows = track_numbers(reader, trial, around)
        except DesignError:
            continue  # the noise of the heading took the last degree
        for name, fields in rows.items():
            yield TurnMeasure(trial=trial.name, t=turn.t, rudder=turn.rudder, name=name, **fields)
