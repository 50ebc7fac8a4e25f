"""What is hidden is found where it is, and noise alone gives no finding."""

import re
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, waves, white, with_noise, zigzag

from trialid.diagnosis.where.bins import members, nice_edges
from trialid.diagnosis.where.doing import ship_activity
from trialid.diagnosis.where.leftover import leftover
from trialid.diagnosis.where.misfit import where
from trialid.diagnosis.where.slice_test import colour, gram, squares
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

FREE = ("Nv", "Nr", "Ndelta", "Yv", "Kv", "Kr", "Kdelta", "Kp", "GM", "Nrar")
FIT = replace(SETTINGS, free=FREE, nuisance=("initial_state", "bias"))
AMPLITUDES = (5, 10, 20)
CLEAN = [zigzag(a) for a in AMPLITUDES]


def record(seed, kind, clean=CLEAN):
    rng = np.random.default_rng(seed)
    return [with_noise(t, *kind(rng, t.samples)) for t in clean]


def made_by(hidden, value):
    """Zig-zags of a ship with an effect the model lacks."""
    effect = CATALOGUE[hidden]
    name = next(iter(effect.parameters))
    truth = (MODEL + effect).with_values({name: value})
    return [zigzag(a, truth) for a in AMPLITUDES]


def found(trials, model=MODEL, settings=FIT):
    return where(identify(trials, model, settings))


def only(findings, output, kind):
    (finding,) = [f for f in findings if (f.output, f.kind) == (output, kind)]
    return finding


# --- chance -------------------------------------------------------------------------------------


@pytest.mark.parametrize("kind", [white, waves])
@pytest.mark.study(turn="each")
def test_noise_alone_gives_no_finding(kind):
    counts = [bool(found(record(seed, kind)).findings) for seed in range(6)]
    assert sum(counts) <= 1


def red(rng, n):
    """Noise with a memory of 10 s."""
    from scipy.signal import lfilter

    pole = np.exp(-0.05)
    parts = lfilter([np.sqrt(1 - pole**2)], [1.0, -pole], rng.standard_normal((2, n + 500)))
    return tuple(np.deg2rad(s) * e for s, e in zip((0.05, 0.1), parts[:, 500:], strict=True))


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("kind", [white, waves, red])
def test_findings_in_noise_alone_are_counted(kind):
    """Any finding in at most 5 of 60 records at a nominal 5 %."""
    alarms = [found(record(seed, kind)).findings for seed in range(1000, 1060)]
    print(kind.__name__, [[f.kind for f in each] for each in alarms if each])
    assert sum(map(bool, alarms)) <= 5


def test_gram_is_the_quadratic_form_of_a_toeplitz_matrix():
    rng = np.random.default_rng(0)
    S, kernel = rng.standard_normal((60, 3)), 0.7 ** np.arange(20)
    lag = np.abs(np.arange(40)[:, None] - np.arange(40))
    C = np.where(lag < 20, kernel[np.minimum(lag, 19)], 0.0)
    expected = S[:40].T @ C @ S[:40] + S[40:].T @ C[:20, :20] @ S[40:]
    assert gram(S, kernel, (slice(0, 40), slice(40, 60))) == pytest.approx(expected)


def test_intervals_of_mean_squares_hold_the_truth_in_19_of_20_slices():
    """Wave noise has the same power everywhere."""
    held = []
    for seed in range(6):
        left = leftover(identify(record(seed, waves), MODEL, FIT))
        t = np.concatenate([np.arange(s.stop - s.start) for s in left.spans])
        inside = members(t.astype(float), np.linspace(0.0, 1200.0, 11))
        parts = squares(left, colour(left), 0, inside)
        held += list((parts.low < 1.0) & (parts.high > 1.0))
    assert np.mean(held) > 0.85


# --- what is hidden -----------------------------------------------------------------------------


@pytest.mark.parametrize("kind", [white, waves])
def test_missing_yaw_drag_shows_in_the_rate_of_turn(kind):
    settings = replace(FIT, free=tuple(n for n in FREE if n != "Nrar"))
    seen = found(record(1, kind), MODEL - "yaw_drag_rar", settings)
    finding = only(seen.findings, "r", "turn-rate amplitude")
    mean = np.array(finding.picture.mean)
    assert mean[-1] < 0.0  # more drag in fast turns: the ship turns less than predicted
    assert "too much between 0.6 and 0.8 deg/s" in finding.sentence
    assert only(seen.findings, "r", "frequency")


@pytest.mark.parametrize("kind", [white, waves])
def test_missing_roll_damping_shows_in_the_amplitude_of_roll(kind):
    seen = found(record(2, kind, made_by("quadratic_roll_damping", -2e-4)))
    finding = only(seen.findings, "phi", "roll amplitude")
    assert finding.p_value < 0.05
    assert {f.output for f in seen.findings} == {"phi"}


