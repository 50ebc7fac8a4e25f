"""A split of the error within what other fits leave, and refused where routes contradict."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.diagnosis.noise import noise_bound
from trialid.diagnosis.noise.error_parts import Split
from trialid.diagnosis.noise.noise_bound import held_against
from trialid.diagnosis.noise.split import INPUT_DRIVEN, STATED
from trialid.diagnosis.search.carried import Errors
from trialid.diagnosis.search.completeness import Completeness

OUTPUTS = ("r", "phi")


@pytest.fixture(autouse=True)
def _left_out(monkeypatch):
    """What a stand-in leaves on rows that it was not fitted to, it says."""
    monkeypatch.setattr(noise_bound, "own_errors", lambda fit: Errors((fit.outside**2,), ()))
    monkeypatch.setattr(noise_bound, "share_at_own_frequencies", lambda fit: fit.slow)


def fit(eps, effects=(), converged=True, outside=0.0, estimates=("Nr",), slow=0.0):
    """A fit as far as its errors go."""
    made = SimpleNamespace(
        eps_rmsn=eps, eps_by_output=dict.fromkeys(OUTPUTS, eps), converged=converged,
        model=SimpleNamespace(effects=[SimpleNamespace(name=n) for n in effects]),
        residual=np.full(10**6, eps / 1000.0), outside=outside or eps,
        estimates=dict.fromkeys(estimates, 0.0), slow=slow,
        problem=SimpleNamespace(unknowns=[SimpleNamespace(trial=t) for t in (None, 0, 1)]),
    )  # fmt: skip
    made.examined = made
    return made


def route(method, noise, interval, total=0.10):
    """A route's split of an error of 10 %."""
    low, high = interval
    rest = [max(total**2 - x**2, 0.0) ** 0.5 for x in (noise, high, low)]
    by_output = dict.fromkeys(OUTPUTS, (noise, rest[0]))
    return Split(method, "", noise, rest[0], interval, (rest[1], rest[2]), by_output)


QUIET = route("quiet stretch", 0.08, (0.07, 0.09))
NOTHING_MORE, A_FORCE = Completeness(5.0, 8.0), Completeness(5.0, 90.0)


def test_no_more_noise_than_another_model_leaves():
    """8 % of noise, at least 7: with an effect more 7.5 % is left in all."""
    base = fit(0.10, ("a",))
    held = held_against(QUIET, (QUIET,), base, [fit(0.075, ("a", "b")), fit(0.09, ("a", "c"))])
    assert held.method == "quiet stretch"
    assert held.noise == pytest.approx(0.075)
    assert held.noise_interval == pytest.approx((0.07, 0.075), rel=1e-4)
    assert held.noise**2 + held.undermodelling**2 == pytest.approx(0.10**2)
    low, high = held.undermodelling_interval
    assert low == QUIET.undermodelling_interval[0]
    assert low <= held.undermodelling <= high
    for noise, model in held.by_output.values():
        assert noise == pytest.approx(0.075)
        assert noise**2 + model**2 == pytest.approx(0.10**2)


def test_what_parameters_took_up_of_the_noise_is_in_the_interval_and_not_in_the_figure():
    """One that the trials share tells by what the error grows; two more are the trials' own."""
    held = held_against(QUIET, (QUIET,), fit(0.10), [fit(0.075, outside=0.076)])
    assert held.noise == pytest.approx(0.075)
    assert held.noise_interval[1] == pytest.approx(
        (0.075**2 + 3.0 * (0.076**2 - 0.075**2)) ** 0.5, rel=1e-4
    )
    barely = held_against(QUIET, (QUIET,), fit(0.10), [fit(0.0695, outside=0.0705)])
    assert barely.available
    assert barely.noise == pytest.approx(0.0695)


def test_a_route_that_no_interval_saves_is_refused_with_both_figures():
    held = held_against(QUIET, (QUIET,), fit(0.10, ("a",)), [fit(0.065, ("a", "b"))])
    assert not held.available
    assert "8.00% (7.00% to 9.00%)" in held.why
    assert "with b in the model only 6.50% is left" in held.why


