"""The clock of one log against another's: declared, by events, by a shared motion; refusals."""

from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from made_recordings import EPOCH, channel, recording

from trialid.alignment import LogClock, SignalSource, align
from trialid.errors import AlignmentError

T = np.arange(0.0, 900.0, 0.1)
SOURCES = [SignalSource("r", "gyro", "rad/s"), SignalSource("X_ext", "rate", "N")]


def motion(t, seed=5):
    """A ship that turns and rolls by no period: a few waves and a walk of the helm."""
    rng = np.random.default_rng(seed)
    orders = np.repeat(rng.uniform(-1, 1, 40), 30)
    helm = np.interp(t, np.arange(1200) - 100.0, np.convolve(orders, np.ones(9) / 9, "same"))
    return helm + 0.2 * np.sin(0.61 * t) + 0.1 * np.sin(0.83 * t + 1)


def heading(t):
    fine = np.arange(-50.0, 1000.0, 0.02)
    return np.interp(t, fine + 0.01, np.cumsum(motion(fine)) * 0.02)


def two_logs(ahead=0.0, drift=0.0, noise=0.02, seed=0, there=motion, epoch=EPOCH, gain=1.0):
    """The trial's log with `gyro`, and another on its own clock with `rate`, of the same motion."""
    rng = np.random.default_rng(seed)
    own = T[200:8500]
    ours = channel("gyro", T, motion(T) + noise * rng.standard_normal(len(T)))
    values = gain * (there(own) + noise * rng.standard_normal(len(own)))
    theirs = channel("rate", own * (1 + drift) + ahead, values, epoch=epoch)
    return [recording(ours, path="bridge.csv"), recording(theirs, path="box.csv")]


def aligned(logs, clock, **more):
    return align("t", "fit", logs, SOURCES, 0.5, log_clocks=[None, clock], **more)


def apart(trial, gain=1.0):
    """Root mean square difference of the two signals, as a share of the motion."""
    both = trial.valid["r"] & trial.valid["X_ext"]
    return np.std((trial.signals["X_ext"] / gain - trial.signals["r"])[both]) / np.std(
        trial.signals["r"]
    )


def remark(trial):
    (word,) = [w for w in trial.remarks if w.startswith("box.csv: its clock")]
    print(word)
    return word


def refused(logs, clock, **more):
    with pytest.raises(AlignmentError) as caught:
        aligned(logs, clock, **more)
    message = str(caught.value)
    print(message)
    assert "\n" not in message
    return message


def test_a_declared_offset_and_drift():
    trial = aligned(two_logs(1.25, 4e-4), LogClock(offset=1.25 + 4e-4 * T[200], drift=400.0))
    assert apart(trial) < 0.03
    assert "declared 1.258 s ahead of the trial's, 400 ppm fast" in remark(trial)
    assert apart(aligned(two_logs(1.25), None)) > 0.1


def test_without_clocks_nothing_moves():
    logs = two_logs()
    plain = align("t", "fit", logs, SOURCES, 0.5)
    same = aligned(logs, None)
    np.testing.assert_array_equal(plain.signals["X_ext"], same.signals["X_ext"])
    assert plain.remarks == same.remarks


def test_events_in_seconds_and_as_dates_are_the_same():
    logs = two_logs(3.4, 2e-4)
    instants = (50.0, 420.0, 800.0)
    seconds = tuple((t * (1 + 2e-4) + 3.4 - (20.0 * (1 + 2e-4) + 3.4), t) for t in instants)
    start = datetime.fromtimestamp(EPOCH, UTC)
    naive = start.replace(tzinfo=None)
    dates = tuple(
        (start + timedelta(seconds=t * (1 + 2e-4) + 3.4), naive + timedelta(seconds=t))
        for t in instants
    )
    trials = [aligned(logs, LogClock(events=events)) for events in (seconds, dates)]
    np.testing.assert_allclose(trials[0].signals["X_ext"], trials[1].signals["X_ext"], atol=1e-4)
    assert apart(trials[0]) < 0.03
    assert "runs 200 ppm fast by 3 events" in remark(trials[0])


