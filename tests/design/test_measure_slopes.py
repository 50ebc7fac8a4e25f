"""Slopes of the standard measures, against ships that are sailed anew with a number changed."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from s175q import MODEL, SHAFT
from waters import VESSEL, D

from trialid.design import standard
from trialid.design.helm import Passage, vessel
from trialid.design.imo.measure_slopes import measure_slopes, until_amidships
from trialid.design.standard import acts_in_calm, in_calm, predict
from trialid.effects import CATALOGUE
from trialid.errors import DesignError
from trialid.ship.effect import Effect, Parameter, Steered, effect
from trialid.trial import Trial

KNOWN = ("Nv", "Nr", "Ndelta", "Ydelta", "GM", "Nrdot", "Nrar", "Xrr", "Xdd", "KT0", "b_r")
NAMES = (
    "advance",
    "tactical diameter",
    "initial turning",
    "first overshoot 10/10",
    "second overshoot 10/10",
    "first overshoot 20/20",
    "second overshoot 20/20",
)


@dataclass(frozen=True)
class Missing:
    """An effect that may be missing, with its columns from a place on."""

    effect: Effect
    columns: tuple[int, ...]
    parameters: tuple[str, ...] = ()
    tried: dict[str, float] = None

    @classmethod
    def at(cls, name, place):
        parameters = tuple(n for n, p in CATALOGUE[name].parameters.items() if p.null == 0.0)
        columns = tuple(range(place, place + len(parameters)))
        return cls(CATALOGUE[name], columns, parameters, {})


@pytest.fixture(autouse=True, scope="module")
def _fine_clock():
    """Four times as fine: a helmsman who reverses a sample later makes differences uncertain."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(standard, "STEPS", 800)
        patch.setattr(standard, "LENGTHS", 30.0)
        yield


def sailed(model, ship=VESSEL):
    """Every measure of a ship with this model."""
    one = vessel(model, ship.period, ship.constants, ship.rudder_rate)
    return np.array([m.value for m in predict([one])])


def by_sailing(make, step, ship=VESSEL):
    """The slopes by a central difference."""
    return (sailed(make(step), ship) - sailed(make(-step), ship)) / (2.0 * step)


def assert_alike(slopes, expected, step):
    """Each within 2 % of the largest move there is of its kind, metres and degrees apart."""
    for kind in (slice(0, 3), slice(3, 7)):
        room = 0.02 * np.abs(expected[kind]).max() + 1e-3 / abs(step)
        assert slopes[kind] == pytest.approx(expected[kind], abs=room)


def measured(found):
    """Names in the order of the criteria, and their slopes by row."""
    order = [list(found.values).index(n) for n in NAMES]
    return found.by[order]


@pytest.fixture(scope="module")
def known():
    return measure_slopes(VESSEL, KNOWN, (), 0)


def test_the_measures_are_those_that_are_predicted(known):
    assert [known.values[n] for n in NAMES] == [m.value for m in predict([VESSEL])]


@pytest.mark.parametrize("name", KNOWN[:-1])
def test_slopes_by_what_the_ship_has(known, name):
    """Forces of hull and rudder, stiffness, an added mass, surge: 2 % more and less of each."""
    value = MODEL.value(name)
    step = 0.02 * abs(value)
    expected = by_sailing(lambda x: MODEL.with_values({name: value + x}), step)
    assert_alike(measured(known)[:, KNOWN.index(name)], expected, step)
    assert np.abs(expected).max() > 0.0


def test_what_the_ship_has_not_moves_nothing(known):
    assert not known.by[:, KNOWN.index("b_r")].any()


RIVALS = ("yaw_cubic_rrr", "hull_asymmetry", "rudder_slipstream", "displacement_error")


def test_slopes_by_what_may_be_missing():
    """At their null: a cubic, two constants, the propeller's race, a mass."""
    missing, place = [], 0
    for name in RIVALS:
        missing.append(Missing.at(name, place))
        place += len(missing[-1].columns)
    found = measured(measure_slopes(VESSEL, ("Nr",), missing, place))
    for one in missing:
        for parameter, column in zip(one.parameters, one.columns, strict=True):
            step = 0.05 * abs(one.effect.parameters[parameter].start)

            def make(x, one=one, parameter=parameter):
                return (MODEL + one.effect).with_values({**one.effect.nulls, parameter: x})

            assert_alike(found[:, 1 + column], by_sailing(make, step), step)


