"""Whether held-out trials are foretold worse, by more than their own stretches let one tell.

The rise is that of the squared error, which is a sum over blocks of time; how these scatter says
how sure it is. Only a rise of more than one standard error speaks against an effect, as one within
it speaks for no structure (`one_standard_error`): of six blocks by chance alone 18 in 100 rise by
more; half of it would take 32, twice of it 5. One that is large needs no such test there nor here.
"""

import numpy as np

from trialid.arrays import Vector
from trialid.diagnosis.one_standard_error import CLEARLY
from trialid.diagnosis.search.carry_over import BLOCKS
from trialid.identification.fit import Fit
from trialid.identification.output_error import output_error, output_matrix
from trialid.identification.trial_score import Score


def worse_held_out(before: Fit, after: Fit) -> bool:
    """Whether held-out trials, where there are any, become worse or are lost."""
    old, new = before.eps_check, after.eps_check
    if old is None or new is None:
        return False
    if not np.isfinite(new):
        return True
    return new > (1.0 + CLEARLY) * old or new**2 - old**2 > _chance(before, after)


def _chance(before: Fit, after: Fit) -> float:
    """Standard error of the rise in the squared error; 0 where there is one block alone."""
    rises = squares_by_block(after) - squares_by_block(before)
    if len(rises) < 2:
        return 0.0
    return float(np.sqrt(len(rises)) * np.std(rises, ddof=1))


def squares_by_block(fit: Fit) -> Vector:
    """What each block of time of the held-out trials adds to the square of their error."""
    scores = [s for s in fit.scores if s.trial.use == "check"]
    counts = np.sum([list(s.counts.values()) for s in scores], axis=0)
    pieces = -(-BLOCKS // max(len(scores), 1))
    each = [_of_trial(fit, one, pieces) / counts for one in scores]
    return np.concatenate(each).mean(axis=1) if each else np.zeros(0)


def _of_trial(fit: Fit, score: Score, pieces: int) -> Vector:
    """Sums of squares of the normed errors in each piece of one trial; (pieces, n_y)."""
    y = output_matrix(score.trial, fit.problem.outputs)
    errors = output_error(y, score.response.y) / fit.problem.y_rms
    squares = np.where(score.compared, np.square(errors), 0.0)
    return np.array([part.sum(axis=0) for part in np.array_split(squares, pieces)])
