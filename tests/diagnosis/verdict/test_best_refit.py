"""Which of two that carry over as well has the name; on made-up fits."""

from made_up_fits import BEFORE
from test_refit import ALIKE, LESS, refit

from trialid.diagnosis.best_refit import best_of
from trialid.diagnosis.search.carried import as_near


def test_of_two_as_good_the_one_that_stands_out_against_the_noise_is_taken():
    nearly = tuple(0.695 * x + 0.02 * (-1) ** i for i, x in enumerate(BEFORE))
    blocks = refit("blocks", BEFORE, nearly, p_value=0.23)[1]
    sure = refit("sure", BEFORE, LESS, p_value=0.04)[1]
    assert best_of([blocks, sure], 0.05) is sure
    more = refit("more", BEFORE, ALIKE, p_value=0.23)[1]
    assert best_of([more, sure], 0.05) is more  # by more than one standard error
    assert best_of([blocks, sure], 0.01) is blocks
    far = refit("far", BEFORE, tuple(0.5 * x for x in BEFORE), p_value=0.23)[1]
    assert best_of([far, sure], 0.05) is far  # no equal


def test_what_does_far_less_is_no_equal_however_wide_the_blocks_scatter():
    """Within one standard error of the best, and it takes less than half of what that does."""
    even = (1.0,) * 6
    best = refit("best", even, (0.1, 1.5, 0.9, 1.45, 0.2, 1.4), p_value=0.23)[1]
    slight = refit("slight", even, (0.97,) * 6, p_value=0.001)[1]
    assert as_near(best.carried.after, slight.carried.after)
    assert best_of([best, slight], 0.05) is best
