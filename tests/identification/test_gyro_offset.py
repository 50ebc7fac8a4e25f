"""What a gyro reads too much, told by the angle whose rate it measures."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, zigzag

from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.nuisance.gyro_offset import gyro_offset
from trialid.identification.nuisance.priors import GYRO, nuisance_prior
from trialid.identification.problem import Settings
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

COMPASS = 0.05
OFF = 0.002
NOISE = np.deg2rad(0.3)


def headed(trial: Trial, seed: int, off: float = OFF, scale: float = 1.0) -> Trial:
    """The trial with a gyro that is off, and the heading beside it by a compass with noise."""
    rng, r = np.random.default_rng([17, seed]), trial.signals["r"]
    turned = np.concatenate([[0.0], np.cumsum(0.5 * trial.period * (r[1:] + r[:-1]))])
    white = rng.standard_normal((2, len(r)))
    read = {"r": scale * r + off + 0.1 * NOISE * white[0], "psi": 2.0 + turned + NOISE * white[1]}
    valid = {**trial.valid, "psi": np.ones(len(r), dtype=bool)}
    return replace(trial, signals={**trial.signals, **read}, valid=valid)


def test_the_offset_is_the_truth_within_what_a_compass_may_deviate() -> None:
    for seed in range(8):
        trial = headed(zigzag(10), seed)
        found, deviation = gyro_offset(trial, "r", COMPASS) or (0.0, 0.0)
        assert found == pytest.approx(OFF, abs=deviation)
        assert deviation == pytest.approx(COMPASS / trial.duration, rel=0.5)
        assert nuisance_prior(MODEL, trial, "b_r", 0.0005) == (found, deviation)


def test_a_roll_rate_is_held_against_the_heel() -> None:
    trial = zigzag(20)
    p = np.gradient(trial.signals["phi"], trial.period) - OFF
    valid = {**trial.valid, "p": trial.valid["phi"]}
    rolled = replace(trial, signals={**trial.signals, "p": p}, valid=valid)
    found, deviation = gyro_offset(rolled, "p", 0.035) or (0.0, 0.0)
    assert found == pytest.approx(-OFF, abs=deviation)
    assert deviation < 0.1 * GYRO


def test_what_stands_in_a_gap_moves_nothing() -> None:
    trial = headed(zigzag(10), 3)
    whole = gyro_offset(trial, "r", COMPASS) or (0.0, 0.0)
    r, there = trial.signals["r"].copy(), trial.valid["r"].copy()
    r[200:300], there[200:300] = 1.0, False
    gap = replace(trial, signals={**trial.signals, "r": r}, valid={**trial.valid, "r": there})
    found = gyro_offset(gap, "r", COMPASS) or (0.0, 0.0)
    assert found[0] == pytest.approx(whole[0], abs=0.5 * whole[1])
    never = replace(trial, valid={**trial.valid, "psi": np.zeros(trial.samples, dtype=bool)})
    assert gyro_offset(never, "r", COMPASS) is None
    assert gyro_offset(zigzag(10), "r", COMPASS) is None


def test_a_gyro_that_reads_a_share_too_much_has_no_offset() -> None:
    """In a turn of many degrees one is the other; a share of 2 % is within what is left open."""
    n = 1200
    blank = zigzag(10)
    steady = {q: np.zeros(n) for q in blank.signals} | {"r": np.full(n, np.deg2rad(1.0))}
    valid = {q: np.ones(n, dtype=bool) for q in steady}
    turning = replace(blank, signals=steady, valid=valid)
    found, deviation = gyro_offset(headed(turning, 4, 0.0, 1.02), "r", COMPASS) or (9.0, 0.0)
    assert 0.0 < found < deviation


def test_a_heading_of_nothing_leaves_a_gyro_as_open_as_none() -> None:
    trial = headed(zigzag(10), 5)
    lost = np.random.default_rng(6).uniform(-3.0, 3.0, trial.samples)
    wild = replace(trial, signals={**trial.signals, "psi": lost})
    without = nuisance_prior(MODEL, zigzag(10), "b_r", 0.0005)
    mean, deviation = nuisance_prior(MODEL, wild, "b_r", 0.0005)
    assert abs(mean) < 2.0 * deviation
    assert deviation <= without[1]


def test_an_offset_no_longer_stands_in_for_a_ship_that_turns_unlike_to_both_sides() -> None:
    """Rudders in unlike flows, which the model lacks: without a heading the gyro takes it up."""
    unlike = (MODEL + CATALOGUE["rudder_flow_asymmetry"]).with_values(
        {"N_flow": 5e-4, "l_flow": -0.8}
    )
    asked = Settings(
        ("Nv", "Nr", "Ndelta"), ("r", "phi"), nuisance=("initial_state", "bias", "rudder_offset")
    )

    def furthest(*, heading: bool) -> float:
        trials = []
        for seed, angle in enumerate((10, 20)):
            blank = zigzag(angle)
            y = respond(prepare(unlike, (), ("r", "phi")), blank, {}, {"u": 7.33}).y
            trial = replace(blank, signals={**blank.signals, "r": y[:, 0], "phi": y[:, 1]})
            read = headed(trial, seed, off=0.0)
            signals = {n: x for n, x in read.signals.items() if heading or n != "psi"}
            trials.append(replace(read, signals=signals))
        fit = identify(trials, MODEL, asked)
        return max(abs(a) for n, a in fit.estimates.items() if n.startswith("b_r"))

    alone, beside = furthest(heading=False), furthest(heading=True)
    print(alone, beside)
    assert alone > 3e-4
    assert beside < 0.2 * alone
