"""Wrong units, names, signs and late sensors: found with evidence, and never where all is well."""

import numpy as np
import pytest
from aligned_records import aligned, healthy, with_values
from made_recordings import channel, recording
from made_trials import record
from real_channels import BUSES, DATA, DECAY, HSVA, bus_series, decay_series, hsva_series, series

from trialid.alignment import SignalSource, align
from trialid.alignment.agreement import checks, duplicate_channels
from trialid.errors import AlignmentError

DEG = np.rad2deg(1.0)
FACTORS = {"deg/s read as rad/s": DEG, "rad/s as deg/s": 1 / DEG, "deg/min as deg/s": 60.0}
real = [
    pytest.mark.real_data,
    pytest.mark.skipif(not DATA.is_dir(), reason="real records are not here"),
]


def errors(found):
    return [one.kind for one in found if one.severity == "error"]


def kinds(found):
    return {one.kind for one in found}


@pytest.fixture(scope="module")
def zigzag():
    """A zig-zag in a calm sea with good sensors."""
    return healthy(155)


def false_alarms(seeds):
    """Errors in healthy records; remarks of scale and lag where no sensor smooths."""
    wrong, remarked = [], []
    for seed in seeds:
        made = record(seed)
        found = checks.of_series(healthy(seed))
        aligned(healthy(seed))
        wrong += [(made.story, one.sentence) for one in found if one.severity == "error"]
        if made.story.endswith("by 0.0 s"):
            told = [one for one in found if one.kind in {"scale", "lag", "unrelated", "still"}]
            remarked += [(made.story, one.sentence) for one in told]
    print(f"{len(seeds)} healthy records: {len(wrong)} errors, {remarked}")
    return wrong, remarked


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("first", range(0, 420, 84))
def test_no_healthy_record_is_refused(first):
    assert false_alarms(range(first, first + 84)) == ([], [])


def shares(seeds, quantity, spoil, kind):
    """Share of spoilt records that are refused, and of those with the right reason."""
    found = []
    for signals in map(healthy, seeds):
        if quantity in signals:
            told = checks.of_series(with_values(signals, quantity, spoil(signals[quantity].y)))
            found.append(errors(told))
    refused = [one for one in found if one]
    right = [one for one in refused if kind in one]
    print(f"{quantity} {kind}: {len(refused)} of {len(found)} refused, {len(right)} rightly")
    return len(refused) / len(found), len(right) / len(refused)


@pytest.mark.parametrize("fault", FACTORS)
@pytest.mark.study(turn="each")
def test_a_rate_of_turn_in_another_unit(fault):
    """What is left are ships on a straight course with a coarse compass, and slow sensors."""
    refused, right = shares(range(28), "r", lambda y: y * FACTORS[fault], "unit")
    assert refused > 0.75
    assert right > 0.8


@pytest.mark.study(turn="each")
def test_a_rate_of_turn_positive_to_port():
    refused, right = shares(range(28), "r", lambda y: -y, "sign")
    assert refused > 0.75
    assert right == 1.0


@pytest.mark.parametrize(("spoil", "kind"), [(lambda y: -y, "sign"), (lambda y: DEG * y, "unit")],
                         ids=["sign", "unit"])  # fmt: skip
@pytest.mark.study(turn="each")
def test_a_roll_rate_in_another_unit_or_to_port(spoil, kind):
    refused, right = shares(range(28), "p", spoil, kind)
    assert refused > 0.75
    assert right > 0.8


def test_the_error_states_evidence_and_the_line_that_mends_it(zigzag):
    spoilt = with_values(zigzag, "r", DEG * zigzag["r"].y)
    with pytest.raises(AlignmentError) as caught:
        aligned(spoilt, {"r": "rad/s"})
    message = str(caught.value)
    assert message.startswith("trial 't': r is 57")
    assert 'a unit is wrong; write unit = "deg/s" for r or gain = 57.2958 for psi' in message
    assert "\n" not in message
    mended = {**spoilt, "r": zigzag["r"]}
    aligned(mended, {"r": "rad/s"})


def test_a_unit_that_the_log_states_is_mended_by_a_gain(zigzag):
    (found,) = [
        one for one in checks.of_series(with_values(zigzag, "r", DEG * zigzag["r"].y))
        if one.severity == "error"
    ]  # fmt: skip
    assert found.kind == "unit"
    assert found.mend == "gain = 0.0174533"
    assert found.about == ("r", "psi")
    low, high = found.evidence["gain_low"], found.evidence["gain_high"]
    assert low < DEG < high or low == pytest.approx(DEG, rel=0.05)


