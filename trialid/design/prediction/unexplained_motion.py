"""What the fitted trials did beyond the model, and what as much would do to a manoeuvre.

Gusts that no anemometer felt, currents that are not steady, and forces that the model lacks lead a
trial away from its prediction; no parameter's error says how far. It shows in the fitted trials:
the rate of turn and the speeds that the record has and the model has not. They are laid over the
manoeuvre, from many places of the trials and to either side.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from trialid.accuracy.likely import student
from trialid.arrays import Vector
from trialid.errors import DesignError
from trialid.identification.fit import Fit
from trialid.identification.trial_score import Score
from trialid.white_noise import white_noise

Track = Mapping[str, Vector]
PLACES: Final = 40
"""Of the trials from which what they did is laid over a manoeuvre; the root mean square of so many
is known to 11 %."""
DRAWN: Final = 157
"""Places of noise that is drawn: each stands for itself, so its root mean square is known to 6 %; a
prime, so that they fall on all parts of a trial. 40 of one draw were 4 to 14 % off, for all fits
alike."""
DRAWS: Final = 20
"""Of noise for each trial, so that places do not share theirs."""
MIRROR: Final = np.array([-1.0, 1.0, -1.0])
NORMAL: Final = 1.96


@dataclass(frozen=True)
class UnexplainedMotion:
    """Motion that is in the record of the fitted trials and not in the model.

    Attributes
    ----------
    rates
        Rate of turn [rad/s], speed ahead and to starboard [m/s], a trial after the other; (M, 3).
    noise
        The same of noise alone, as much of it as is white in the record, drawn over and over.
    trials
        How many; each counts as one value of what there may be.
    """

    rates: Vector
    noise: Vector
    period: float
    trials: int

    def errors(
        self, read: Callable[[Track], Mapping[str, float]], track: Track, begin: int
    ) -> dict[str, float]:
        """By how much numbers read from a track differ by it from a sample on: one standard error.

        What noise of sensors does of that is taken off. As few trials tell it, so much more, that
        1.96 of it are 95 %.
        """
        whole = self._squares(read, track, self._laid_over(track, begin, self.rates, PLACES))
        noise = self._squares(read, track, self._laid_over(track, begin, self.noise, DRAWN))
        wider = float(student(float(self.trials))) / NORMAL
        return {
            n: wider * float(np.sqrt(max(x - noise.get(n, 0.0), 0.0))) for n, x in whole.items()
        }

    @staticmethod
    def _squares(
        read: Callable[[Track], Mapping[str, float]], track: Track, others: Iterable[Track]
    ) -> dict[str, float]:
        """Mean squares of what numbers differ by."""
        found, apart = read(track), dict[str, list[float]]()
        for other in others:
            try:
                moved = read(other)
            except DesignError:
                continue  # it would not come so far
            for name in (n for n in found if n in moved):
                apart.setdefault(name, []).append(moved[name] - found[name])
        return {n: float(np.mean(np.square(x))) for n, x in apart.items()}

    def _laid_over(self, track: Track, begin: int, rates: Vector, places: int) -> Iterator[Track]:
        """The track with what was done at each place, to either side in turns."""
        samples = len(track["psi"]) - begin - 1
        for k, first in enumerate(np.linspace(0, len(rates), places, endpoint=False).astype(int)):
            rows = np.take(rates, range(first, first + samples), axis=0, mode="wrap")
            side = MIRROR if k % 2 else np.ones(3)
            yield _moved(track, begin, rows * side * self.period)


def _moved(track: Track, begin: int, steps: Vector) -> Track:
    """The track turned [rad] and carried on [m] by each step from a sample on."""
    turned = np.cumsum(steps[:, 0])
    psi, x, y = (track[n].copy() for n in ("psi", "x", "y"))
    way = (np.diff(x[begin:]) + 1j * np.diff(y[begin:])) * np.exp(1j * turned)
    psi[begin + 1 :] += turned
    way += (steps[:, 1] + 1j * steps[:, 2]) * np.exp(1j * psi[begin + 1 :])
    place = x[begin] + 1j * y[begin] + np.cumsum(way)
    x[begin + 1 :], y[begin + 1 :] = place.real, place.imag
    return {**track, "psi": psi, "x": x, "y": y}


def unexplained_motion(fit: Fit, samples: int) -> UnexplainedMotion | None:
    """What fitted trials did beyond the model; None where no heading or rate was compared.

    Parameters
    ----------
    samples
        Of the time in which she sails her length. Noise of sensors is no motion: what is faster
        than that is taken off by a mean over so many, and what that leaves is known.
    """
    rng = np.random.default_rng(0)
    fitted = [s for s in fit.scores if s.trial.use == "fit" and s.trial.samples > 2 * samples]
    rates = [x for s in fitted if (x := _rates(fit, s, samples)) is not None]
    if not rates:
        return None
    noise = [
        x for _ in range(DRAWS) for s in fitted if (x := _rates(fit, s, samples, rng)) is not None
    ]
    period = fitted[0].trial.period
    return UnexplainedMotion(np.concatenate(rates), np.concatenate(noise), period, len(rates))


def _rates(
    fit: Fit, score: Score, samples: int, rng: np.random.Generator | None = None
) -> Vector | None:
    """Of one trial, or of noise drawn for it; what was not compared is as the model has it."""
    left = {n: _left(fit, score, n, samples, rng) for n in fit.problem.outputs}
    turn, period = left.get("r"), score.trial.period
    if "psi" in left:  # a rate's noise would add up in the heading
        turn = np.gradient(left["psi"], period)
    if turn is None:
        return None
    nothing = np.zeros(len(turn))
    ahead, aside = left.get("u", nothing), left.get("v", nothing)
    if {"x", "y", "psi"} <= left.keys():
        ahead, aside = _from_places(fit, score, left, samples)
    return np.column_stack([turn, ahead, aside])


def _left(
    fit: Fit, score: Score, name: str, samples: int, rng: np.random.Generator | None
) -> Vector:
    """Recorded less simulated, or as much noise as is in it, smooth, gaps bridged."""
    place = fit.problem.outputs.index(name)
    known = np.flatnonzero(score.compared[:, place])
    if not len(known):
        return np.zeros(score.trial.samples - samples + 1)
    off = (score.trial.signals[name] - score.response.y[:, place])[known]
    if rng is not None:
        off = white_noise(off) * rng.standard_normal(len(off))
    whole = np.interp(np.arange(score.trial.samples), known, off)
    return np.convolve(whole, np.full(samples, 1.0 / samples), mode="valid")


def _from_places(
    fit: Fit, score: Score, left: Mapping[str, Vector], samples: int
) -> tuple[Vector, Vector]:
    """Speeds ahead and to starboard beyond the model's, from positions, less what heading did."""
    first, period = (samples - 1) // 2, score.trial.period
    model = {
        n: score.response.y[first : first + len(left[n]), fit.problem.outputs.index(n)]
        for n in ("x", "y", "psi")
    }
    way = np.gradient(model["x"] + 1j * model["y"], period)
    sailed = way + np.gradient(left["x"] + 1j * left["y"], period)
    beyond = (sailed * np.exp(-1j * left["psi"]) - way) * np.exp(-1j * model["psi"])
    return beyond.real, beyond.imag
