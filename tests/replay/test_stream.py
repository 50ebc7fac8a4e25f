"""A model in step with a record gives the batch run's numbers, bit for bit, by any way."""

import numpy as np
import pytest
from s175q import MODEL, OUTPUTS, zigzag

from trialid.effects import CATALOGUE
from trialid.replay.stream import Stream
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

MODELS = {
    "plain": {},
    "bias": {"b_r": 0.0005, "b_phi": 0.004},
    "late sensor": {"tau_phi": 0.7},
    "early sensor": {"tau_phi": -0.9, "tau_r": 0.2},
    "whole samples late": {"tau_phi": 1.0},
    "low-pass": {"T_r": 3.0},
    "two low-passes and a delay": {"T_rr": 2.0, "tau_r": 0.6},
    "drifting clock": {"drift_phi": 0.004},
    "late rudder record": {"tau_delta": 0.8},
    "accelerations": {"k_incl": 1.0, "z_incl": 5.0},
}
OWNERS = {p: e for e in CATALOGUE.values() for p in e.parameters}


@pytest.fixture(scope="module")
def trial():
    return zigzag(20)


def made(case, engine="compiled", substeps=1):
    values = MODELS[case]
    model = MODEL
    for effect in {OWNERS[p].name: OWNERS[p] for p in values}.values():
        model = model + effect
    return prepare(model.with_values(values), (), OUTPUTS, engine, substeps)


def first(trial, n):
    signals = {name: x[:n].copy() for name, x in trial.signals.items()}
    valid = {name: x[:n].copy() for name, x in trial.valid.items()}
    return Trial(trial.name, trial.use, trial.period, signals, valid)


@pytest.mark.parametrize("case", MODELS)
@pytest.mark.parametrize("step", [1, 7, 64, 5000])
def test_the_stream_is_the_batch_run_bit_for_bit(case, step, trial):
    simulator = made(case)
    batch = respond(simulator, trial, {}, {"u": 7.33}, sensitivities=False)
    short = first(trial, 500) if step == 1 else trial
    stream = Stream(simulator, short, {}, {"u": 7.33})
    for to in range(step, short.samples + step, step):
        stream.advance(to)
        assert stream.at == min(to, short.samples)
    settled = short.samples if short is trial else short.samples - stream.open_end
    assert np.isfinite(batch.y).all()
    assert np.array_equal(stream.y[:settled], batch.y[:settled])


@pytest.mark.parametrize("engine", ["compiled", "numpy"])
def test_finer_steps_and_the_reference_engine_stream_alike(engine, trial):
    simulator, short = made("late sensor", engine, 3), first(trial, 300)
    stream = Stream(simulator, short, {}, {"u": 7.33})
    for to in range(0, 312, 11):
        stream.advance(to)
    batch = respond(simulator, short, {}, {"u": 7.33}, sensitivities=False)
    assert np.array_equal(stream.y, batch.y)


def test_what_a_delay_looks_ahead_is_known(trial):
    assert Stream(made("plain"), trial, {}, {}).ahead == 0
    assert Stream(made("low-pass"), trial, {}, {}).ahead == 0
    assert Stream(made("late sensor"), trial, {}, {}).ahead == 1
    assert Stream(made("early sensor"), trial, {}, {}).ahead == 4


@pytest.mark.parametrize("case", MODELS)
def test_a_growing_record_is_carried_on(case, trial):
    simulator = made(case)
    whole = respond(simulator, trial, {}, {"u": 7.33}, sensitivities=False)
    earlier = Stream(simulator, first(trial, 200), {}, {"u": 7.33})
    earlier.advance(200 - earlier.open_end)
    later = Stream(simulator, trial, {}, {"u": 7.33})
    assert later.take_over(earlier) >= 200 - 2 * earlier.open_end - 3
    later.advance(trial.samples)
    assert np.array_equal(later.y, whole.y)


def test_where_a_longer_record_moved_what_was_there_the_model_steps_again(trial):
    simulator = made("plain")
    earlier = Stream(simulator, first(trial, 300), {}, {"u": 7.33})
    earlier.advance(300)
    delta = trial.signals["delta"].copy()
    delta[120] += 1e-9
    moved = Trial("moved", "fit", trial.period, {**trial.signals, "delta": delta}, trial.valid)
    later = Stream(simulator, moved, {}, {"u": 7.33})
    assert later.take_over(earlier) == 120
    later.advance(trial.samples)
    batch = respond(simulator, moved, {}, {"u": 7.33}, sensitivities=False)
    assert np.array_equal(later.y, batch.y)
    other_start = Stream(simulator, moved, {}, {"u": 7.0})
    assert other_start.take_over(earlier) == 0


def test_a_departure_is_where_the_batch_run_has_it(trial):
    wild = MODEL.with_values({"GM": -3.0})
    simulator = prepare(wild, (), OUTPUTS)
    batch = respond(simulator, trial, {}, {"u": 7.33}, sensitivities=False)
    stream = Stream(simulator, trial, {}, {"u": 7.33})
    for to in range(0, trial.samples + 9, 9):
        stream.advance(to)
    assert batch.departure is not None
    assert stream.departure == batch.departure
    assert np.array_equal(stream.y, batch.y, equal_nan=True)
