"""What a split of the error must bear: other models of the same rows, and the other routes.

A route rests on an assumption: that the quiet stretch was as noisy as the manoeuvre, that the
model errs alike in every period. Where the assumption fails, the split is wrong by any factor, and
its interval says nothing of it. But noise can never be more than what some fitted model leaves on
the same rows and its parameters took up, nor more than what of the residual does not depend on the
input; it is not as slow as the ship herself; and two routes that exclude each other leave nothing
to state.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from trialid.diagnosis.noise.error_parts import Split, may_be_noise
from trialid.diagnosis.noise.own_motion import share_at_own_frequencies
from trialid.diagnosis.noise.split import INPUT_DRIVEN, STATED
from trialid.diagnosis.search.carried import FALL
from trialid.diagnosis.search.carry_over import own_errors
from trialid.diagnosis.search.completeness import Completeness
from trialid.identification.fit import Fit

SLOW: Final = 0.5
"""Share of what would be noise at the ship's own frequencies from which on it is none: simulated
noise of sensors, waves and turbulence has at most 0.2, zig-zags in wind without the wind 0.75. At
half of it these verdicts are the same, twice doubts nothing."""

OF_NO_FIT: Final = Split("not separable", "a fit that carries no verdict tells neither")
"""What is said of both where nothing is concluded."""


def held_against(
    chosen: Split,
    routes: Sequence[Split],
    fit: Fit,
    others: Sequence[Fit] = (),
    whole: Completeness | None = None,
) -> Split:
    """The split, within what other fits of the same rows leave; refused where routes contradict.

    Parameters
    ----------
    others
        Models with more in them, fitted to the same rows.
    whole
        Whether forces of any shape explain what the catalogue does not.
    """
    if not chosen.available:
        return chosen
    most = next((r.noise for r in routes if r.method == INPUT_DRIVEN), None)
    why = _contradiction(chosen, [r for r in routes if r.available and r is not chosen], whole)
    if why := why or _as_slow_as_she_is(chosen, fit):
        return Split("not separable", why, at_most=most)
    able = [f for f in others if f.converged and f.eps_rmsn < fit.eps_rmsn]
    if not able:
        return chosen
    least = min(able, key=lambda f: f.eps_rmsn)
    if chosen.method == INPUT_DRIVEN and (least.eps_rmsn / fit.eps_rmsn) ** 2 < FALL:
        said = f"{_said(chosen)} at most: how much less is not told without {_added(fit, least)}"
        return Split("not separable", said, at_most=most)
    return _bounded(chosen, fit, least)


def _as_slow_as_she_is(chosen: Split, fit: Fit) -> str:
    """Why what does not depend on the input is no noise either; empty where it may be."""
    if chosen.method != INPUT_DRIVEN or not chosen.noise:
        return ""
    slow = share_at_own_frequencies(fit) * fit.eps_rmsn**2 - (chosen.undermodelling or 0.0) ** 2
    share = slow / chosen.noise**2
    if share < SLOW:
        return ""
    return (
        f"{min(share, 1.0):.0%} of what would be noise ({chosen.noise:.2%} by {chosen.method}) is "
        "as slow as the ship herself: no sensor's noise is, but a force that nobody logged or that "
        "the model lacks"
    )


def _bounded(chosen: Split, fit: Fit, least: Fit) -> Split:
    """No more noise than the closest fit leaves, output by output."""
    assert chosen.noise is not None
    assert chosen.noise_interval is not None
    assert chosen.undermodelling_interval is not None
    low, high = chosen.noise_interval
    total, left = fit.eps_rmsn, least.eps_rmsn
    most = left * _room(least)
    if low > most:
        added = _added(fit, least)
        said = f"{_said(chosen)}, yet with {added} in the model only {left:.2%} is left in all"
        return Split("not separable", said)
    by_output = {
        c: (min(x, least.eps_by_output[c]), fit.eps_by_output[c])
        for c, (x, _) in (chosen.by_output or {}).items()
    }
    noise = min(chosen.noise, left)
    if by_output:
        noise = min(noise, float(np.sqrt(np.mean([x**2 for x, _ in by_output.values()]))))
    floor, top = chosen.undermodelling_interval
    model = _rest(total, noise)
    return replace(
        chosen,
        noise=noise,
        undermodelling=model,
        noise_interval=(min(low, noise), min(high, most)),
        undermodelling_interval=(floor, max(top, model)),  # by chance alone a fit leaves less, too
        by_output={c: (x, _rest(eps, x)) for c, (x, eps) in by_output.items()} or None,
    )


def _room(fit: Fit) -> float:
    """How much larger than what a fit leaves noise may be, for the parameters took some up."""
    seen = fit.examined
    inside, outside = float(seen.residual @ seen.residual), sum(own_errors(seen).whole)
    return float(np.sqrt(may_be_noise(seen, inside, outside) / max(inside, 1e-300)))


def _added(fit: Fit, larger: Fit) -> str:
    """What a larger model has more, by name: effects, or else coefficients that were held."""
    known = {*(e.name for e in fit.model.effects), *fit.estimates}
    more = [e.name for e in larger.model.effects if e.name not in known]
    return " and ".join(more or [f"{n} freed" for n in larger.estimates if n not in known])


def _rest(total: float, part: float) -> float:
    return float(np.sqrt(max(total**2 - part**2, 0.0)))


def _contradiction(chosen: Split, others: Sequence[Split], whole: Completeness | None) -> str:
    """What speaks against a route, in words with both figures; empty where nothing does."""
    if chosen.method == INPUT_DRIVEN and whole is not None and whole.gap:
        return f"{_said(chosen)} at most: the catalogue does not hold all that depends on the input"
    for other in others:
        if _excludes(chosen, other, whole):
            return f"routes contradict each other: {_said(chosen)}; {_said(other)}"
    return ""


def _excludes(one: Split, other: Split, whole: Completeness | None) -> bool:
    """Whether two routes cannot both be right.

    What depends on the input is model: the rest is the most that noise can be. It may be model too
    where the catalogue does not hold what is missing, and then a force of some shape shows. A
    sensor's own figure is the least that noise can be.
    """
    (low, high), (floor, top) = one.noise_interval or (0, 0), other.noise_interval or (0, 0)
    if STATED in (one.method, other.method):
        return (high < floor) if other.method == STATED else (top < low)
    if other.method == INPUT_DRIVEN:
        unexplained = whole is not None and not whole.gap
        return low > top or (high < floor and unexplained)
    if one.method == INPUT_DRIVEN:
        return _excludes(other, one, whole)
    return low > top or high < floor


def _said(route: Split) -> str:
    """A route and its noise with the interval."""
    low, high = route.noise_interval or (0.0, 0.0)
    return f"{route.method}: noise {route.noise:.2%} ({low:.2%} to {high:.2%})"
