"""What a name is not told from beside single effects: two others at once, and what is held."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, SHIP, white, with_noise, zigzag

from trialid.diagnosis import meant_as_well
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.examine import examine_fit
from trialid.diagnosis.meant_as_well import (
    Freed,
    also_from,
    beside_others,
    held_before,
    held_instead,
    two_instead,
)
from trialid.diagnosis.search.freed import free_coefficient
from trialid.diagnosis.search.refit import refit
from trialid.diagnosis.search.score import rank
from trialid.diagnosis.verdict import Verdict
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.result.missing_rows import verdict_part

FREE = ("Nv", "Nr", "Ndelta", "Yv")
TWO = ("yaw_drag_rar", "heel_yaw")
TRIED = {n: CATALOGUE[n] for n in (*TWO, "heel_yaw_cubic", "yaw_cubic_rrr")}


def silent(words):
    """Say nothing of how far it is."""


def sailed(truth):
    """Zig-zags of 10 and 20 deg as she sails them, with noise."""
    made = []
    for angle in (10, 20):
        trial = zigzag(angle, truth)
        made.append(with_noise(trial, *white(np.random.default_rng(angle), trial.samples)))
    return made


def tried(fit, name):
    """The model with one effect more."""
    ranking, _ = rank(fit, {name: CATALOGUE[name]})
    [found] = refit(fit, ranking, silent)
    return found


@pytest.fixture(scope="module")
def without_two():
    """A fit that lacks two effects, both four times those of the ship's file."""
    truth = MODEL.with_values({n: 4.0 * MODEL.value(n) for n in ("Nrar", "Nphi")})
    base = replace(MODEL, effects=tuple(e for e in MODEL.effects if e.name not in TWO))
    return identify(sailed(truth), base, replace(SETTINGS, free=FREE))


def test_two_do_what_one_of_four_coefficients_does(without_two):
    named = tried(without_two, "heel_yaw_cubic")
    found = two_instead(without_two, named, ("heel_yaw_cubic",), TRIED, 4, silent)
    assert found is not None
    assert {*found.names} == {*TWO}


def test_what_is_told_already_is_not_told_as_one_of_two(without_two):
    named = tried(without_two, "heel_yaw_cubic")
    told = ("heel_yaw_cubic", *TWO)
    assert two_instead(without_two, named, told, TRIED, 4, silent) is None


def test_two_are_no_plainer_than_one_coefficient(without_two):
    named = tried(without_two, "yaw_cubic_rrr")
    assert two_instead(without_two, named, ("yaw_cubic_rrr",), TRIED, 4, silent) is None


@pytest.mark.parametrize(("knows", "told"), [(0.3, True), (0.05, False)])
def test_what_is_held_is_told_as_far_as_its_source_lets_it_be_off(knows, told):
    """Of a ship whose added masses are 1.5 times what her file says; all else is weighed."""
    water = {name: 1.5 * SHIP.mass[name] for name in ("Nrdot", "Yvdot")}
    known = replace(SHIP, uncertainty={"default": 0.0, **dict.fromkeys(water, knows)})
    trials = sailed(replace(MODEL, ship=replace(SHIP, mass={**SHIP.mass, **water})))
    fit = identify(trials, replace(MODEL, ship=known), replace(SETTINGS, free=FREE))
    found = held_instead(fit, tried(fit, "yaw_inertia_error"), silent)
    assert (found is not None) is told
    if found is not None:
        assert {*found.moved} == {*water}


def test_of_a_dozen_that_are_held_those_are_told_that_do_as_well_alone():
    """Her file says of each how far it may be off; two are, by what does little to the error.

    All were freed, and those told that lay one deviation off: freed alone they did nothing.
    """
    water = {name: 1.15 * SHIP.mass[name] for name in ("Nrdot", "Yvdot")}
    known = replace(SHIP, uncertainty={"default": 0.02, **dict.fromkeys(water, 0.2)})
    trials = sailed(replace(MODEL, ship=replace(SHIP, mass={**SHIP.mass, **water})))
    fit = identify(trials, replace(MODEL, ship=known), replace(SETTINGS, free=FREE))
    found = held_instead(fit, tried(fit, "yaw_inertia_error"), silent)
    assert found is not None
    assert {*found.fit.settings.free} == {*FREE, *found.moved}
    assert 2 <= len(found.moved) < 10
    named = tried(fit, "yaw_inertia_error").fit
    assert found.fit.eps_rmsn < 0.5 * (fit.eps_rmsn + named.eps_rmsn)


