"""How far apart the samples of a trial's logs are, before they are put on its clock."""

import numpy as np
from made_recordings import channel, recording

from trialid.alignment import SignalSource, align

UNITS = {"delta": "rad", "r": "rad/s", "u": "m/s"}


def test_the_slowest_of_orders_and_rates_counts_and_not_the_speed():
    made = []
    for name, step in (("delta", 0.1), ("r", 0.2), ("u", 1.0)):
        t = np.arange(0.0, 100.0, step)
        made.append(channel(name, t, 0.1 * np.sin(0.3 * t) + (name == "u")))
    sides = {"delta": "starboard"}
    sources = [SignalSource(n, n, unit, sides.get(n)) for n, unit in UNITS.items()]
    trial = align("t", "fit", [recording(*made)], sources, 0.5)
    assert round(trial.logged_every, 6) == 0.2
