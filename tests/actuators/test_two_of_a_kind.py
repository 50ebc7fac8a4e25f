"""Two rudders, two engines, two gears: each a channel of its own, port and starboard apart."""

import struct
import sys
from pathlib import Path

import numpy as np

from trialid.ingest import read

sys.path.append(str(Path(__file__).parents[1] / "ingest"))

from test_nmea0183 import log, raw
from test_nmea2000 import decode, rudder


def test_both_sensors_of_a_rudder_sentence(tmp_path):
    channels = read(log(tmp_path, [raw("TI", "RSA", ["-3.5", "A", "4.5", "A"])])).channels
    assert {name: c.y.tolist() for name, c in channels.items()} == {
        "RSA/TI:starboard": [-3.5],
        "RSA/TI:port": [4.5],
    }
    assert {(c.quantity, c.positive) for c in channels.values()} == {("delta", "starboard")}


def test_two_rudders_two_engines_and_their_gears_are_kept_apart():
    def engine(instance, rpm):
        return struct.pack("<BHHb2x", instance, round(rpm / 0.25), 0xFFFF, 0x7F)

    def gear(instance, code):
        return bytes([instance, 0xFC | code, *[0xFF] * 6])

    messages = [
        (0, 127245, 11, rudder(500, instance=0)),
        (0, 127245, 11, rudder(-2000, instance=1)),
        (0, 127488, 40, engine(0, 800.0)),
        (0, 127488, 40, engine(1, 650.0)),
        (1, 127493, 40, gear(0, 0)),
        (1, 127493, 40, gear(1, 2)),
        (2, 127493, 40, gear(1, 3)),
    ]
    channels, _ = decode(messages)
    found = {name: one.y.tolist() for name, one in channels.items()}
    assert found["rudder/11/0:position"] == [0.05]
    assert found["rudder/11/1:position"] == [-0.2]
    assert found["engine/40/0:speed"] == [800.0]
    assert found["engine/40/1:speed"] == [650.0]
    assert found["transmission/40/0:gear"] == [0.0]
    assert found["transmission/40/1:gear"][0] == 2.0
    assert np.isnan(found["transmission/40/1:gear"][1])
    assert "instance 0 (single engine or port)" in channels["engine/40/0:speed"].description
    assert "instance 1 (starboard engine)" in channels["transmission/40/1:gear"].description
