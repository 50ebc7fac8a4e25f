"""What carries over: blocks left out in turn, against the same done by fitting each anew."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, waves, with_noise, zigzag
from scipy.signal import lfilter

from trialid.diagnosis.search import backward, carry_over
from trialid.diagnosis.search.carried import Carried, as_good
from trialid.diagnosis.search.carry_over import BLOCKS, WHOLE, LeftOut, left_out, own_errors
from trialid.diagnosis.search.score import rank
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.trial_rows import Stretch

TRIALS, SAMPLES, SHARED, OWN, EFFECTS = 3, 240, 3, 2, 5
ROWS = TRIALS * SAMPLES


def smooth(rng, columns, memory=20.0):
    """Slow columns, as traces of physical effects are."""
    keep = np.exp(-1.0 / memory)
    return lfilter([1.0], [1.0, -keep], rng.standard_normal((ROWS + 200, columns)), axis=0)[200:]


def made(seed, hidden=0.0, noise=1.0, priors=None, trials=TRIALS):
    """Columns of a made-up fit, the first effect hidden in the residual; as `left_out` takes them.

    `hidden` may be one number for each trial: then the effect does not carry over.
    """
    rng = np.random.default_rng(seed)
    psi = np.zeros((ROWS, SHARED + trials * OWN))
    psi[:, :SHARED] = smooth(rng, SHARED)
    length = ROWS // trials
    parts = [
        Stretch(i, 0, slice(i * length, (i + 1) * length), np.ones(length, dtype=bool))
        for i in range(trials)
    ]
    for i, part in enumerate(parts):
        at = SHARED + i * OWN
        psi[part.rows, at : at + OWN] = smooth(rng, OWN)[part.rows]
    S = smooth(rng, EFFECTS)
    size = np.repeat(np.broadcast_to(hidden, trials), length)
    residual = noise * rng.standard_normal(ROWS) + size * S[:, 0]
    unknowns = tuple(
        SimpleNamespace(name=f"x{i}", trial=None if i < SHARED else (i - SHARED) // OWN,
                        prior=(priors or {}).get(i))
        for i in range(psi.shape[1])
    )  # fmt: skip
    fit = SimpleNamespace(
        problem=SimpleNamespace(unknowns=unknowns, weights=np.ones(1)), at_bounds={}, level=noise,
        theta=np.zeros(psi.shape[1]), eps_by_output={"r": 1.0},
    )  # fmt: skip
    return fit, residual, psi, S, tuple(parts)


def by_hand(fit, residual, psi, S, parts, columns):
    """The same, each block fitted anew by least squares, nuisances over the whole of a trial."""
    X = np.column_stack([residual, psi[:, :SHARED], S[:, columns]])
    for i, part in enumerate(parts):
        N = psi[part.rows][:, SHARED + i * OWN : SHARED + (i + 1) * OWN]
        X[part.rows] -= N @ np.linalg.lstsq(N, X[part.rows], rcond=None)[0]
    pieces = -(-BLOCKS // len(parts))
    block = np.concatenate([
        i * pieces + np.arange(len(p.compared)) * pieces // len(p.compared)
        for i, p in enumerate(parts)
    ])  # fmt: skip
    errors = []
    for k in range(block.max() + 1):
        fitted, out = X[block != k], X[block == k]
        theta = np.linalg.lstsq(fitted[:, 1:], fitted[:, 0], rcond=None)[0]
        errors.append(np.sum((out[:, 0] - out[:, 1:] @ theta) ** 2))
    return np.array(errors)


@pytest.mark.parametrize("columns", [[], [0], [1, 3], [0, 2, 4]])
def test_it_is_each_block_fitted_anew_without_fitting(columns):
    record = made(1, hidden=0.5)
    found = left_out(*record)
    np.testing.assert_allclose(found.errors(columns).whole, by_hand(*record, columns), rtol=1e-8)
    assert len(found.errors().whole) == BLOCKS


@pytest.mark.parametrize(("trials", "blocks"), [(1, 6), (2, 6), (3, 6), (4, 8), (5, 5), (8, 8)])
def test_five_trials_are_blocks_themselves_and_fewer_are_cut(trials, blocks):
    *rest, parts = made(2, trials=trials)
    for each in (parts, (*parts, Stretch(trials, 0, slice(ROWS, ROWS), np.zeros(3, dtype=bool)))):
        assert len(left_out(*rest, each).errors().whole) == blocks
    assert blocks >= BLOCKS or trials == WHOLE


@pytest.mark.parametrize("seed", [3, 13, 23])
def test_an_effect_that_is_there_carries_over(seed):
    true, *wrong = [left_out(*made(seed, hidden=0.4)).carried([i]) for i in range(EFFECTS)]
    assert true.ratio < 0.5
    assert true.better == true.blocks
    assert true.steady
    assert true.falls
    assert min(c.ratio for c in wrong) > 0.8  # slow traces in short records are a little alike
    assert min(c.price(1) for c in wrong) > 0.3 * true.price(1)


def test_where_nothing_is_hidden_hardly_anything_carries_over():
    """Five made-up effects in each of twenty records of white noise: ours, none of 100 falls."""
    found = [left_out(*made(50 + seed)).carried([i]) for seed in range(20) for i in range(EFFECTS)]
    print(f"{sum(c.falls for c in found)} of {len(found)} fall")
    assert sum(c.falls for c in found) <= 3
    assert np.median([c.ratio for c in found]) > 1.0


def test_an_effect_of_another_sign_in_every_trial_carries_nothing_over():
    """It would lower the fitted error of each trial for itself; between trials it is no effect."""
    same = left_out(*made(4, hidden=(0.4, 0.4, 0.4), trials=3)).carried([0])
    turned = left_out(*made(4, hidden=(0.4, -0.4, 0.4), trials=3)).carried([0])
    assert same.falls
    assert not turned.falls
    assert same.price(1) < turned.price(1)


def test_what_each_trial_has_for_itself_hides_no_effect():
    """A trace that nuisances of the trials all but mimic is seen beside the shared ones."""
    fit, residual, psi, S, parts = made(5, hidden=0.0)
    rng = np.random.default_rng(6)
    faint = 0.05 * smooth(rng, 1)[:, 0]
    for i, part in enumerate(parts):
        faint[part.rows] += (
            psi[part.rows] @ np.r_[np.zeros(SHARED), np.eye(TRIALS)[i].repeat(OWN) * 3.0]
        )
    residual = residual + 10.0 * faint
    found = left_out(fit, residual, psi, np.column_stack([faint, S]), parts).carried([0])
    assert found.seen > 0.5
    assert found.falls


def test_a_trace_that_shared_parameters_mimic_is_faint_and_comes_after():
    fit, residual, psi, S, parts = made(7, hidden=0.5)
    faint = psi[:, 0] + 0.02 * S[:, 0]
    record = fit, residual, psi, np.column_stack([S[:, 0], faint]), parts
    plain, hidden = (left_out(*record).carried([i]) for i in (0, 1))
    assert hidden.ratio == pytest.approx(plain.ratio, rel=0.05)
    assert hidden.seen < 0.01 < plain.seen
    assert hidden.price(1) > 0.5 * plain.price(1)


def test_a_prior_holds_a_nuisance_as_the_fit_does():
    """A nuisance that is known stays where it is: the effect cannot hide behind it."""
    fit, residual, psi, S, parts = made(8, hidden=0.3)
    psi[:, SHARED:] = 0.0
    for i, part in enumerate(parts):
        psi[part.rows, SHARED + i * OWN] = S[part.rows, 0]  # mimics the effect in its own trial
    known = {SHARED + i * OWN: (0.0, 1e-6) for i in range(TRIALS)}
    unknowns = tuple(
        SimpleNamespace(name=x.name, trial=x.trial, prior=known.get(i))
        for i, x in enumerate(fit.problem.unknowns)
    )
    problem = SimpleNamespace(unknowns=unknowns, weights=np.ones(1))
    held = SimpleNamespace(**{**vars(fit), "problem": problem})
    assert left_out(held, residual, psi, S, parts).carried([0]).falls
    free = left_out(fit, residual, psi, S, parts).carried([0])
    assert free.ratio == pytest.approx(1.0, abs=0.01)  # rounding is all that is left of it


def test_what_lies_at_a_bound_stays_there():
    fit, residual, psi, S, parts = made(9)
    at_bound = SimpleNamespace(**{**vars(fit), "at_bounds": {"x0": 1.0}})
    dropped = psi.copy()
    dropped[:, 0] = 0.0
    np.testing.assert_allclose(
        left_out(at_bound, residual, psi, S, parts).errors().whole,
        left_out(fit, residual, dropped, S, parts).errors().whole, rtol=1e-9,
    )  # fmt: skip


def test_units_and_the_order_of_trials_do_not_matter():
    fit, residual, psi, S, parts = made(10, hidden=0.3)
    one = left_out(fit, residual, psi, S, parts).carried([0])
    scaled = left_out(fit, residual, psi * 1e-4, S * 1e6, parts).carried([0])
    assert scaled.ratio == pytest.approx(one.ratio, rel=1e-9)
    turned = left_out(fit, residual, psi, S, tuple(reversed(parts))).carried([0])
    assert turned.ratio == pytest.approx(one.ratio, rel=1e-9)
    assert turned.better == one.better


def test_errors_are_compared_block_by_block():
    old, new = (4.0, 3.0, 5.0, 4.0, 6.0, 5.0), (3.0, 2.1, 4.2, 2.9, 5.0, 4.1)
    assert not as_good(new, old)
    assert as_good(old, new)
    assert as_good(old, (4.1, 2.9, 5.2, 3.8, 6.1, 4.9))
    assert Carried(old, new).better == 6
    assert Carried(old, new).worth == pytest.approx(27.0 / 21.3)
    assert Carried(new, old).worth < 1.0
    assert Carried(new, old).ratio > 1.0
    assert not Carried(new, old).falls
    one_block = Carried((9.0, 1.0, 1.0, 1.0), (1.0, 1.1, 1.1, 1.1))  # all of it in one block
    assert one_block.ratio < 0.5
    assert not one_block.falls


def test_no_blocks_no_claim():
    assert not Carried((), ()).falls
    assert not isinstance(left_out(*made(1)), Carried)
    assert isinstance(left_out(*made(1)), LeftOut)


# --- on ships -----------------------------------------------------------------------------------

FREE = ("Nv", "Nr", "Ndelta", "Yv", "Kv", "Kr", "Kdelta", "Kp", "GM")
FIT = replace(SETTINGS, free=FREE)


@pytest.fixture(scope="module")
def sailed():
    """Zig-zags of a ship with quadratic roll damping, one held out, and the fit that lacks it."""
    truth = (MODEL + CATALOGUE["quadratic_roll_damping"]).with_values({"Kpap": -2e-4})
    rng = np.random.default_rng(41)
    trials = []
    for amplitude in (5, 10, 20):
        trial = zigzag(amplitude, truth, use="check" if amplitude == 10 else "fit")
        trials.append(with_noise(trial, *waves(rng, trial.samples)))
    return trials, identify(trials, MODEL, FIT)


def with_damping(trials, value=None):
    effect = CATALOGUE["quadratic_roll_damping"]
    settings = FIT if value is not None else replace(FIT, free=(*FREE, "Kpap"))
    return identify(trials, (MODEL + effect).with_values({"Kpap": value or -1e-4}), settings)


def test_foreseen_and_refitted_agree_on_what_carries_over(sailed):
    trials, fit = sailed
    ranking, _ = rank(fit, CATALOGUE)
    foreseen = {c.effect.name: c.carried for c in ranking}["quadratic_roll_damping"]
    refitted = Carried.between(own_errors(fit), own_errors(with_damping(trials)))
    print(f"left-out squared error x {foreseen.ratio:.3f} foreseen, {refitted.ratio:.3f} refitted")
    assert foreseen.before == pytest.approx(own_errors(fit).whole)
    assert refitted.ratio == pytest.approx(foreseen.ratio, abs=0.06)
    assert foreseen.falls
    assert refitted.falls


def test_damping_of_the_wrong_sign_makes_left_out_blocks_worse(sailed):
    trials, fit = sailed
    before = own_errors(fit)
    assert Carried.between(before, own_errors(with_damping(trials, -2e-4))).ratio < 0.95
    assert Carried.between(before, own_errors(with_damping(trials, +1e-5))).ratio > 1.0


def test_leaving_it_out_again_costs_what_it_brought(sailed, monkeypatch):
    trials, _ = sailed
    full = with_damping(trials)
    effect = CATALOGUE["quadratic_roll_damping"]
    (worth,) = backward.worths(full, trials, [effect])
    assert worth.pays
    assert worth.costs > 1.05
    assert backward.worth_naming([worth]) == (effect.name,)
    assert backward.to_drop(full, [worth]) is None
    idle = (MODEL + effect + CATALOGUE["sway_froude"]).with_values({"Kpap": -1e-4})
    grown = identify(trials, idle, replace(FIT, free=(*FREE, "Kpap", "Yv_F")))  # it is not there
    both = backward.worths(grown, trials, [effect, CATALOGUE["sway_froude"]])
    assert [w.effect for w in both] == [effect.name, "sway_froude"]
    assert not both[1].pays
    fitted = []
    monkeypatch.setattr(backward, "identify", lambda *_, **__: fitted.append(1))
    known = backward.worths(grown, trials, [effect, CATALOGUE["sway_froude"]], known=both)
    assert known == both
    assert not fitted  # no model twice


BEFORE = (1.0, 1.1, 0.9, 1.0, 1.05, 0.95)


def test_what_is_hardly_seen_must_fall_further_to_be_worth_a_name():
    """A sixteenth off the squared error: a name for what is seen, none for 0.2 % of a trace."""
    after = tuple(0.94 * x for x in BEFORE)
    assert Carried(BEFORE, after, seen=0.2).falls
    assert not Carried(BEFORE, after, seen=0.002).falls
    assert Carried(BEFORE, tuple(0.7 * x for x in BEFORE), seen=0.002).falls


def test_what_ended_at_a_bound_in_one_fit_is_moved_in_neither(monkeypatch):
    """A gain that one block alone teaches: at its bound before the effect, found with it."""
    fit, residual, psi, S, parts = made(2, hidden=2.0)
    psi[ROWS // BLOCKS :, 0] *= 0.01
    psi[:, SHARED : SHARED + OWN] = 0.0  # its own trial's would carry it over the block's end
    monkeypatch.setattr(carry_over, "stretches", lambda problem: parts)
    of = {**vars(fit), "eps_rmsn": 1.0}
    before = SimpleNamespace(**{**of, "at_bounds": {"x0": 0.0}}, residual=residual, psi=psi)
    noise = residual - 2.0 * S[:, 0]
    after = SimpleNamespace(**of, residual=noise, psi=psi)
    apart = Carried.between(own_errors(before), own_errors(after))
    carried = carry_over.carried_between(before, after)
    assert apart.before[0] == pytest.approx(carried.before[0])
    assert apart.after[0] > 10.0 * carried.after[0]
    assert carried.falls
    assert carried.better == BLOCKS
    back = carry_over.carried_between(after, before)
    assert back.after == pytest.approx(carried.before)
