"""Manoeuvres in a record by evidence: what the rudder, the shaft and the heading did.

The rudder is cut into excursions, from where it leaves midships to where it comes back or crosses.
One that was held through 180 deg is a turning circle; some of opposite sides and one angle, each
given at one change of heading, are a zig-zag; a rudder that stays midships after a long turn is a
pull-out; angles that go down by steps from one side to the other are a spiral; a shaft that turns
astern while the ship has way is a stop. Whatever is none of these has no name.
"""

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from trialid.arrays import Vector
from trialid.design.imo.excursions import (
    ALIKE,
    HELD,
    MIDSHIPS,
    STRAIGHT,
    Excursion,
    SteeredRecord,
    given_back,
    heading,
    is_held,
    rudder_of,
)
from trialid.trial import Trial

Kind = Literal["turning circle", "turn", "zig-zag", "pull-out", "spiral", "stop"]

PULL_OUT: Final = 3.0
"""Ship lengths of midships after a turn: a rate that is not to stay has fallen by then. On
the days that `excursions` speaks of, by twice of it 64 of 71 manoeuvres are found, by half all but
one as here."""
ROUND, SPARE = float(np.deg2rad(5.0)), float(np.deg2rad(0.7))
"""Angles that are ordered, and by how much helmsman, compass and rudder are off them: by half of it
one name less is wrong on those days, by twice two more are."""
SLOWEST_GEAR: Final = 2.0 * 6.0 / (65.0 / 28.0)
"""[s] Twice what SOLAS leaves a gear for the 6 deg about midships: 65 deg in 28 s."""
RECENT: Final = 200
"""Samples that tell where a rudder is held."""
STEPS: Final = 5
"""Angles of a spiral at least, of both sides."""
WAY: Final = 0.1
"""Share of the approach speed at which a ship is stopped."""
QUARTER: Final = np.pi / 2.0


@dataclass(frozen=True, kw_only=True)
class Recognised:
    """A manoeuvre: samples from the order on, `end` one past the last.

    Attributes
    ----------
    reversals
        Samples at which the rudder was ordered over, of a zig-zag; else empty.
    rudder
        First angle held [rad], zero for a stop.
    course
        Mean heading before the order [rad].
    remark
        What it lacks; empty where it is whole.
    """

    kind: Kind
    execute: int
    end: int
    rudder: float
    course: float
    reversals: tuple[int, ...] = ()
    remark: str = ""


def recognise(trial: Trial, length: float, speed: float) -> tuple[Recognised, ...]:
    """The manoeuvres of a trial in the order of time; none without a rudder and a heading.

    Parameters
    ----------
    length, speed
        Of the ship [m] and of her approach [m/s]: her own clock.
    """
    psi = heading(trial)
    rudder = rudder_of(trial)
    if psi is None or rudder is None:
        return ()
    found = SteeredRecord(trial, rudder, psi, max(round(length / speed / trial.period), 10))
    steered = [*_spirals(found)]
    free = [e for e in found.excursions if not any(m.execute <= e.begin < m.end for m in steered)]
    steered += _zigzags(found, free)
    free = [e for e in free if not any(m.execute <= e.begin < m.end for m in steered)]
    steered += _turns(found, free)
    steered += [*_pull_outs(found, free), *_stops(found, steered)]
    return tuple(sorted(steered, key=lambda m: m.execute))


def _turns(record: SteeredRecord, free: Sequence[Excursion]) -> Iterator[Recognised]:
    for one in free:
        turned, course = record.turned(one), record.straight(one.begin)
        if not is_held(one) or course is None or turned < QUARTER:
            continue
        short = f"broken off at {np.rad2deg(turned):.0f} deg of heading"
        yield Recognised(
            kind="turning circle" if turned >= 2.0 * QUARTER else "turn",
            execute=one.begin,
            end=given_back(record, one, one.end),
            rudder=one.angle,
            course=course,
            remark="" if turned >= 2.0 * QUARTER else short,
        )


