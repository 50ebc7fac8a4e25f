"""All forces that a hull usually has, at once, where no effect and no two of them stand alone."""

import re
from dataclasses import replace

import pytest
from s175q import SHIP
from test_usual_forces import begun, drawn, fitted, sailed

from trialid.diagnosis.force.usual_forces import hull_at_once
from trialid.diagnosis.search.together import stands
from trialid.effects import CATALOGUE

SEED = 27
BEYOND = re.compile("[YN](phi|p)|Kphi|[YNK][vr]a[vr]")
"""Coefficients of what a linear model has not."""


@pytest.fixture(scope="module")
def fit():
    return begun(sailed(drawn(SEED), SEED))


@pytest.mark.study(turn="each")
def test_it_stands_every_check_with_none_of_its_forces_at_an_end(fit):
    found = hull_at_once(fit, CATALOGUE)
    assert stands(fit, found)
    assert len(found.effects) > 5
    assert found.fit.eps_rmsn < 0.7 * fit.eps_rmsn
    new = {n for effect in found.effects for n in effect.parameters}
    assert new <= {*found.fit.settings.free}
    assert not new & {*found.fit.at_bounds}
    assert {*fit.settings.free} <= {*found.fit.settings.free}


def test_only_what_is_tried_is_in_it(fit):
    few = {n: CATALOGUE[n] for n in ("sway_drag_vav", "yaw_drag_rar", "roll_drag_vav", "heel_yaw")}
    found = hull_at_once(fit, few)
    assert found is None or {*found.names} <= {*few}
    assert hull_at_once(fit, {}) is None


@pytest.mark.study(turn="each")
def test_a_ship_without_them_has_none():
    """Fitted to the noise without, all of them take no tenth of the squared error off."""
    none = dict.fromkeys((n for n in SHIP.coefficients if BEYOND.fullmatch(n)), 0.0)
    plain = begun(sailed(replace(SHIP, coefficients=SHIP.coefficients | none), SEED))
    assert hull_at_once(plain, CATALOGUE) is None


def test_nothing_holds_so_many_without_her_file():
    assert hull_at_once(fitted(SHIP, sailed(drawn(SEED), SEED), by_ship=False), CATALOGUE) is None
