"""A CAN bus that is listened to: python-can's virtual one, with the frames of a sample trial."""

import sys
import threading
import time
from pathlib import Path

import can
import numpy as np
import pytest
from click.testing import CliRunner

from trialid.cli import main
from trialid.errors import TrialidError
from trialid.ingest import read
from trialid.replay.live_bus import Address, LiveBus, address

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "tests" / "ingest"))
import write_can  # noqa: E402

SAMPLES = ROOT / "sample_data" / "hidden_effect"
START = 1_700_000_000_000_000_000
KNOTS, DEGREES = 1852 / 3600, np.pi / 180
COLUMNS = {"delta": ("rudder", DEGREES), "r": ("rot", DEGREES / 60), "phi": ("heel", DEGREES),
           "u": ("stw", KNOTS)}  # fmt: skip
LIVE = """
[[trial]]
name = "at sea"
logs = ["at_sea.log"]
use = "check"
[trial.signals]
delta = { channel = "rudder/11/0:position", unit = "rad", positive = "starboard" }
r     = { channel = "rate_of_turn/11:rate", unit = "rad/s" }
phi   = { channel = "attitude/11:roll", unit = "rad" }
u     = { channel = "speed/11:water", unit = "m/s" }
"""


def trialid_(*arguments):
    return CliRunner().invoke(main.commands, [str(a) for a in arguments], prog_name="trialid")


@pytest.fixture(scope="module")
def sent():
    """Ten minutes of the sample's check trial as NMEA 2000 messages."""
    table = read(SAMPLES / "zigzag-15.csv").channels
    series = {}
    for quantity, (column, factor) in COLUMNS.items():
        t, y = table[column].t, table[column].y * factor
        there = (t - t[0] < 600 * 10**9) & np.isfinite(y)
        series[quantity] = (START + (t - t[0])[there], y[there])
    return write_can.messages(series)


@pytest.fixture(scope="module")
def done(tmp_path_factory, sent):
    """A pipeline with a trial that comes over the bus, and its run from the same frames."""
    folder = tmp_path_factory.mktemp("bus")
    text = (ROOT / "pipelines" / "hidden_effect.toml").read_text(encoding="utf-8")
    text = text.replace("../sample_data", str(ROOT / "sample_data")).replace('"all"', "[]")
    head, align = text.split("\n[align]")
    pipeline = folder / "pipeline.toml"
    pipeline.write_text(f"{head}{LIVE}\n[align]{align}", encoding="utf-8")
    lines = write_can.candump_lines(sent, "-l")
    (folder / "at_sea.log").write_text("\n".join(lines) + "\n", encoding="ascii")
    outcome = trialid_("run", pipeline, "--out", folder / "run", "--quiet")
    assert outcome.exit_code == 0, outcome.output
    return pipeline, folder / "run"


class Ship(threading.Thread):
    """Sends the frames with their own stamps, as fast as the log is read, once somebody listens."""

    def __init__(self, channel, sent, seconds=0.0):
        super().__init__(daemon=True)
        self.frames, self.pause = write_can.frames(sent), seconds
        self.bus = can.Bus(channel, interface="virtual", preserve_timestamps=True)
        self.until = time.monotonic() + 60.0

    def run(self):
        while len(self.bus.channel) < 2:  # queues of those who listen, its own among them
            if time.monotonic() > self.until:
                return
            time.sleep(0.01)
        for i, frame in enumerate(self.frames):
            self.bus.send(frame)
            if self.pause and i % 200 == 0:
                time.sleep(self.pause)
        time.sleep(0.5)
        self.bus.shutdown()


def followed(channel, sent, *arguments, seconds=0.0):
    ship = Ship(channel, sent, seconds)
    ship.start()
    outcome = trialid_("replay", *arguments, "--follow", f"can:virtual:{channel}", "--idle", "4")
    ship.join()
    return outcome


@pytest.mark.study(turn=8)
def test_a_trial_over_the_bus_is_the_trial_of_its_log(done, sent, tmp_path):
    pipeline, run = done
    kept = pipeline.parent / "at_sea.log"
    logged = trialid_("replay", pipeline, "--run", run, "--fast", "--trial", "at sea")
    record = tmp_path / "frames.log"
    live = followed("alpha", sent, pipeline, "--run", run, "--record", record, seconds=0.05)
    assert live.exit_code == 0, live.output
    summary = live.stdout[live.stdout.index("at sea: played") :].splitlines()
    assert summary[:-1] == logged.stdout[logged.stdout.index("at sea: played") :].splitlines()
    assert summary[-1].startswith("  what was shown as the log grew moved by up to")
    taken = record.read_text(encoding="ascii").replace(" R\n", "\n")  # R: received
    assert taken == kept.read_text(encoding="ascii")


@pytest.mark.study
def test_the_bus_may_be_followed_without_a_run(done, sent):
    outcome = followed("beta", sent, done[0], "--quiet")
    assert outcome.exit_code == 0, outcome.output


def test_nothing_is_sent(sent):
    """What else listens on the bus hears the ship alone."""
    ship = Ship("gamma", sent[:100])
    with can.Bus("gamma", interface="virtual") as other:
        heard = can.BufferedReader()
        notifier = can.Notifier(other, [heard])
        ship.start()
        outcome = trialid_("replay", "--help")
        ship.join()
        notifier.stop()
    assert outcome.exit_code == 0
    assert sum(heard.get_message(0) is not None for _ in range(200)) == 100


@pytest.mark.parametrize(
    ("bus", "words"),
    [
        ("can:nonsense:0", "python-can has no interface 'nonsense'"),
        ("can:socketkan:can0", "did you mean 'socketcan' or"),
        ("can:socketcan", "a bus is can:INTERFACE:CHANNEL"),
        ("can::can0", "a bus is can:INTERFACE:CHANNEL"),
        ("can:neovi:1", "cannot be opened"),
        ("can:slcan:/dev/no_such_port", "cannot be opened"),
        ("can:socketcan:no_such_bus", "cannot be opened"),
        ("can:socketcand:can0", "state what the driver needs"),
    ],
)
def test_a_bus_that_is_not_there_is_one_line(done, bus, words):
    outcome = trialid_("replay", done[0], "--run", done[1], "--follow", bus)
    assert outcome.exit_code == 2
    assert words in outcome.stderr
    assert len(outcome.stderr.strip().splitlines()) == 1


def test_a_silent_bus_is_one_line(done):
    outcome = trialid_(
        "replay", done[0], "--run", done[1], "--follow", "can:virtual:silence", "--idle", "0.5"
    )
    assert outcome.exit_code == 2
    assert "no frame came within 0.5 s; look at the bus" in outcome.stderr


def test_follow_may_stand_before_the_pipeline(done):
    outcome = trialid_("replay", "--follow", done[0], "--run", done[1], "--idle", "0.5", "--quiet")
    assert outcome.exit_code == 0, outcome.output
    assert trialid_("replay", done[0], "--record", "a.log").exit_code == 2
    assert trialid_("replay", done[0], "--follow", "--loop").exit_code == 2


def test_the_driver_has_channels_with_colons():
    assert address("can:socketcand:[::1]:can0") == Address("socketcand", "[::1]:can0")


def test_the_log_that_cannot_be_written_is_named(tmp_path):
    with pytest.raises(TrialidError, match="cannot be written"):
        LiveBus(Address("virtual", "delta"), tmp_path / "no folder" / "frames.log")
