"""Where the roll that was fitted goes on as a swell does, what bends it has no name."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import s175q
from test_moved_otherwise import said_of

from trialid.diagnosis.objections import SWELL, follows_a_swell, objection
from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.score import Candidate
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
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
        said = said_of(before, refit)
        assert (said.kind, said.effect) == ("cannot tell", None)
        assert "goes on as a swell does" in said.sentence


@pytest.mark.parametrize(
    ("after", "rolls_on", "follows"),
    [
        ({"r": 0.05, "phi": 0.30}, True, True),
        ({"r": 0.05, "phi": 0.30}, False, False),
        ({"r": 0.02, "phi": 0.445}, True, False),  # of the yaw, by its own error
        ({"r": 0.06, "phi": 0.449}, True, False),  # all in all it takes nothing
    ],
)
def test_what_is_mostly_of_the_yaw_keeps_its_name(after, rolls_on, follows) -> None:
    problem = SimpleNamespace(weights=np.ones(2), roll=object())
    before, then = (
        SimpleNamespace(eps_by_output=left, problem=problem)
        for left in ({"r": 0.05, "phi": 0.45}, after)
    )
    assert follows_a_swell(before, SimpleNamespace(fit=then, rolls_on=rolls_on)) is follows
