"""Is each rate the slope of its angle? A wrong unit, a wrong sign, a lag, another quantity.

A number wrong by a known factor is a wrong unit, one that is small and contrary is another quantity
under that name; both are errors. A sensor that smooths is smaller than the truth too, but then it
comes later as well: that is only remarked.
"""

from collections.abc import Iterator, Mapping
from dataclasses import replace

import numpy as np

from trialid.alignment.agreement import relation
from trialid.alignment.agreement.channel_finding import Finding
from trialid.alignment.agreement.rate_drift import drift_finding, drift_of, late_of
from trialid.alignment.agreement.relation import Relation
from trialid.errors import UnitError
from trialid.names import units
from trialid.names.quantities import MOTIONS, SIGNALS, SLOPES
from trialid.trial import Contradiction, Trial

CLEAR = 0.9
"""Correlation above which a gain is told; real rates of turn reach 0.95 to 1.00."""
LOOSE = 0.7
"""Correlation that each part of the record must reach for a lag or a small gain to be told."""
FAR = 3.0
"""Factor no sensor is wrong by: real ones smooth by up to 0.62 over a whole manoeuvre."""
CLOSE = 1.15
"""A unit explains a factor this near to its own."""
ALIKE = 0.02
"""Units whose factors fit as well as this tell nothing apart: both are named.
57.3 and 60 differ by 0.046."""
FAIR = 1.04
"""Gains within this factor of one are not worth a remark. Of 687 logs of real and made records that
tell the gain of a gyro those of sound ones lie within 1.02, and 22 whose gyro is wrong, or which
call a course a heading, beyond 1.05; so that half of it tells the same, and twice loses a boat's
whose predictions were 6 % too large."""
PROMPT = 0.1
"""Share of a swing: smoothing to a third delays by a fifth of a swing and more."""
LATE = 0.2
"""[s] Lags not worth a remark: half of them moves a time constant of 20 s by 0.7 %."""
MOVING = 10.0
"""Motion in units of noise below which nothing is said of it."""
SAME = 0.97
"""Correlation with the slope above which a signal of another name is taken for the rate."""
ASKS = frozenset({"scale", "unrelated"})
UNRELATED = 0.5
"""Correlation at every lag and length below which one is not the slope of the other."""
TURNS = np.deg2rad(20.0)
"""[rad] The angle must change by so much before its slope is called unrelated."""
UNITS = ("rad/s", "deg/s", "deg/min", "rad", "deg")


def check_slopes(trial: Trial, stated: Mapping[str, str], beside: Trial) -> Iterator[Finding]:
    """Each rate against its angle; `beside` holds all signals, to find one under a wrong name."""
    for rate, angle in SLOPES.items():
        if rate in trial.signals and angle in trial.signals:
            valid = trial.valid[rate] & trial.valid[angle]
            y, x = trial.signals[rate], trial.signals[angle]
            found = relation.of_slope(y, x, valid, trial.period)
            if found is not None:
                for one in _slope(rate, angle, found, float(np.ptp(x[valid])), stated):
                    hint = _better(beside, rate, angle) if one.kind in ASKS else ""
                    yield replace(one, sentence=one.sentence + hint)
                if is_clear(found) and (drift := drift_of(y, x, valid, trial.period)):
                    yield drift_finding(rate, angle, drift, trial.duration)
                elif not is_clear(found) and found.correlation > CLEAR:
                    yield from _late(rate, angle, late_of(y, x, valid, trial.period))


def _better(trial: Trial, rate: str, angle: str) -> str:
    """Words on another signal that is the slope of the angle, whatever its name.

    In size, too: roll goes with every turn, and is not the rate of it.
    """
    if angle not in trial.signals:
        return ""
    for name, y in trial.signals.items():
        if name in {rate, angle} or name not in MOTIONS or SIGNALS[name].mirror > 0:
            continue
        valid = trial.valid[name] & trial.valid[angle]
        found = relation.of_slope(y, trial.signals[angle], valid, trial.period)
        as_large = found is not None and CLOSE**-2 < found.gain[0] * found.gain[1] < CLOSE**2
        if found and as_large and abs(found.correlation) > SAME and _prompt(found):
            return f"; {name} goes with that slope ({found.correlation:.3f}): are they exchanged?"
    return ""


def _slope(
    rate: str, angle: str, found: Relation, travel: float, stated: Mapping[str, str]
) -> Iterator[Finding]:
    """What one relation of a rate and an angle says."""
    evidence = {
        "correlation": found.correlation, "gain_low": found.gain[0], "gain_high": found.gain[1],
        "lag": found.lag, "lag_low": found.lags[0], "lag_high": found.lags[1],
    }  # fmt: skip
    pair = rate, angle
    if abs(found.correlation) > CLEAR and _wrong(found):
        words, mend = _scale_words(rate, angle, found, stated)
        yield Finding("unit" if mend else "scale", "error", pair, words, evidence, mend)
        return
    if _contrary(found):
        words = (
            f"{rate} and the slope of {angle} have opposite signs (correlation "
            f'{found.correlation:.2f}); add positive = "port" to the one that is positive to port'
        )
        yield Finding("sign", "error", pair, words, evidence, 'positive = "port"')
        return
    if abs(found.correlation) < UNRELATED and travel > TURNS and min(found.moves) > MOVING:
        words = (
            f"{rate} does not follow the slope of {angle} (correlation {found.correlation:.2f} at "
            "best, at any lag up to 20 s); is it another quantity?"
        )
        yield Finding("unrelated", "remark", pair, words, evidence)
        return
    yield from _small_faults(rate, angle, found, evidence)