def test_one_event_gives_the_offset_alone():
    trial = aligned(two_logs(2.0), LogClock(events=((100.0, 120.0),)))
    assert apart(trial) < 0.03
    assert "2.0000 s ahead of the trial's by one event" in remark(trial)


def test_events_of_no_clock():
    assert "runs 3e+04 ppm" in remark(aligned(two_logs(), LogClock(events=((0, 0), (100, 97)))))
    clock = LogClock(events=((0.0, 0.0), (100.0, 90.0)))
    assert "gains 10.00% on the trial's, which no clock does" in refused(two_logs(), clock)
    assert "all at one instant" in refused(two_logs(), LogClock(events=((10, 0), (10, 1))))


@pytest.mark.parametrize(
    ("there", "gain"), [(motion, 1.0), (motion, -57.3), (heading, 1.0), (heading, -1.0)]
)
def test_a_match_of_the_same_motion_or_its_rate(there, gain):
    match = LogClock(match=("rate", "gyro"), within=20.0)
    word = remark(aligned(two_logs(-4.321, there=there, gain=gain), match))
    found, reach = (
        float(word.split("clock is ")[1].split()[0]),
        float(word.split("+- ")[1].split()[0]),
    )
    assert abs(found + 4.321) < 1.5 * reach
    assert reach < 0.1
    assert ("of opposite sign" in word) == (gain < 0)
    assert ("gyro" in word and "the rate of rate" in word) == (there is heading)


def test_a_match_puts_the_logs_on_one_clock_and_finds_the_drift():
    trial = aligned(two_logs(5.0, 5e-4), LogClock(match=("rate", "gyro")))
    assert apart(trial) < 0.03
    drift = float(remark(trial).split("it runs ")[1].split()[0])
    assert drift == pytest.approx(500, abs=60)


@pytest.mark.study(turn=8)
def test_the_interval_of_a_match_holds_the_truth_as_often_as_it_says():
    from trialid.alignment.clock_match import Signal, match_clocks

    held = []
    for seed in range(200):
        ours, theirs = (
            next(iter(log.channels.values())) for log in two_logs(1.7, noise=0.15, seed=seed)
        )
        found = match_clocks(
            Signal("a", theirs.t, theirs.y), Signal("b", ours.t, ours.y), 0, 20.0, "here"
        )
        held.append(abs(found.offset - 1.7) < found.reach)
    print(np.mean(held))
    assert 0.90 <= np.mean(held) <= 0.99


@pytest.mark.parametrize(
    ("size", "scales"), [(18.0, "GPS time and UTC"), (-18.2, "GPS time and UTC"), (37.0, "TAI")]
)
def test_leap_seconds_are_said(size, scales):
    word = remark(aligned(two_logs(size), LogClock(match=("rate", "gyro"))))
    assert f"the leap seconds between {scales}" in word
    assert "leap" not in remark(aligned(two_logs(16.5), LogClock(match=("rate", "gyro"))))


def test_a_box_that_counts_from_its_own_start():
    """Its first stamp is 20 s after the other's; within says how far starts may be apart."""
    logs = two_logs(epoch=0)
    message = refused(logs, None)
    assert "box.csv counts X_ext from its own start, bridge.csv r from 1970; say how" in message
    line = 'logs = [{ path = "box.csv", clock = { match = ["channel here", "channel there"] } }]'
    assert line in message
    trial = aligned(logs, LogClock(match=("rate", "gyro"), within=40.0))
    assert apart(trial) < 0.03
    assert "the other counts from 1970; its 0 is 2023-11-14T22:13:20" in remark(trial)


def noise(t):
    return np.random.default_rng(99).standard_normal(len(t))


@pytest.mark.parametrize(
    ("there", "reason"),
    [
        (noise, "the best correlation within 60 s is 0."),
        (lambda t: motion(t, 77), "they agree as well"),
        (lambda t: 0.0 * t, "the best correlation within 60 s is 0.00"),
    ],
)
def test_no_offset_is_made_up_where_two_channels_have_little_in_common(there, reason):
    message = refused(two_logs(there=there, noise=0.0), LogClock(match=("rate", "gyro")))
    assert "cannot tell the offset" in message
    assert reason in message


