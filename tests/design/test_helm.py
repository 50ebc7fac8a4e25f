import numpy as np
import pytest
from waters import VESSEL, D

from trialid.design.helm import Follow, Hold, carry_out, sail, track, vessel
from trialid.design.rudders import ramp
from trialid.effects import CATALOGUE
from trialid.errors import DesignError
from trialid.ship.model import ShipModel


def at(passage, *times):
    """Sample numbers of instants [s]."""
    return [round(t / passage.trial.period) for t in times]


def test_orders_are_carried_out_after_the_approach():
    def told():
        yield Hold(5 * D, 30.0)
        yield Hold(-10 * D, 20.0)

    passage = carry_out(VESSEL, told(), 10.0, 100.0)
    order = passage.trial.signals["delta_order"]
    assert len(order) == 201
    changes = np.flatnonzero(np.diff(order)) + 1
    np.testing.assert_array_equal(changes, at(passage, 10, 40, 60))
    np.testing.assert_allclose(order[changes], [5 * D, -10 * D, 0.0])


def test_the_rudder_follows_at_the_gears_rate():
    def told():
        yield Hold(20 * D, 50.0)

    rudder = carry_out(VESSEL, told(), 0.0, 50.0).trial.signals["delta"]
    assert np.diff(rudder).max() == pytest.approx(5 * D * VESSEL.period)
    assert rudder[at_four_seconds := round(4.0 / VESSEL.period)] == pytest.approx(20 * D)
    assert rudder[at_four_seconds - 1] < 20 * D


def test_a_condition_ends_an_order_at_the_sample_it_holds_at():
    def told():
        yield Hold(10 * D, 1e4, lambda motion: motion["psi"] >= 10 * D)

    passage = carry_out(VESSEL, told(), 20.0, 300.0)
    psi, order = (passage.trial.signals[n] for n in ("psi", "delta_order"))
    end = int(np.flatnonzero(order)[-1]) + 1
    assert psi[end] >= 10 * D > psi[end - 1]


def test_a_look_shows_the_ship_as_she_is():
    seen = {}

    def told():
        seen["first"] = (yield Hold(0.0, 0.0))()
        seen["then"] = (yield Hold(10 * D, 60.0))()

    passage = carry_out(VESSEL, told(), 20.0, 200.0)
    motion = passage.trial.signals
    assert seen["first"]["t"][-1] == 20.0
    for name in ("psi", "r", "phi"):
        np.testing.assert_allclose(seen["then"][name], motion[name][: len(seen["then"]["t"])])
    assert seen["then"]["t"][-1] == 80.0


def test_orders_written_down_in_advance_are_followed_to_the_end_of_the_trial():
    orders = 5 * D * np.sin(np.arange(500) / 20)

    def told():
        yield Follow(orders)

    passage = carry_out(VESSEL, told(), 0.0, 100.0)
    np.testing.assert_array_equal(passage.trial.signals["delta_order"], orders[:201])
    again = sail(VESSEL, orders[:201])
    np.testing.assert_array_equal(again["r"], passage.trial.signals["r"])


def test_a_circle_closes_its_track():
    def told():
        yield Hold(15 * D, 1e4)

    passage = carry_out(VESSEL, told(), 0.0, 3000.0)
    psi = passage.trial.signals["psi"]
    turn = np.flatnonzero(psi > psi[-1] - 2 * np.pi)[0]
    span = np.hypot(np.ptp(passage.x[turn:]), np.ptp(passage.y[turn:]))
    assert np.hypot(passage.x[-1] - passage.x[turn], passage.y[-1] - passage.y[turn]) < 0.01 * span


def test_a_track_by_hand():
    t = np.array([0.0, 10.0, 20.0])
    east = {"u": np.full(3, 2.0), "v": np.full(3, 1.0), "psi": np.full(3, np.pi / 2)}
    x, y = track(t, east, 9.0)
    np.testing.assert_allclose(x, [0, -10, -20], atol=1e-12)
    np.testing.assert_allclose(y, [0, 20, 40])
    x, _ = track(t, {"psi": np.zeros(3)}, 9.0)
    np.testing.assert_allclose(x, [0, 90, 180])


def test_a_ship_that_leaves_her_model_ends_her_trial_there():
    def told():
        yield Hold(35 * D, 1e4)

    wild = ShipModel(
        VESSEL.model.ship, VESSEL.model.states, VESSEL.model.effects,
        {**VESSEL.model.values, "Kr": 0.01},
    )  # fmt: skip
    passage = carry_out(vessel(wild, 0.5, VESSEL.constants, 5 * D), told(), 20.0, 600.0)
    assert passage.departure is not None
    assert passage.trial.duration < passage.departure.t + 1.0
    assert all(np.isfinite(values).all() for values in passage.trial.signals.values())


def test_a_ship_that_cannot_turn_is_refused():
    still = ShipModel(VESSEL.model.ship, ("p", "phi"), ())
    with pytest.raises(DesignError, match="put r among the states"):
        vessel(still, 0.5, {}, 5 * D)


def test_a_rudder_never_runs_past_its_order():
    orders = np.repeat([0.1, -0.2, 0.05, 0.0], 40)
    followed = ramp(orders, 0.011)
    assert followed.max() <= 0.1
    assert followed.min() >= -0.2
    assert followed[-1] == 0.0


def test_where_she_is_can_be_an_output_as_well():
    """Positions, and what receivers make of them; a test to come is rated by all outputs."""

    def told():
        yield Hold(20 * D, 300.0)

    passage = carry_out(VESSEL, told(), 20.0, 300.0)
    signals, valid = passage.trial.signals, passage.trial.valid
    np.testing.assert_array_equal(signals["x"], passage.x)
    np.testing.assert_array_equal(signals["y"], passage.y)
    assert all(valid[n].all() for n in ("x", "y", "sog", "cog"))
    run = np.hypot(*np.gradient(np.stack([passage.x, passage.y]), VESSEL.period, axis=1))
    np.testing.assert_allclose(signals["sog"], run)
    ahead = signals["cog"] - signals["psi"]
    assert abs(ahead[30]) < 1e-6
    assert np.all(ahead[-20:] < -0.02)  # she drifts outwards


def test_what_only_changes_her_log_is_no_part_of_a_ship_under_orders():
    """A gyro that is late and off; a rudder whose record is early acts late, and stays."""

    def told():
        yield Hold(10 * D, 60.0)

    reading = {"delay_r": {"tau_r": 5.0}, "bias_r": {"b_r": 0.01}, "scale_r": {"e_r": 0.3}}
    model = VESSEL.model
    for name, values in reading.items():
        model = (model + CATALOGUE[name]).with_values(values)
    read = vessel(model, VESSEL.period, VESSEL.constants, VESSEL.rudder_rate)
    assert not {*reading} & {e.name for e in read.model.effects}
    bare, own = (carry_out(one, told(), 5.0, 60.0).trial.signals["r"] for one in (VESSEL, read))
    np.testing.assert_array_equal(own, bare)
    outputs = read.simulator.outputs
    assert outputs == VESSEL.simulator.outputs
    early = (VESSEL.model + CATALOGUE["rudder_record_delay"]).with_values({"tau_delta": 1.0})
    ready = vessel(early, VESSEL.period, VESSEL.constants, VESSEL.rudder_rate)
    assert "rudder_record_delay" in {e.name for e in ready.model.effects}
