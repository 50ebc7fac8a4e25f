"""Sentences of a fix as the clock of a log in which nothing tells a date."""

import sys
from pathlib import Path

import numpy as np
import pytest

sys.path.append(str(Path(__file__).parents[1]))

from test_nmea0183_log import SECOND, START, iso, read_text, unstamped, zda
from write_nmea0183 import sentence

PLACE = ["5910.0000", "N", "01030.0000", "E"]


def gga(t, quality=1):
    clock = iso(t)[11:].replace(":", "")[:-2]
    return sentence("GP", "GGA", [clock, *PLACE, str(quality), "9", "1.0", "1.0", "M", "", "M"])


def gll(t):
    return sentence("GP", "GLL", [*PLACE, iso(t)[11:].replace(":", "")[:-2], "A"])


@pytest.mark.parametrize("fix", [gga, gll])
def test_the_time_of_day_of_a_fix_is_the_clock_where_nothing_tells_a_date(tmp_path, fix):
    recording = read_text(tmp_path, unstamped(lambda i: fix(START + i * SECOND)))
    channel = recording.channels["ROT/TI:rate"]
    midnight = START // (86_400 * SECOND) * 86_400 * SECOND
    np.testing.assert_allclose(channel.t / 1e9, (START - midnight) / 1e9 + channel.y, atol=1e-8)
    assert channel.clock.endswith("time of day, no date")


def test_a_receiver_without_a_fix_counts_on_and_is_not_believed(tmp_path):
    def tick(i):
        return gga(START + (i if i > 5 else i - 900) * SECOND, quality=int(i > 5))

    channel = read_text(tmp_path, unstamped(tick)).channels["ROT/TI:rate"]
    assert channel.y.min() > 5


def test_a_date_is_better_than_a_time_of_day(tmp_path):
    def tick(i):
        return gga(START + (i + 7) * SECOND) + "\r\n" + zda(START + i * SECOND)

    channel = read_text(tmp_path, unstamped(tick)).channels["ROT/TI:rate"]
    assert "GPZDA" in channel.clock
    assert channel.t.min() > 1.5e18
