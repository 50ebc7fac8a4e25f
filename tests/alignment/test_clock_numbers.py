"""How fast a clock is by its events, and how wide the interval of a match."""

import numpy as np
from made_recordings import channel, recording
from test_log_clock import aligned, two_logs

from trialid.alignment import LogClock
from trialid.alignment.clock_match import Signal, match_clocks


def test_a_clock_that_runs_fast_by_its_events_is_that_fast():
    """Nine seconds in a thousand, of the trial's: not of its own, which would be 0.08 s less."""
    t = np.arange(0.0, 1000.0, 0.1)
    line = 0.002 * t
    logs = [
        recording(channel("gyro", t, line), path="bridge.csv"),
        recording(channel("rate", 1.009 * t, line), path="box.csv"),
    ]
    trial = aligned(logs, LogClock(events=((0.0, 0.0), (1009.0, 1000.0))))
    off = (trial.signals["X_ext"] - trial.signals["r"])[trial.valid["X_ext"]] / 0.002
    assert np.abs(off).max() < 0.005


def test_intervals_of_matches_are_as_wide_as_their_scatter():
    """Two and a bit standard errors: offsets scatter by half of an interval's reach."""
    found = []
    for seed in range(6):
        ours, theirs = (
            next(iter(log.channels.values())) for log in two_logs(1.7, noise=0.15, seed=seed)
        )
        one = match_clocks(
            Signal("a", theirs.t, theirs.y), Signal("b", ours.t, ours.y), 0, 20.0, "here"
        )
        found.append((one.offset - 1.7) / one.reach)
    scatter = float(np.sqrt(np.mean(np.square(found))))
    print(f"{scatter:.2f} of the reach")
    assert 0.15 < scatter < 0.55
