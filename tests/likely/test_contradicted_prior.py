"""What the record contradicts of a ship's file moves nothing else of it: a GM keeps its range.

Of 100 fits of an outsider's ships, whose rudders heel them four times as much as their files say,
43 ranges of GM ended below the truth: inertias in roll went down with the rudder's moment.
"""

from dataclasses import replace

import numpy as np
import pytest
from s175q import OUTPUTS, SHIP, white, with_noise, zigzag

from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.examine import examine_fit
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.identification.ship_priors import ship_priors
from trialid.progress import silent
from trialid.ship.model import ShipModel

FREE = ("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM")
LINEAR = ("linear_hull", "linear_rudder", "linear_roll")
KNOWN = {"I_xx": 0.26, "Kpdot": 0.47, "Kdelta": 0.65, "GM": 0.71, "Kp": 0.72, "Kv": 0.57}


def model(ship):
    """The linear model of a ship."""
    return ShipModel(ship, ("v", "p", "r", "phi"), tuple(CATALOGUE[e] for e in LINEAR))


def sailed(ship, seed):
    """Her zig-zags of 10 and 20 deg with noise."""
    made = []
    for angle in (10, 20):
        trial = zigzag(angle, model(ship))
        made.append(with_noise(trial, *white(np.random.default_rng([seed, angle]), trial.samples)))
    return made


def gm_of(seed, stronger, lever=1.0):
    """The row of GM of a ship whose rudder heels her so many times what her file says.

    And sway, by a lever that is so many times her file's, as her rudder's is.
    """
    truth = replace(SHIP, mass={**SHIP.mass, "I_xx": 1.1 * SHIP.mass["I_xx"]})
    file = replace(
        SHIP,
        coefficients=SHIP.coefficients
        | {"Kdelta": SHIP.coefficients["Kdelta"] / stronger / lever}
        | {n: SHIP.coefficients[n] / lever for n in ("Kv", "Kr")},
        uncertainty={"default": 0.3, **KNOWN},
    )
    known = model(file)
    settings = Settings(FREE, OUTPUTS, priors=ship_priors(known, FREE), priors_of_ship=True)
    fit = identify(sailed(truth, seed), known, settings)
    assert fit.converged
    found, _ = examine_fit(fit, DiagnoseSettings(), silent)
    [row] = [one for one in found.own_accuracy.physical if one.name == "GM"]
    return row, fit.contradicted


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", [1, pytest.param(2, marks=pytest.mark.study(turn="each"))])
def test_a_rudder_unlike_her_files_leaves_gm_its_range(seed):
    row, against = gm_of(seed, stronger=4.0)
    low, high = row.likely
    truth = SHIP.coefficients["GM"]
    assert "Kdelta" in against
    assert low < truth < high
    own, _ = gm_of(seed, stronger=1.0)
    assert high - low < 1.5 * np.diff(own.likely)


@pytest.mark.parametrize("seed", [3, pytest.param(4, marks=pytest.mark.study(turn="each"))])
def test_a_lever_unlike_her_files_does_not_lower_gm(seed):
    """Each for itself three moments of a lever twice as long say that her inertia is less."""
    row, _ = gm_of(seed, stronger=2.0, lever=2.0)
    low, high = row.likely
    assert low < SHIP.coefficients["GM"] < high