def test_a_coefficient_that_is_freed_is_no_rival_of_itself():
    """Of a ship whose yaw moment of drift is 1.5 times her file's, and all else is known."""
    known = replace(SHIP, uncertainty={"default": 0.0, "Nvav": 0.3})
    truth = MODEL.with_values({"Nvav": 1.5 * MODEL.value("Nvav")})
    fit = identify(sailed(truth), replace(MODEL, ship=known), replace(SETTINGS, free=FREE))
    freed = {"Nvav": free_coefficient(fit.model, "Nvav")}
    ranking, _ = rank(fit, freed)
    [named] = refit(fit, ranking, silent)
    assert held_instead(fit, named, silent) is None
    [other] = refit(fit, rank(fit, {"rudder_cubic": CATALOGUE["rudder_cubic"]})[0], silent)
    assert held_instead(fit, other, silent).moved == ("Nvav",)


@pytest.mark.parametrize(
    ("effect", "short", "as_well"),
    [
        ("yaw_drag_rar", 0.008, True),
        ("yaw_drag_rar", 0.02, False),
        ("heel_yaw_cubic", 0.03, True),
        ("heel_yaw_cubic", 0.05, False),
    ],
)
@pytest.mark.parametrize("alone", [False, True])
def test_what_is_held_does_as_well_but_for_what_parameters_are_worth(
    without_two, monkeypatch, effect, short, as_well, alone
):
    """By the whole error, or by each output's own alone: a coarse one hides what another shows.

    And 1 % for each of its coefficients, of which the second has four.
    """
    named = tried(without_two, effect)
    of, more = named.carried, np.exp(short)
    own = tuple(more * x for x in of.own[1])
    after = of.after if alone else tuple(more * x for x in of.after)
    made = Freed(named.fit, ("m",), replace(of, after=after, own=(of.own[0], own)))
    monkeypatch.setattr(meant_as_well, "_sought", lambda *asked: made)
    whole = SimpleNamespace(foretold=lambda still=(): 1.0, still=lambda known: set())
    monkeypatch.setattr(meant_as_well, "_slopes", lambda *asked: whole)
    assert held_instead(without_two, named, silent) is (made if as_well else None)


def test_where_what_is_held_does_as_well_nothing_has_a_name(without_two):
    named = tried(without_two, "yaw_drag_rar")
    found = held_before(without_two, named, Freed(named.fit, ("m", "Yv", "Yr"), named.carried))
    assert (found.kind, found.effect, found.family) == ("cannot tell", None, ())
    assert verdict_part(found, None).held_as_well == ("m", "Yv", "Yr")
    before, after = (f"{fit.eps_rmsn:.2%}" for fit in (without_two, named.fit))
    assert found.sentence == (
        f"yaw_drag_rar takes the error from {before} to {after}, and numbers that are held do as "
        f"well, off by at most twice what is known of each: to {after}, by m and Yv most of 3. "
        "Free all of them before any effect is added, and look again"
    )


NONE = Verdict("not in catalogue", None, (), "no effect explains it")


def beside(fit):
    """What is said of it where no effect explains it."""
    asked = DiagnoseSettings(candidates={})
    parts = examine_fit(fit, asked, lambda words, share: None)[0].split
    return beside_others(fit, NONE, None, parts, None, asked=asked, progress=silent)


@pytest.mark.parametrize(("knows", "kind"), [(0.3, "cannot tell"), (0.02, "not in catalogue")])
def test_nothing_lies_outside_the_catalogue_that_what_is_held_explains(knows, kind):
    """Of a ship whose added masses are 1.5 times her file's; a file that is sure shuts them out."""
    water = {name: 1.5 * SHIP.mass[name] for name in ("Nrdot", "Yvdot")}
    known = replace(SHIP, uncertainty={"default": 0.0, **dict.fromkeys(water, knows)})
    trials = sailed(replace(MODEL, ship=replace(SHIP, mass={**SHIP.mass, **water})))
    fit = identify(trials, replace(MODEL, ship=known), replace(SETTINGS, free=FREE))
    found = beside(fit)
    assert found.kind == kind
    assert {*found.held_as_well} == ({*water} if kind == "cannot tell" else set())


def test_what_is_held_and_leaves_more_than_noise_explains_nothing(without_two):
    """Two numbers are four times those of a file that is sure to 1 %: what is held takes a part."""
    known = replace(SHIP, uncertainty={"default": 0.01})
    fit = identify(without_two.trials, replace(MODEL, ship=known), without_two.settings)
    assert beside(fit) is NONE


