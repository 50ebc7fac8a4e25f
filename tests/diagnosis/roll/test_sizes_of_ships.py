"""What may be missing is as large as the ship: a range is no other of her model."""

from dataclasses import replace

import pytest
from decays import Roller

from trialid.diagnosis.may_be_off import doubts
from trialid.diagnosis.restated import restates
from trialid.diagnosis.search.augment import augment
from trialid.effects import CATALOGUE
from trialid.errors import EffectError
from trialid.ship.effect import Force, Parameter, effect
from trialid.workflow.notebook.front import diagnose

SHIPS = {"model": (3.1, 0.02, 1.0), "ship": (110.0, 0.8, 6.0)}


def fitted(length, GM, speed, free=("Kp", "GM")):
    her = Roller(length=length, GM=GM, ratio=0.04)
    return her.fit(her.decays(13, speed=speed), free=free)


@pytest.mark.parametrize(("length", "GM", "speed"), SHIPS.values(), ids=SHIPS)
def test_exact_numbers_are_believed_at_any_scale(length, GM, speed):
    """Her model's GM could have been 1.5 times off, and Kp by 4e7 %."""
    fit = fitted(length, GM, speed)
    rows = {row.name: row for row in diagnose(fit).result.physical}
    for name in ("GM", "Kp"):
        low, high = rows[name].likely
        assert low < fit.value(name) < high
        assert high - low < 0.5 * abs(fit.value(name))


def test_typical_values_of_a_model_are_those_of_the_ship_by_froude():
    """Moments grow with the fourth power of the length, seconds with its root."""
    damping = CATALOGUE["still_water_roll_damping"].of_ship(175.0 / 49.0).parameters["Kp0"]
    assert damping.start == pytest.approx(-1e6 / 49.0**4.5)
    GM = CATALOGUE["linear_roll"].of_ship(17.5).parameters["GM"]
    assert GM.start == pytest.approx(0.05)
    assert GM.of_ship(17.5) == GM
    assert CATALOGUE["heel_roll"].of_ship(3.0) is CATALOGUE["heel_roll"]


def test_a_search_and_a_model_know_the_ships_own_size():
    fit = fitted(*SHIPS["model"])
    traced = {t.effect.name: t.effect for t in augment(fit, CATALOGUE).traces}
    times = 3.1 / 175.0
    for name, parameter in (("static_list", "a_0"), ("righting_arm_cubic", "GM3")):
        plain, sized = (e.parameters[parameter].start for e in (CATALOGUE[name], traced[name]))
        assert sized == pytest.approx(plain * times)
        grown = fit.model + CATALOGUE[name]
        assert grown.parameters[parameter].start == pytest.approx(plain * times)


def test_what_is_free_is_no_doubt_said_in_other_words():
    free, held = (fitted(*SHIPS["ship"], free=f) for f in (("Kp", "GM"), ("Kp",)))
    wrong = CATALOGUE["metacentric_height_error"]
    assert restates(wrong, free)
    assert not restates(wrong, held)
    assert not restates(CATALOGUE["heel_roll"], free)
    asked = {n: CATALOGUE[n] for n in ("metacentric_height_error", "heel_roll")}
    missing = {t.effect.name for t in doubts(augment(free, asked)).missing}
    assert missing == {"heel_roll"}


def test_a_mass_that_is_free_is_no_doubt_either():
    fit = fitted(*SHIPS["ship"])
    error = CATALOGUE["roll_inertia_error"]
    assert not restates(error, fit)
    unknowns = (*fit.problem.unknowns, replace(fit.problem.unknowns[0], column="I_xx"))
    assert restates(error, replace(fit, problem=replace(fit.problem, unknowns=unknowns)))


def test_a_value_that_does_not_grow_with_a_ship_is_of_no_length():
    with pytest.raises(EffectError, match="not known to grow"):

        @effect(source="none")
        def odd(p, *, K_odd=Parameter(1.0, "rad", of_length=100.0)):
            """K = K_odd p: none."""
            return Force(K=K_odd * p)
