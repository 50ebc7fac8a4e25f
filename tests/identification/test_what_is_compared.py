"""What a fit compares and what it holds: gaps, ends, norms, bounds, sensors of held-out trials."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, white, with_noise, zigzag
from scipy.optimize import lsq_linear
from scipy.signal import lfilter

from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.nuisance.priors import nuisance_prior
from trialid.identification.output_error import linearise, row_scale, step_halving
from trialid.identification.problem import norms, pose_problem
from trialid.identification.weighing import level_of
from trialid.least_squares.gauss_newton import minimise
from trialid.trial import Trial

FEW = ("Nr", "Ndelta", "Kdelta", "Kp")
PLAIN = replace(SETTINGS, free=FEW, nuisance=())


def cut(trial, samples, **signals):
    """The first samples of a trial, some of its signals replaced."""
    kept = {n: (signals.get(n, y))[:samples] for n, y in trial.signals.items()}
    valid = {n: m[:samples].copy() for n, m in trial.valid.items()}
    return Trial(trial.name, trial.use, trial.period, {n: y.copy() for n, y in kept.items()}, valid)


def holed(trial, signal, hole):
    """The trial with a signal that was not measured for a while."""
    there = trial.valid[signal].copy()
    there[hole] = False
    return replace(trial, valid={**trial.valid, signal: there})


def test_no_output_is_compared_where_the_rudder_was_not_measured():
    problem = pose_problem([holed(zigzag(10), "delta", slice(300, 350))], MODEL, PLAIN)
    (mask,) = problem.compared
    assert not mask[300:350].any()
    assert mask[:300].all()
    assert mask[350:].all()


def test_an_output_is_not_compared_where_its_delay_looks_beyond_the_record():
    """A delay of 3 s either way at two samples a second, and three samples to interpolate."""
    problem = pose_problem([zigzag(10)], MODEL, replace(PLAIN, nuisance=("delay",)))
    (mask,) = problem.compared
    for ends in (mask[:9], mask[-9:]):
        assert not ends.any()
    assert mask[9:-9].all()


@pytest.mark.parametrize("samples", [33, 49, 97])
def test_a_short_trial_keeps_three_quarters_whatever_a_delay_is_sought(samples):
    """It is sought by an eighth of the trial at most, and three samples more are left out."""
    trial = cut(zigzag(10), samples)
    problem = pose_problem([trial], MODEL, replace(PLAIN, nuisance=("delay",)))
    (mask,) = problem.compared
    most = min(3.0, 0.125 * trial.duration)
    ends = int(np.ceil(most / trial.period)) + 3
    assert mask.sum(axis=0).tolist() == [samples - 2 * ends] * 2
    late = [x for x in problem.unknowns if x.column.startswith("tau_")]
    assert {(x.low, x.high) for x in late} == {(-most, most)}


def test_a_delay_of_all_trials_is_sought_as_far_as_the_shortest_lets_it():
    both = [zigzag(10), replace(cut(zigzag(20), 21), name="short")]
    late = MODEL + CATALOGUE["delay_r"]
    problem = pose_problem(both, late, replace(PLAIN, free=(*FEW, "tau_r")))
    [tau] = [x for x in problem.unknowns if x.name == "tau_r"]
    assert (tau.low, tau.high) == (-1.25, 1.25)


def test_an_output_is_normed_about_its_own_mean_unless_about_zero():
    trial = zigzag(10)
    level = replace(trial, signals={**trial.signals, "phi": trial.signals["phi"] + 0.1})
    mask = [np.ones((trial.samples, 1), dtype=bool)]
    about = norms([trial], mask, ("phi",), "mean", 175.0)[0]
    assert norms([level], mask, ("phi",), "mean", 175.0)[0] == pytest.approx(about)
    offset = 0.1 + float(trial.signals["phi"].mean())
    assert norms([level], mask, ("phi",), "zero", 175.0)[0] == pytest.approx(
        np.hypot(about, offset)
    )


def test_every_output_counts_alike_however_much_of_it_is_missing():
    """The squares of the rows sum to the mean over outputs of their mean squares."""
    trial = holed(
        with_noise(zigzag(10), *white(np.random.default_rng(1), 2401)), "phi", slice(200, 1900)
    )
    problem = pose_problem([trial], MODEL, PLAIN)
    residual, _ = linearise(problem, problem.start)
    fit = identify([trial], MODEL, PLAIN)
    expected = 0.5 * sum(
        np.mean((trial.signals[c] - fit.scores[0].response.y[:, i])[mask] ** 2) / size**2
        for i, (c, mask, size) in enumerate(
            zip(("r", "phi"), problem.compared[0].T, problem.y_rms, strict=True)
        )
    )
    assert float(fit.residual @ fit.residual) == pytest.approx(expected)
    assert fit.eps_rmsn**2 == pytest.approx(expected)
    assert row_scale(problem)[1] * problem.y_rms[1] * np.sqrt(2.0 * 701) == pytest.approx(1.0)
    assert len(residual) == 2401 + 701


def test_a_long_trial_counts_by_its_length():
    trials = [with_noise(zigzag(10), *white(np.random.default_rng(2), 2401)), zigzag(20)]
    fit = identify([trials[0], cut(trials[1], 400)], MODEL, PLAIN)
    rows = [(s.trial.signals["r"] - s.response.y[:, 0]) / fit.problem.y_rms[0] for s in fit.scores]
    expected = np.sqrt(np.mean(np.concatenate(rows) ** 2))
    assert fit.eps_by_output["r"] == pytest.approx(expected)
    assert len(np.concatenate(rows)) == 2801


def test_a_held_out_trial_has_sensors_as_the_fitted_ones_have_on_average():
    """Roll sensors 1 and 3 deg off in the fitted trials: 2 deg is what the third is given."""

    def off(trial, degrees):
        return with_noise(trial, 0.0, np.deg2rad(degrees))

    trials = [off(zigzag(10), 1.0), off(zigzag(20), 3.0), off(zigzag(5, use="check"), 2.0)]
    fit = identify(trials, MODEL, replace(PLAIN, nuisance=("bias",)))
    assert fit.value("b_phi [zigzag-10]") == pytest.approx(np.deg2rad(1.0), rel=0.02)
    assert fit.value("b_phi [zigzag-20]") == pytest.approx(np.deg2rad(3.0), rel=0.02)
    assert fit.eps_check < 0.1  # a degree more or less would be 0.4 of the roll


def test_a_held_out_trial_that_is_lost_has_no_finite_error():
    check = zigzag(20, use="check")
    wild = replace(check, signals={**check.signals, "delta": 60.0 * check.signals["delta"]})
    fit = identify([zigzag(10), wild], MODEL, PLAIN)
    assert fit.scores[1].response.departure is not None
    assert fit.eps_check == np.inf
    assert fit.eps_rmsn < 1e-3


def test_integration_errors_fall_by_far_more_than_the_step():
    """With the fourth power where nothing has a kink; |v| and |r| have."""
    fit = identify([zigzag(10)], MODEL, replace(PLAIN, most_substeps=1))
    simulator = fit.problem.simulator
    finer = replace(fit, problem=replace(fit.problem, simulator=replace(simulator, substeps=2)))
    coarse, fine = (step_halving(f.problem, f.theta)["phi"] for f in (fit, finer))
    assert coarse > 1e-9
    assert 4.0 < coarse / fine < 20.0


def test_a_large_motion_does_not_make_what_is_left_of_a_small_one_little():
    """Four trials, and a fifth in which noise is a fifth of the little that moved."""
    trials = [replace(zigzag(20), name=f"zigzag-20-{k}") for k in range(4)]
    small = zigzag(2)
    moved = float(np.std(small.signals["r"]))
    noise = 0.2 * moved * np.random.default_rng(1).standard_normal(len(small.t))
    noisy = replace(small, signals={**small.signals, "r": small.signals["r"] + noise})
    fit = identify([*trials, noisy], MODEL, replace(PLAIN, outputs=("r",)))
    assert fit.eps_of_own == pytest.approx(0.2, rel=0.1)
    assert fit.eps_rmsn < 0.02


# --- bounds and priors ----------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("low", "high"),
    [((-9.0, 0.5), (9.0, 9.0)), ((-9.0, -9.0), (0.8, 9.0)), ((1.4, -9.0), (9.0, 0.1))],
)
def test_what_is_held_at_a_bound_leaves_the_others_their_best(low, high):
    """Columns nearly alike: the free one answers for what the held one may not."""
    rng = np.random.default_rng(3)
    A = rng.standard_normal((200, 2)) @ np.array([[1.0, 0.97], [0.0, 0.243]])
    y = A @ [1.0, -0.3] + 0.05 * rng.standard_normal(200)
    best = lsq_linear(A, y, (low, high), tol=1e-14).x

    def evaluate(theta):
        return y - A @ theta, A

    start = np.clip([0.0, 0.0], low, high)
    found = minimise(evaluate, start, np.ones(2), np.array(low), np.array(high))
    assert found.converged
    assert found.reason == "orthogonal"
    np.testing.assert_allclose(found.theta, best, atol=1e-7)
    assert found.evaluations < 20


def test_a_valley_that_leaves_the_bounds_is_followed_along_them():
    """Of eight columns the last moves 16 000 times less than the first.

    A step cut short at each bound goes up the valley's side: 183 steps at most, and half of the
    searches take 14.
    """
    counts = []
    for seed in range(20):
        rng = np.random.default_rng(seed)
        U, _, Vt = np.linalg.svd(rng.standard_normal((40, 8)), full_matrices=False)
        A = (U * 10.0 ** (-0.6 * np.arange(8))) @ Vt
        y = A @ (2.0 * rng.standard_normal(8)) + 0.01 * rng.standard_normal(40)
        ends = (-np.ones(8), np.ones(8))
        found = minimise(lambda x, A=A, y=y: (y - A @ x, A), np.zeros(8), np.ones(8), *ends)
        least = lsq_linear(A, y, ends, method="bvls").cost
        assert pytest.approx(least, rel=1e-9) == found.V
        counts.append(len(found.iterations))
    assert max(counts) <= 20
    assert np.median(counts) <= 8


def test_the_history_of_a_search_is_of_the_record_not_of_what_was_known_before():
    rows, known = np.array([1.0, 2.0, 2.5]), np.array([3.0])

    def evaluate(theta):
        return np.concatenate([rows - theta, known - theta]), np.ones((4, 1))

    found = minimise(evaluate, np.zeros(1), np.ones(1), rows=3)
    assert found.theta[0] == pytest.approx(8.5 / 4)
    assert pytest.approx(0.5 * float(rows @ rows)) == found.iterations[0].V
    assert pytest.approx(0.5 * np.sum((rows - 8.5 / 4) ** 2), rel=1e-5) == found.iterations[-1].V


@pytest.mark.parametrize("rho", [0.0, 0.9])
def test_a_prior_weighs_against_as_many_rows_as_say_different_things(rho):
    """Of n rows of a first-order process (1 - rho) / (1 + rho) do; three went into unknowns."""
    n = 20_000
    e = lfilter([1.0], [1.0, -rho], np.random.default_rng(4).standard_normal(n))
    residual = 0.2 * e / np.linalg.norm(e)
    problem = SimpleNamespace(compared=(np.ones((n, 1), dtype=bool),), unknowns=(None, None, None))
    expected = 0.2 * np.sqrt((1.0 + rho) / (1.0 - rho) / (n - 3))
    assert level_of(problem, residual) == pytest.approx(expected, rel=0.1)


@pytest.mark.parametrize(
    ("column", "degrees"),
    [
        ("b_phi", 2.0),
        ("b_psi", 2.9),
        ("delta_0", 1.15),
        ("b_r", 0.0573),
        ("b_p", 0.0573),
    ],
)
def test_sensors_are_off_by_what_their_makers_state(column, degrees):
    """Of a ship that hardly moves: a gyro then keeps a tenth of a degree in two minutes."""
    trial = zigzag(10)
    still = replace(
        trial,
        signals={
            **trial.signals,
            "r": 1e-9 * trial.signals["r"],
            "u": np.full(trial.samples, 1e-6),
        },
    )
    mean, deviation = nuisance_prior(MODEL, still, column, 0.0005)
    assert mean == 0.0
    assert deviation == pytest.approx(np.deg2rad(degrees), rel=0.05)
