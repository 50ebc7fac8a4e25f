"""Error by frequency: what follows the rudder is the model's, what does not is sea or sensor.

Welch's spectra over all trials, half-overlapping Hann segments. A ship answers its rudder in more
than proportion, and the proportionate part the fit has taken: so the coherence is the multiple one
with the rudder and with square and signed square of the output as predicted, which the rudder
drives too. Of noise, whatever its colour, the squared coherence with q given signals is
beta(q, K - q) distributed for K independent segments.
"""

from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import betainc, betaincinv

from trialid.diagnosis.where import words
from trialid.diagnosis.where.finding import Examined, Finding, Spectrum
from trialid.diagnosis.where.leftover import Leftover

Vector = NDArray[np.float64]

LEVEL: Final = 0.05
SEGMENT: Final = 120.0
"""[s] for a ship of 175 m."""

OVERLAP: Final = 0.947
"""Independent segments over segments, for Hann windows that overlap by half (Welch 1967)."""

MOVING: Final = 1e-3
"""Frequencies at which the rudder's spectrum is below this share of its peak are not examined."""

WHOLE: Final = 0.9
"""Share of a segment that must have been compared."""

FEWEST: Final = 4
PLENTY: Final = 12
"""Segments for any coherence, and for the multiple one."""

NARROW: Final = 2.2
"""A band of waves reaches over little more than an octave."""

SHIP: Final = "where the ship itself moves: frequency alone cannot say whether model or noise"
SENSOR: Final = "looks like sensor noise"
OUTSIDE: Final = "looks like the sea, the wind or the sensor"


@dataclass(frozen=True)
class Spectra:
    """Over all segments: frequency [rad/s], spectra as sums, squared coherence; (F,) each.

    `predicted` is the spectrum of the output as predicted, `error` that of the residual. `inputs`
    counts the signals of the coherence, `segments` the independent ones.
    """

    frequency: Vector
    error: Vector
    predicted: Vector
    coherence: Vector
    examined: NDArray[np.bool_]
    inputs: int
    segments: float

    @property
    def p(self) -> Vector:
        """Chance of the coherence where it is examined."""
        rest = np.clip(1.0 - self.coherence[self.examined], 0.0, 1.0)
        return np.asarray(betainc(self.segments - self.inputs, self.inputs, rest))

    @property
    def coherent(self) -> Vector:
        """Spectrum of what follows the rudder, less what chance would make of it."""
        chance = (1.0 - self.coherence) * self.inputs / (self.segments - self.inputs)
        return np.asarray(self.error * np.maximum(self.coherence - chance, 0.0) * self.examined)

    @property
    def threshold(self) -> float:
        """Squared coherence that chance exceeds at any frequency in one record of twenty."""
        level = LEVEL / max(int(self.examined.sum()), 1)
        return 1.0 - float(betaincinv(self.segments - self.inputs, self.inputs, level))


def spectra(left: Leftover, output: int) -> Spectra | str:
    """Spectra of the residual and of what the rudder drives."""
    angle = left.rudder()
    if angle is None or not np.any(angle):
        return "no single rudder in the record"
    period = max(r.trial.period for r in left.parts)
    length = 2 * max(round(0.5 * SEGMENT * left.time_scale / period), 8)
    segments = [
        slice(a, a + length)
        for span, part in zip(left.spans, left.parts, strict=True)
        if part.trial.period == period
        for a in range(span.start, span.stop - length + 1, length // 2)
        if left.compared[a : a + length, output].mean() > WHOLE
    ]
    if len(segments) < FEWEST:
        return "the trials are too short for spectra"
    driven = _driven(left, angle, output) if len(segments) >= PLENTY else angle[:, None]
    X = np.array([_tapered(driven[s] - driven[s].mean(axis=0)) for s in segments])
    y = np.concatenate([r.predicted[:, output] for r in left.parts])
    both = np.column_stack([left.eps[:, output], y - y.mean()])
    E, Y = np.array([_tapered(both[s]) for s in segments]).transpose(2, 0, 1)
    examined = _moving(X)
    examined[0] = False
    omega = np.asarray(2.0 * np.pi * np.fft.rfftfreq(length, period), dtype=np.float64)
    doubled = np.r_[1.0, np.full(len(omega) - 1, 2.0)]
    error, moved = [(np.abs(x) ** 2).sum(axis=0) * doubled for x in (E, Y)]
    return Spectra(
        frequency=omega,
        error=error,
        predicted=moved,
        coherence=_coherence(X, E, examined),
        examined=examined,
        inputs=driven.shape[1],
        segments=OVERLAP * len(segments),
    )


def _driven(left: Leftover, angle: Vector, output: int) -> Vector:
    """The rudder, and what it makes of the output beyond proportion; (N, 3)."""
    y = np.concatenate([r.predicted[:, output] for r in left.parts])
    return np.column_stack([angle, y * np.abs(y), y**2])


def _moving(X: NDArray[np.complex128]) -> NDArray[np.bool_]:
    """Where the rudder moves enough to be followed; (F,)."""
    power = (np.abs(X[:, :, 0]) ** 2).sum(axis=0)
    return np.asarray(power > MOVING * power.max())


def _coherence(
    X: NDArray[np.complex128], E: NDArray[np.complex128], examined: NDArray[np.bool_]
) -> Vector:
    """Squared multiple coherence of E (K, F) with X (K, F, q), zero where not examined; (F,)."""
    x, e = X[:, examined].transpose(1, 0, 2), E[:, examined].T[:, :, None]
    Q = np.linalg.qr(x / np.maximum(np.linalg.norm(x, axis=1, keepdims=True), 1e-300))[0]
    explained = (np.abs(Q.conj().transpose(0, 2, 1) @ e) ** 2).sum(axis=(1, 2))
    found = np.zeros(X.shape[1])
    found[examined] = explained / np.maximum((np.abs(e) ** 2).sum(axis=(1, 2)), 1e-300)
    return found


def _tapered(x: Vector) -> NDArray[np.complex128]:
    """Fourier transform of a tapered segment; (F, q)."""
    taper = 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(len(x)) / len(x))
    return np.asarray(np.fft.rfft(taper[:, None] * x, axis=0))


