"""Damaged stamps are found in a long log part by part, as all at once."""

import numpy as np

from trialid.ingest.nmea0183 import nmea0183_steps


def test_parts_do_not_show(monkeypatch):
    rng = np.random.default_rng(19)
    for _ in range(20):
        t = np.cumsum(rng.integers(0, 200_000_000, 300))
        damaged = rng.choice(300, 20, replace=False)
        t[damaged] += rng.integers(-(10**11), 10**11, 20)
        monkeypatch.setattr(nmea0183_steps, "PART", 1000)
        whole = nmea0183_steps.out_of_step(t)
        monkeypatch.setattr(nmea0183_steps, "PART", 7)
        assert whole[damaged].mean() > 0.8
        np.testing.assert_array_equal(nmea0183_steps.out_of_step(t), whole)
