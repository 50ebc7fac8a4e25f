"""Do the signals of a trial agree in sign with one another? Nothing is ever flipped here.

Positive rudder turns the bow to starboard: over a stretch of time the rate of turn grows with the
mean rudder, less what the ship's own damping, the mean rate of turn, takes away. So the correlation
is a partial one, with the mean rate of turn taken out of both. And the heading grows with the mean
rate of turn. The length of the stretches is the one that shows the relation best: short ones drown
in noise, long ones are few.

A light boat follows her rudder so fast that the rate of turn itself goes with it, and nothing is
left of its change; then the rate of turn is held against the rudder directly. A helmsman who meets
every swing would show the opposite sign there, but after the ship and not before her.
"""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from trialid.alignment.agreement import relation
from trialid.alignment.agreement.held_turn import held_turn
from trialid.alignment.agreement.turning import Turning
from trialid.alignment.sources import SignalSource
from trialid.arrays import Mask, Vector
from trialid.errors import AlignmentError
from trialid.names.quantities import RUDDERS
from trialid.trial import Trial

CONTRADICTION = -0.3
"""Correlation below which a sign is taken to be wrong."""
FEWEST_STRETCHES = 20
"""Independent stretches the record must hold; fewer correlate by chance."""
PARTS = 4
"""The record is looked at in so many parts: two must agree with the whole, none contradict it."""
MOVES = 0.25
"""A part in which the cause moves by less than this share of its whole range says nothing."""
FOLLOWS, FOLLOWS_PART = 0.8, 0.6
"""Correlation of rudder and rate of turn, in all and in each part, when the one follows the other
at once."""
STANDS = 0.25
"""Of a rudder that stands still the steps from sample to sample have this share at least of what
white noise has: a mean over samples leaves 0.4 of it, zig-zags of 10 samples from one reversal to
the next 0.2, of 20 0.1. Of four roll decays with the rudder amidships one was refused, as inverted
by chance: with twice of it, too. Half of it is a zig-zag of 16 samples."""
FIDGETS = float(np.deg2rad(5.0))
"""[rad] And it goes no further than that from end to end. Half of it is the noise of some, twice of
it a zig-zag of 5 deg in a slow log."""
STRETCH = 0.6
"""[s] A light boat's turn changes over this. Of nine records whose motors are logged 0.5 to 2.5 s
late, and eight whose clocks are one, three of them with the sides exchanged, each has its side, and
the delay to 0.4 s: with half of it, too, and to 0.8 s with twice. A ninth, whose motors hardly turn
her, shows neither."""
APART = 8.0
"""[s] Clocks that are further apart show in what they hold of themselves."""
DEPENDENT = 0.03
"""Share of a signal that must be left without the damping; less tells delays, not signs."""


def check(trial: Trial, sources: Mapping[str, SignalSource], where: str) -> Iterator[str]:
    """Remarks on signs that agree; AlignmentError on a clear contradiction."""
    if "r" in trial.signals and "psi" in trial.signals:
        yield from _heading(trial, where)
    turning = rate_of_turn(trial)
    rudders = RUDDERS | _together(trial, sources)
    for rudder in sorted(rudders & trial.signals.keys()):
        if turning is not None and runs_ahead(trial):
            yield from _rudder(trial, rudder, turning, sources[rudder], where)


def _together(trial: Trial, sources: Mapping[str, SignalSource]) -> set[str]:
    """Rudders of several that move alike; apart from the others one may well go against them."""
    several = [n for n, s in sources.items() if s.of is not None and s.of.steers]
    moved = [trial.signals[n] for n in several if np.ptp(trial.signals[n]) > 0.0]
    if not moved or len(moved) < len(several):
        return set()
    alike = np.min(np.corrcoef(moved)) > FOLLOWS
    return {*several} if alike else set()


def _heading(trial: Trial, where: str) -> Iterator[str]:
    valid = trial.valid["r"] & trial.valid["psi"]
    found = agreement(trial.signals["r"], trial.signals["psi"], valid)
    if contradicts(found):
        raise AlignmentError(
            f"{where}: r and the slope of psi have opposite signs (correlation {found[0]:.2f} over "
            f'{trial.duration:.0f} s); add positive = "port" to the one that is positive to port'
        )
    yield f"r and the slope of psi: correlation {found[0]:.2f}"


