"""An effect is tried under the priors that the pipeline gives it, and so holds its word."""

from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, SETTINGS, SHIP, white, with_noise, zigzag

from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.refit import refit
from trialid.diagnosis.search.rivals import _held_back, rivals
from trialid.diagnosis.search.score import rank
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.ship_priors import ship_priors

FREE = ("Nv", "Nr", "Ndelta")
EFFECT = CATALOGUE["yaw_drag_rar"]


@pytest.fixture(scope="module")
def trials():
    """Of a ship with three times the quadratic yaw damping of her file, which knows a tenth."""
    truth = MODEL.with_values({"Nrar": 3.0 * MODEL.value("Nrar")})
    made = []
    for angle in (10, 20):
        trial = zigzag(angle, truth)
        made.append(with_noise(trial, *white(np.random.default_rng(angle), trial.samples)))
    return made


def tried(trials, *, by_ship):
    """What the refit finds, and what the fit of the larger model from the file finds."""
    base = replace(MODEL - "yaw_drag_rar", ship=replace(SHIP, uncertainty={"default": 0.1}))
    larger = base + EFFECT
    held = ship_priors(base, FREE) if by_ship else {}
    asked = replace(SETTINGS, free=FREE, priors=held, priors_of_ship=by_ship)
    fit = identify(trials, base, asked)
    ranking, _ = rank(fit, {EFFECT.name: EFFECT})
    [found] = refit(fit, ranking, lambda words: None)
    free = (*FREE, "Nrar")
    every = ship_priors(larger, free) if by_ship else {}
    return found.fit, identify(trials, larger, replace(asked, free=free, priors=every))


@pytest.mark.parametrize("by_ship", [True, False])
def test_the_file_gives_what_was_promised(trials, by_ship):
    promised, given = tried(trials, by_ship=by_ship)
    assert given.eps_rmsn == pytest.approx(promised.eps_rmsn, rel=1e-3)
    assert given.value("Nrar") == pytest.approx(promised.value("Nrar"), rel=0.02)


def test_what_the_ships_file_says_of_it_counts(trials):
    """A tenth about the file's number holds it below three times that."""
    held, _ = tried(trials, by_ship=True)
    loose, _ = tried(trials, by_ship=False)
    assert loose.value("Nrar") == pytest.approx(3.0 * MODEL.value("Nrar"), rel=0.1)
    assert abs(held.value("Nrar")) < 0.99 * abs(loose.value("Nrar"))
    assert "Nrar" in held.contradicted


OTHER = CATALOGUE["yaw_cubic_rrr"]


@pytest.mark.parametrize(("spread", "held"), [(0.05, True), (5.0, False)])
def test_what_is_held_back_by_the_file_may_be_meant_as_well(trials, spread, held):
    """Of three times her file's number the cube does more, where that is held to a twentieth."""
    ship = replace(SHIP, uncertainty={"default": 10.0, "Nrar": spread})
    base = replace(MODEL - "yaw_drag_rar", ship=ship)
    asked = replace(SETTINGS, free=FREE, priors=ship_priors(base, FREE), priors_of_ship=True)
    fit = identify(trials, base, asked)
    ranking, _ = rank(fit, {EFFECT.name: EFFECT, OTHER.name: OTHER})
    cube, square = sorted(
        refit(fit, ranking, lambda words: None), key=lambda r: r.candidate.effect.name
    )
    assert cube.candidate.effect is OTHER
    assert _held_back(square) == held
    assert not _held_back(cube)
    if held:
        assert cube.fit.eps_rmsn < square.fit.eps_rmsn
        assert EFFECT.name in rivals(cube, ranking, (cube, square))
    else:
        assert square.fit.eps_rmsn < cube.fit.eps_rmsn


def test_what_is_held_back_and_would_do_nothing_is_not_meant(trials):
    """By its slope it has to do as well: else no number of it would."""
    ship = replace(SHIP, uncertainty={"default": 10.0, "Nrar": 0.05})
    base = replace(MODEL - "yaw_drag_rar", ship=ship)
    asked = replace(SETTINGS, free=FREE, priors=ship_priors(base, FREE), priors_of_ship=True)
    fit = identify(trials, base, asked)
    ranking, _ = rank(fit, {EFFECT.name: EFFECT, OTHER.name: OTHER})
    found = {r.candidate.effect.name: r for r in refit(fit, ranking, lambda words: None)}
    square, cube = found[EFFECT.name], found[OTHER.name]
    before = square.candidate.carried.before
    idle = replace(square.candidate, carried=Carried(before, before))
    rest = tuple(idle if c.effect is EFFECT else c for c in ranking)
    told = rivals(cube, rest, (cube, replace(square, candidate=idle)))
    assert _held_back(square)
    assert EFFECT.name not in told