SENSORS_AND_WEATHER = ("lag_r", "bias_phi", "delay_psi", "steady_wind", "current_in_speed_record")


def test_what_is_logged_wrong_or_is_weather_moves_nothing():
    """In calm water a ship with a slow gyro turns as any other."""
    assert not any(acts_in_calm(CATALOGUE[n]) for n in SENSORS_AND_WEATHER)
    assert acts_in_calm(CATALOGUE["rudder_record_delay"])  # it may be the gear that is late
    places, missing = 0, []
    for name in SENSORS_AND_WEATHER:
        missing.append(Missing.at(name, places))
        places += len(missing[-1].columns)
    assert not measure_slopes(VESSEL, (), missing, places).by.any()


def test_a_gear_is_tried_at_its_value():
    """A servo of 4 s instead of a rudder that follows at its rate: not linear in anything."""
    tried = Missing(CATALOGUE["rudder_servo"], (0,), (), {"T_delta": 4.0})
    found = measure_slopes(VESSEL, (), [tried], 1)
    with_it = sailed((MODEL + tried.effect).with_values({"T_delta": 4.0}))
    assert measured(found)[:, 0] == pytest.approx(with_it - sailed(MODEL))
    assert measured(found)[3, 0] > 0.3  # a slower rudder overshoots more


def test_a_slow_gear_that_is_still_on_its_way_when_it_is_reversed():
    """At 0.4 deg/s the rudder takes 50 s for a 10/10, and is reversed before it has arrived."""
    slow = replace(VESSEL, rudder_rate=0.4 * D)
    found = measured(measure_slopes(slow, ("Nr",), (), 0))[:, 0]
    value = MODEL.value("Nr")
    step = 0.02 * abs(value)
    expected = by_sailing(lambda x: MODEL.with_values({"Nr": value + x}), step, slow)
    assert_alike(found, expected, step)


@effect(source="a wheel that is off")
def wheel(*, off=Parameter(0.01, "rad")):
    """The rudder is delta + off: more rudder than is ordered, to one side."""
    return Steered(delta=off)


def test_the_helmsman_answers():
    """A rudder that is off by 1 deg: the heading reaches 10 deg sooner, and he reverses sooner.

    With his orders as they were given the overshoots would move four and ten times as far.
    """
    missing = Missing(wheel, (0,), ("off",), {})
    found = measured(measure_slopes(VESSEL, (), [missing], 1))[:, 0]
    step = 0.2 * D
    expected = by_sailing(lambda x: (MODEL + wheel).with_values({"off": x}), step)
    assert_alike(found, expected, step)
    assert found[0] < 0.0  # more rudder, less advance
    assert found[3] * found[4] < 0.0


def test_a_ship_whose_speed_is_given():
    """The same without surge: her track is at the approach speed."""
    model = replace(MODEL, states=("v", "p", "r", "phi"))
    ship = vessel(model, 0.5, {"n": SHAFT}, 2.5 * D)
    found = measured(measure_slopes(ship, ("Nr",), (), 0))[:, 0]
    value = model.value("Nr")
    step = 0.02 * abs(value)
    expected = by_sailing(lambda x: model.with_values({"Nr": value + x}), step, ship)
    assert_alike(found, expected, step)


def test_calm_water_has_no_wind_and_no_sensors():
    windy = MODEL + CATALOGUE["steady_wind"] + CATALOGUE["lag_r"]
    wind = {"F_N": 2e-4, "F_E": 2e-4, "x_wind": 0.1, "z_wind": 0.05, "k_wind": 0.3}
    windy = windy.with_values({**wind, "T_r": 3.0})
    left = in_calm(vessel(windy, 0.5, VESSEL.constants, VESSEL.rudder_rate)).model.effects
    assert left == MODEL.effects
    assert sailed(windy) == pytest.approx(sailed(MODEL))


def test_a_ship_that_leaves_her_model_on_the_approach_is_told() -> None:
    """Turned by her rudder's zero alone where a number that is changed makes her unstable."""
    n = 8
    signals = {name: np.zeros(n) for name in ("delta_order", "delta", "psi", "r", "v")}
    trial = Trial("zig-zag 20/20", "check", 0.5, signals, {})
    lost = Passage(trial, np.zeros(n), np.zeros(n), None)
    with pytest.raises(DesignError, match="zig-zag 20/20: the ship leaves her model on the appr"):
        until_amidships(lost)
