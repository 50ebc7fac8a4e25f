"""One simulated trial in every format: the same series, and the same fit.

A zig-zag of S175Q with white sensor noise is written by the libraries of every format, read back by
its content alone, aligned and fitted; all is held against the same series that were in no file. Of
a format without the speed the fit has the stated one, on both sides.
"""

import functools
import importlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import s175q
from s175q import EFFECTS, GYRO, INCLINOMETER, SHIP, zigzag

from trialid.accuracy.parameter_table import Subject, assess
from trialid.alignment import SignalSource, align
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.output_error import stretches
from trialid.identification.problem import Settings
from trialid.ingest import read
from trialid.recording import Channel, Recording
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond

WRITERS = sorted(path.stem for path in Path(__file__).parent.glob("write_*.py"))
FORMATS = [form for name in WRITERS for form in importlib.import_module(name).FORMATS]

START = 1_700_000_000_123_456_000
"""[ns] Not on a millisecond: what stamps of milliseconds lose must show."""
RATE = 4.0
PERIOD = 0.5
SPEED = 7.33
"""[m/s] That of the approach; stated where a format has none."""
SIGMA = {"delta": 0.0, "r": GYRO, "phi": INCLINOMETER, "u": 0.02, "psi": np.radians(0.05)}
SEED = 41
AHEAD = {"propeller_thrust", "surge_resistance", "surge_turning", "surge_rudder"}
STATES = ("v", "p", "r", "phi")
MODEL = ShipModel(SHIP, STATES, tuple(CATALOGUE[e] for e in EFFECTS if e not in AHEAD))
SETTINGS = Settings(("Nv", "Nr", "Ndelta", "Kp"), ("r", "phi"), nuisance=("initial_state",))


@functools.cache
def series():
    """Stamps and values of delta, r, phi, u, psi with the noise of their sensors."""
    clean = zigzag(10)
    simulated = prepare(s175q.MODEL, (), ("r", "phi", "u"))
    r, phi, u = respond(simulated, clean, {}, {"u": SPEED}, sensitivities=False).y.T
    turned = np.cumsum(np.concatenate([[0.0], (r[1:] + r[:-1]) / 2 * clean.period]))
    psi = np.radians(355.0) + turned  # it passes north
    motion = {"delta": clean.signals["delta"], "r": r, "phi": phi, "u": u, "psi": psi}
    rng = np.random.default_rng(SEED)
    t = np.arange(0.0, clean.duration, 1 / RATE)
    stamps = START + np.rint(t * 1e9).astype(np.int64)
    noise = {name: SIGMA[name] * rng.standard_normal(len(t)) for name in motion}
    return {name: (stamps, np.interp(t, clean.t, y) + noise[name]) for name, y in motion.items()}


@functools.cache
def never_written(names):
    """The trial of these series without a file between."""
    channels = {name: Channel(name, *series()[name], clock="simulated") for name in names}
    units = {"r": "rad/s", "u": "m/s"}
    sources = [
        SignalSource(name, name, units.get(name, "rad"), "starboard" if name == "delta" else None)
        for name in names
    ]
    return align("zigzag", "fit", [Recording(Path("none"), "none", "", channels)], sources, PERIOD)


@functools.cache
def fit_of_the_same(names):
    """Value and standard error of each free parameter, fitted to what was never written."""
    return fitted(never_written(names))


def fitted(trial):
    """Value and standard error of each free parameter; the speed is stated where not recorded."""
    if "u" not in trial.signals:
        u, there = np.full(trial.samples, SPEED), np.ones(trial.samples, dtype=bool)
        trial = replace(trial, signals={**trial.signals, "u": u}, valid={**trial.valid, "u": there})
    fit = identify([trial], MODEL, SETTINGS)
    assert fit.converged
    subjects = [
        Subject(x.name, x.kind, x.unit, v, v if x.kind == "physical" else x.size)
        for x, v in zip(fit.problem.unknowns, fit.theta, strict=True)
    ]
    known = assess(subjects, fit.psi, fit.residual, stretches(fit.problem), fit.eps_rmsn, 0.0)
    free = known.parameters[: len(SETTINGS.free)]
    assert tuple(p.name for p in free) == SETTINGS.free
    return np.array([(p.value, p.standard_error) for p in free]).T


def distance(name, a, b):
    """How far apart; of headings the short way round."""
    apart = np.abs(a - b)
    return np.minimum(apart, np.abs(2 * np.pi - apart)) if name == "psi" else apart


def steepest(name):
    """Steepest slope of a written series [1/s]; of headings the short way round."""
    y = series()[name][1]
    return RATE * np.abs(np.diff(y)).max()


@pytest.mark.parametrize("form", FORMATS, ids=lambda form: form.name)
@pytest.mark.study(turn="each")
def test_the_same_series_and_the_same_fit(form, tmp_path):
    """Ours: at most 0.50 of the resolution; 0.04 standard errors, of MAVLink's rudder 0.09.

    A servo's pulses cut a rudder angle to steps of 0.09 deg, towards midships.
    """
    path = tmp_path / "log"
    written = form.write(path, series())
    names = tuple(source.quantity for source in written.sources)
    assert {"delta", "r", "phi", "psi"} <= set(names)
    trial = align("zigzag", "fit", [read(path, None, written.aids)], written.sources, PERIOD)
    same = never_written(names)
    assert trial.samples == same.samples
    for name in names:
        there = trial.valid[name]
        assert np.array_equal(there, same.valid[name])
        assert there.mean() > 0.99
        bound = written.resolution[name] + steepest(name) * written.clock_resolution
        assert distance(name, trial.signals[name], same.signals[name])[there].max() <= bound + 1e-9
    (value, error), (expected, its_error) = fitted(trial), fit_of_the_same(names)
    print((value - expected) / its_error)
    assert np.all(np.abs(value - expected) < 0.1 * its_error)
    assert error == pytest.approx(its_error, rel=0.05)


def test_what_is_compared_is_the_trial_and_its_truth():
    """The fit itself is one: within three standard errors of the truth, which are small."""
    names = ("delta", "r", "phi", "u", "psi")
    value, error = fit_of_the_same(names)
    truth = np.array([MODEL.value(name) for name in SETTINGS.free])
    assert np.all(np.abs(value - truth) < 3 * error)
    assert np.all(error < 0.05 * np.abs(truth))


def test_every_writer_there_is_takes_part():
    assert len({form.name for form in FORMATS}) == len(FORMATS)
    assert set(WRITERS) >= {f"write_{name}" for name in ("can", "mcap", "nmea0183", "tables")}
