"""What is said of one candidate: its range, its error foreseen, the chance of any value tried."""

from types import SimpleNamespace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, white, with_noise, zigzag
from scipy.signal import lfilter

from trialid.diagnosis.noise.noise_colour import colour, whiten_rows
from trialid.diagnosis.search import p_value
from trialid.diagnosis.search.bias import foresee_adding
from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.p_value import against_chance
from trialid.diagnosis.search.score import Candidate, _best_of_each, _families, _in_range, rank
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import replace
from trialid.ship.effect import Parameter
from trialid.trial_rows import Stretch


def candidate(name, p_value=0.5, score=1.0, after=0.9, expected=0.1):
    """A candidate of one parameter as far as the record says."""
    effect = SimpleNamespace(name=name, parameters={"a": Parameter(0.1)})
    return Candidate(
        effect=effect,
        expected={"a": expected},
        eps_predicted=0.1,
        score=score,
        p_value=p_value,
        visibility=1.0,
        family=(name,),
        allowed=True,
        carried=Carried((1.0,), (after,)),
    )


@pytest.mark.parametrize(
    ("size", "allowed"),
    [
        (0.0, True),
        (1.0, True),
        (1.24, True),
        (1.26, False),
        (-0.24, True),
        (-0.26, False),
    ],
)
def test_a_value_may_lie_outside_its_range_by_two_and_a_half_errors(size, allowed):
    """Rows of a hundred squares: a coefficient is known to 0.1, and may be from 0 to 1."""
    rows = SimpleNamespace(gram=np.array([[100.0]]), moment=np.array([100.0 * size]))
    evidence = SimpleNamespace(white=rows, inflation=1.0)
    effect = SimpleNamespace(parameters={"a": Parameter(0.5, low=0.0, high=1.0)}, nulls={"a": 0.0})
    trace = SimpleNamespace(effect=effect, columns=(0,), parameters=("a",))
    assert _in_range(evidence, trace) is allowed
    # rows that are a quarter as many as they seem: twice the error
    wider = SimpleNamespace(white=rows, inflation=4.0)
    assert _in_range(wider, trace) is (-0.5 <= size <= 1.5)


def test_the_error_foreseen_is_what_is_left_when_the_effect_has_taken_its_part():
    """By another route: omitted-variable bias on the same columns."""
    hidden = CATALOGUE["quadratic_roll_damping"]
    trial = zigzag(20, (MODEL + hidden).with_values({"Kpap": -2e-3}))
    trial = with_noise(trial, *white(np.random.default_rng(1), trial.samples))
    fit = identify([trial], MODEL, replace(SETTINGS, free=("Nr", "Kp"), nuisance=()))
    (found,), _ = rank(fit, {hidden.name: hidden})
    assert found.eps_predicted == pytest.approx(foresee_adding(fit, hidden).eps_rmsn, rel=0.01)
    assert found.eps_predicted < 0.96 * fit.eps_rmsn


def test_of_several_values_tried_the_chance_is_that_of_any():
    tried = [
        candidate("lag_r", p_value=0.4, score=1.0, after=0.8, expected=2.0),
        candidate("lag_r", p_value=0.01, score=9.0, after=0.95, expected=5.0),
        candidate("lag_r", p_value=0.7, score=0.5, after=0.99, expected=10.0),
    ]
    (best,) = _best_of_each(tried)
    assert best.expected == {"a": 2.0}
    assert (best.p_value, best.score) == (0.01, 9.0)


def test_a_family_is_of_those_whose_traces_are_nearly_parallel():
    """Columns at 10, 40 and 90 degrees to the first: one of them is kin at |cos| > 0.9."""
    angles = np.deg2rad([0.0, 10.0, 40.0, 90.0])
    S = np.array([np.cos(angles), np.sin(angles)])
    made = [candidate(n) for n in "abcd"]
    traces = [SimpleNamespace(effect=c.effect, columns=(i,), tried={}) for i, c in enumerate(made)]
    evidence = SimpleNamespace(white=SimpleNamespace(gram=S.T @ S))
    augmented = SimpleNamespace(traces=traces, evidence=evidence)
    first, second, third, _ = _families(made, augmented, 0.9)
    assert first.family == ("a", "b")
    assert first.cosines == pytest.approx({"b": np.cos(angles[1])})
    assert second.family == ("b", "a")
    assert third.family == ("c",)


def test_chances_of_nothing_are_spread_evenly():
    """A single candidate that is not there: its chance is anything between 0 and 1."""
    n = 1200
    part = (Stretch(0, 0, slice(0, n), np.ones(n, dtype=bool)),)
    found = []
    for seed in range(60):
        rng = np.random.default_rng(seed)
        S = lfilter([1.0], [1.0, -0.9], rng.standard_normal((n, 2)), axis=0)
        Q, _ = np.linalg.qr(S[:, 1:])
        e = rng.standard_normal(n)
        left, column = e - Q @ (Q.T @ e), S[:, :1] - Q @ (Q.T @ S[:, :1])
        (chance,) = against_chance(left, Q, column, [(0,)], part)
        found.append(chance.p_value)
    assert max(found) <= 1.0
    assert 0.35 < np.mean(found) < 0.65
    assert 0.3 < np.mean(np.array(found) < 0.5) < 0.7


def test_rows_are_whitened_to_what_drives_the_noise():
    """A second-order process gives back, sample by sample, the numbers that it was made of."""
    n = 4000
    drive = np.random.default_rng(2).standard_normal(n)
    e = lfilter([1.0], [1.0, -1.5, 0.7], 0.3 * drive)[:, None]
    mask = np.ones((n, 1), dtype=bool)
    known = colour([e], [mask], 2)
    assert known.filters[0] == pytest.approx([1.0, -1.5, 0.7], abs=0.05)
    assert known.deviations[0] == pytest.approx(0.3, rel=0.03)
    rows = whiten_rows(e[:, :, None], mask, known)[:, 0]
    assert np.corrcoef(rows, drive[2:])[0, 1] > 0.99


def test_a_draw_is_the_record_with_blocks_turned_and_all_parameters_fitted_again():
    """Every draw made as a record of its own, and its score worked out block by block."""
    n = 600
    part = (Stretch(0, 0, slice(0, n), np.ones(n, dtype=bool)),)
    rng = np.random.default_rng(3)
    columns = lfilter([1.0], [1.0, -0.99], rng.standard_normal((n, 5)), axis=0)
    Q, _ = np.linalg.qr(columns[:, 1:])
    S = columns[:, :1] - Q @ (Q.T @ columns[:, :1])
    S /= np.linalg.norm(S)
    e = rng.standard_normal(n)
    e -= Q @ (Q.T @ e)
    sums, blocks = p_value._sums(e, Q, S, part), p_value._blocks(part)
    signs = p_value._signs(blocks.max() + 1)[:20]
    found, _ = p_value._scores(sums, [0], signs, signs @ sums.moved)
    for score, sign in zip(found, signs, strict=True):
        turned = sign[blocks] * e
        turned -= Q @ (Q.T @ turned)
        own = np.array([S[blocks == b, 0] @ turned[blocks == b] for b in range(len(sign))])
        gram = np.array([S[blocks == b, 0] @ S[blocks == b, 0] for b in range(len(sign))])
        spread = np.sum((own - own.sum() / gram.sum() * gram) ** 2)
        assert score == pytest.approx(own.sum() ** 2 / spread, rel=1e-9)
