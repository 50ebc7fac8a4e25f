"""Whether the fitted ship is the one of her file, by the coefficients that both give."""

from dataclasses import replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.identification.fit import Fit

Vector = NDArray[np.float64]

OFF: Final = 2.0
"""Factor by which a coefficient is another ship's: published sets of one hull differ by 1.3."""

CLEARLY: Final = 3.0
"""Standard errors by which it must be off as well: weakly seen ones are far off by themselves."""

FEWEST: Final = 3
PLACEHOLDER: Final = "PLACEHOLDER"
"""How the source of a ship file begins that says itself that it is not hers."""


def unlike_file(fit: Fit) -> tuple[dict[str, float], int]:
    """Fitted coefficients clearly unlike the ship file's, over the file's; and how many compare.

    Those whose start the user states differently are not compared, nor is a placeholder. What the
    file says of its own scatter counts: an estimate is not another ship's for being as far off.
    """
    model = fit.problem.simulator.model
    if model.ship.source.startswith(PLACEHOLDER):
        return {}, 0
    plain, errors, said = replace(model, values={}), _standard_errors(fit), model.ship.uncertainty
    found, compared = dict[str, float](), 0
    for x, a, error in zip(fit.problem.unknowns, fit.theta, errors, strict=True):
        stated = plain.stated(x.name) if x.kind == "physical" else None
        if not stated or model.values.get(x.name, stated) != stated:
            continue
        compared += 1
        ratio, scatter = float(a) / stated, said.get(x.name, said.get("default", 0.0)) * stated
        clearly = CLEARLY * float(np.hypot(error, scatter))
        if not 1.0 / OFF < ratio < OFF and abs(float(a) - stated) > clearly:
            found[x.name] = ratio
    return found, compared


def is_another_ship(fit: Fit) -> bool:
    """Whether half of what can be compared, and three coefficients, are clearly another ship's.

    A quarter would call a ship with one missing effect another, all of them none.
    """
    found, compared = unlike_file(fit)
    return len(found) >= FEWEST and 2 * len(found) >= compared


def _standard_errors(fit: Fit) -> Vector:
    """By the level of the error with its colour, priors counted; (n_theta,)."""
    held = [fit.level / x.prior[1] if x.prior else 0.0 for x in fit.problem.unknowns]
    rows = np.concatenate([fit.psi, np.diag(held)])
    sizes = np.maximum(np.linalg.norm(rows, axis=0), 1e-300)
    R = np.linalg.qr(rows / sizes, mode="r")
    return np.asarray(fit.level * np.linalg.norm(np.linalg.pinv(R), axis=1) / sizes)