@pytest.mark.parametrize("shape", [lambda t: np.sin(2 * np.pi * t / 12), lambda t: t])
def test_what_agrees_as_well_elsewhere_is_refused(shape):
    logs = [
        recording(channel("gyro", T, shape(T) + 0.01 * noise(T)), path="bridge.csv"),
        recording(channel("rate", T[200:8000] + 2, shape(T[200:8000])), path="box.csv"),
    ]
    assert "they agree as well" in refused(logs, LogClock(match=("rate", "gyro")))


def test_a_match_beyond_within_is_refused():
    message = refused(two_logs(80.0), LogClock(match=("rate", "gyro")))
    assert "they agree better 80 s apart, and within = 60 s" in message


def test_too_short_a_match():
    logs = two_logs()
    short = recording(channel("rate", T[:150], motion(T[:150])), path="box.csv")
    assert "too short for their rate" in refused([logs[0], short], LogClock(match=("rate", "gyro")))
    few = recording(channel("rate", T[:50], motion(T[:50])), path="box.csv")
    assert "50 values, at least 100" in refused([logs[0], few], LogClock(match=("rate", "gyro")))


def test_every_log_with_a_clock_of_its_own():
    clocks = [LogClock(match=("gyro", "rate")), LogClock(match=("rate", "gyro"))]
    with pytest.raises(AlignmentError, match="no other log to compare it with"):
        align("t", "fit", two_logs(), SOURCES, 0.5, log_clocks=clocks)


def test_files_of_one_log_share_its_clock():
    whole, box = two_logs(2.0)
    one = box.channels["rate"]
    halves = [
        recording(type(one)("rate", one.t[part], one.y[part], clock=one.clock), path=f"box{i}.csv")
        for i, part in enumerate((slice(0, 4000), slice(4000, None)))
    ]
    clock = LogClock(match=("rate", "gyro"))
    trial = align("t", "fit", [whole, *halves], SOURCES, 0.5, log_clocks=[None, clock, clock])
    single = aligned([whole, box], clock)
    np.testing.assert_array_equal(trial.signals["X_ext"], single.signals["X_ext"])


# --- files of one recorder ----------------------------------------------------------------------


def split(overlap, shift=0.0, adapter="csv"):
    """A log cut in two whose files both hold some samples."""
    early = recording(channel("gyro", T[:4000], motion(T[:4000])), path="1.csv")
    late = recording(
        channel("gyro", T[4000 - overlap :] + shift, motion(T[4000 - overlap :])), path="2.csv"
    )
    return [early, type(late)(late.path, adapter, late.sha256, late.channels)]


def test_a_few_samples_both_files_hold_at_the_seam_are_joined():
    source = [SignalSource("r", "gyro", "rad/s")]
    whole = align("t", "fit", [recording(channel("gyro", T, motion(T)))], source, 0.5)
    trial = align("t", "fit", split(6)[::-1], source, 0.5)
    assert (
        "gyro: 1.csv and 2.csv overlap by 6 samples at the seam; joined, the first file's stay"
        in (trial.remarks)
    )
    np.testing.assert_allclose(trial.signals["r"], whole.signals["r"], atol=1e-12)
    assert trial.valid["r"][100:-100].all()  # filtered across the seam


def test_the_tail_of_one_file_is_filtered_with_the_head_of_the_next():
    source = [SignalSource("r", "gyro", "rad/s")]
    whole = align("t", "fit", [recording(channel("gyro", T, motion(T)))], source, 0.5)
    trial = align("t", "fit", split(0), source, 0.5)
    np.testing.assert_array_equal(trial.signals["r"], whole.signals["r"])
    assert not any("seam" in remark for remark in trial.remarks)