@pytest.mark.parametrize("delay", [1.0, 3.0, 8.8])
def test_a_late_rate_of_turn_is_remarked_with_its_seconds(zigzag, delay):
    one = zigzag["r"]
    late = {**zigzag, "r": series("r", one.t + round(delay * 1e9), one.y)}
    (found,) = [f for f in checks.of_series(late) if f.kind == "lag"]
    assert found.severity == "remark"
    assert found.evidence["lag"] == pytest.approx(delay, abs=0.3)
    assert found.evidence["lag_low"] < delay < found.evidence["lag_high"]
    assert found.mend is not None
    assert found.mend.startswith("delay = ")
    assert any("later than the slope of psi" in words for words in aligned(late).remarks)


@pytest.mark.study(turn=4)
def test_a_smoothed_rate_of_turn_is_never_an_error():
    """Two poles of 5 s take 90 % off the waves of a small boat; a unit would be no excuse."""
    from scipy.signal import lfilter

    for seed in range(28):
        signals = healthy(seed)
        one = signals["r"]
        pole = np.exp(-one.period / 5.0)
        slow = lfilter([(1 - pole) ** 2], [1, -2 * pole, pole**2], one.y)
        assert not errors(checks.of_series(with_values(signals, "r", slow)))


def test_another_motion_in_place_of_the_rate_of_turn_is_remarked(zigzag):
    t = zigzag["r"].t
    slow = np.convolve(np.random.default_rng(1).normal(size=len(t)), np.hanning(400), "same")
    other = 1e-3 * slow
    found = checks.of_series({**zigzag, "r": series("r", t, other)})
    assert "unrelated" in kinds(found)
    assert not errors(found)


def test_which_way_she_heels_is_told_and_never_refused(zigzag):
    outward = [f for f in checks.of_series(zigzag) if f.kind == "heel"]
    assert "heels outward in turns" in outward[0].sentence
    planing = checks.of_series(with_values(zigzag, "phi", -zigzag["phi"].y))
    inward = [f for f in planing if f.kind == "heel"]
    assert "heels inward in turns" in inward[0].sentence
    assert inward[0].severity == "remark"


def test_a_ship_at_the_quay_is_told(zigzag):
    u = zigzag["u"]
    quay = 0.04 + 0.01 * np.random.default_rng(2).normal(size=len(u.y))
    found = checks.of_series(with_values(zigzag, "u", quay))
    assert "still" in kinds(found)
    assert not errors(found)
    assert "still" not in kinds(checks.of_series(zigzag))


def test_the_side_of_a_rudder_is_proposed_to_who_has_not_stated_it(zigzag):
    (found,) = [f for f in checks.of_series(zigzag) if f.kind == "side"]
    assert found.mend == 'positive = "starboard"'
    other = with_values(zigzag, "delta", -zigzag["delta"].y)
    (found,) = [f for f in checks.of_series(other) if f.kind == "side"]
    assert found.mend == 'positive = "port"'


def test_nothing_is_said_of_what_does_not_overlap_or_is_too_short(zigzag):
    later = series("psi", zigzag["psi"].t + 10**13, zigzag["psi"].y)
    assert checks.of_series({**zigzag, "psi": later}) == ()
    few = {q: series(q, one.t[:3], one.y[:3]) for q, one in zigzag.items()}
    assert checks.of_series(few) == ()
    assert checks.of_series({}) == ()


def test_two_channels_of_one_quantity(zigzag):
    one = zigzag["r"]
    rng = np.random.default_rng(3)
    same = series("r", one.t, one.y + 0.1 * np.std(one.y) * rng.normal(size=len(one.y)))
    assert duplicate_channels.disagreements({"r/1": one, "r/2": same, "psi/1": zigzag["psi"]}) == ()
    late = series("r", one.t + 2 * 10**9, 0.6 * one.y + np.std(one.y))
    (found,) = duplicate_channels.disagreements({"r/1": one, "r/2": late})
    assert found.about == ("r/1", "r/2")
    assert found.severity == "remark"
    assert found.evidence["lag"] == pytest.approx(2.0, abs=0.2)
    assert found.evidence["gain_low"] < 0.61
    assert found.evidence["gain_high"] > 0.59
    assert found.evidence["offset"] == pytest.approx(np.std(one.y) - 0.4 * np.mean(one.y), rel=0.1)
    assert "deg/s apart" in found.sentence


