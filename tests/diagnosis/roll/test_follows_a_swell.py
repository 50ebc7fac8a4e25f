"""Where the roll that was fitted goes on as a swell does, what bends it has no name."""

from dataclasses import replace

import numpy as np
import pytest
import s175q

from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.examine import examine_fit
from trialid.diagnosis.objections import SWELL, objection
from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.score import Candidate
from trialid.diagnosis.verdict import decide
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.progress import silent
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

FREE = ("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "GM")
BEND = CATALOGUE["righting_arm_cubic"]
SHIP = (s175q.MODEL + BEND).with_values({"GM3": 8.0})


def sailed(ship: ShipModel) -> list[Trial]:
    """Two zig-zags of a ship."""
    simulator, trials = prepare(ship, (), s175q.OUTPUTS), list[Trial]()
    for i, angle in enumerate((10, 20)):
        blank = s175q.zigzag(angle)
        y = respond(simulator, blank, {}, {"u": 7.33}, sensitivities=False).y
        whole = replace(blank, signals={**blank.signals, "r": y[:, 0], "phi": y[:, 1]})
        noise = s175q.white(np.random.default_rng([61, i]), whole.samples)
        trials.append(s175q.with_noise(whole, *noise))
    return trials


def found(trials: list[Trial], **held: float) -> tuple[Fit, Refit]:
    """The ship without the bend, and with it, her roll damped as her file says or as is found."""
    whole = SHIP.with_values(held)
    free = (*FREE, *(("Kp",) if "Kp" not in held else ()))
    added = tuple(BEND.parameters)
    before = identify(trials, whole - BEND.name, replace(s175q.SETTINGS, free=free))
    after = identify(trials, whole, replace(s175q.SETTINGS, free=(*free, *added)))
    carried = Carried((1.0,) * 8, (0.5,) * 8)
    said = {"eps_predicted": 0.1, "score": 90.0, "p_value": 1e-3, "visibility": 0.5}
    expected = dict.fromkeys(added, 1.0)
    one = Candidate(BEND, expected, **said, family=(), allowed=True, carried=carried)
    return before, Refit(one, after, carried)


@pytest.mark.parametrize(
    ("held", "why"), [({}, ""), ({"Kp": -1e-9}, SWELL)], ids=["her own", "a swell's"]
)
def test_what_bends_a_roll_that_goes_on_has_no_name(held, why) -> None:
    """Damped by next to nothing a roll is a swell's."""
    before, refit = found(sailed(SHIP), **held)
    assert objection(before, refit, 0.05) == why
    if why:
        asked = DiagnoseSettings(candidates={}, coefficients=False)
        split = examine_fit(before, asked, silent)[0].split
        said = decide(before, [refit.candidate], [refit], split, None, 0.05)
        assert (said.kind, said.effect) == ("cannot tell", None)
        assert "goes on as a swell does" in said.sentence
