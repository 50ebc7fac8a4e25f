"""Manoeuvres in a record by evidence: what the rudder, the shaft and the heading did.

The rudder is cut into excursions, from where it leaves midships to where it comes back or crosses.
One that was held through 180 deg is a turning circle; some of opposite sides and one angle, each
given at one change of heading, are a zig-zag; a rudder that stays midships after a long turn is a
pull-out; angles that go down by steps from one side to the other are a spiral; a shaft that turns
astern while the ship has way is a stop; a turn out, round to the other side and steady on the
reciprocal course is a Williamson turn. Whatever is none of these has no name.
"""

import itertools
from collections.abc import Iterator, Sequence
from typing import Final

import numpy as np

from trialid.arrays import Mask
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
    reverses,
    rudder_of,
)
from trialid.design.imo.recognition import Recognised
from trialid.design.imo.spirals import find_spirals
from trialid.design.imo.stops import find_stops
from trialid.design.imo.williamson import find_williamson_turns
from trialid.trial import Trial

PULL_OUT: Final = 3.0
"""Ship lengths of midships after a turn: a rate that is not to stay has fallen by then. On
the days that `excursions` speaks of, by twice of it 63 of 65 manoeuvres are found, by half all."""
SETTLED: Final = 0.05
"""Share of the rate of turn before, by which it may still change: she would fall by less than that
again. A compass of 0.2 deg noise alone makes it 1.6 % over two ship lengths of 20 s."""
UNSETTLED: Final = "the rate of turn had not settled"
ROUND, SPARE = float(np.deg2rad(5.0)), float(np.deg2rad(0.7))
"""Angles that are ordered, and by how much helmsman, compass and rudder are off them. Half and
twice change nothing on those days."""
QUARTER: Final = np.pi / 2.0


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
    record = SteeredRecord(trial, rudder, psi, samples_a_length(trial, length, speed))
    found = list(find_spirals(record))
    for search in (find_williamson_turns, _zigzags):
        found += search(record, _free(record, found))
    free = _free(record, found)
    found += _turns(record, free)
    found += [*_pull_outs(record, free), *find_stops(record, _taken(record, found))]
    return tuple(sorted(found, key=lambda m: m.execute))


def samples_a_length(trial: Trial, length: float, speed: float) -> int:
    """Samples in which the ship runs her length, 10 at least."""
    return max(round(length / speed / trial.period), 10)


def _free(record: SteeredRecord, found: Sequence[Recognised]) -> list[Excursion]:
    """What the rudder did besides the manoeuvres found."""
    taken = _taken(record, found)
    return [e for e in record.excursions if not taken[e.begin]]


def _taken(record: SteeredRecord, found: Sequence[Recognised]) -> Mask:
    """The samples of manoeuvres; (N,)."""
    taken = np.zeros(len(record.psi), dtype=bool)
    for one in found:
        taken[one.execute : one.end] = True
    return taken


def _turns(record: SteeredRecord, free: Sequence[Excursion]) -> Iterator[Recognised]:
    for one in free:
        turned = record.turned(one)
        if turned < QUARTER or not is_held(one):
            continue
        course = record.straight(one.begin)
        if course is None:
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
        course = record.straight(free[place].begin) if is_held(free[place]) else None
        run = [] if course is None else _run(record, free, place, course)
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
            remark=_lacks(record, run, free[place + 2 : place + 3]),
        )
        place += len(run)


def _lacks(record: SteeredRecord, run: Sequence[Excursion], rest: Sequence[Excursion]) -> str:
    """Why a zig-zag has no second reversal: there was none, or not at that change of heading."""
    if len(run) > 2:
        return ""
    if rest and reverses(record, run[-1], rest[0], run[0].angle):
        return "the second reversal is at another change of heading"
    return "broken off after the first reversal"


def _round(record: SteeredRecord, run: Sequence[Excursion], course: float) -> bool:
    """Whether rudder and change of heading are one number that a crew is told: 10/10, 20/20.

    One reversal alone is also what a helmsman does who meets a turn. So both angles of the rudder
    and the change of heading are to be that number: by chance less than one time in thirty.
    """
    k = given_back(record, run[0], run[1].begin)
    change, late = abs(record.psi[k] - course), 2.0 * abs(record.psi[k] - record.psi[k - 1])
    told = ROUND * round(abs(run[0].angle) / ROUND)
    spares = ((change, SPARE + late), *((abs(one.angle), SPARE) for one in run))
    return all(abs(x - told) <= spare for x, spare in spares)


def _run(
    record: SteeredRecord, free: Sequence[Excursion], place: int, course: float
) -> list[Excursion]:
    """The longest zig-zag that begins with an excursion; that alone where there is none.

    An indicator may differ from side to side, but to one side an order is the same angle again.
    """
    run, usual = [free[place]], 0.0
    for k in range(place + 1, len(free)):
        last, one = run[-1], free[k]
        if not reverses(record, last, one, run[0].angle):
            break
        turned = record.psi[given_back(record, last, one.begin)] - course
        change = float(np.sign(last.angle) * turned)  # on the side to which she was turned
        usual = usual or change
        even = abs(change - usual) <= max(ALIKE * usual, STRAIGHT) and change > STRAIGHT
        again = len(run) < 2 or abs(abs(one.angle) - abs(run[-2].angle)) <= 2.0 * SPARE
        if not (even and again) or change >= QUARTER or (one.held < HELD and k < len(free) - 1):
            break
        run.append(one)
    return run


def _pull_outs(record: SteeredRecord, free: Sequence[Excursion]) -> Iterator[Recognised]:
    """Midships after a turn with the rudder held, and left alone."""
    rest = np.abs(record.rudder) > MIDSHIPS / 2.0
    away, came = (np.append(np.flatnonzero(x), len(rest)) for x in (rest, ~rest))
    for one in free:
        if record.turned(one) < QUARTER or not is_held(one):
            continue
        begin = int(came[np.searchsorted(came, one.end)])
        end = int(away[np.searchsorted(away, begin)])
        if end - begin >= round(PULL_OUT * record.clock) and _goes_on(record, one, begin):
            yield Recognised(
                kind="pull-out",
                execute=given_back(record, one, one.end),
                end=end,
                rudder=one.angle,
                course=float(record.psi[one.end - 1]),
                remark="" if _settled(record, one, end) else UNSETTLED,
            )


def _settled(record: SteeredRecord, one: Excursion, end: int) -> bool:
    """Whether the rate of turn changes no more, from the second third of a pull-out to the last."""
    execute = given_back(record, one, one.end)
    third = (end - execute) // 3
    middle, last = (
        float(np.polyfit(np.arange(third), record.psi[k - third : k], 1)[0])
        for k in (end - third, end)
    )
    before = record.psi[execute] - record.psi[max(execute - record.clock, 0)]
    return bool(abs(last - middle) <= SETTLED * abs(before) / record.clock)


def _goes_on(record: SteeredRecord, one: Excursion, begin: int) -> bool:
    """Whether she still turns when the rudder is midships: no counter rudder took it off."""
    clock, side = record.clock, float(np.sign(one.angle))
    execute = given_back(record, one, one.end)
    before = side * (record.psi[execute] - record.psi[max(execute - clock, 0)])
    after = side * (record.psi[min(begin + clock, len(record.psi) - 1)] - record.psi[begin])
    return bool(after > 0.1 * before)
