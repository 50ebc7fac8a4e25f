"""Whether the fitted ship is the one of her file, by the coefficients that both give."""

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.fit import Fit
from trialid.identification.one_search import search
from trialid.identification.output_error import Unknown, ranges
from trialid.linear_algebra import triangle

Vector = NDArray[np.float64]

OFF: Final = 2.0
"""Factor by which a coefficient is another ship's: published sets of one hull differ by 1.3."""

CLEARLY: Final = 3.0
"""Standard errors by which it must be off as well: weakly seen ones are far off by themselves."""

FEWEST: Final = 3
LEAVES: Final = 2.0
"""Times the fit's error that the ship of a file which is not hers leaves at her best. Of 17 fits of
two real ships by their own files 6 have most coefficients unlike them, and the most is 1.4; three
other ships' files left 2.7, 3.6 and 6.7. Half of it refuses the six, twice misses two of the three.
"""
STEERS: Final = "Ndelta"
PLACEHOLDER: Final = "PLACEHOLDER"
"""How the source of a ship file begins that says itself that it is not hers."""


def unlike_file(fit: Fit) -> tuple[dict[str, float], int]:
    """Fitted coefficients clearly unlike the ship file's, over the file's; and how many compare.

    Those whose start the user states differently are not compared, nor is a placeholder. What the
    file says of its own scatter counts: an estimate is not another ship's for being as far off.
    """
    errors = dict(zip((x.name for x in fit.problem.unknowns), _standard_errors(fit), strict=True))
    compared, found = _compared(fit), dict[str, float]()
    for name, (stated, scatter) in compared.items():
        value = fit.value(name)
        clearly = CLEARLY * float(np.hypot(errors[name], scatter))
        if not 1.0 / OFF < value / stated < OFF and abs(value - stated) > clearly:
            found[name] = value / stated
    return found, len(compared)


def _compared(fit: Fit) -> dict[str, tuple[float, float]]:
    """The coefficients that the file gives and the search had, with the file's scatter."""
    model = fit.problem.simulator.model
    if model.ship.source.startswith(PLACEHOLDER):
        return {}
    plain, said = replace(model, values={}), model.ship.uncertainty
    usual = said.get("default", 0.0)
    stated = {x.name: plain.stated(x.name) for x in fit.problem.unknowns if x.kind == "physical"}
    return {
        n: (value, said.get(n, usual) * abs(value))
        for n, value in stated.items()
        if value and model.values.get(n, value) == value
    }


def most_are_unlike(fit: Fit) -> str:
    """That half of what can be compared, and three, are clearly unlike the file's; else empty.

    A quarter would call a ship with one missing effect another, all of them none.
    """
    found, compared = unlike_file(fit)
    if len(found) < FEWEST or 2 * len(found) < compared:
        return ""
    listed = ", ".join(f"{n} {x:.2g}" for n, x in list(found.items())[:4])
    return (
        f"{len(found)} of {compared} fitted coefficients are less than half or more than twice "
        f"the file's ({listed} times)"
    )


def left_by_file(fit: Fit) -> float | None:
    """How many times the fit's error the ship of her file leaves; None where hers is the fit's.

    Coefficients unlike the file's do not make her another: where drift and rate of turn go together
    a model that lacks something is fitted by sway coefficients that are not hers, and others do
    nearly as well. So the search is made again with every coefficient kept where it is not unlike.
    """
    if not most_are_unlike(fit):
        return None
    problem = replace(fit.problem, unknowns=_kept_near(fit))
    _, low, high = ranges(problem.unknowns)
    ends = [
        search(problem, fit.settings, np.clip(x, low, high)) for x in (fit.theta, problem.start)
    ]
    left = float(np.sqrt(min(end.V for end in ends) / fit.V))
    return left if left >= LEAVES else None


def steers_backwards(fit: Fit) -> bool:
    """Whether the rudder as fitted clearly turns her to the other side than in her file.

    Which side is the file's `rudder_positive`, of a placeholder too; a model that lacks something
    may follow a turn by a ship that is unstable and held by her rudder. Of the real turn where this
    was found it is 4.8 standard errors: half of `CLEARLY` finds it too, twice does not.
    """
    names = [x.name for x in fit.problem.unknowns]
    if STEERS not in names:
        return False
    model = fit.problem.simulator.model
    value, stated = fit.value(STEERS), replace(model, values={}).stated(STEERS)
    error = float(_standard_errors(fit)[names.index(STEERS)])
    return value * (stated or 0.0) < 0.0 and abs(value) > CLEARLY * error


def _kept_near(fit: Fit) -> tuple[Unknown, ...]:
    """The unknowns, each coefficient within what is not unlike the file's."""
    compared = _compared(fit)
    return tuple(
        _near(x, *compared[x.name]) if x.name in compared else x for x in fit.problem.unknowns
    )


def _near(x: Unknown, stated: float, scatter: float) -> Unknown:
    far = CLEARLY * scatter
    allowed = (stated / OFF, stated * OFF, stated - far, stated + far)
    return replace(x, low=max(x.low, min(allowed)), high=min(x.high, max(allowed)))


def _standard_errors(fit: Fit) -> Vector:
    """By the level of the error with its colour, priors counted; (n_theta,)."""
    seen = fit.examined
    held = [seen.level / x.prior[1] if x.prior else 0.0 for x in fit.problem.unknowns]
    rows = np.concatenate([triangle(seen.psi), np.diag(held)])
    sizes = np.maximum(np.linalg.norm(rows, axis=0), 1e-300)
    R = np.linalg.qr(rows / sizes, mode="r")
    return np.asarray(seen.level * np.linalg.norm(np.linalg.pinv(R), axis=1) / sizes)