def _zigzags(record: SteeredRecord, free: Sequence[Excursion]) -> Iterator[Recognised]:
    """Runs of excursions to alternate sides, of one angle, given at one change of heading."""
    place = 0
    while place < len(free):
        run = _run(record, free, place)
        course = record.straight(free[place].begin)
        if len(run) < 2 or course is None or (len(run) == 2 and not _round(record, run, course)):
            place += 1
            continue
        yield Recognised(
            kind="zig-zag",
            execute=run[0].begin,
            end=given_back(record, run[-1], run[-1].end),
            rudder=run[0].angle,
            course=course,
            reversals=tuple(given_back(record, a, b.begin) for a, b in itertools.pairwise(run)),
            remark="broken off after the first reversal" if len(run) == 2 else "",
        )
        place += len(run)


def _round(record: SteeredRecord, run: Sequence[Excursion], course: float) -> bool:
    """Whether rudder and change of heading are numbers that a crew is told: 10 and 10, 20 and 20.

    One reversal alone is also what a helmsman does who meets a turn.
    """
    k = given_back(record, run[0], run[1].begin)
    change, late = abs(record.psi[k] - course), 2.0 * abs(record.psi[k] - record.psi[k - 1])
    spares = ((change, SPARE + late), (abs(run[0].angle), SPARE))
    return all(abs(x - ROUND * round(x / ROUND)) <= spare for x, spare in spares)


def _run(record: SteeredRecord, free: Sequence[Excursion], place: int) -> list[Excursion]:
    """The longest zig-zag that begins with an excursion; that alone where there is none."""
    run = [free[place]]
    course = record.straight(run[0].begin)
    if course is None or not is_held(run[0]):
        return run
    reached: list[float] = []
    for one in free[place + 1 :]:
        last = run[-1]
        change = abs(record.psi[given_back(record, last, one.begin)] - course)
        near = (one.begin - last.end) * record.trial.period <= SLOWEST_GEAR
        alike = abs(abs(one.angle) - abs(run[0].angle)) <= ALIKE * abs(run[0].angle)
        usual = reached[0] if reached else change
        even = abs(change - usual) <= max(ALIKE * usual, STRAIGHT) and change > STRAIGHT
        if not (near and alike and even and one.angle * last.angle < 0.0 and change < QUARTER):
            break
        if one.held < HELD and one is not free[-1]:
            break
        reached.append(change)
        run.append(one)
    return run


def _pull_outs(record: SteeredRecord, free: Sequence[Excursion]) -> Iterator[Recognised]:
    """Midships after a turn with the rudder held, and left alone."""
    for one in free:
        if not is_held(one) or record.turned(one) < QUARTER:
            continue
        away = np.flatnonzero(np.abs(record.rudder[one.end :]) > MIDSHIPS / 2.0)
        came = np.flatnonzero(np.abs(record.rudder[one.end :]) <= MIDSHIPS / 2.0)
        begin = one.end + (int(came[0]) if len(came) else 0)
        later = away[away > begin - one.end]
        end = one.end + int(later[0]) if len(later) else len(record.rudder)
        if end - begin >= round(PULL_OUT * record.clock) and _goes_on(record, one, begin):
            yield Recognised(
                kind="pull-out",
                execute=given_back(record, one, one.end),
                end=end,
                rudder=one.angle,
                course=float(record.psi[one.end - 1]),
            )


def _goes_on(record: SteeredRecord, one: Excursion, begin: int) -> bool:
    """Whether she still turns when the rudder is midships: no counter rudder took it off."""
    clock, side = record.clock, float(np.sign(one.angle))
    execute = given_back(record, one, one.end)
    before = side * (record.psi[execute] - record.psi[max(execute - clock, 0)])
    after = side * (record.psi[min(begin + clock, len(record.psi) - 1)] - record.psi[begin])
    return bool(after > 0.1 * before)


