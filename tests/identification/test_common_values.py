"""What a held-out trial takes of the sensors: of each as sure as the trials know it."""

import numpy as np
import pytest
import s175q

from trialid.identification.check.common_values import common_values, weights_between
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

OFFSET = np.deg2rad(1.0)


@pytest.mark.parametrize(
    ("values", "variances", "mean"),
    [
        ([1.0, 3.0], [4.0, 4.0], 2.0),
        ([0.0, 4.0], [1.0, 1e6], 4e-6 / (1.0 + 1e-6)),  # one knows it, the other does not
        ([0.0, 10.0], [1.0, 4.0], 485.0 / 100.0),  # tau^2 = 47.5, by hand
        ([0.0, 10.0], [1e-12, 4e-12], 5.0),  # both know their own, and they differ
        ([7.0], [0.0], 7.0),
        ([7.0], [np.inf], 7.0),
        ([1.0, 3.0], [np.inf, np.inf], 2.0),  # nobody knows
        ([1.0, 3.0], [np.inf, 1.0], 3.0),
        ([1.0, 3.0], [0.0, 0.0], 2.0),
    ],
)
def test_mean_of_values_known_unequally(values: list, variances: list, mean: float) -> None:
    weights, between = weights_between(np.array(values), np.array(variances))
    assert weights @ values == pytest.approx(mean, rel=1e-6, abs=1e-9)
    assert weights.sum() == pytest.approx(1.0)
    assert between >= 0.0


def test_what_lies_between_values_is_what_their_scatter_has_beyond_their_own() -> None:
    assert weights_between(np.array([0.0, 10.0]), np.array([1.0, 4.0]))[1] == pytest.approx(47.5)
    assert weights_between(np.array([0.0, 1.0]), np.array([1.0, 4.0]))[1] == 0.0
    assert weights_between(np.array([7.0]), np.array([1.0]))[1] == 0.0


def sailed(name: str, delta: np.ndarray, use: str, rng: np.random.Generator) -> Trial:
    """The ship under a rudder whose record lacks its offset, and with it the noise of sensors."""
    n = len(delta)
    blank = s175q.zigzag(10, use=use)
    known = {q: np.ones(n, dtype=bool) for q in blank.signals}
    signals = {"delta": delta + OFFSET, "n": np.full(n, s175q.SHAFT)}
    signals |= {q: np.zeros(n) for q in ("r", "phi")}
    bare = Trial(name, use, 0.5, signals, known)
    simulator = prepare(s175q.MODEL, (), s175q.OUTPUTS)
    y = respond(simulator, bare, {}, {"u": 7.33}, sensitivities=False).y
    moved = {**signals, "delta": delta, "r": y[:, 0].copy(), "phi": y[:, 1].copy()}
    return s175q.with_noise(Trial(name, use, 0.5, moved, known), *s175q.white(rng, n))


def fitted(seed: int) -> Fit:
    """Two zig-zags and a turn, in which a damping may stand for the rudder's zero; one held out."""
    rng = np.random.default_rng([31, seed])
    zigzags = {a: s175q.zigzag(a).signals["delta"] for a in (5, 10, 20)}
    turn = np.minimum(0.05 * np.arange(600.0), 20.0) * np.pi / 180.0
    trials = [sailed(f"z{a}", zigzags[a], "fit", rng) for a in (5, 20)]
    trials += [sailed("turn", turn, "fit", rng), sailed("z10", zigzags[10], "check", rng)]
    free = ("Nr", "Nv", "Ndelta", "Nrar")
    settings = Settings(free, s175q.OUTPUTS, nuisance=("initial_state", "rudder_offset", "bias"))
    return identify(trials, s175q.MODEL, settings)


def test_a_trial_that_hardly_knows_the_zero_of_the_rudder_hardly_counts() -> None:
    plain, weighed = [], []
    for seed in range(4):
        fit = fitted(seed)
        own = [fit.estimates[f"delta_0 [{n}]"] for n in ("z5", "z20", "turn")]
        plain.append(np.mean(own) - OFFSET)
        weighed.append(fit.common["delta_0"] - OFFSET)
        found = common_values(fit.problem, fit.theta, fit.level)
        assert fit.common == {n: x.mean for n, x in found.items()}
    assert np.std(weighed) < 0.5 * np.sqrt(np.mean(np.square(plain)))
    assert np.sqrt(np.mean(np.square(weighed))) < np.deg2rad(0.05)
