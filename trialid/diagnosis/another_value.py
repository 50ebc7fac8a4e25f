"""Held-out trials that the model follows with another value of one parameter: a ship loaded anew.

Between two trials of one ship her cargo may have come aboard, or her log have been set. Then one
parameter is another there, and nothing is missing in the model.
"""

from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from trialid.identification.fit import Fit
from trialid.identification.trial_score import Score, check_rows, pool_errors, score_trial
from trialid.names.wording import shown_unit

WORSE: Final = 2.0
"""Times the fitted trials' error of an output that a held-out trial must leave to be looked at.
Of seven simulated sets, one of a ship loaded anew, that one is told, and at half and twice too."""

MENDS: Final = 0.75
"""Share of its squared error that goes with the other value where it is told: half its error. Of a
simulated naval vessel 0.90 goes with another GM where she has 0.64 of it, and 0.52 with the best of
all where she only sails faster and the model lacks something: at half of it that would be told."""

FROM: Final = tuple(np.geomspace(0.4, 2.5, 24))
"""Multiples of GM that are tried, to look from the best: a quarter off, roll is out of phase with
what slopes say, and searches from half and twice of it stopped in false valleys. 8 % from one to
the next are 4 % of the period; half as many find the same in the tests, twice take twice as long.
"""

STEPS: Final = 8
NEAR: Final = 0.99
"""Share of the error above which a step has brought the search to its end."""

HALVINGS: Final = 3


def follow_with_another_value(fit: Fit) -> tuple[str, ...]:
    """In words, of each held-out trial whose error one parameter's other value explains."""
    return tuple(words for score in _far_off(fit) for words in _told(fit, score))


def _far_off(fit: Fit) -> Iterator[Score]:
    """Held-out trials that leave much more of some output than the fitted ones do."""
    for score in fit.scores:
        if score.trial.use == "check" and score.response.departure is None:
            fitted = fit.eps_by_output
            if any(eps > WORSE * fitted.get(c, np.inf) for c, eps in score.eps_rmsn.items()):
                yield score


def _told(fit: Fit, score: Score) -> Iterator[str]:
    """The parameter that mends the trial best, with its value there, where one does."""
    ends = [(place, *_search(fit, score, place, begin)) for place, begin in _starts(fit, score)]
    if not ends:
        return
    place, value, after = min(ends, key=lambda end: end[2])
    before = _error(score)
    if 1.0 - (after / before) ** 2 < MENDS:
        return
    unknown = fit.problem.unknowns[place]
    unit, factor = shown_unit(unknown.unit)
    there, here = (f"{x * factor:.3g}" for x in (value, float(fit.theta[place])))
    yield (
        f"held-out {score.trial.name} is followed with {unknown.name} = {there}"
        f"{f' {unit}' if unit != '1' else ''}, {here} in the fitted trials: its error falls from "
        f"{before:.1%} to {after:.1%}; {_why(fit, score)}"
    )


def _why(fit: Fit, score: Score) -> str:
    """What makes it so; within one log no cargo comes aboard."""
    lacks = "the model lacks what makes it so"
    fitted = {log for t in fit.trials if t.use == "fit" for log in t.logs}
    return lacks if fitted & {*score.trial.logs} else f"she was loaded otherwise there, or {lacks}"


def _starts(fit: Fit, score: Score) -> Iterator[tuple[int, float]]:
    """Each parameter of the ship by its place, and a start; of GM the best of a scan too."""
    for place, unknown in enumerate(fit.problem.unknowns):
        if unknown.trial is None and unknown.kind == "physical":
            begun = float(fit.theta[place])
            yield place, begun
            if unknown.name == "GM":
                tried = [times * begun for times in FROM]
                yield place, min(tried, key=lambda x: _error_at(fit, score, {unknown.column: x}))


def _search(fit: Fit, score: Score, place: int, begin: float) -> tuple[float, float]:
    """The value with which the trial is followed best, and its error then; Gauss-Newton on one."""
    shared = [i for i, x in enumerate(fit.problem.unknowns) if x.trial is None]
    unknown, column = fit.problem.unknowns[place], shared.index(place)

    def at(value: float) -> dict[str, float]:
        return {unknown.column: value}

    value, least = begin, _error_at(fit, score, at(begin))
    for _ in range(STEPS):
        rows = check_rows(fit, score.trial, {**fit.common, **at(value)})
        if rows is None:
            break
        slope = rows.psi[:, column]
        step = float(slope @ rows.residual) / max(float(slope @ slope), 1e-300)
        for halved in range(HALVINGS):
            tried = float(np.clip(value + step / 2.0**halved, unknown.low, unknown.high))
            if (error := _error_at(fit, score, at(tried))) < NEAR * least:
                break
        else:
            break
        value, least = tried, error
    return value, least


def _error_at(fit: Fit, score: Score, values: Mapping[str, float]) -> float:
    """What is left of a trial with other values of some parameters."""
    return _error(score_trial(fit, score.trial, {**fit.common, **values}))


def _error(score: Score) -> float:
    return float(np.sqrt(np.mean(np.square(list(pool_errors([score]).values())))))