def picture(s: Spectra) -> Spectrum:
    """The spectrum as shares of the squared error per rad/s."""
    total = float(s.error.sum()) * float(s.frequency[1])
    parts = (s.frequency, s.error / total, s.coherent / total, s.coherence)
    frequency, density, coherent, coherence = [tuple(float(v) for v in x) for x in parts]
    return Spectrum(frequency, density, coherent, coherence, s.threshold)


def follows_rudder(left: Leftover, output: int, s: Spectra) -> Examined:
    """Whether the residual holds anything that follows the rudder, and in which band."""
    p = s.p
    least = min(float(p.min()) * len(p), 1.0) if len(p) else 1.0
    if least > LEVEL:
        return Examined(least)
    at = np.flatnonzero(s.examined)[p <= LEVEL / len(p)]
    weight = s.coherent[at]
    kept = at[np.cumsum(np.sort(weight)[::-1]).searchsorted(0.9 * weight.sum()) >= _place(weight)]
    low, high = int(kept.min()), int(kept.max())
    total = float(s.error.sum())
    share = float(s.coherent[at].sum()) / total
    band = float(s.error[low : high + 1].sum()) / total
    where = _band(s.frequency, low, high)
    name = words.name(left.outputs[output])
    return Examined(
        least,
        (
            Finding(
                output=left.outputs[output],
                kind="frequency",
                share=share,
                beyond=share,
                excess=float(s.error[low : high + 1].mean() / s.error[1:].mean()),
                p_value=1.0,
                sentence=f"{name}: {words.share(band)} of its squared error lies {where}, and "
                f"{words.share(share)} is coherent with the rudder: the model, not the noise",
                picture=picture(s),
            ),
        ),
    )


def _place(weight: Vector) -> NDArray[np.intp]:
    """Rank of each weight, the largest first."""
    place = np.empty(len(weight), dtype=np.intp)
    place[np.argsort(-weight, kind="stable")] = np.arange(len(weight))
    return place


def _band(frequency: Vector, low: int, high: int) -> str:
    """A band in words, half a step beyond its outer frequencies."""
    half = 0.5 * float(frequency[1])
    if low <= 1:
        return f"below {words.figure(frequency[high] + half)} rad/s"
    ends = words.figure(frequency[low] - half), words.figure(frequency[high] + half)
    return f"between {ends[0]} and {ends[1]} rad/s"


def rest(left: Leftover, output: int, s: Spectra) -> str:
    """What the part that does not follow the rudder looks like, in a sentence."""
    other = np.where(s.examined, s.error * (1.0 - s.coherence), s.error)[1:]
    share = float(np.clip(1.0 - s.coherent.sum() / s.error.sum(), 0.0, 1.0))
    sums = np.cumsum(other) / other.sum()
    low, high = (int(np.searchsorted(sums, q)) + 1 for q in (0.15, 0.85))
    peak = int(np.argmax(other)) + 1
    about = f"{words.share(share)} of its squared error is not coherent with the rudder"
    place = f"{words.name(left.outputs[output])}: {about}; most of it lies "
    band = slice(low, high + 1)
    if float(s.predicted[band].sum()) > float(s.error[band].sum()):
        return f"{place}{_band(s.frequency, low, high)}, {SHIP}"
    if s.frequency[high] > 0.5 * s.frequency[-1]:
        return f"{place}{_band(s.frequency, low, high)}, over most frequencies: {SENSOR}"
    if low > 3 and s.frequency[high] < NARROW * s.frequency[low]:
        period = 2.0 * np.pi / float(s.frequency[peak])
        about = f"around {words.figure(float(s.frequency[peak]))} rad/s, a period of {period:.0f} s"
        return f"{place}{about}, where the model hardly moves: looks like waves"
    return f"{place}{_band(s.frequency, low, high)}, where the model hardly moves: {OUTSIDE}"