def test_the_channel_that_was_not_chosen_is_compared():
    rng = np.random.default_rng(4)
    t = np.arange(0, 300, 0.1)
    y = 2.0 * np.sin(0.05 * t) + 0.01 * rng.normal(size=len(t))
    log = recording(
        _of_format("rate/27", t, y), _of_format("rate/52", t + 8.8, y), _of_format("rate/9", t, y)
    )
    trial = align("t", "fit", [log], [SignalSource("r", "rate/52")], 0.5)
    told = [one for one in trial.remarks if "against" in one]
    assert len(told) == 2
    assert all("8.8 s" in one for one in told)


def _of_format(name, t, y):
    from dataclasses import replace

    return replace(channel(name, t, y, "deg/s"), quantity="r")


def test_channels_without_a_known_quantity_or_unit_are_not_compared():
    t = np.arange(0, 300, 0.1)
    bare = channel("x", t, np.sin(t))
    assert duplicate_channels.series_of(bare) is None
    assert duplicate_channels.series_of(_of_format("r", t, np.sin(t))) is not None


class TestReal:
    pytestmark = real

    @pytest.mark.parametrize("path", HSVA, ids=lambda path: path.stem)
    def test_zigzags_rightly_read(self, path):
        found = checks.of_series(hsva_series(path))
        small = path.stem.endswith("05_01")  # she turns by 5 degrees only
        assert kinds(found) == ({"side"} if small else {"heel", "side"})
        assert small or "outward" in found[0].sentence

    @pytest.mark.parametrize("path", HSVA, ids=lambda path: path.stem)
    def test_zigzags_as_their_catalogue_labels_them(self, path):
        """Columns 7 and 8 exchanged: the roll angle [deg] in the place of the rate of turn."""
        c = hsva_series(path)
        swapped = {
            **c, "r": series("r", c["phi"].t, c["phi"].y), "phi": series("phi", c["r"].t, c["r"].y)
        }  # fmt: skip
        (found,) = [one for one in checks.of_series(swapped) if one.severity == "error"]
        assert found.kind == "scale"
        assert found.mend is None
        assert found.evidence["gain_high"] < 1 / 3
        assert "phi goes with that slope (1.000): are they exchanged?" in found.sentence
        with pytest.raises(AlignmentError, match="which no unit explains"):
            aligned(swapped)

    def test_a_roll_decay(self):
        assert not errors(checks.of_series(decay_series(DECAY)))

    @pytest.mark.parametrize("path", BUSES, ids=lambda path: path.stem)
    def test_no_bus_is_refused_whatever_its_sources(self, path):
        channels = bus_series(path)
        for source in {source for _, source in channels}:
            mine = {q: one for (q, s), one in channels.items() if s == source}
            rest = {q: one for (q, _), one in channels.items()}
            assert not errors(checks.of_series(rest | mine))

    def test_the_two_compasses_of_one_boat(self):
        found = duplicate_channels.disagreements(_named(bus_series(_bus("furuno-130842.raw"))))
        roll, turn = found
        assert roll.about == ("phi/27", "phi/52")
        assert np.rad2deg(roll.evidence["offset"]) == pytest.approx(7.4, abs=0.1)
        assert turn.evidence["lag"] == pytest.approx(8.8, abs=0.1)
        assert turn.evidence["correlation"] > 0.99
        assert "8.8 s later" in turn.sentence

    def test_two_rates_of_turn_of_a_yacht_and_her_rudder_to_port(self):
        channels = bus_series(_bus("00090013.candump.log"))
        found = {one.about: one for one in duplicate_channels.disagreements(_named(channels))}
        assert set(found) == {("phi/11", "phi/128"), ("r/11", "r/128")}
        assert found["r/11", "r/128"].evidence["gain_high"] < 0.9  # the damped one
        mine = {"r": channels["r", 128], "delta": channels["delta", 5]}
        (side,) = [one for one in checks.of_series(mine) if one.kind == "side"]
        assert side.mend == 'positive = "port"'


def _bus(name):
    return next(path for path in BUSES if path.name == name)


def _named(channels):
    return {f"{quantity}/{source}": one for (quantity, source), one in channels.items()}


def test_a_log_cut_short_leaves_one_channel_with_hardly_a_sample():
    t = np.arange(0, 40, 0.1)
    long = series("r", t, 0.01 * np.sin(0.3 * t))
    assert duplicate_channels.disagreements({"a": long, "b": series("r", t[:1], np.zeros(1))}) == ()