def _rudder(
    trial: Trial, rudder: str, turning: tuple[Vector, Mask], source: SignalSource, where: str
) -> Iterator[str]:
    found = answer(trial, rudder, turning)
    if found.sign < 0:
        other = "port" if source.positive == "starboard" else "starboard"
        raise AlignmentError(
            f"{where}: {rudder} looks inverted, the ship turns the other way (correlation of "
            f"{rudder} with {found.words} {found.correlation:.2f} over {trial.duration:.0f} s); "
            f'write positive = "{other}" for {rudder}, or correct the sign of the rate of turn'
        )
    yield f"{rudder} and {found.words}: correlation {found.correlation:.2f}"


def answer(trial: Trial, rudder: str, turning: tuple[Vector, Mask]) -> Turning:
    """How the ship answers this rudder; `turning` is from `rate_of_turn`."""
    rate, valid = turning
    delta, both = trial.signals[rudder], valid & trial.valid[rudder]
    found = answer_of(delta, rate, both, trial.period)
    held = found if found.sign else held_turn(delta, rate, both, trial.period)
    return held if held.sign else found


def answer_of(
    rudder: Vector, rate: Vector, both: Mask, period: float, beside: Sequence[Vector] = ()
) -> Turning:
    """The same of a rudder and a rate of turn on one clock, `period` [s], where both are valid.

    What else turns her, `beside`, is taken out as her damping is.
    """
    if _stands(rudder[both]):
        return Turning(0.0, 0.0, "dr/dt")
    whole, parts = agreement(rudder, rate, both, (rate, *beside))
    for side in (1.0, -1.0):
        if contradicts((-side * whole, [-side * part for part in parts])):
            return Turning(side, whole, "dr/dt")
    at_once = relation.of_values(rudder, rate, both, period)
    if at_once is not None and _follows(at_once):
        sign = float(np.sign(at_once.correlation))
        return Turning(sign, at_once.correlation, "r, which follows at once")
    return Turning(0.0, whole, "dr/dt")


def _stands(rudder: Vector) -> bool:
    """Whether nothing of a rudder is more than the noise of its sensor: that tells no side."""
    if len(rudder) < FEWEST_STRETCHES or np.ptp(rudder) > FIDGETS:
        return False
    return float(np.mean(np.diff(rudder) ** 2)) >= STANDS * 2.0 * float(np.var(rudder))


def _follows(found: relation.Relation) -> bool:
    """True when the rate of turn goes with the rudder itself, at once and not before it."""
    sign = np.sign(found.correlation)
    same = [sign * part for part in found.parts]
    return bool(
        abs(found.correlation) >= FOLLOWS
        and len(same) >= 2
        and min(same) >= FOLLOWS_PART
        and found.lag >= 0.0
        and abs(found.at_once) >= 0.95 * abs(found.correlation)
        and found.against <= 0.3
    )


def rate_of_turn(trial: Trial) -> tuple[Vector, Mask] | None:
    """Rate of turn [rad/s], from the heading where it was not logged, and where it is valid."""
    if "r" in trial.signals:
        return trial.signals["r"], trial.valid["r"]
    if "psi" in trial.signals:
        return np.gradient(trial.signals["psi"], trial.period), trial.valid["psi"]
    return None


def runs_ahead(trial: Trial) -> bool:
    """A rudder works the other way when the ship goes astern; then it cannot be judged."""
    return "u" not in trial.signals or float(np.median(trial.signals["u"])) > 0


def contradicts(found: tuple[float, list[float]]) -> bool:
    """True when the record as a whole says that a sign is wrong, and its parts agree with that."""
    whole, parts = found
    against = sum(part < CONTRADICTION for part in parts)
    return whole < CONTRADICTION and against >= 2 and max(parts) < -CONTRADICTION


