"""A search that ends at a kink: no step lowers the error, and slopes say that one should."""

import numpy as np
import pytest

from trialid.least_squares.gauss_newton import AT_A_KINK, minimise

NOISE = 10.0
LEFT = np.sqrt(2.0) / np.hypot(1.0, NOISE)
"""Standard errors that the slopes at b = 1 promise: of two rows one goes with them."""


def kinked(b):
    """Residual 1 + |b - 1| and a row that nothing moves: least at b = 1, with a slope there."""
    side = np.where(b >= 1.0, 1.0, -1.0)
    return np.array([1.0 + abs(b[0] - 1.0), NOISE]), np.vstack([-side, 0.0 * b])


@pytest.mark.parametrize(
    ("share", "reason"), [(1.2, "kink"), (0.6 * AT_A_KINK, "kink"), (1.2 * AT_A_KINK, "stalled")]
)
def test_it_has_arrived_where_next_to_nothing_is_left(share, reason):
    """So much is left, in what is next to nothing."""
    end = minimise(kinked, np.array([1.7]), np.ones(1), worth=lambda: LEFT / share)
    assert end.theta == pytest.approx(1.0, abs=1e-6)
    assert end.reason == reason
    assert end.converged is (reason == "kink")
