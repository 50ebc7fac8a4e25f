"""A log that is still being written: read again as it grows, in step with what is there."""

import late_effect
import numpy as np
import pytest

from trialid import pipeline_file
from trialid.diagnosis.examine import examine_fit
from trialid.errors import TrialidError
from trialid.identification.trial_score import of_trial
from trialid.replay.alarm import bands
from trialid.replay.follow import Follower
from trialid.replay.playback import Playback
from trialid.replay.session import Wishes, play
from trialid.simulation.integrate import respond
from trialid.workflow.build_model import available
from trialid.workflow.findings import diagnose_settings
from trialid.workflow.fit_model import fit_of
from trialid.workflow.read_trials import align_trial, align_trials


def quietly(words, share):
    pass


class WritingTime:
    """A wall clock by which a logger writes a second of the log each second, in torn pieces."""

    def __init__(self, path, text, speed):
        self.path, self.text, self.speed = path, text, speed
        self.t = self.written = 0

    def now(self):
        return self.t

    def wait(self, seconds):
        self.t += max(seconds, 0.01)
        until = min(round(self.t * self.speed), len(self.text))
        if until > self.written:
            with self.path.open("a", encoding="utf-8") as file:
                file.write(self.text[self.written : until])
            self.written = until


@pytest.fixture(scope="module")
def pipeline(tmp_path_factory):
    return late_effect.write(tmp_path_factory.mktemp("growing"), 0.5, 600.0)


@pytest.fixture(scope="module")
def ready(pipeline):
    """Fit and bands from the finished logs."""
    read = pipeline_file.load(pipeline)
    catalogue = available(read)
    fit = fit_of(read, align_trials(read, quietly), catalogue, quietly)
    found, augmented = examine_fit(fit, diagnose_settings(read, catalogue), quietly)
    return read, fit, bands(fit, found.split, augmented)


@pytest.mark.study(turn=11)
def test_a_growing_log_is_followed_and_ends_in_the_numbers_of_the_batch_run(pipeline, ready):
    read, fit, noise = ready
    path = pipeline.parent / "halfway.csv"
    text = path.read_text(encoding="utf-8")
    cut = len(text) // 4
    path.write_text(text[:cut], encoding="utf-8")
    time = WritingTime(path, text[cut:], speed=len(text) / 120.0)  # 1200 s in two minutes
    follower = Follower([path], lambda: align_trial(read, read.trials[-1]), 20.0, time.now)
    first = follower.first(time.wait)
    playback = Playback(fit, first, noise, growing=True)
    course, raised = [], []

    def show(now_playing, pace, now):
        course.append((now, now_playing.at, now_playing.trial.samples))
        if now_playing.monitor.alarms and not raised:
            raised.append((now, now_playing.trial.duration))

    played = play(playback, Wishes(np.inf), time, show, follower=follower)
    assert path.read_text(encoding="utf-8") == text
    whole = align_trial(read, read.trials[-1])
    batch = respond(fit.problem.simulator, whole, *of_trial(fit, whole), sensitivities=False)
    assert played.at == whole.samples
    assert np.array_equal(played.stream.y, batch.y)
    print(f"\nwhat was shown moved by up to {played.revised:.2g} sigma")
    assert 0.0 < played.revised < 0.5
    lengths = {samples for _, _, samples in course}
    assert len(lengths) > 50  # in step, not at the end
    behind = [n - at for _, at, n in course[1:]]
    assert np.quantile(behind, 0.9) <= played.stream.ahead + 3
    assert raised[0][1] < 640.0  # while it was still being written


@pytest.mark.study(turn=11)
def test_it_waits_for_enough_of_a_log_and_gives_up_when_nothing_comes(pipeline, ready, tmp_path):
    read = ready[0]
    text = (pipeline.parent / "halfway.csv").read_text(encoding="utf-8")
    path = tmp_path / "halfway.csv"
    path.write_text(text[:40], encoding="utf-8")
    trial = read.trials[-1]
    here = trial.model_copy(
        update={"logs": tuple(log.model_copy(update={"path": path}) for log in trial.logs)}
    )
    time = WritingTime(path, text[40:20000], speed=5000.0)
    follower = Follower([path], lambda: align_trial(read, here), 3.0, time.now)
    assert follower.first(time.wait).samples > 10
    assert time.now() > 0
    path.write_text(text[:40], encoding="utf-8")
    silent = WritingTime(path, "", 1.0)
    with pytest.raises(TrialidError):
        Follower([path], lambda: align_trial(read, here), 3.0, silent.now).first(silent.wait)
    assert silent.now() >= 3.0
