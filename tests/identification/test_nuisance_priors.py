"""What each trial has for itself stays likely, unless the record clearly says otherwise."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, waves, white, with_noise, zigzag

from trialid.identification.fit import identify
from trialid.identification.nuisance.priors import limits, nuisance_prior
from trialid.identification.problem import Settings, pose_problem
from trialid.identification.roll.roll_range import DAMPING_RATIO, GM_OVER_L
from trialid.identification.weighing import Weighing, colour_of, level_of
from trialid.ship.effect import Force
from trialid.trial import Trial
from trialid.trial_rows import Stretch

EVERY = ("initial_state", "bias", "rudder_offset", "delay")
FEW = ("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM")
ALONE = Settings(FEW, ("r", "phi"), nuisance=EVERY)


def piece(trial, seconds, use="fit"):
    n = round(seconds / trial.period)
    signals = {name: y[:n].copy() for name, y in trial.signals.items()}
    return Trial(trial.name, use, trial.period, signals, {s: np.ones(n, bool) for s in signals})


def piece_from(trial, place):
    signals = {name: y[place:].copy() for name, y in trial.signals.items()}
    return replace(trial, signals=signals, valid={n: m[place:] for n, m in trial.valid.items()})


def noisy(trial, seed, kind=white):
    return with_noise(trial, *kind(np.random.default_rng(seed), trial.samples))


def wrong_model():
    """The ship without her cross-flow: what is missing is for the nuisances to hide."""
    gone = ("sway_drag_vav", "yaw_drag_rar", "roll_drag_vav")
    return replace(MODEL, effects=tuple(e for e in MODEL.effects if e.name not in gone))


def furthest(fit):
    """Each kind of nuisance at its furthest from the truth, which is zero, or at the record's."""
    kinds = {"delta_0": 0.0, "tau_r": 0.0, "tau_phi": 0.0, "p(0)": 0.0}
    for x, a in zip(fit.problem.unknowns, fit.theta, strict=True):
        if x.column in kinds:
            kinds[x.column] = max(kinds[x.column], abs(float(a)))
    return kinds


@pytest.fixture(scope="module")
def short():
    return [piece(noisy(zigzag(a), 20 + a), 200.0) for a in (10, 20)]


def test_nuisances_of_short_records_stay_likely_where_alone_they_run_off(short):
    held = furthest(identify(short, wrong_model(), ALONE))
    alone = furthest(identify(short, wrong_model(), replace(ALONE, hold_nuisance=False)))
    print(held, alone)
    assert held["delta_0"] < 0.5 * alone["delta_0"]
    assert held["delta_0"] < 0.04
    assert max(held["tau_r"], held["tau_phi"]) < 1.0
    assert held["p(0)"] < 0.1


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_half_or_twice_of_what_is_likely_does_not_move_the_ship(short, factor, monkeypatch):
    """The ship's own numbers move by less than their errors: the priors hold what nobody saw."""
    from trialid.identification.nuisance import of_each_trial as posing

    def other(*asked):
        mean, deviation = nuisance_prior(*asked)
        return mean, factor * deviation

    trials = [noisy(zigzag(a), 30 + a) for a in (10, 20)]
    usual = identify(trials, MODEL, ALONE)
    monkeypatch.setattr(posing, "nuisance_prior", other)
    changed = identify(trials, MODEL, ALONE)
    for name in FEW:
        truth = MODEL.value(name)
        assert changed.value(name) == pytest.approx(usual.value(name), abs=0.02 * abs(truth)), name


@pytest.mark.study(turn="each")
def test_noise_alone_never_contradicts_a_prior():
    """Ten records with nothing wrong but noise, of either colour."""
    for seed in range(5):
        for kind in (white, waves):
            fit = identify([noisy(zigzag(10), seed, kind)], MODEL, ALONE)
            assert fit.contradicted == {}, (seed, kind)


def test_the_start_is_read_off_the_record_and_one_struck_sample_is_no_start():
    trial = noisy(zigzag(10), 3)
    r = trial.signals["r"].copy()
    mean, deviation = nuisance_prior(MODEL, trial, "r(0)", 0.0005)
    assert abs(mean - np.mean(r[:20])) < deviation < 0.2 * np.std(r) + 0.01
    r[0] = 1.0
    struck = replace(trial, signals={**trial.signals, "r": r})
    assert nuisance_prior(MODEL, struck, "r(0)", 0.0005)[0] == pytest.approx(mean, abs=deviation)
    low, high = limits((mean, deviation))
    assert low < mean < high


@pytest.mark.parametrize("kind", [white, waves])
def test_the_first_roll_rate_is_read_off_the_heel_however_the_record_begins(kind):
    """Begun in forty places, for a ship that rolls in 8 s as 175 m do at the shortest."""
    quiet, means, free = zigzag(20), [], []
    fastest = np.std(quiet.signals["phi"]) * 2.0 * np.pi / 8.0
    truth = np.gradient(quiet.signals["phi"], quiet.period)
    places = range(60, 1260, 30)
    for place in places:
        begun = piece_from(noisy(quiet, place, kind), place)
        mean, deviation = nuisance_prior(MODEL, begun, "p(0)", 0.001)
        means.append(mean)
        free.append(deviation)
    assert np.max(np.abs(means - truth[places]) / free) < 3.0
    assert np.corrcoef(means, truth[places])[0, 1] > 0.6
    assert np.median(free) < 0.3 * fastest