def _small_faults(
    rate: str, angle: str, found: Relation, evidence: Mapping[str, float]
) -> Iterator[Finding]:
    low, high = found.gain
    late = found.later and abs(found.lag) > LATE
    off = low > FAIR or high < 1 / FAIR
    if not is_clear(found) or not (late or off):
        return
    ends = dict.fromkeys(f"{end:.3g}" for end in found.gain)
    pair, times = (rate, angle), f"is {' to '.join(ends)} times"
    comes = (
        f"{rate} comes {abs(found.lag):.2g} s {'later' if found.lag > 0 else 'earlier'} than "
        f"the slope of {angle} ({found.lags[0]:.2g} to {found.lags[1]:.2g} s)"
    )
    if late and found.lag > 0 and high < 1 / FAIR:  # no delay makes it small, no gain late
        smooths = f"as of a sensor that smooths: the effect lag_{rate} has it"
        words = f"{comes} and {times} that slope, {smooths}"
        yield Finding("lag", "remark", pair, words, evidence)
        return
    if late:
        mend = f"delay = {abs(found.lag):.2g}"  # of the later one: no sensor is early
        why = ": psi may be a course over ground, or its clock be late"  # which follows her drift
        words = comes + why if angle == "psi" and found.lag < 0.0 else comes
        yield Finding("lag", "remark", pair, words, evidence, mend)
    if off:
        # over whole turns no compass is wrong by a factor
        gain = f"gain = {1 / np.sqrt(low * high):.3g}" if angle == "psi" and not late else None
        yield Finding(
            "scale", "remark", pair, f"{rate} {times} the slope of {angle}", evidence, gain
        )


def _late(rate: str, angle: str, late: float) -> Iterator[Finding]:
    """What the integral of a rate says where the record has too few turns for its slope.

    That an angle is late is not told so: a course over ground is behind the heading as she drifts.
    """
    if late > LATE:
        words = f"{rate} comes {late:.2g} s later than the slope of {angle}, by the angle it lacks"
        evidence = {"lag": late}
        yield Finding("lag", "remark", (rate, angle), words, evidence, f"delay = {late:.2g}")


def contradiction(found: Finding) -> Contradiction | None:
    """What a finding says of a rate and its angle; None where it is another."""
    if not found.of_slope(found.about[0]):
        return None
    rate, angle = found.about
    told = Contradiction(rate=rate, angle=angle, sentence=found.words)
    if found.kind == "drift":
        return replace(told, drift=found.evidence["drift"])
    if found.kind == "lag":
        return replace(told, late=found.evidence["lag"])
    return replace(
        told, factor=float(np.sqrt(found.evidence["gain_low"] * found.evidence["gain_high"]))
    )


def is_clear(found: Relation) -> bool:
    """True when the record is clear about lag and gain: all of its parts say so."""
    parts = np.array(found.parts)
    alike = bool(np.all(parts * np.sign(found.correlation) > LOOSE))
    return abs(found.correlation) > CLEAR and len(parts) > 1 and alike


def _wrong(found: Relation) -> bool:
    """True when no sensor, however slow, explains the gain."""
    low, high = found.gain
    if low > FAR:
        return True
    contrary = found.correlation < 0 and not found.ambiguous
    return high < 1 / FAR and (_prompt(found) or contrary)


def _contrary(found: Relation) -> bool:
    """True when the sign is wrong and nothing else: no lag that could have turned it."""
    parts = max(found.parts, default=0.0)
    return found.correlation < -CLEAR and _prompt(found) and not found.ambiguous and parts < 0


def _prompt(found: Relation) -> bool:
    """True when there is no delay that comes with smoothing."""
    return abs(found.lag) < PROMPT * found.swing


def _scale_words(
    rate: str, angle: str, found: Relation, stated: Mapping[str, str]
) -> tuple[str, str | None]:
    """The sentence and the line that would mend it, where a unit explains the factor."""
    low, high = found.gain
    middle = float(np.sqrt(low * high))
    sign = "-" if found.correlation < 0 else ""
    fact = (
        f"{rate} is {sign}{middle:.3g} times the slope of {angle} ({low:.3g} to {high:.3g}, "
        f"correlation {found.correlation:.2f})"
    )
    able = [
        (off, name, line)
        for name, factor in ((rate, 1 / middle), (angle, middle))
        for line, off in _mends(name, stated.get(name), factor)
        if _prompt(found)
    ]
    mends = [(name, line) for off, name, line in able if off < min(able)[0] + ALIKE]
    if not mends:
        return f"{fact}, which no unit explains; take another channel for one of them", None
    lines = " or ".join(f"{line} for {name}" for name, line in mends)
    return f"{fact}: a unit is wrong; write {lines}", mends[0][1]


def _mends(name: str, stated: str | None, factor: float) -> Iterator[tuple[str, float]]:
    """The unit the numbers are in, if those of `stated` are wrong by the factor; else the gain.

    With the logarithm of what then remains. A unit that the log states cannot be overruled by
    another one, but by a gain.
    """
    known = [(unit, one) for unit in UNITS if (one := _factor(unit, SIGNALS[name].unit))]
    here = _factor(stated, SIGNALS[name].unit) if stated else None
    if here:
        lines = [(f'unit = "{unit}"', one / here) for unit, one in known]
    else:
        ratios = {one / other for _, one in known for _, other in known} - {1.0}
        lines = [(f"gain = {ratio:.6g}", ratio) for ratio in sorted(ratios)]
    off, line = min((abs(float(np.log(ratio / factor))), line) for line, ratio in lines)
    if off < np.log(CLOSE):
        yield line, off


def _factor(unit: str, si: str) -> float | None:
    try:
        return units.factor(unit, si)
    except UnitError:
        return None
