"""Terms a missing force may be made of: signed powers and products of what the record holds."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations, permutations
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.ship.prime import FORCE_LENGTH, prime_signal

Vector = NDArray[np.float64]

MOTIONS: Final = ("v", "r", "p", "phi", "delta")
"""Signals that change sign in the mirror; all others in a term do not, or are the heading."""

FACTORS: Final[Mapping[str, tuple[str, Callable[[Mapping[str, Vector]], Vector]]]] = {
    **{s: (s, lambda x, s=s: x[s]) for s in MOTIONS},  # type: ignore[misc]
    **{f"a{s}": (f"abs({s})", lambda x, s=s: np.abs(x[s])) for s in MOTIONS},  # type: ignore[misc]
    "du": ("(u / U0 - 1.0)", lambda x: x["u"] / x["U0"] - 1.0),
    "sinpsi": ("sin(psi)", lambda x: np.sin(x["psi"])),
    "cospsi": ("cos(psi)", lambda x: np.cos(x["psi"])),
}
"""Factor to its text in an effect file and its value from primed signals; `ar` is |r|."""

READS: Final = {"du": ("u", "U0"), "sinpsi": ("psi",), "cospsi": ("psi",)}
"""Signals of the factors that are not named after theirs."""

WORDS: Final = {"du": "u/U0 - 1", "sinpsi": "sin psi", "cospsi": "cos psi"}


@dataclass(frozen=True)
class Term:
    """A product of factors, primed; none is a constant."""

    factors: tuple[str, ...]

    @property
    def text(self) -> str:
        """The product as Python."""
        return " * ".join(FACTORS[f][0] for f in self.factors) or "1.0"

    @property
    def words(self) -> str:
        """The product as people write it.

        >>> Term(("delta", "aphi")).words, Term(("v", "v", "r")).words
        ('delta |phi|', 'v^2 r')
        """
        said = []
        for f in dict.fromkeys(self.factors):
            count = self.factors.count(f)
            name = WORDS.get(f) or (f"|{f[1:]}|" if f[1:] in MOTIONS else f)
            name = f"({name})" if f == "du" and len(self.factors) > 1 else name
            said.append(name if count == 1 else f"{name}^{count}")
        return " ".join(said) or "a constant"

    @property
    def signals(self) -> tuple[str, ...]:
        """What it reads, in the order of the factors."""
        read = [s for f in self.factors for s in READS.get(f, (f[1:] if f[1:] in MOTIONS else f,))]
        return tuple(dict.fromkeys(read))

    @property
    def mirror(self) -> str:
        """`odd` or `even` when port and starboard are exchanged; a heading is neither."""
        if any(f.endswith("psi") for f in self.factors):
            return "by heading"
        return "odd" if sum(f in MOTIONS for f in self.factors) % 2 else "even"

    def of(self, primed: Mapping[str, Vector]) -> Vector:
        """Its value from primed signals; (n,)."""
        value = np.ones_like(primed["u"])
        for f in self.factors:
            value = value * FACTORS[f][1](primed)
        return value


def parameter(row: str, term: Term) -> str:
    """Name of a term's coefficient in one equation; the underscore keeps it off the catalogue's.

    >>> parameter("N", Term(("delta", "aphi")))
    'N_delta_aphi'
    """
    return "_".join((row, *(term.factors or ("0",))))


def dictionary(row: str, known: Sequence[str]) -> tuple[Term, ...]:
    """Terms for one equation from the signals there are: 80 at most.

    Y, K, N of a ship that is alike on both sides are odd in the mirror, X is even; a few of the
    other kind stand for what is not alike (one propeller, a list, a bent rudder).
    """
    motions = [s for s in MOTIONS if s in known]
    asked = (_even if row == "X" else _odd)(motions)
    asked += [("sinpsi",), ("cospsi",)] if "psi" in known else []
    return tuple(Term(f) for f in asked)


def _odd(motions: Sequence[str]) -> list[tuple[str, ...]]:
    one = [(x,) for x in motions]
    signed = [(x, f"a{x}") for x in motions] + [(x, x, x) for x in motions]
    speed = [(x, "du") for x in motions]
    mixed = [(x, f"a{y}") for x, y in permutations(motions, 2)]
    cubic = [(x, x, y) for x, y in permutations(motions, 2)]
    triple = list(combinations(motions, 3))
    return [*one, *signed, *speed, *mixed, *cubic, *triple, *_both(motions)]


def _even(motions: Sequence[str]) -> list[tuple[str, ...]]:
    products = list(combinations(motions, 2))
    modulus = [(f"a{x}",) for x in motions]
    speed = [(x, x, "du") for x in motions] + [("du", "du")]
    cubic = [(x, x, f"a{y}") for x, y in permutations(motions, 2)]
    return [*products, *modulus, *speed, *cubic, *[(x,) for x in motions], *_both(motions)]


def _both(motions: Sequence[str]) -> list[tuple[str, ...]]:
    return [(), ("du",), *[(x, x) for x in motions]]


def prime_signals(signals: Mapping[str, Vector]) -> dict[str, Vector]:
    """Signals as an effect in the prime system gets them; (n,) each."""
    L, U = signals["L"], signals["U"]
    wanted = (*MOTIONS, "u", "U0", "psi")  # in their order, not a set's, which each process has
    return {n: prime_signal(n, signals[n], L, U) for n in wanted if n in signals}


def pressure(row: str, signals: Mapping[str, Vector]) -> Vector:
    """What a primed force in an equation is multiplied by to be SI; (n,)."""
    scale = signals["L"] ** FORCE_LENGTH[row]
    return np.asarray(0.5 * signals["rho"] * signals["U"] ** 2 * scale)
