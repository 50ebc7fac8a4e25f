"""Directions of parameter space that a record hardly sees, in words."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from trialid.arrays import Mask, Vector
from trialid.least_squares.fold import triangle


@dataclass(frozen=True)
class Weakness:
    """A direction of parameter space that the record hardly sees.

    `moves` is how far noise lets its parameters go together: one standard error of the
    combination, as a share of each parameter's size, up or down.
    """

    parameters: tuple[str, ...]
    sentence: str
    relative_error: float
    moves: Mapping[str, float] = field(default_factory=dict)


def without_nuisance(A: Vector, physical: Mask) -> Vector:
    """Columns of the physical parameters with everything projected out that nuisances can mimic."""
    nuisance = A[:, ~physical]
    if nuisance.shape[1] == 0:
        return A[:, physical]
    norms = np.linalg.norm(nuisance, axis=0)
    Q, _ = np.linalg.qr(nuisance[:, norms > 0.0] / norms[norms > 0.0])
    wanted = A[:, physical]
    return np.asarray(wanted - Q @ (Q.T @ wanted))


COLLINEAR: Final = 10.0
"""A collinearity index above this names a weak direction (Brun et al. 2001: 10 to 15)."""


WELL_KNOWN: Final = 0.1
"""A combination known better than this is not weak, however alike its parameters act."""


SHARE: Final = 0.3
"""A parameter with at least this share of a direction is named in it; where none has as much, the
two that have most."""


def weak_directions(A: Vector, names: Sequence[str], error: float) -> tuple[Weakness, ...]:
    """Directions of the physical parameters that leave hardly a trace, in words.

    Columns are brought to length one first, so that the answer does not depend on how parameters
    are scaled; a direction is weak when its singular value is below 1 / `COLLINEAR` and noise
    leaves it open by more than `WELL_KNOWN`. `error` is the normed noise over the root of the
    effective samples, from which the relative error of the combination follows.
    """
    norms = np.linalg.norm(A, axis=0)
    alive = norms > 0.0
    found = [
        Weakness((n,), f"{coefficient_label(n)} leaves no trace in this record", float("inf"))
        for n, on in zip(names, alive, strict=True)
        if not on
    ]
    kept = [n for n, on in zip(names, alive, strict=True) if on]
    if len(kept) < 2:
        return tuple(found)
    _, s, Vt = np.linalg.svd(triangle(A[:, alive]) / norms[alive])
    for value, direction in zip(s[::-1], Vt[::-1], strict=True):
        if value >= 1.0 / COLLINEAR:
            break
        shares = np.abs(direction)
        leading = np.argsort(-shares)
        parts = tuple(kept[i] for i in leading if shares[i] >= min(SHARE, shares[leading[1]]))
        along = direction / norms[alive]
        deviation = error / value if value > 0.0 else float("inf")
        relative = deviation * float(np.linalg.norm(along))
        if relative > WELL_KNOWN:
            words = _weak_sentence(parts, 1.0 / max(value, 1e-300))
            moves = {n: deviation * float(along[kept.index(n)]) for n in parts}
            found.append(Weakness(parts, words, relative, moves))
    return tuple(found)


def _weak_sentence(parts: tuple[str, ...], index: float) -> str:
    words = [coefficient_label(p) for p in parts]
    if len(words) == 1:
        return f"{words[0]} is answered for by all the others together (collinearity {index:.3g})"
    listed = ", ".join(words[:-1]) + " and " + words[-1]
    return f"{listed} cannot be told apart here (collinearity {index:.3g})"


def coefficient_label(name: str) -> str:
    """A coefficient as people write it: `av` and `ar` are moduli.

    >>> [coefficient_label(name) for name in ("Yvar", "Nrar", "Kpap", "Nvav", "Yv")]
    ['Yv|r|', 'Nr|r|', 'Kp|p|', 'Nv|v|', 'Yv']
    """
    for letter in "uvpr":
        if name.endswith("a" + letter) and len(name) > 3:
            return f"{name[:-2]}|{letter}|"
    return name