def test_missing_righting_arm_is_too_little_here_and_too_much_there():
    seen = found(record(3, waves, made_by("righting_arm_cubic", 8.0)))
    finding = only(seen.findings, "phi", "roll amplitude")
    assert "too much between 4 and 10 deg" in finding.sentence


@pytest.mark.parametrize("kind", [white, waves])
def test_a_rudder_offset_that_is_not_free_shows_by_side(kind):
    settings = replace(FIT, nuisance=("initial_state",))
    seen = found(record(4, kind, made_by("rudder_offset", np.deg2rad(1.0))), settings=settings)
    finding = only(seen.findings, "r", "side")
    port, starboard = finding.picture.mean
    assert port > 0.0
    assert starboard > 0.0
    assert "port and starboard differ" in finding.sentence
    assert finding.sentence.count("too far to port") == 2


@pytest.mark.parametrize("kind", [white, waves])
def test_a_delay_shows_by_frequency_and_is_coherent(kind):
    late = []
    for trial in CLEAN:
        r = np.concatenate([np.full(3, trial.signals["r"][0]), trial.signals["r"][:-3]])
        late.append(replace(trial, signals={**trial.signals, "r": r}))
    finding = only(found(record(5, kind, late)).findings, "r", "frequency")
    assert "coherent with the rudder" in finding.sentence
    picture = finding.picture
    assert max(picture.coherence) > picture.threshold