@pytest.mark.parametrize("other", [
    fit(0.03, ("b",), converged=False),  # a search that stopped somewhere says nothing
    fit(0.12, ("b",)),  # a worse one neither
    fit(0.095, ("b",)),  # and this one leaves room
])  # fmt: skip
def test_other_fits_change_nothing_else(other):
    assert held_against(QUIET, (QUIET,), fit(0.10), [other]).noise == QUIET.noise


@pytest.mark.parametrize(("other", "whole", "contradicts"), [
    (route("repeated manoeuvre", 0.05, (0.04, 0.06)), None, True),
    (route("repeated manoeuvre", 0.095, (0.092, 0.098)), None, True),
    (route("repeated manoeuvre", 0.065, (0.055, 0.075)), None, False),
    # noise is what does not depend on the input, at most
    (route(INPUT_DRIVEN, 0.06, (0.055, 0.065)), A_FORCE, True),
    # and less where the catalogue does not hold what depends on it; then a force shows
    (route(INPUT_DRIVEN, 0.098, (0.095, 0.10)), A_FORCE, False),
    (route(INPUT_DRIVEN, 0.098, (0.095, 0.10)), NOTHING_MORE, True),
    # a sensor's own figure is the least that noise is
    (route(STATED, 0.05, (0.05, 0.05)), None, False),
    (route(STATED, 0.095, (0.095, 0.095)), None, True),
])  # fmt: skip
def test_routes_are_held_against_each_other(other, whole, contradicts):
    held = held_against(QUIET, (QUIET, other), fit(0.10), (), whole)
    assert held.available is not contradicts
    if contradicts:
        assert f"{QUIET.noise:.2%}" in held.why
        assert f"{other.noise:.2%}" in held.why
        assert other.method in held.why
        assert held.at_most == (other.noise if other.method == INPUT_DRIVEN else None)
    turned = held_against(other, (other, QUIET), fit(0.10), (), whole)
    unknown = other.method == INPUT_DRIVEN and whole is A_FORCE  # what is missing is no candidate
    assert turned.available is not (contradicts or unknown)


def test_what_is_no_split_stays_none():
    none = Split("not separable", "no route holds")
    assert held_against(none, (none,), fit(0.10), [fit(0.01)]) is none


def test_slopes_of_a_model_that_lacks_something_do_not_say_what_noise_is():
    """On real zig-zags 13 % were called noise where a third structure leaves 9 % in all."""
    by_input = route(INPUT_DRIVEN, 0.06, (0.055, 0.065))
    held = held_against(by_input, (by_input,), fit(0.10, ("a",)), [fit(0.08, ("a", "b"))])
    assert not held.available
    assert "not told without b" in held.why
    assert held.at_most == by_input.noise  # what does not depend on the input is the most it can be
    freed = fit(0.08, ("a",), estimates=("Nr", "Ydelta"))
    held = held_against(by_input, (by_input,), fit(0.10, ("a",)), [freed])
    assert "not told without Ydelta freed" in held.why
    small = held_against(by_input, (by_input,), fit(0.10, ("a",)), [fit(0.0995, ("a", "b"))])
    assert small.available


@pytest.mark.parametrize(
    ("slow", "noise", "separable"),
    [
        (0.70, 0.08, False),  # 0.36 of the square is the model's: 0.34 of 0.64 are slow noise
        (0.66, 0.08, True),
        (0.45, 0.099, True),
        (0.55, 0.099, False),
    ],
)
def test_what_is_as_slow_as_the_ship_is_no_noise(slow, noise, separable):
    """What the split calls the model's may be as slow as it likes; half of the noise may not."""
    by_input = route(INPUT_DRIVEN, noise, (0.9 * noise, 0.1))
    held = held_against(by_input, (by_input,), fit(0.10, ("a",), slow=slow))
    assert held.available is separable
    if not separable:
        assert held.at_most == noise
        assert "as slow as the ship herself" in held.why
    quiet = route("quiet stretch", noise, (0.9 * noise, 0.1))  # there she stands still
    assert held_against(quiet, (quiet,), fit(0.10, ("a",), slow=slow)).available
