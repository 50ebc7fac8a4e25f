"""The command: the run's numbers in its recording, and mistakes in one line."""

import json
import os
import re
import select
import sys
import time

import late_effect
import numpy as np
import pytest
from click.testing import CliRunner
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from trialid.cli import main
from trialid.replay.keys import key_names


def trialid_(*arguments):
    return CliRunner().invoke(main.commands, [str(a) for a in arguments], prog_name="trialid")


@pytest.fixture(scope="module")
def done(tmp_path_factory):
    """A pipeline and its run."""
    pipeline = late_effect.write(tmp_path_factory.mktemp("command"), 0.5, 600.0)
    out = pipeline.parent / "run"
    assert trialid_("run", pipeline, "--out", out, "--quiet").exit_code == 0
    return pipeline, out


def columns(path, trial, role):
    read = []
    with path.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        topics = [f"/trialid/{trial}/{role}"]
        for _, _, message, decoded in reader.iter_decoded_messages(topics=topics):
            read.append((message.log_time, decoded.yaw_rate_radps, decoded.roll_rad))
    return np.array(read)


def edges(path, trial):
    """Both edges of the band about the predicted rate of turn and roll."""
    topics = [f"/trialid/{trial}/predicted_band"]
    with path.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        read = [m for *_, m in reader.iter_decoded_messages(topics=topics)]
    return [
        (m.yaw_rate_radps_upper, m.yaw_rate_radps_lower, m.roll_rad_upper, m.roll_rad_lower)
        for m in read
    ]


@pytest.mark.study(turn=3)
def test_the_band_is_that_of_the_run(done, tmp_path):
    """As `result.json` has it, with --run and where the fit is made anew."""
    pipeline, run = done
    band = json.loads((run / "result.json").read_text(encoding="utf-8"))["fit"]["band"]
    for given in (["--run", run], []):
        out = tmp_path / "replay.mcap"
        options = [*given, "--fast", "--out", out, "--force"]
        told = trialid_("replay", pipeline, *options)
        with out.open("rb") as stream:
            [attached] = make_reader(stream).iter_attachments()
        assert json.loads(attached.data)["prediction_band"] == pytest.approx(band, rel=1e-9)
        assert bool(band) is ("95 % band of the prediction" in told.stdout)


@pytest.mark.parametrize("trial", ["before", "halfway"])
@pytest.mark.parametrize("start", [0.0, 333.0])
@pytest.mark.study(turn="each")
def test_the_recording_holds_the_runs_numbers_bit_for_bit(done, trial, start):
    pipeline, run = done
    out = pipeline.parent / f"{trial}-{start:g}.mcap"
    outcome = trialid_("replay", pipeline, "--run", run, "--fast", "--trial", trial,
                       "--from", start, "--out", out)  # fmt: skip
    assert outcome.exit_code == 0, outcome.output
    assert f"{trial}: played from {start:g} to " in outcome.stdout
    for role in ("measured", "predicted", "residual"):
        batch = columns(run / "predicted.mcap", trial, role)
        replayed = columns(out, trial, role)
        assert len(replayed) == len(batch) - round(start / 0.5)
        assert np.array_equal(replayed, batch[-len(replayed) :], equal_nan=True)
    assert edges(out, trial) == edges(run / "predicted.mcap", trial)[-len(replayed) :]
    assert out.with_suffix(".foxglove.json").is_file()
    assert out.with_suffix(".plotjuggler.xml").is_file()


@pytest.mark.study(turn=9)
def test_alarms_are_told_as_they_come_and_fitting_first_gives_the_same(done):
    pipeline, run = done
    given = trialid_("replay", pipeline, "--run", run, "--fast")
    fitted = trialid_("replay", pipeline, "--fast")
    assert fitted.stdout == given.stdout
    first = given.stdout.splitlines()[0]
    match = re.match(r"([\d.]+) s: r left its noise band at", first)
    assert match, first
    assert 600.0 < float(match[1]) <= 610.0
    assert "to port" in first
    assert trialid_("replay", pipeline, "--run", run, "--fast", "--quiet").stdout == ""


@pytest.mark.study(turn=9)
def test_a_log_that_grows_no_more_is_followed_to_its_end(done):
    pipeline, run = done
    outcome = trialid_("replay", pipeline, "--run", run, "--follow", "--idle", "0.5")
    assert outcome.exit_code == 0, outcome.output
    last = columns(run / "predicted.mcap", "halfway", "predicted")[-1, 0] / 1e9
    assert f"played from 0 to {last:g} s" in outcome.stdout


