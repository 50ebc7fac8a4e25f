"""What a change of the model does to the error where nobody fitted it."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, Self

import numpy as np
from scipy.special import stdtrit  # scipy.stats would take another 0.4 s to import

from trialid.arrays import Vector

FALL: Final = 0.985
"""Ratio of squared errors from which on an effect is worth a name: 0.7 % of the error itself. Half
as strict, a speed logged half a percent wrong is named; twice as strict, weak damping is not."""

LARGE: Final = 0.90
"""Ratio of squared errors that needs no test of the noise, where the blocks agree: on short or
smooth records the noise has no colour that could be told from the effect's. With nothing hidden
0.98 is hardly reached; by the trouble of a single block, with much else wrong, any ratio is."""

FAR: Final = 2.0
"""By how much more of the squared error an effect takes off than any that stands every check, and a
tenth of it at least, where it is looked at whatever speaks against it. Found on a ship that a wind
and her screw push to one side (5414, 5456 of `growth/hidden_several.py`), where a hull that is
driven on by her drift stands in for both: there the wind foretells 0.51 and 0.47, and what was
named took 0.08 and 0.05 off. Half of it asks of any that does more, twice changes neither. The wind
is first in 20 of 21 choices of zig-zags on a pond, in 17 at half of it, in 20 at twice."""

ALIKE: Final = 0.05
"""Level of Wilcoxon's signed ranks from which on blocks agree: of six all but the least."""

SHAPE: Final = 1.05
"""Ratio of squared errors that an effect must be worth to join effects that were added, and to stay
beside them: by their shapes any error is mended a little. In five records of a hull of another
structure (`growth/hidden_several.py`, 5400 to 5407) seven effects of nothing hidden had joined:
worth 1.003 to 1.044. Half of it keeps one or two of them, twice drops four that were hidden."""

FAINT: Final = 0.02
"""Share of its trace beside the parameters at which an effect's fall counts half: a centre of
gravity or a memory keeps less, and buys its fall with a coefficient that no ship has."""

EACH: Final = 0.01
"""What a further parameter must lower the error by, as a share of the squared error."""

CHANCE: Final = 0.975
"""Student's level beyond which the errors of two models differ by more than chance."""

NEAR: Final = 1.0
"""Standard errors within which two are as good and another reason may choose, as of structures
(Breiman et al. 1984, `one_standard_error.py`). Two of a tanker's model on zig-zags lie 1.7 apart:
half of it says the same of them, twice names the other."""

TINY: Final = 1e-300
"""What an error of nothing counts as where its logarithm is taken."""

RIVAL: Final = 0.5
"""Share of the named effect's fall, as a logarithm, below which another explains too little to be
taken for it, and its own slope foretold too little to be believed. Stuck rudders had 0.05 and 0.10
by their slopes, a cubic yaw term of a real model 0.37, a weak thruster 0.66, most others 0.9 and
more. Half: of these only what is stuck is looked into. Twice: everything is fitted; tried on ships
with every coefficient off, a tiny fall then brought thirteen further fits and no better name."""


@dataclass(frozen=True)
class Errors:
    """Squared error of each block left out: as the fit weighs outputs, and each by its own."""

    whole: tuple[float, ...]
    own: tuple[float, ...]


@dataclass(frozen=True)
class Carried:
    """What an effect does to the error of blocks of time that did not choose its coefficient.

    Attributes
    ----------
    before, after
        Squared error of each block without and with the effect, parameters fitted to the others.
    seen
        Share of the effect's trace, the trials' own nuisances taken out, that no parameter which
        the trials share can mimic.
    steady
        Whether its coefficients keep their sign whichever block is left out.
    own
        `before` and `after` with each output held against its own error (`levels`).
    """

    before: tuple[float, ...]
    after: tuple[float, ...]
    seen: float = 1.0
    steady: bool = True
    own: tuple[tuple[float, ...], tuple[float, ...]] = ((), ())

    @classmethod
    def between(
        cls, before: Errors, after: Errors, seen: float = 1.0, *, steady: bool = True
    ) -> Self:
        """Give what lies between the errors of two models."""
        return cls(before.whole, after.whole, seen, steady, (before.own, after.own))

    def beyond(self, other: Self) -> Self:
        """Give what lies between another change of the model, of the same blocks, and this one."""
        return replace(self, before=other.after, own=(other.own[1], self.own[1]))

    @property
    def ratio(self) -> float:
        """Squared error with the effect over that without; not a number where there is none."""
        return _ratio(self.before, self.after)

    @property
    def worth(self) -> float:
        """Squared error without the effect over that with it: of all, or by each output's own."""
        return 1.0 / max(min(self.ratio, _ratio(*self.own) if self.own[0] else np.inf), TINY)

    @property
    def better(self) -> int:
        """In how many blocks the error is smaller."""
        return _better(self.before, self.after)

    @property
    def blocks(self) -> int:
        """How many blocks there are."""
        return len(self.before)

    @property
    def in_most(self) -> bool:
        """Whether the error is smaller in more than half of the blocks."""
        return 2 * self.better > self.blocks

    @property
    def falls(self) -> bool:
        """Whether so much carries over that it is worth a name, and in more than half of them.

        Of the whole error, or of each output's own: where one is measured coarsely, what another
        shows plainly is next to nothing of the whole. Of what is hardly seen it must be more: other
        errors of the model look like it. Neither may rise by as much where the other falls.
        """
        both = (self.before, self.after), self.own
        return not any(_ratio(old, new) > 1.0 / FALL for old, new in both) and any(
            self._believed(_ratio(old, new)) < np.log(FALL) and 2 * _better(old, new) > len(old)
            for old, new in both
        )

    @property
    def large(self) -> bool:
        """Whether the error falls by far too much for chance, and blocks alike."""
        falls = np.subtract(self.before, self.after)
        return self.ratio < LARGE and signed_rank_p(falls) < ALIKE

    @property
    def log_ratio(self) -> float:
        """Natural logarithm of the ratio; zero where there is nothing to compare."""
        return float(np.log(max(self.ratio, TINY))) if self.blocks else 0.0

    def price(self, parameters: int) -> float:
        """What candidates are ordered by: the fall that is believed, and something a parameter."""
        return self.believed + EACH * (parameters - 1)

    @property
    def believed(self) -> float:
        """Logarithm of the ratio, as far as it is believed by how much of the trace is seen."""
        return self._believed(self.ratio) if self.blocks else 0.0

    def _believed(self, ratio: float) -> float:
        """The logarithm of a ratio by how much of the trace is seen."""
        return float(np.log(max(ratio, TINY))) * self.seen / (self.seen + FAINT)