def agreement(
    cause: Vector, effect: Vector, valid: Mask, others: Sequence[Vector] = ()
) -> tuple[float, list[float]]:
    """Correlation of the mean of `cause` with the change of `effect` over stretches of time.

    The means of `others`, as of damping, are taken out of both first. Second result: the same in
    each part of the record. Zero, and no parts, where nothing moves or the record is too short.
    """
    tables = list(_doubled(cause, effect, others, valid))
    strengths = [_correlation(table) for table in tables]
    if not strengths:
        return 0.0, []
    best = int(np.argmax(np.abs(strengths)))
    parts = [_correlation(part) for part in _moving_parts(tables[best])]
    return strengths[best], [part for part in parts if part != 0.0]


def late_cause(cause: Vector, effect: Vector, valid: Mask, period: float) -> tuple[float, float]:
    """At which delay of the effect [s] a cause goes with its change best, and their correlation.

    Over short stretches: in long ones a turn and the next one to the other side run together. A
    cause that is logged late has the effect before it, and a delay below zero.

    Parameters
    ----------
    cause, effect, valid
        On one clock of this period [s], and where both are; (N,) each.
    """
    n = max(1, round(STRETCH / period))
    most = min(int(APART / period), len(cause) // 2 - 3 * n)
    found = [(0.0, 0.0)]
    for k in range(-most, most + 1):
        whole = slice(max(0, k), len(cause) + min(0, k))
        part = slice(max(0, -k), len(cause) - max(0, k))
        table = _of_stretches(cause[part], effect[whole], valid[part] & valid[whole], n)
        found.append((_correlation(table), k * period))
    strength, lag = max(found, key=lambda x: abs(x[0]))
    return lag, strength


def _of_stretches(cause: Vector, effect: Vector, valid: Mask, n: int) -> Vector:
    """Mean cause of stretches of n samples, change of the effect over them, its mean; (m, 3)."""
    means = [np.convolve(y, np.full(n, 1.0 / n), "valid") for y in (cause, effect)]
    whole = np.convolve(valid, np.ones(n), "valid") > n - 0.5
    both = whole[: -2 * n] & whole[n:-n] & whole[2 * n :]
    middle = [y[n:-n] for y in means]
    change = means[1][2 * n :] - means[1][: -2 * n]
    return np.column_stack([middle[0], change, middle[1]])[both]


def _moving_parts(table: Vector) -> list[Vector]:
    """The parts of the record in which the cause moves as it does in the whole."""
    if not len(table):
        return []
    moves = MOVES * np.ptp(table[:, 0])
    return [part for part in np.array_split(table, PARTS) if _moves(part, moves)]


def _moves(part: Vector, least: float) -> bool:
    return len(part) > 0 and float(np.ptp(part[:, 0])) > least


def _doubled(
    cause: Vector, effect: Vector, others: Sequence[Vector], valid: Mask
) -> Iterator[Vector]:
    """Mean cause, change of the effect, means of others of every wholly valid stretch; (n, 2 + k).

    Of one period, then of twice as many, each from the two halves of a stretch, the ends counting
    half: a day takes a second, where each sum made anew would take a minute.
    """
    missing = np.concatenate([[0], np.cumsum(~valid)])
    means = [(y[1:] + y[:-1]) / 2 for y in (cause, *others)]
    length = 1
    while length <= len(cause) // FEWEST_STRETCHES:
        whole = missing[length + 1 :] == missing[: -length - 1]
        change = effect[length:] - effect[:-length]
        yield np.column_stack([means[0], change, *means[1:]])[whole]
        means = [(y[length:] + y[:-length]) / 2 for y in means]
        length *= 2


def _correlation(table: Vector) -> float:
    """Correlation of the first two columns without what the others explain; 0 if nothing moves."""
    if len(table) < FEWEST_STRETCHES:
        return 0.0
    explained, _ = np.linalg.qr(np.column_stack([np.ones(len(table)), table[:, 2:]]))
    centred = table[:, :2] - table[:, :2].mean(axis=0)
    left = centred - explained @ (explained.T @ centred)
    if np.any(np.std(left, axis=0) <= DEPENDENT * np.std(centred, axis=0)):
        return 0.0
    return float(np.corrcoef(left.T)[0, 1])