def _spirals(record: SteeredRecord) -> Iterator[Recognised]:
    """Angles held one after another that go down by steps through midships to the other side."""
    levels = list(_levels(record))
    place = 0
    while place < len(levels):
        run = [levels[place]]
        for begin, end, angle in levels[place + 1 :]:
            down = (run[-1][2] - angle) * np.sign(run[0][2])
            if down <= MIDSHIPS / 3.0 or begin - run[-1][1] > record.clock:
                break
            run.append((begin, end, angle))
        if len(run) >= STEPS and run[0][2] * run[-1][2] < 0.0:
            first = _left_midships(record, run[0][0])
            yield Recognised(
                kind="spiral",
                execute=first,
                end=run[-1][1],
                rudder=run[0][2],
                course=float(record.psi[first]),
            )
            place += len(run)
        else:
            place += 1


def _left_midships(record: SteeredRecord, k: int) -> int:
    """The sample after which the rudder went over to where it is at a later one."""
    side = np.sign(record.rudder[k])
    while k > 0 and record.rudder[k - 1] * side > MIDSHIPS / 2.0:
        k -= 1
    return k


def _levels(record: SteeredRecord) -> Iterator[tuple[int, int, float]]:
    """Stretches of at least two ship lengths in which the rudder stays within a degree."""
    rudder, begin = record.rudder, 0
    summed = np.concatenate([[0.0], np.cumsum(rudder)]).tolist()
    for k in range(1, len(rudder) + 1):
        first = max(begin, k - RECENT)
        if k < len(rudder):
            usual = (summed[k] - summed[first]) / (k - first)
            if abs(rudder[k] - usual) <= MIDSHIPS / 3.0:
                continue
        if k - begin >= 2 * record.clock:
            yield begin, k, float(np.median(rudder[begin:k]))
        begin = k


def _stops(record: SteeredRecord, steered: Sequence[Recognised]) -> Iterator[Recognised]:
    """The shaft astern while the ship has way, until she has none."""
    n, u = record.trial.signals.get("n"), record.trial.signals.get("u", _over_ground(record.trial))
    if n is None or u is None:
        return
    ahead = float(np.quantile(n, 0.9))
    begun = np.flatnonzero((n[1:] < 0.0) & (n[:-1] >= 0.0)) + 1
    for k in begun.tolist():
        approach = float(np.mean(u[max(k - record.clock, 0) : k]))
        if ahead <= 0.0 or approach <= 0.5 * float(np.quantile(u, 0.9)):
            continue
        stopped = np.flatnonzero(u[k:] <= WAY * approach)
        turning = np.flatnonzero(n[k:] >= 0.0)
        end = k + int(stopped[0]) if len(stopped) else len(u)
        if any(m.execute <= k < m.end for m in steered):
            continue
        if len(turning) and k + int(turning[0]) < end:
            end = k + int(turning[0])
        execute = _left_ahead(n, k)
        whole = len(stopped) > 0 and end == k + int(stopped[0])
        yield Recognised(
            kind="stop",
            execute=execute,
            end=end,
            rudder=0.0,
            course=float(np.mean(record.psi[max(execute - record.clock, 0) : execute + 1])),
            remark="" if whole else "broken off before she stopped",
        )


def _left_ahead(n: Vector, k: int) -> int:
    """The sample at which the shaft left its revolutions ahead."""
    usual = float(np.median(n[max(k - 400, 0) : k]))
    while k > 0 and n[k - 1] < (1.0 - ALIKE / 3.0) * usual:
        k -= 1
    return k


def _over_ground(trial: Trial) -> Vector | None:
    """Speed over the ground [m/s]; None where no position is recorded."""
    if "sog" in trial.signals:
        return trial.signals["sog"]
    if not {"x", "y"} <= {*trial.signals}:
        return None
    return np.hypot(*(np.gradient(trial.signals[c], trial.period) for c in ("x", "y")))
