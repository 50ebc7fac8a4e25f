"""Of a log without stamps a sensor's times are as even as it sends, whatever comes in between."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.append(str(Path(__file__).parents[1]))

from test_nmea0183_log import SECOND, START, read_text, zda
from write_nmea0183 import sentence

from trialid.ingest.nmea0183.nmea0183_evened import evenly
from trialid.inspection import inspect_log

RATE = 5
SECONDS = 60


def heading(t):
    """At this time [s], as whole and tenths of a degree."""
    return sentence("HC", "HDG", [f"{t:.1f}", "", "", "", ""])


def written(folder, lost=range(0)):
    """Five headings a second among sentences that come where they come, a receiver's time first."""
    others = [sentence("YX", "MTW", ["8.0", "C"])] * 2
    lines = []
    for i in range(SECONDS):
        told = [heading(i + k / RATE) for k in range(RATE) if i not in lost]
        lines += [zda(START + i * SECOND), *told[:1], *others, *told[1:3], *others[:1], *told[3:]]
    return read_text(folder, "".join(line + "\r\n" for line in lines))


def test_a_compass_of_five_a_second_has_no_gaps(tmp_path):
    """It was one of 10 Hz with a gap every second, and nothing of it usable at its own period."""
    channel = written(tmp_path).channels["HDG/HC:heading"]
    apart = np.diff(channel.t) / SECOND
    assert apart == pytest.approx(1.0 / RATE, abs=0.03)
    late = (channel.t - START) / SECOND - channel.y
    assert np.ptp(late) < 0.1
    assert abs(late.mean()) < 0.5
    [log] = tmp_path.iterdir()
    [seen] = [c for c in inspect_log(log).channels.values() if c.name == "HDG/HC:heading"]
    assert seen.rate == pytest.approx(RATE, rel=0.05)
    assert seen.gaps.count == 0


@pytest.mark.parametrize(("lost", "longest"), [(range(20, 25), 5.2), (range(20, 21), 1.2)])
def test_a_pause_stays_one(tmp_path, lost, longest):
    """What comes before and after it is where it was, and no part of it is taken for sent."""
    channel = written(tmp_path, lost=lost).channels["HDG/HC:heading"]
    apart = np.diff(channel.t) / SECOND
    assert np.sum(apart > 1.0) == 1
    assert apart[apart < 1.0] == pytest.approx(1.0 / RATE, abs=0.03)  # on both sides of it
    assert apart.max() == pytest.approx(longest, abs=0.3)
    assert np.ptp((channel.t - START) / SECOND - channel.y) < 0.3


def test_a_clock_put_back_parts_what_is_evened():
    """By 5 s: both stretches are as even as without it."""
    places = np.array([0.0, 0.3, 0.4, 0.7, 0.8])
    one = (SECOND * (np.arange(60)[:, None] + places).ravel()).astype(np.int64)
    made = evenly(np.concatenate([one, one + 55 * SECOND]), SECOND)
    assert np.array_equal(
        made, np.concatenate([evenly(one, SECOND), evenly(one, SECOND) + 55 * SECOND])
    )
    assert np.diff(made[:300]) / SECOND == pytest.approx(0.2, abs=0.03)


def test_what_comes_as_seldom_as_the_time_or_in_bursts_stays_where_it_is():
    seldom = np.arange(50) * SECOND + 3
    assert np.array_equal(evenly(seldom, SECOND), seldom)
    bursts = np.sort(np.concatenate([np.arange(40) * SECOND // 100, 10 * SECOND + np.arange(3)]))
    assert np.array_equal(evenly(bursts, SECOND), bursts)
    assert len(evenly(np.zeros(0, dtype=np.int64), SECOND)) == 0