def _ratio(before: Sequence[float], after: Sequence[float]) -> float:
    whole = sum(before)
    return sum(after) / whole if whole > 0.0 else float("nan")


def _better(before: Sequence[float], after: Sequence[float]) -> int:
    """In how many blocks the error is smaller."""
    return sum(new < old for old, new in zip(before, after, strict=True))


def signed_rank_p(gaps: Sequence[float] | Vector) -> float:
    """Chance of signed ranks at least so high where either sign is as likely; one where none is.

    Source: Wilcoxon (1945), Individual comparisons by ranking methods, Biometrics Bull 1; exact, by
    the number of subsets of the ranks with each sum.
    """
    order = np.argsort(np.abs(gaps), kind="stable")
    above = int(np.sum(1 + np.flatnonzero(np.asarray(gaps)[order] > 0.0)))
    ways = np.ones(1)
    for rank in range(1, len(order) + 1):
        ways = np.r_[ways, np.zeros(rank)] + np.r_[np.zeros(rank), ways]
    return float(ways[above:].sum() / ways.sum())


def is_far(more: float, less: float) -> bool:
    """Whether a share of the squared error that goes is far more than another."""
    return more > max(FAR * less, 1.0 - LARGE)


def does_as_well(mine: Carried, its: Carried) -> bool:
    """Whether another effect carries over as well as far as these blocks can tell.

    And explains more than `RIVAL` of what the first does.
    """
    return 0.0 < its.ratio < mine.ratio**RIVAL and as_good(mine.after, its.after)


def believed_as_much(mine: Carried, its: Carried) -> bool:
    """The same of what is believed of either: what is hardly seen buys its fall with other errors.

    Of a model in a basin a memory of the hull, of which parameters leave a hundredth, gives way to
    a cubic term with 0.38 of its fall and 0.57 of what is believed of it.
    """
    return its.believed < RIVAL * mine.believed and as_good(mine.after, its.after)


def as_good(one: Sequence[float], other: Sequence[float]) -> bool:
    """Whether the second list of squared errors is not greater than the first beyond chance.

    By how far they lie apart, or because they agree: where two blocks of six differ by much and
    four by little, six of six are no chance although their spread is large. As logarithms: blocks
    differ in how much there is to explain, and one with most of it would hide that others agree.
    """
    if len(one) < 2:
        return True
    gaps = _gaps(one, other)
    apart = _in_standard_errors(gaps) >= stdtrit(len(one) - 1, CHANCE)
    return not (apart or signed_rank_p(gaps) < 1.0 - CHANCE)


def as_near(one: Sequence[float], other: Sequence[float]) -> bool:
    """Whether the second list of squared errors is not greater by more than chance may well do."""
    return len(one) < 2 or _in_standard_errors(_gaps(one, other)) <= NEAR


def _gaps(one: Sequence[float], other: Sequence[float]) -> Vector:
    """By how much the second list is the larger one, as logarithms."""
    gaps: Vector = np.log(np.maximum(other, TINY)) - np.log(np.maximum(one, TINY))
    return gaps


def _in_standard_errors(gaps: Vector) -> float:
    """Their mean over its standard error."""
    return float(gaps.mean() / max(np.std(gaps, ddof=1) / np.sqrt(len(gaps)), TINY))
