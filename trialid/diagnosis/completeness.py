"""Whether the catalogue holds what is missing: its best effects against forces of any shape."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray
from scipy.special import chdtrc, chdtri  # scipy.stats would take another 0.4 s to import

from trialid.diagnosis.augment import Augmented
from trialid.diagnosis.coarse import coarse
from trialid.diagnosis.evidence import Evidence, Projected, gather, likeliest, without
from trialid.diagnosis.probes import Probes, probes
from trialid.diagnosis.whitening import whitened
from trialid.identification.fit import Fit
from trialid.ship.rigid_body import ROWS

Vector = NDArray[np.float64]
Group = tuple[int, ...]

STEPS: Final = 3
"""Effects, or forces, that may be missing at once."""

WORTH: Final = 10.0
"""Twice the log likelihood by which forces of any shape must be better to speak of a gap."""

SHARE: Final = 0.25
"""Share of what they gain that the catalogue must miss."""


@dataclass(frozen=True)
class Completeness:
    """What the catalogue explains, and what forces of any simple shape would.

    Both are gains in twice the log likelihood, with every coefficient and the search at their
    price.
    """

    catalogue: float
    any_shape: float

    @property
    def gap(self) -> bool:
        """Whether the catalogue misses much of what can be explained."""
        missed = self.any_shape - self.catalogue
        return missed > max(WORTH, SHARE * self.any_shape)


def completeness(fit: Fit, augmented: Augmented) -> Completeness | None:
    """Forward selection from the catalogue, and from the catalogue and forces of any shape.

    None where there is nothing to compare, or no equation that a force acts in.
    """
    moved = set(ROWS) & set(fit.problem.simulator.equations.states)
    if not augmented.traces or not moved:
        return None
    tried = probes(coarse(fit))
    evidence = _with_colour(augmented, tried)
    white, _ = whitened(tried.columns, augmented.stretches, evidence.colour)
    white -= evidence.white.Q @ (evidence.white.Q.T @ white)
    first = evidence.white.S.shape[1]
    # single precision: the sums are compared by their tenths, and there are thousands of them
    Z = np.concatenate([evidence.white.S, white], axis=1, dtype=np.float32, casting="same_kind")
    moment = (Z.T @ evidence.white.residual.astype(np.float32)).astype(float)
    search = _Search((Z.T @ Z).astype(float), moment, len(Z), evidence.inflation)
    effects = [t.columns for t in augmented.traces]
    forces = [tuple(first + i for i in g) for g in tried.groups]
    return Completeness(search.gain(effects, []), search.gain(effects, forces))


def _with_colour(augmented: Augmented, tried: Probes) -> Evidence:
    """The evidence, by the noise's colour without the best force where that beats every effect.

    Else what is missing would pass for the colour of the noise, and nothing would show.
    """
    known = augmented.evidence
    left = tried.columns - known.raw.Q @ (known.raw.Q.T @ tried.columns)
    forces = Projected(known.raw.residual, left, known.raw.Q, left.T @ left,
                       left.T @ known.raw.residual)  # fmt: skip
    effects = [t.columns for t in augmented.traces]
    _, cost = likeliest(known.raw, effects, augmented.stretches)
    force, force_cost = likeliest(forces, tried.groups, augmented.stretches)
    if force_cost >= cost:
        return known
    return gather(augmented.residual, augmented.psi, augmented.S, augmented.stretches, effects,
                  without(forces, force))  # fmt: skip


@dataclass(frozen=True)
class _Search:
    """Sums of products of whitened columns, and what a gain has to pay."""

    gram: Vector
    moment: Vector
    rows: int
    inflation: float

    def gain(self, effects: Sequence[Group], forces: Sequence[Group]) -> float:
        """What a forward selection gains; effects and forces pay for the search among their own.

        One coefficient pays ln N (Schwarz, 1978), several what is as rare by chance; each step
        pays 2 ln J for one of J (Chen & Chen, 2008).
        """
        steps = [(g, len(effects)) for g in effects] + [(g, len(forces)) for g in forces]
        chosen, total = list[int](), 0.0
        for _ in range(STEPS):
            known = self._explained(chosen)
            found = [
                (self._net(chosen, g, known) - 2.0 * np.log(among), g)
                for g, among in steps
                if not set(g) & set(chosen)
            ]
            gained, group = max(found, key=lambda x: x[0], default=(0.0, ()))
            if gained <= 0.0:
                break
            chosen += group
            total += float(gained)
        return total

    def _net(self, chosen: Sequence[int], group: Group, known: float) -> float:
        gain = (self._explained([*chosen, *group]) - known) / self.inflation
        return gain - float(chdtri(len(group), chdtrc(1, np.log(self.rows))))

    def _explained(self, columns: Sequence[int]) -> float:
        """Fall of the whitened sum of squares with these columns."""
        if not columns:
            return 0.0
        gram = self.gram[np.ix_(columns, columns)]
        sizes = np.sqrt(np.maximum(np.diag(gram), 1e-300))
        scaled = self.moment[list(columns)] / sizes
        inverse = np.linalg.pinv(gram / np.outer(sizes, sizes), rcond=1e-5, hermitian=True)
        return float(scaled @ inverse @ scaled)
