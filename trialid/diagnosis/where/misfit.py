"""Where the model fails: by output, stretch of time, amplitude, side, heading, speed, frequency.

Every slice of the residual is a question to chance. A question has one p-value, corrected for
its bins; over all questions Holm's correction holds the chance of any finding in a record that
leaves nothing but noise at 5 %.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from trialid.diagnosis.where import graded, heading, offset, sides, spectrum, stretches, words
from trialid.diagnosis.where.finding import Examined, Finding, Spectrum
from trialid.diagnosis.where.leftover import Leftover, leftover
from trialid.diagnosis.where.slice_test import Colour, colour, holm
from trialid.identification.fit import Fit

LEVEL: Final = 0.05


@dataclass(frozen=True)
class OutputShare:
    """One output's share of the squared error of all, weights included."""

    output: str
    share: float
    sentence: str


@dataclass(frozen=True)
class Rest:
    """What of an output's residual does not follow the rudder, in words and as a spectrum."""

    output: str
    sentence: str
    picture: Spectrum


@dataclass(frozen=True)
class Where:
    """Where the model fails.

    Attributes
    ----------
    findings
        What stands out against the noise, the most of the error first.
    by_output
        Shares of the squared error, largest first.
    rest
        The noise, described.
    not_examined
        Slices this record does not allow, with the reason.
    questions
        How many were put, over all outputs.
    """

    findings: tuple[Finding, ...]
    by_output: tuple[OutputShare, ...]
    rest: tuple[Rest, ...]
    not_examined: tuple[str, ...]
    questions: int


def where(fit: Fit, level: float = LEVEL) -> Where:
    """Slices of the residual that stand out against chance, the most of the error first.

    Parameters
    ----------
    level
        Chance of any finding in a record that leaves nothing but noise.
    """
    whole, left = leftover(fit), leftover(fit.examined)
    hue = colour(left)
    asked: list[Examined] = []
    absent: dict[str, None] = {}
    rest: list[Rest] = []
    for c, output in enumerate(left.outputs):
        if not np.any(left.eps[:, c]):
            absent[f"{output}: nothing is left over"] = None
            continue
        for subject, answer in _questions(left, hue, c):
            if isinstance(answer, str):
                absent[f"{subject}: {answer}"] = None
            else:
                asked.append(answer)
        seen = spectrum.spectra(whole, c)
        if not isinstance(seen, str):
            rest.append(Rest(output, spectrum.rest(whole, c, seen), spectrum.picture(seen)))
    p = holm([max(a.p_value, hue.least) for a in asked])
    standing = [replace(f, p_value=x) for a, x in zip(asked, p, strict=True) if x <= level
                for f in a.findings]  # fmt: skip
    found = sorted(standing, key=lambda f: -f.beyond)
    return Where(tuple(found), _by_output(fit), tuple(rest), tuple(absent), len(asked))


def _questions(left: Leftover, hue: Colour, c: int) -> Iterator[tuple[str, Examined | str]]:
    """Every slice of one output: what was asked, and the answer or why there is none."""
    yield "stretch", stretches.worst_stretches(left, hue, c)
    scales, absent = graded.scales(left)
    yield from absent.items()
    for scale in scales:
        yield scale.kind, graded.amplitude_dependence(left, hue, c, scale)
    yield "side", sides.side(left, hue, c)
    yield "heading sector", heading.by_heading(left, hue, c)
    yield "mean offset", offset.offset(left, hue, c)
    seen = spectrum.spectra(left, c)
    yield "frequency", seen if isinstance(seen, str) else spectrum.follows_rudder(left, c, seen)


def _by_output(fit: Fit) -> tuple[OutputShare, ...]:
    weights = dict(zip(fit.problem.outputs, map(float, fit.problem.weights), strict=True))
    parts = {c: (weights[c] * eps) ** 2 for c, eps in fit.eps_by_output.items()}
    total = sum(parts.values()) or 1.0
    rows = [
        OutputShare(
            c, x / total, f"{words.name(c)} holds {words.share(x / total)} of the squared error"
        )
        for c, x in parts.items()
    ]
    return tuple(sorted(rows, key=lambda row: -row.share))
