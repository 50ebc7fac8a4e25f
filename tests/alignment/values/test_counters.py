"""Counters that ran over, put on the line that they were made of."""

import numpy as np
import pytest

from trialid.alignment.stamps.time_steps import unwrap_counter


@pytest.mark.parametrize(("bits", "tick"), [(32, 1e-9), (16, 1e-3), (32, 1e-6), (32, 1e-3)])
def test_counters_of_so_many_bits_begin_again_where_they_must(bits, tick):
    """The stamps of a counter that ran over twice, put on the line that they were made of."""
    turn = 2**bits * tick
    true = 0.3 * turn + np.arange(4000) * (turn / 1700)
    found, turns = unwrap_counter(true % turn)
    np.testing.assert_allclose(found, true, rtol=0, atol=1e-9 * turn)
    assert turns == pytest.approx([turn, turn])
