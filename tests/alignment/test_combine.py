"""Two rudders or two gyros as one signal: the mean where both are known, or a refusal."""

import json
from pathlib import Path

import numpy as np
import pytest
from made_recordings import channel, recording

from trialid.alignment import SignalSource, align
from trialid.errors import AlignmentError, PipelineError
from trialid.pipeline_file import load
from trialid.workflow.origin import signals_of
from trialid.workflow.read_trials import align_trial

T = np.arange(0, 200, 0.5)


def turning(t):
    return 5 * np.sin(0.4 * t) + 2 * np.sin(0.11 * t + 1)


def both(quantity, unit="deg/s", positive=None):
    return [SignalSource(quantity, name, unit, positive, combine="mean") for name in ("one", "two")]


def aligned(first, second, sources):
    logs = [recording(first), recording(second, path="other.log")]
    return align("zigzag", "fit", logs, sources, 0.5)


def test_noise_of_two_gyros_is_less_than_that_of_either():
    noise = np.random.default_rng(11).normal(0.0, 0.5, (2, len(T)))
    logged = [channel(n, T, turning(T) + e) for n, e in zip(("one", "two"), noise, strict=True)]
    trial = aligned(*logged, both("r"))
    alone = aligned(*logged, [SignalSource("r", "one", "deg/s")])
    truth = np.radians(turning(T))
    errors = [np.std(made.signals["r"] - truth) for made in (trial, alone)]
    assert errors[0] / errors[1] == pytest.approx(np.sqrt(0.5), rel=0.1)
    np.testing.assert_allclose(trial.signals["r"] - truth, np.radians(noise.mean(axis=0)))
    assert any(remark.startswith("r is the mean of one, two") for remark in trial.remarks)


def test_where_one_is_silent_the_mean_is_not_known():
    silent = (T > 50) & (T < 80)
    trial = aligned(
        channel("one", T, turning), channel("two", T[~silent], turning(T[~silent]) + 4), both("r")
    )
    inside = (T > 51) & (T < 79)
    assert not trial.valid["r"][inside].any()
    known = trial.valid["r"]
    assert known.sum() > 300
    np.testing.assert_allclose(np.degrees(trial.signals["r"][known]), turning(T[known]) + 2)
    assert any("two against one: +4 deg/s apart" in remark for remark in trial.remarks)


def test_headings_on_either_side_of_north_have_their_mean_between_them():
    trial = aligned(
        channel("one", T, np.mod(359 + turning(T), 360)),
        channel("two", T, np.mod(1 + turning(T), 360)),
        both("psi", "deg"),
    )
    apart = np.degrees(trial.signals["psi"]) - turning(T)
    np.testing.assert_allclose(np.mod(apart + 180, 360) - 180, 0.0, atol=1e-9)


def test_rudders_counted_to_two_sides_have_no_mean():
    one, two = channel("one", T, turning), channel("two", T, lambda t: -turning(t))
    with pytest.raises(AlignmentError, match=r"'one' and 'two' move against one another .*-1\.00"):
        aligned(one, two, both("delta", "deg", "starboard"))
    aligned(one, channel("two", T, lambda t: 0.9 * turning(t)), both("delta", "deg", "starboard"))


def test_two_antennas_are_not_one():
    with pytest.raises(AlignmentError, match="two antennas stand in two places"):
        aligned(channel("one", T, turning), channel("two", T, turning), both("x", "m"))


PIPELINE = """
[model]
states = []
effects = []
[identify]
free = ["r_bias"]
outputs = ["r"]
[[trial]]
name = "z"
logs = ["log.csv"]
[trial.signals]
r = { SIGNAL }
"""


def pipeline(folder: Path, signal: str):
    rows = "\n".join(f"{t:g},{turning(t):.6f},{turning(t) + 1:.6f}" for t in T)
    (folder / "log.csv").write_text(f"t [s],fore [deg/s],aft [deg/s]\n{rows}\n")
    (folder / "p.toml").write_text(PIPELINE.replace("SIGNAL", signal))
    return load(folder / "p.toml")


def test_a_pipeline_names_the_channels(tmp_path):
    read = pipeline(tmp_path, 'channels = ["fore", "aft"], combine = "mean"')
    trial = align_trial(read, read.trials[0])
    np.testing.assert_allclose(np.degrees(trial.signals["r"]), turning(T) + 0.5, atol=1e-5)
    assert [row.channel for row in signals_of(read)] == ["fore", "aft"]


@pytest.mark.parametrize(
    ("signal", "key", "words"),
    [
        ("", "channel", "missing; the pipeline needs it"),
        ('channels = ["fore"], combine = "mean"', "channels", "two or more, each once"),
        ('channels = ["fore", "fore"], combine = "mean"', "channels", "two or more, each once"),
        ('channels = ["fore", "aft"]', "combine", 'missing; write combine = "mean"'),
        ('channel = "fore", combine = "mean"', "combine", "one channel has nothing"),
        ('channel = "fore", channels = ["fore", "aft"]', "channels", "one of the two"),
        ('channels = ["fore", "aft"], combine = "men"', "combine", "did you mean 'mean'?"),
    ],
)
def test_what_does_not_go_together_is_said(tmp_path, signal, key, words):
    with pytest.raises(PipelineError) as caught:
        pipeline(tmp_path, signal)
    assert f"trial[0].signals.r.{key}: " in str(caught.value)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_channel_of_two_is_named(tmp_path):
    read = pipeline(tmp_path, f'channels = {json.dumps(["fore", "after"])}, combine = "mean"')
    with pytest.raises(Exception, match=r"signal 'r' \(after\): no channel 'after'.*'aft'"):
        align_trial(read, read.trials[0])
