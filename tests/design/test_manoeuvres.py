import numpy as np
import pytest
from waters import ROLL, VESSEL, D

from trialid.design import manoeuvres, signals
from trialid.design.helm import carry_out


def sailed(instructions, duration=1200.0, approach=20.0):
    return carry_out(VESSEL, instructions, approach, duration)


def reversals(passage):
    """Samples at which the order changes side."""
    order = passage.trial.signals["delta_order"]
    return np.flatnonzero(order[1:] * order[:-1] < 0) + 1


@pytest.mark.parametrize(("angle", "heading"), [(10, 10), (20, 10), (5, 15)])
def test_a_zigzag_reverses_where_the_heading_says(angle, heading):
    passage = sailed(manoeuvres.zigzag(angle * D, heading * D))
    psi, order = (passage.trial.signals[n] for n in ("psi", "delta_order"))
    turns = reversals(passage)
    assert len(turns) > 5
    assert set(np.round(np.unique(order) / D)) == {-angle, 0, angle}
    for k in turns:
        side = np.sign(order[k - 1])
        assert side * psi[k] >= heading * D > side * psi[k - 1]


def test_a_zigzag_counts_from_its_own_course():
    def drifting():
        yield from manoeuvres.turning_circle(10 * D, 30 * D)
        yield from manoeuvres.zigzag(10 * D, 10 * D, 4)

    passage = sailed(drifting())
    psi, turns = passage.trial.signals["psi"], reversals(passage)
    assert (psi[turns[0]] - psi[turns[1]]) / D == pytest.approx(20.0, abs=0.5)
    assert psi[turns[0]] / D > 39.0


def test_a_turning_circle_turns_by_so_much_to_its_side():
    for side in (1, -1):
        passage = sailed(manoeuvres.turning_circle(side * 35 * D))
        psi, order = (passage.trial.signals[n] for n in ("psi", "delta_order"))
        end = int(np.flatnonzero(order)[-1]) + 1
        assert side * psi[end] / D == pytest.approx(540.0, abs=1.0)


def test_after_a_pull_out_a_stable_ship_steadies():
    passage = sailed(manoeuvres.pull_out(20 * D, 90 * D, 900.0))
    r = passage.trial.signals["r"]
    assert np.abs(r[-20:]).max() < 0.02 * np.abs(r).max()


def test_a_spiral_ends_each_angle_when_the_rate_of_turn_is_steady():
    angles = np.array([15.0, 10.0, 5.0, -5.0, -10.0]) * D
    passage = sailed(manoeuvres.spiral(angles, 30.0, 400.0), 2500.0)
    r, order = (passage.trial.signals[n] for n in ("r", "delta_order"))
    ends = np.flatnonzero(np.diff(order))[1:6]
    np.testing.assert_allclose(order[ends], angles)
    for k in ends:
        assert abs(r[k] - r[k - 60]) <= 0.021 * abs(r[k]) + 2e-5


def test_a_reversed_spiral_steers_to_its_rates():
    rates = np.array([0.3, 0.1, -0.1, -0.3]) * D
    passage = sailed(
        manoeuvres.reversed_spiral(rates, 20.0, 60.0, 20 * D, 250.0, 2.0), 1010.0, approach=5.0
    )
    r = passage.trial.signals["r"]
    for i, rate in enumerate(rates):
        end = round((5.0 + 2.0 + 250.0 * (i + 1)) / 0.5) - 4
        assert r[end] == pytest.approx(rate, abs=0.03 * D)
    assert np.abs(passage.trial.signals["delta_order"]).max() <= 20 * D


def test_a_modified_spiral_has_its_period():
    passage = sailed(manoeuvres.modified_spiral(np.array([10, 20, -20, -10]) * D, 100.0))
    order = passage.trial.signals["delta_order"][40:]
    np.testing.assert_array_equal(order[200:2000], order[:1800])
    assert [round(a / D) for a in order[[0, 50, 100, 150]]] == [10, 20, -20, -10]


def test_roll_is_excited_and_left_to_die():
    period = 2 * np.pi / ROLL
    passage = sailed(manoeuvres.roll_excitation(10 * D, period, 4, 150.0), 300.0, 0.0)
    phi, t = passage.trial.signals["phi"], passage.trial.t
    driven, free = phi[t < 4 * period], phi[t > 4 * period + 5]
    steady = sailed(manoeuvres.turning_circle(10 * D), 300.0, 0.0).trial.signals["phi"]
    assert np.abs(driven).max() > 1.5 * np.abs(steady).max()
    assert np.abs(free[-60:]).max() < 0.7 * np.abs(free[:60]).max()


def test_steps_last_as_long_as_told():
    passage = sailed(manoeuvres.step_sequence([0.1, -0.2, 0.0], [30.0, 10.0, 60.0]), 200.0, 0.0)
    order = passage.trial.signals["delta_order"]
    assert list(np.flatnonzero(np.diff(order)) + 1) == [60, 80]


def test_the_binary_test_has_one_angle_and_switches_on_the_grid():
    numbers = signals.lines(1200.0, ROLL).numbers
    phases = np.linspace(0.0, 6.0, len(numbers))
    test = manoeuvres.multi_frequency_binary(
        10 * D, numbers, np.ones(len(numbers)), phases, 1200.0, 0.5, hold=4
    )
    order = sailed(test, approach=0.0).trial.signals["delta_order"]
    np.testing.assert_allclose(np.unique(np.abs(order)), [10 * D])
    assert np.all((np.flatnonzero(np.diff(order)) + 1) % 4 == 0)


def test_most_of_a_binary_tests_energy_lies_on_its_lines():
    """Jensen 1959: the sign of a multisine keeps most of the energy where it was."""
    numbers = signals.lines(1200.0, ROLL).numbers
    t = np.arange(2400) * 0.5
    omega = 2 * np.pi * np.array(numbers) / 1200.0
    phases = np.random.default_rng(4).uniform(0, 2 * np.pi, len(numbers))
    order = signals.binary(signals.multisine(t, 1.0, np.ones(len(numbers)), omega, phases), 1.0, 1)
    power = np.abs(np.fft.rfft(order)) ** 2
    assert power[list(numbers)].sum() / power[1:].sum() > 0.6
