"""How far published ships lie from their estimates, in the scatter that is stated."""

import numpy as np
import pytest
from published import published_ships


def counted():
    """By number: how far each counted set lies from the estimate, in the scatter that is stated."""
    found = {}
    for ship in published_ships():
        for name, value, share, known in ship.pairs():
            if ship.counted and share > 0.0 and not ship.is_own(name):
                found.setdefault(name, []).append((known / value - 1.0) / share)
    return found


def test_the_stated_scatter_is_what_was_counted():
    """One deviation, root mean square, where two ships and more have the number."""
    rms = {n: float(np.sqrt(np.mean(np.square(z)))) for n, z in counted().items() if len(z) > 1}
    assert len(rms) > 25
    assert {n: round(z, 1) for n, z in rms.items() if z > 1.4} == {}
    assert float(np.median(list(rms.values()))) == pytest.approx(0.9, abs=0.25)


def test_ships_that_nothing_was_counted_on_lie_within_it():
    """KVLCC2, Esso Osaka and a tanker: 30 of 30 within two deviations, 29 within one.

    All three are full and slow, where formulas do well; the ships counted on are of all kinds.
    """
    off = [
        (known / value - 1.0) / share
        for ship in published_ships()
        if not ship.counted
        for _, value, share, known in ship.pairs()
        if share > 0.0
    ]
    within = [float(np.mean(np.abs(off) < k)) for k in (1.0, 2.0)]
    print(len(off), within)
    assert len(off) >= 25
    assert within[1] >= 0.9
    assert within[0] >= 0.6
    assert float(np.sqrt(np.mean(np.square(off)))) > 0.3  # and it says something
