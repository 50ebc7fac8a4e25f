"""A heel that is held and let go: what lies before the release is no motion of the ship's own.

A model is heeled by hand, held, and swings when she is let go. A simulation that begins while she
is held has a moment in it that no log holds, and a fit puts an effect of the heel in its place.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.names.quantities import RUDDERS, SIGNALS
from trialid.trial import Trial

STILL: Final = 0.1
"""Share of the heel, from where it comes to rest, within which it is held: hands are not still. Of
300 drawn decays that begin held, by a hand that goes by up to 4 %, 260 are found, their releases up
to 0.12 of a period late, and of 300 that begin free none; half finds 187, twice 295 and 33."""

NOISE: Final = 4.0
"""Standard deviations of the sensor's noise that count as still, where that is no more than half as
much again as `STILL`: in more noise than that no heel is seen to stand."""

A_GOOD_PART: Final = 0.25
"""Share of the roll period that a held heel stands for at least: a free one is within `STILL` of
its turn for 0.14. Of 297 decays that are held for a fifth of a period 293 are told, of 300 that are
free none. Half of it tells 15 of these to be held, with twice of it none of the 297 is told."""

AGAIN: Final = 0.8
"""As much, where she rolled further before, as when she is heeled again: late swings are small, and
where they come to rest is not known to a tenth of them. With 0.3 in its place 6 of 1000
free decays are cut, with half or twice of this none."""

AT_ONCE: Final = 0.6
"""Share of the roll period in which she swings from there through where she comes to rest: a
quarter where she is free; what is let down slowly is no release. Half of it misses 7 of 268."""

OVER: Final = 0.15
"""Share of the heel that she swings to the other side: damped by half of what is critical. Of the
drawn ones, damped by up to a fifth, none is told otherwise with half or twice of it."""

DIES: Final = 0.9
"""Share of the heel that the last third of the record swings by at most: what is held again, or
driven, goes on. Half of it misses 7 of 268 whose records are short, twice of it asks for nothing.
"""

STEERED: Final = float(np.deg2rad(5.0))
"""[rad] What a rudder goes from side to side in a trial of which the roll is no answer to it: a
course is kept with less. Half of it misses decays under an autopilot, twice of it is a zig-zag of
5 deg. Of 112 zig-zags of roro ships 21 were told to be held where it was asked for the time of the
swing alone: a rudder that has gone over stands still, too. Of what is no angle it is 0.09 of its
unit, a tenth of full, and then it goes by `DRIVEN`."""

DRIVEN: Final = 0.25
"""Share of the most it shows that what steers or drives her goes by in a trial of which the roll is
no answer to it. Of 52 zig-zags and turns of ferries with two rudders, an outsider's, 15 were told
to be held where rudders with names of their own were not asked; none is, nor with half or twice."""

LEAST: Final = float(np.deg2rad(1.0))
"""[rad] Heel that is held at least, from where it comes to rest: less has no roll worth reading. Of
the drawn ones, of 3 to 20 deg, none is told otherwise with half or twice of it."""

KNOWN: Final = 0.5
"""Share of a held heel that was measured: a straight line through a gap stands still, too, and a
hold with half of it in a gap is as likely none."""

PIECE: Final = 5
"""Samples whose middle is a heel that may be held: noise does not move it, nor a swing in them."""

LEFT: Final = float(np.arccos(1.0 - STILL)) / (2.0 * np.pi)
"""Share of the roll period in which a free swing leaves `STILL` of where it began."""


@dataclass(frozen=True)
class Held:
    """A heel that was held: the samples from `begin` up to `release`, the first that is free."""

    begin: int
    release: int
    heel: float

    def stands(self, trial: Trial) -> str:
        """At what heel and how long, in words."""
        span = (self.release - self.begin) * trial.period
        return f"phi stands at {np.rad2deg(self.heel):.1f} deg for {span:.1f} s and then swings"

    def words(self, trial: Trial) -> str:
        """That she was held, and when she was let go [s], as a window of the log states it."""
        at = released_at(trial, self)
        return f"{self.stands(trial)}: she was held; begin the window at {at:.1f} s"


def released_at(trial: Trial, held: Held) -> float:
    """When she was free [s], on the clock of a pipeline's windows; a tenth of a second later."""
    return float(np.ceil(10.0 * (trial.opening + held.release * trial.period) - 1e-6)) / 10.0


def without_held_roll(trial: Trial) -> Trial:
    """The trial from the release on, with a remark, where it begins with a heel that is held."""
    if (held := held_roll(trial)) is None:
        return trial
    first = trial.opening + held.release * trial.period
    last = trial.opening + trial.duration
    used = f"{held.words(trial)}: only [{first:.1f}, {last:.1f}] s is used"
    return trial.part(held.release, trial.samples, used)