def circles(seed, wind):
    """Two turning circles with the heading recorded; wind of so many rad/s turns the bow off it."""
    rng = np.random.default_rng(seed)
    made = []
    for name, side in (("port", -1.0), ("starboard", 1.0)):
        n = 2400
        delta = side * np.deg2rad(np.repeat([10.0, 15.0, 10.0, 5.0], n // 4))
        valid = {s: np.ones(n, dtype=bool) for s in ("delta", "n", "r", "phi", "psi")}
        shaft = zigzag(10).signals["n"][0]
        blank = {"delta": delta, "n": np.full(n, shaft), "r": np.zeros(n), "phi": np.zeros(n)}
        simulator = prepare(MODEL, (), ("r", "phi"))
        trial = Trial(name, "fit", 0.5, {**blank, "psi": np.zeros(n)}, valid)
        y = respond(simulator, trial, {}, {"u": 7.33}, sensitivities=False).y
        psi = np.cumsum(y[:, 0]) * 0.5
        signals = {**blank, "r": y[:, 0] + wind * np.sin(psi), "phi": y[:, 1].copy()}
        signals["psi"] = np.mod(psi, 2.0 * np.pi)
        trial = Trial(name, "fit", 0.5, signals, valid)
        made.append(with_noise(trial, *waves(rng, n)))
    return made


def test_wind_shows_by_heading_sector():
    seen = found(circles(6, np.deg2rad(0.03)))
    finding = only(seen.findings, "r", "heading sector")
    mean = dict(zip(finding.picture.names, finding.picture.mean, strict=True))
    assert mean["east"] > 0.0 > mean["west"]
    assert "east 0.0" in finding.sentence  # or north-east: the wind turns her on both
    assert "too far to port" in finding.sentence
    assert not [f for f in found(circles(6, 0.0)).findings if f.kind == "heading sector"]


def test_a_disturbed_stretch_is_found_merged_and_named():
    """A gust of 150 s in one zig-zag: one stretch of about that length, in that trial."""
    trials = record(7, white)
    r = trials[1].signals["r"].copy()
    gust = slice(600, 900)
    r[gust] += 3.0 * np.deg2rad(0.05) * np.random.default_rng(8).standard_normal(300)
    trials[1] = replace(trials[1], signals={**trials[1].signals, "r": r})
    seen = found(trials)
    finding = only(seen.findings, "r", "stretch")
    assert finding.trial == "zigzag-10"
    assert finding.t_start == pytest.approx(300.0, abs=31.0)
    assert finding.t_end == pytest.approx(450.0, abs=31.0)
    assert finding.doing in finding.sentence
    assert finding.share > 0.3
    assert finding.excess > 3.0


def test_noise_at_one_rudder_angle_alone_is_not_said_to_grow_with_it():
    """Twice the noise in the 10-10 only: the bin about 10 deg, not all above it."""
    trials = record(13, white)
    louder = trials[1].signals["r"] + np.deg2rad(0.1) * np.random.default_rng(14).standard_normal(
        trials[1].samples
    )
    trials[1] = replace(trials[1], signals={**trials[1].signals, "r": louder})
    finding = only(found(trials).findings, "r", "rudder amplitude")
    assert "between 7.5 and 12.5 deg of rudder angle, " in finding.sentence
    assert "grows" not in finding.sentence
    assert finding.picture.standing == (False, True, False)


# --- words and bins -----------------------------------------------------------------------------


def test_what_cannot_be_examined_is_said():
    seen = found(record(9, white))
    assert "heading sector: no heading in the record" in seen.not_examined
    assert "speed: no speed in the record" in seen.not_examined
    assert sum(row.share for row in seen.by_output) == pytest.approx(1.0)
    noise = {r.output: r.sentence for r in found(record(9, waves)).rest}
    assert re.search(r"around 0\.(5[5-9]|6[0-5]?) rad/s", noise["r"])
    assert "looks like waves" in noise["r"]


def test_windows_scale_with_the_root_of_the_length():
    left = leftover(identify(record(10, white), MODEL, FIT))
    assert left.time_scale == pytest.approx(1.0)
    small = replace(left.fit.model.ship, particulars={**left.fit.model.ship.particulars, "L": 1.75})
    model = ShipModel(small, left.fit.model.states, left.fit.model.effects)
    assert replace(left, fit=replace(left.fit, model=model)).time_scale == pytest.approx(0.1)


def seen(**signals):
    """Signals of a ship of 175 m beside the residuals of a record."""
    parts = leftover(identify(record(11, white), MODEL, FIT)).parts
    rudder = signals["delta"]
    return SimpleNamespace(parts=parts, time_scale=1.0, rudder=lambda: rudder, signal=signals.get)


@pytest.mark.parametrize(("angle", "turn", "words"), [
    (np.where(np.arange(120) < 60, 0.17, -0.17), np.zeros(120), "rudder reversal to port"),
    (np.sign(np.sin(np.arange(120) / 10.0)) * 0.17, np.zeros(120), "rudder reversals"),
    (np.full(120, 0.17), np.full(120, 0.01), "steady turn to starboard"),
    (np.full(120, -0.17), -np.linspace(0.005, 0.01, 120), "turning to port"),
    (np.zeros(120), np.zeros(120), "straight course"),
    (None, np.where(np.arange(120) < 100, -0.002, -0.01), "slow turn to port"),
    (None, np.where(np.arange(120) < 118, 0.0, 0.01), "straight course"),
    (None, np.full(120, -2.5e-4), "straight course"),
    (None, np.full(120, -3.5e-4), "steady turn to port"),
])  # fmt: skip
def test_what_the_ship_was_doing(angle, turn, words):
    assert ship_activity(seen(delta=angle, r=turn), slice(0, 120)) == words


def test_rolling_while_the_rudder_rests_is_at_the_natural_frequency():
    roll = 0.1 * np.sin(2.0 * np.pi * 0.5 * np.arange(120) / 15.0)
    here = seen(delta=np.zeros(120), r=np.zeros(120), phi=roll)
    assert ship_activity(here, slice(0, 120)).startswith(
        "rolling at its natural frequency, period 15 s"
    )


def test_bins_hold_enough_samples_and_all_of_them():
    rng = np.random.default_rng(12)
    for x in (np.abs(rng.standard_normal(5000)), rng.uniform(5.0, 7.5, 500), np.ones(50)):
        edges = nice_edges(x)
        inside = members(x, edges)
        assert (inside.sum(axis=1) == 1).all()
        assert edges[0] <= x.min()
        assert edges[-1] >= x.max()
        assert inside.mean(axis=0).min() >= min(0.03, 1.0)


def test_an_error_on_one_side_is_said_of_that_side():
    """Three times the noise in the rate of turn wherever she turns to starboard."""
    trials = record(21, white)
    rng = np.random.default_rng(22)
    size = 0.15 * np.deg2rad(1.0)
    starboard = [size * rng.standard_normal(c.samples) * (c.signals["r"] > 0) for c in CLEAN]
    rough = [with_noise(t, more, 0.0) for t, more in zip(trials, starboard, strict=True)]
    finding = only(found(rough).findings, "r", "side")
    assert finding.sentence.startswith("yaw rate r: turning to starboard, ")
    assert finding.excess > 1.3


def test_an_offset_is_said_in_its_trial_and_to_its_side():
    """A roll sensor that reads half a degree too far to starboard in one of three trials."""
    trials = record(23, white)
    trials[1] = with_noise(trials[1], 0.0, np.deg2rad(0.5))
    seen = found(trials, settings=replace(FIT, nuisance=("initial_state",)))
    finding = only(seen.findings, "phi", "mean offset")
    assert finding.trial == "zigzag-10"
    assert "too far to port" in finding.sentence
    assert "0.5" in finding.sentence or "0.4" in finding.sentence
    assert not [f for f in found(record(24, waves)).findings if f.kind == "mean offset"]