def test_a_struck_heel_leaves_the_first_roll_rate_open():
    trial = noisy(zigzag(20), 5)
    whole = nuisance_prior(MODEL, trial, "p(0)", 0.001)
    phi = trial.signals["phi"].copy()
    phi[2] = 1.0
    struck = replace(trial, signals={**trial.signals, "phi": phi})
    mean, deviation = nuisance_prior(MODEL, struck, "p(0)", 0.001)
    assert abs(mean - whole[0]) < deviation
    assert deviation > 3.0 * whole[1]


def test_a_record_that_begins_in_a_turn_lets_the_ship_drift():
    trial = zigzag(10)
    begun = piece_from(trial, 200)
    turning, straight = (nuisance_prior(MODEL, t, "v(0)", 0.1)[1] for t in (begun, trial))
    assert turning > straight
    assert straight == pytest.approx(0.05 * 7.33, rel=0.05)


def test_a_held_out_trial_that_begins_in_a_gap_is_simulated_all_the_same():
    """What stands in the gap, 1 rad/s, is outside what the model knows, and is no start."""
    trial = noisy(zigzag(10), 4)
    check = noisy(zigzag(20, use="check"), 5)
    r, there = check.signals["r"].copy(), check.valid["r"].copy()
    r[:4], there[:4] = 1.0, False
    gap = replace(check, signals={**check.signals, "r": r}, valid={**check.valid, "r": there})
    fit, whole = (identify([trial, t], MODEL, SETTINGS).scores[1] for t in (gap, check))
    assert fit.response.departure is None
    for output, eps in whole.eps_rmsn.items():
        assert fit.eps_rmsn[output] == pytest.approx(eps, rel=0.05)


# --- what weighs them -----------------------------------------------------------------------------


def ar(rho, n, seed):
    e = np.random.default_rng(seed).standard_normal(n)
    for k in range(1, n):
        e[k] += rho * e[k - 1]
    return e


@pytest.mark.parametrize(("rho", "expected"), [(0.0, 1.0), (0.5, 3.0), (0.9, 19.0)])
def test_colour_is_how_many_rows_say_the_same(rho, expected):
    """Of a first-order process: (1 + rho) / (1 - rho)."""
    n = 40_000
    part = Stretch(0, 0, slice(0, n), np.ones(n, bool))
    assert colour_of(ar(rho, n, 1), [part]) == pytest.approx(expected, rel=0.15)


def test_rows_of_what_is_known_are_the_gradient_of_what_they_say():
    problem = pose_problem([noisy(zigzag(10), 6)], MODEL, ALONE)
    weighing = Weighing(problem)
    theta = problem.start * 1.01 + np.array([0.01 * x.size for x in problem.unknowns])
    residual, psi = weighing(theta)
    for i, x in enumerate(problem.unknowns):
        step = 1e-6 * max(abs(theta[i]), x.size)
        moved = theta.copy()
        moved[i] += step
        rows = (residual - weighing(moved)[0])[weighing.rows :] / step
        np.testing.assert_allclose(rows, psi[weighing.rows :, i], rtol=1e-4, atol=1e-9)
    assert len(residual) - weighing.rows == len(weighing.held) + 2  # GM and the damping


def test_the_level_follows_where_the_search_stands():
    problem = pose_problem([noisy(zigzag(10), 7)], MODEL, ALONE)
    weighing = Weighing(problem)
    far, near = problem.start * 1.05, problem.start
    point = weighing(far)
    before = weighing.level
    weighing.again(near, weighing(near))
    assert weighing.level < 0.5 * before
    assert weighing.level == pytest.approx(level_of(problem, weighing(near)[0][: weighing.rows]))
    assert len(point[0]) == len(weighing(near)[0])


def test_the_middle_of_what_ships_have_pulls_nowhere():
    problem = pose_problem([noisy(zigzag(10), 8)], MODEL, ALONE)
    roll, theta = problem.roll, problem.start.copy()
    theta[roll.GM] = GM_OVER_L * 175.0
    theta[roll.Kp] = roll.damping(theta[roll.GM], DAMPING_RATIO)
    np.testing.assert_allclose(roll.rows(theta)[0], 0.0, atol=1e-12)
    theta[roll.GM] *= 3.0
    assert roll.rows(theta)[0][0] == pytest.approx(-1.0)


def test_critical_damping_is_that_of_the_roll_equation():
    """K = Kp p of the model's own effect against 2 sqrt(stiffness x inertia), in SI."""
    problem = pose_problem([noisy(zigzag(10), 8)], MODEL, ALONE)
    L, U, rho = 175.0, 7.33, 1025.0
    Kp = problem.roll.damping(0.3, 1.0)
    linear = next(e for e in MODEL.effects if e.name == "linear_roll")
    [force] = linear({"p": 1.0 * L / U, "phi": 0.0, "rho": 2.0, "g": 0.0, "nabla": 0.0,
                      "Kp": Kp, "GM": 0.0})  # fmt: skip
    assert isinstance(force, Force)
    inertia = 0.5 * rho * L**5 * (0.0000176 + 0.0000034)
    critical = 2.0 * np.sqrt(rho * 9.81 * 21222.0 * 0.3 * inertia)
    assert -force.K * 0.5 * rho * L**3 * U**2 == pytest.approx(critical, rel=1e-6)
