"""From a dataflash log of a skid-steered boat to a model by `trialid start`.

ArduPilot says by SERVOn_FUNCTION which output is the left motor, and by MIN, TRIM and MAX what its
pulse widths mean; NMEA 2000 says which engine is to port.
"""

import struct
import sys
from pathlib import Path

import numpy as np
import pytest
import skid_steer
from click.testing import CliRunner

from trialid.cli.main import commands
from trialid.ingest import read
from trialid.inspection import inspect_log
from trialid.inspection.drives import drives_of
from trialid.result.json_file import read as result_of

sys.path.append(str(Path(__file__).parents[1] / "ingest"))

from test_nmea0183 import log
from test_nmea0183 import raw as sentence
from test_nmea2000 import decode, rudder


def test_shares_come_back_from_pulse_widths_with_their_own_ends(tmp_path: Path) -> None:
    """Within one count of the shorter side; 1500 and 400 for all would be off by a fifth."""
    skid_steer.write(tmp_path / "a.bin", 710, duration=30.0)
    channels = read(tmp_path / "a.bin").channels
    t = np.arange(0.0, 30.0, skid_steer.PERIOD)
    for i, name in enumerate(("servo/1:throttle_left", "servo/3:throttle_right")):
        wanted = skid_steer.shares(t, 710)[:, i]
        np.testing.assert_allclose(channels[name].y, wanted, atol=1.0 / 380.0)
        assert (channels[name].unit, channels[name].quantity) == ("1", None)
    naive = (channels["RCOU:C3"].y - 1500.0) / 400.0
    assert np.abs(naive - skid_steer.shares(t, 710)[:, 1]).max() > 0.2


@pytest.mark.study(turn=4)
def test_from_the_log_to_a_model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of what the first model lacks, sway and a lag, the record does not tell which is missed."""
    monkeypatch.chdir(tmp_path)
    for name, seed in (("a", 711), ("b", 712)):
        skid_steer.write(tmp_path / f"{name}.bin", seed, duration=90.0)
    done = CliRunner().invoke(commands, ["start", "a.bin", "b.bin", "--length", "2", "--quiet"])
    assert done.exit_code == 0, done.output
    text = (tmp_path / "first_trial.toml").read_text(encoding="utf-8")
    assert 'thruster_port_order      = { channel = "servo/1:throttle_left", unit = "1" }' in text
    assert "# thruster_port_order: by its parameters; side confirmed by the turn" in text
    assert 'command = "share"' in (tmp_path / "first_trial_ship.toml").read_text(encoding="utf-8")
    found = result_of(tmp_path / "runs" / "first_trial" / "result.json")
    assert found.fit.converged
    assert found.verdict.kind == "cannot tell"
    assert found.verdict.family == ("sway_in_turns", "thrusters_lag")
    assert found.fit.eps_rmsn < 0.2


def test_cables_that_are_exchanged_are_asked(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    skid_steer.write(tmp_path / "a.bin", 713, swapped=True, duration=60.0)
    done = CliRunner().invoke(commands, ["start", "a.bin", "--length", "2"])
    assert done.exit_code == 0, done.output
    assert "she turns towards the stronger one" in " ".join(done.stdout.split())
    assert not (tmp_path / "runs").exists()


def test_engines_of_a_bus_are_port_and_starboard_by_their_instance(tmp_path: Path) -> None:
    """PGN 127488: instance 1 is sent first, and is starboard all the same."""
    rows = []
    for k in range(60):
        for instance, rpm in ((1, 700.0 + 3.0 * k), (0, 900.0 - 2.0 * k)):
            data = struct.pack("<BHHb2x", instance, round(4.0 * rpm), 0xFFFF, 0x7F)
            rows.append(f"({1_700_000_000 + 0.1 * k:.6f}) can0 09F20028#{data.hex().upper()}")
    path = tmp_path / "bus.log"
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
    port, starboard = drives_of(inspect_log(path))
    assert port.name.endswith("/0:speed")
    assert starboard.name.endswith("/1:speed")
    assert (port.low, starboard.low) == (782.0, 700.0)


def test_both_sensors_of_a_rudder_sentence(tmp_path):
    channels = read(log(tmp_path, [sentence("TI", "RSA", ["-3.5", "A", "4.5", "A"])])).channels
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