@pytest.mark.parametrize(
    ("family", "said"),
    [
        (("a",), "a is missing; this record cannot tell it from b and c together"),
        (("a", "b"), "a is missing; nor from b and c together"),
    ],
)
def test_two_at_once_are_said_after_what_is_said(family, said):
    found = Verdict("missing", "a", family, "a is missing")
    assert also_from(found, SimpleNamespace(names=("b", "c"))).sentence == said
    assert also_from(found, None) is found


@pytest.mark.parametrize(
    ("name", "two", "kind"),
    [
        ("steady_wind", ("yaw_drag_rar", "heel_yaw"), "cannot tell"),
        ("steady_wind", ("yaw_drag_rar", "bias_r"), "missing"),
        ("heel_yaw_cubic", ("yaw_drag_rar", "heel_yaw"), "missing"),
        ("compass_deviation", ("yaw_drag_rar", "heel_yaw"), "missing"),
    ],
)
def test_what_nobody_recorded_gives_way_to_two_of_the_ship(monkeypatch, name, two, kind):
    """A ship in gusts of 1 m/s about none had a steady wind; rudder and hull did as much."""
    pair = SimpleNamespace(
        names=two, effects=[CATALOGUE[n] for n in two], fit=SimpleNamespace(eps_rmsn=0.03)
    )
    monkeypatch.setattr(meant_as_well, "two_instead", lambda *_: pair)
    named = SimpleNamespace(
        candidate=SimpleNamespace(effect=CATALOGUE[name]), fit=SimpleNamespace(eps_rmsn=0.02)
    )
    found = Verdict("missing", name, (name,), f"{name} is missing")
    asked = DiagnoseSettings(candidates={}, coefficients=False)
    monkeypatch.setattr(meant_as_well, "tried_effects", lambda *_: {})
    fit = SimpleNamespace(eps_rmsn=0.05)
    said = beside_others(fit, found, named, None, None, asked=asked, progress=silent)
    assert (said.kind, said.pair_as_well) == (kind, two)
    assert (said.effect is None) == (kind == "cannot tell")
    assert "2.00%" in said.sentence or kind == "missing"


def test_two_at_once_stand_in_the_result_too():
    two = SimpleNamespace(names=("b", "c"))
    row = verdict_part(also_from(Verdict("missing", "a", ("a",), "a is missing"), two), None)
    assert (row.pair_as_well, row.held_as_well, row.family) == (("b", "c"), (), ("a",))


def test_what_is_held_of_the_roll_is_freed_where_no_roll_is_compared(without_two):
    """GM is one of it, and a search of other GMs has nothing to go by there."""
    yaw = replace(without_two.settings, outputs=("r",))
    fit = identify(without_two.trials, without_two.model, yaw)
    found = held_instead(fit, tried(fit, "yaw_drag_rar"), silent)
    assert found is None or "GM" not in found.moved


def test_what_is_held_and_moves_nothing_is_no_hindrance(without_two):
    """Of the yaw alone inertia in roll is in the file, and nothing of it in the record."""
    yaw = replace(MODEL, states=("v", "r"), effects=MODEL.effects[:2])
    known = replace(SHIP, uncertainty={"default": 1e-4})
    trials = [with_speed(trial) for trial in without_two.trials]
    asked = replace(without_two.settings, free=("Nv", "Nr", "Ndelta"), outputs=("r",))
    fit = identify(trials, replace(yaw, ship=known), asked)
    assert held_instead(fit, tried(fit, "yaw_drag_rar"), silent) is None


def test_nothing_is_told_to_be_freed_that_moves_nothing(without_two):
    """An outsider freed 17 numbers of a yaw; eight of them were of the roll and moved nothing."""
    yaw = replace(MODEL, states=("v", "r"), effects=MODEL.effects[:2])
    known = replace(SHIP, uncertainty={"default": 0.3})
    trials = [with_speed(trial) for trial in without_two.trials]
    asked = replace(without_two.settings, free=("Nv", "Nr", "Ndelta"), outputs=("r",))
    fit = identify(trials, replace(yaw, ship=known), asked)
    held = meant_as_well._as_known(fit, ())
    still = meant_as_well._slopes(fit, held).still(held)
    assert {"I_xx", "Kpdot", "Kvdot", "Ypdot", "Kv", "Kr", "Kdelta"} & {*held} <= still
    assert not {"Yvdot", "Nvdot", "Nrdot", "I_zz", "Yv", "Yr", "Ydelta"} & still


def with_speed(trial):
    """The trial with her speed as an input."""
    signals = {**trial.signals, "u": np.full(trial.samples, 7.33)}
    return replace(trial, signals=signals, valid={n: np.ones(trial.samples, bool) for n in signals})