@pytest.mark.parametrize(("arguments", "words"), [
    (["--trial", "zigzag"], "no trial 'zigzag'"),
    (["--run", "nowhere"], "--run nowhere: result.json cannot be read"),
    (["--out", "replay.csv"], "the suffix says the format, .mcap"),
    (["--out", "nowhere/replay.mcap"], "make it first"),
    (["--from", "5000", "--fast"], "--from 5000: trial 'halfway' lasts 1199"),
])  # fmt: skip
def test_a_mistake_is_one_line(done, arguments, words):
    pipeline, run = done
    if "--from" in arguments:
        arguments = [*arguments, "--run", run]
    outcome = trialid_("replay", pipeline, *arguments)
    assert outcome.exit_code == 2
    assert words in outcome.stderr
    assert len(outcome.stderr.strip().splitlines()) == 1


def test_a_run_of_another_model_is_refused(done, tmp_path):
    pipeline, run = done
    result = json.loads((run / "result.json").read_text(encoding="utf-8"))
    result["model"]["effects"].append("righting_arm_cubic")
    (tmp_path / "result.json").write_text(json.dumps(result), encoding="utf-8")
    outcome = trialid_("replay", pipeline, "--run", tmp_path)
    assert outcome.exit_code == 2
    assert "apart in righting_arm_cubic" in outcome.stderr
    result["model"]["effects"].pop()
    result["accuracy"]["parameters"] = result["accuracy"]["parameters"][1:]
    (tmp_path / "result.json").write_text(json.dumps(result), encoding="utf-8")
    outcome = trialid_("replay", pipeline, "--run", tmp_path)
    assert outcome.exit_code == 2
    assert "there is no value for Yv" in outcome.stderr


@pytest.mark.parametrize("options", [["--fast", "--speed", "2"], ["--loop", "--follow"]])
def test_options_that_exclude_each_other(done, options):
    assert trialid_("replay", done[0], *options).exit_code == 2


@pytest.mark.skipif(sys.platform == "win32", reason="needs a pseudo-terminal")
@pytest.mark.study(turn=0)
def test_in_a_terminal_space_pauses_arrows_seek_and_q_ends(done):
    pipeline, run = done
    pid, place = os.forkpty()
    if pid == 0:
        os.environ |= {"TERM": "xterm", "COLUMNS": "120", "LINES": "40"}
        code = "from trialid.cli.main import main; main()"
        arguments = ["replay", pipeline, "--run", run, "--from", "100", "--speed", "2"]
        os.execv(sys.executable, [sys.executable, "-c", code, *map(str, arguments)])
    terminal = Terminal(place)
    began = terminal.position(r"2 times")
    assert 100.0 <= began < 110.0
    os.write(place, b" ")
    stood = terminal.position("paused")
    os.write(place, b"\x1b[C")
    assert terminal.position("paused", beyond=stood) == pytest.approx(stood + 10.0, abs=0.6)
    os.write(place, b" ")
    assert terminal.position(r"2 times", beyond=stood + 10.5) < stood + 40.0
    os.write(place, b"q")
    assert "no alarm" in terminal.rest()
    assert os.waitpid(pid, 0)[1] == 0


class Terminal:
    """What a replay writes to its terminal."""

    def __init__(self, place):
        self.place, self.text = place, ""

    def position(self, how, beyond=-1.0):
        """Where the replay stands when its heading next says how it runs."""
        until = time.monotonic() + 60.0
        while time.monotonic() < until:
            if select.select([self.place], [], [], 0.1)[0]:
                self.text += os.read(self.place, 65536).decode(errors="replace")
            found = re.findall(rf"halfway  ([\d.]+) of [\d.]+ s  {how}", self.text)
            if found and float(found[-1]) > beyond:
                self.text = ""
                return float(found[-1])
        raise AssertionError(self.text[-2000:])

    def rest(self):
        """All that comes until the other side hangs up."""
        while True:
            try:
                sent = os.read(self.place, 65536)
            except OSError:  # Linux says so where others send nothing
                sent = b""
            if not sent:
                return self.text
            self.text += sent.decode(errors="replace")


def test_keys_that_mean_nothing_are_passed_over():
    assert key_names(b"\x1b[D\x1b[Bx  \x1b") == ["left", "space", "space"]