def held_roll(trial: Trial) -> Held | None:
    """The heel that is held and let go in a trial, None where none is; the last one of several."""
    phi = trial.signals.get("phi")
    if phi is None or trial.samples < 4 * PIECE or not trial.valid["phi"].any():
        return None
    if _steered(trial):
        return None
    rest = float(np.median(np.array_split(phi, 3)[-1]))
    noise = noise_of(phi)
    for begin, end in reversed(_plateaus(phi - rest, noise)):
        heel = float(np.median(phi[begin:end]))
        after = np.sign(heel - rest) * (phi[end:] - rest)
        greatest = abs(heel - rest) * (1.0 + STILL) >= np.max(
            np.abs(phi[:begin] - rest), initial=0.0
        )
        period = _swing(after, abs(heel - rest), noise)
        part = A_GOOD_PART if greatest else AGAIN
        if period is None or end - begin < max(part * period, PIECE):
            continue
        known = _known(trial.valid["phi"])[begin:end].mean()
        if known > KNOWN and _turned(trial, slice(begin, end)) < abs(heel - rest):
            return Held(begin, end - int(LEFT * period) + 1, heel)
    return None


def _swing(after: Vector, heel: float, noise: float) -> int | None:
    """Period of the swing from a held heel [rad], in samples; None where it is no free one.

    Counted positive to the side of the heel: she goes through where she comes to rest at once, over
    to the other side, never further than she was held, and less in the end.
    """
    through = int(np.argmax(after < 0.0)) if np.any(after < 0.0) else len(after)
    back = np.flatnonzero(after[through:] > 0.0)
    if not len(back):
        return None
    half = int(back[0])
    over = -float(np.min(after[through : through + half]))
    size, late = (float(np.max(np.abs(y))) for y in (after, np.array_split(after, 3)[-1]))
    free = (
        over > max(OVER * heel, NOISE * noise)
        and through <= AT_ONCE * 2 * half
        and size <= heel * (1.0 + STILL) + NOISE * noise
        and late <= DIES * heel
    )
    return 2 * half if free else None


def noise_of(y: Vector) -> float:
    """Standard deviation of what is white in it, by its third differences: swings have little."""
    return float(np.median(np.abs(np.diff(y, 3)))) / 0.6745 / 20.0**0.5


def _plateaus(off: Vector, noise: float) -> list[tuple[int, int]]:
    """Stretches that stand still, the heel beyond all that comes after; ends are one past the last.

    In the order in which they end, which is before the end of the record.
    """
    pieces = np.array_split(np.arange(len(off)), max(len(off) // PIECE, 1))
    levels = np.array([float(np.median(off[piece])) for piece in pieces])
    later = np.maximum.accumulate(np.abs(levels)[::-1])[::-1]
    far = np.abs(levels) * (1.0 + STILL) + NOISE * noise >= later
    clear = np.abs(levels) >= max(LEAST, NOISE * noise / (1.5 * STILL))
    found, seen = list[tuple[int, int]](), 0
    for k in np.flatnonzero(far & clear):
        near = pieces[k][np.argmin(np.abs(off[pieces[k]] - levels[k]))]
        if (middle := int(near)) < seen:
            continue
        band = max(STILL * abs(levels[k]), NOISE * noise)
        moved = np.flatnonzero(np.abs(off - levels[k]) > band)
        place = int(np.searchsorted(moved, middle))
        begin = int(moved[place - 1]) + 1 if place else 0
        seen = int(moved[place]) if place < len(moved) else len(off)
        found.append((begin, seen))
    return [(begin, end) for begin, end in found if begin < end < len(off)]


def _known(valid: Mask) -> Mask:
    """What was measured, and the ends, where a low-pass has only one side of it."""
    known, at = valid.copy(), np.flatnonzero(valid)
    known[: at[0]] = known[at[-1] :] = True
    return known


def _steered(trial: Trial) -> bool:
    """Whether a rudder, or an actuator that has a name of its own, goes far in a trial."""
    moved = (y for n, y in trial.signals.items() if n in RUDDERS or n not in SIGNALS)
    return any(
        course_span(y) > max(STEERED, DRIVEN * float(np.max(np.abs(y))), NOISE * noise_of(y))
        for y in moved
    )


def course_span(y: Vector) -> float:
    """How far a signal goes, beside its noise: of its smooth course from end to end."""
    pieces = np.array_split(y, max(min(len(y) // 5, 20), 1))
    middles = [float(np.median(piece)) for piece in pieces]
    return max(middles) - min(middles)


def _turned(trial: Trial, part: slice) -> float:
    """Angle that she turns through while it is held [rad]: a steady turn heels her, too."""
    r = trial.signals.get("r")
    if r is not None:
        return abs(float(np.sum(r[part]))) * trial.period
    psi = trial.signals.get("psi")
    return 0.0 if psi is None else course_span(psi[part])
