"""What the noise's interval knows of: what carries over, what is rare, what is not typical."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter
from test_noise_routes import NOTHING, SIGMA, fit_of, noise, steered, trial

from trialid.diagnosis.noise.split import split
from trialid.trial_rows import Stretch


def slow(rng, n, count):
    """Slow motions of mean square 1; (n, count)."""
    x = lfilter([1.0], [1.0, -0.95], rng.standard_normal((n + 400, count)), axis=0)[400:]
    return x / np.sqrt(np.mean(x**2, axis=0))


def driven(seed, beta, directions=30, n=900, as_slow=False):
    """A residual of noise and of what slow candidates explain of it, with the candidates' rows."""
    rng = np.random.default_rng(seed)
    S = slow(rng, n, directions) / np.sqrt(n)
    own = slow(rng, n, 1)[:, 0] if as_slow else rng.standard_normal(n)
    left = SIGMA * own + np.sqrt(n) * beta * S[:, 0]
    residual = left / np.sqrt(n)
    part = (Stretch(0, 0, slice(0, n), np.ones(n, dtype=bool)),)
    raw = SimpleNamespace(S=S, residual=residual)
    white = SimpleNamespace(S=S * np.sqrt(n) / SIGMA, residual=left / SIGMA)
    evidence = SimpleNamespace(raw=raw, white=white, parts=part)
    fit = fit_of(trial("moving", left, delta=steered(n)))
    rows = {"residual": residual, "psi": np.zeros((n, 0)), "S": S, "stretches": part}
    augmented = SimpleNamespace(fit=fit, traces=(1,), evidence=evidence, **rows)
    _, routes = split(fit, augmented, {})
    return routes[3]


def test_what_candidates_explain_of_noise_by_chance_is_no_model():
    """Thirty directions explain a thirtieth of 900 samples of noise; out of sample nothing."""
    model = [driven(seed, 0.0).undermodelling ** 2 for seed in range(8)]
    assert np.mean(model) < 0.6 * SIGMA**2 * 30 / 900


def test_what_candidates_explain_beyond_chance_is_model():
    model = [driven(seed, 0.1).undermodelling ** 2 for seed in range(8)]
    assert np.mean(model) == pytest.approx(0.1**2, rel=0.15)


def test_noise_that_runs_with_the_input_is_not_said_to_be_model():
    """Noise as slow as the motion, and taken for white: what it is explained by does not last."""
    held = [driven(seed, 0.0, directions=10, as_slow=True) for seed in range(20)]
    assert np.mean([x.undermodelling for x in held]) > 0.05 * SIGMA
    assert all(x.noise_interval[1] > 0.98 * SIGMA for x in held)
    assert np.mean([x.undermodelling_interval[0] == 0.0 for x in held]) > 0.9
    sure = [driven(seed, SIGMA, directions=10) for seed in range(8)]  # and what lasts is
    assert all(x.undermodelling_interval[0] > 0.5 * SIGMA for x in sure)


def test_values_far_off_that_an_approach_lacks_are_in_its_interval_or_it_gives_no_figure():
    """One in a hundred, 20 times the noise: 120 samples hold one of them, or none, or three."""
    held = []
    for seed in range(40):
        n = 3000
        rng = np.random.default_rng(seed)
        far = 20.0 * (rng.random(n) < 0.01) * rng.choice([-1.0, 1.0], n)
        left = SIGMA * (noise(seed, n) + far)
        delta = np.where(np.arange(n) < 240, 0.0, steered(n))
        chosen, _ = split(fit_of(trial("far", left, delta=delta)), NOTHING, {})
        low, high = chosen.noise_interval or (0.0, np.inf)
        held.append(low <= np.sqrt(np.mean(left**2)) <= high)
    assert np.mean(held) >= 0.9


def test_a_quiet_stretch_noisier_than_the_whole_record_is_not_typical():
    n = 3000
    loud = np.where(np.arange(n) < 600, 3.0, 0.5) * SIGMA
    delta = np.where(np.arange(n) < 600, 0.0, steered(n))
    chosen, routes = split(fit_of(trial("calmer", loud * noise(8, n), delta=delta)), NOTHING, {})
    assert not chosen.available
    assert "not typical" in routes[2].why


def counted(step):
    """A record whose sensor counts in such steps, and of which the model misses nothing."""
    n = 3000
    motion = np.sin(np.arange(n) / 15.0) * (np.arange(n) >= 240)
    seen = np.round((motion + SIGMA * noise(6, n)) / step) * step
    delta = np.where(np.arange(n) < 240, 0.0, steered(n))
    return fit_of(trial("counted", seen - motion, predicted=motion, delta=delta))


@pytest.mark.parametrize(("step", "coarse"), [(1.0, False), (3.0, True)])
def test_a_count_coarser_than_the_noise_follows_the_motion_and_is_no_noise(step, coarse):
    """Of once the noise it is noise itself; of three times nearly nothing changes at rest."""
    fit = counted(step * SIGMA)
    chosen, _ = split(fit, NOTHING, {})
    assert chosen.available is not coarse
    if coarse:
        assert "counts coarser than the noise: r" in chosen.why
        assert split(fit, NOTHING, {"r": 0.25})[0].method == "stated sensor figure"
    else:
        low, high = chosen.noise_interval
        assert low <= np.sqrt(1.0 + step**2 / 12.0) * SIGMA <= high


def test_runs_that_the_model_foretells_to_differ_may_differ_by_its_error():
    """The second run's motion is a fifth more, and so is what the model misses of it."""
    n = 3000
    motion = np.sin(np.arange(n) / 9.0)
    runs = [
        trial(f"{k}", 0.15 * size * motion + SIGMA * noise(k, n), size * motion, steered(n))
        for k, size in ((30, 1.0), (31, 1.2))
    ]
    chosen, _ = split(fit_of(*runs), NOTHING, {})
    low, high = chosen.noise_interval
    assert low < 0.99 * SIGMA < high
    alike = [
        trial(f"{k}", 0.15 * motion + SIGMA * noise(k, n), motion, steered(n)) for k in (30, 31)
    ]
    sure = split(fit_of(*alike), NOTHING, {})[0].noise_interval
    assert low < 0.95 * sure[0] < SIGMA