@pytest.mark.parametrize("logs", [split(300), split(6, adapter="mcap")])
def test_a_real_overlap_is_refused_as_ever(logs):
    with pytest.raises(AlignmentError, match=r"is in 1\.csv or 2\.csv for the same time"):
        align("t", "fit", logs, [SignalSource("r", "gyro", "rad/s")], 0.5)


# --- from the pipeline file ----------------------------------------------------------------------

PIPELINE = """
[[trial]]
name = "t"
logs = ["bridge.csv", { path = "box.csv", clock = CLOCK }]
[trial.signals]
r_ref = { channel = "rate", unit = "rad/s" }
r = { channel = "gyro", unit = "rad/s" }
[align]
period = 0.5
clocks = "REPAIR"
[model]
states = []
effects = ["reference_rate"]
[identify]
free = ["k_ref"]
outputs = ["r"]
[diagnose]
candidates = "none"
"""


def run(folder, clock, repair="repair", logs=None):
    from trialid.pipeline_file import load
    from trialid.workflow.run import run as run_pipeline

    for log in logs or two_logs(1.5, 3e-4):
        ((name, one),) = log.channels.items()
        table = np.column_stack([(one.t - EPOCH * 10**9) / 1e9, one.y])
        np.savetxt(folder / log.path.name, table, "%.6f", ",", header=f"t,{name}", comments="")
    path = folder / "p.toml"
    path.write_text(PIPELINE.replace("CLOCK", clock).replace("REPAIR", repair), encoding="utf-8")
    return run_pipeline(load(path)).result


@pytest.mark.parametrize(
    "clock",
    [
        "{ offset = 1.506, drift = 300.0 }",
        "{ events = [[30.009, 50.0], [780.234, 800.0]] }",
        '{ match = ["rate", "gyro"], within = 30 }',
        '{ events = [[1970-01-01T00:00:51.515, "1970-01-01T00:00:50Z"], '
        "[1970-01-01T00:13:21.74, 1970-01-01T00:13:20]] }",
    ],
)
def test_every_way_in_a_pipeline(tmp_path, clock):
    result = run(tmp_path, clock)
    print(result.trials[0])
    assert result.fit.eps_rmsn < 0.05
    assert any("box.csv: its clock is" in r for r in result.trials[0].remarks)


def test_the_repair_is_switched_off_in_a_pipeline(tmp_path):
    logs = two_logs()
    ((_, one),) = logs[0].channels.items()
    rng = np.random.default_rng(3)
    shaken = one.t + np.rint(3e7 * rng.standard_normal(len(one.t))).astype(np.int64)
    logs[0] = recording(type(one)("gyro", np.sort(shaken), one.y), path="bridge.csv")
    for repair in ("repair", "as logged"):
        remarks = run(tmp_path, "{ offset = 0.0 }", repair, logs).trials[0].remarks
        assert any("stamps repaired" in remark for remark in remarks) == (repair == "repair")


@pytest.mark.parametrize(
    ("clock", "words"),
    [
        ("{ }", "clock: write one of offset, events, match; found none"),
        ('{ offset = 1.0, match = ["rate", "gyro"] }', "match; found offset and match"),
        ("{ events = [[1.0, 2.0]], drift = 3.0 }", "drift goes with offset, and events is given"),
        ("{ offset = 1.0, within = 3.0 }", "within goes with match, and offset is given; leave"),
        ("{ events = [] }", "events is empty; write at least one"),
        ("{ ofset = 1.0 }", "clock.ofset: unknown key; did you mean 'offset'?"),
        ('{ match = ["rate"] }', "clock.match[1]: missing"),
        ('{ match = ["rate", "gyr"] }', "no channel 'gyr' in bridge.csv; did you mean 'gyro'?"),
        ('{ match = ["rat", "gyro"] }', "no channel 'rat' in box.csv; did you mean 'rate'?"),
    ],
)
def test_what_is_wrong_with_a_clock_is_one_line(tmp_path, clock, words):
    from trialid.errors import TrialidError

    with pytest.raises(TrialidError) as caught:
        run(tmp_path, clock)
    print(caught.value)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
