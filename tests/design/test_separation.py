from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, OUTPUTS
from waters import NOISE, ROLL, SPEED, VESSEL, D

from trialid.design import triangles as module
from trialid.design.kinds import Test, sail
from trialid.design.limits import Limits
from trialid.design.rating import Noise
from trialid.design.search import Search
from trialid.design.separation import ENOUGH, Likeness, Separation, likeness, rivals, separate
from trialid.design.triangles import triangles, triangles_beside, whiten_sensitivities
from trialid.effects import CATALOGUE
from trialid.errors import DesignError
from trialid.identification.problem import Settings

FIVE = ("Yv", "Ydelta", "Nv", "Nr", "Ndelta")
STAIRS = Test(
    "modified_spiral", {"angles": (0.0,) * 4}, 600.0, 30.0,
    {"angles": (-35 * D, 35 * D), "period": (100.0, 600.0)}, "stairs",
)  # fmt: skip
CIRCLE = Test("turning_circle", {}, 600.0, 30.0, {"angle": (5 * D, 35 * D)}, "circle")


def pair(one, other, outputs=OUTPUTS, free=FIVE):
    settings = Settings(free, outputs, nuisance=("initial_state",))
    both = (CATALOGUE[one], CATALOGUE[other])
    return rivals(MODEL, settings, dict(NOISE), both, VESSEL, ROLL, SPEED)


def zigzag(angle, duration=600.0):
    test = Test("zigzag", {"angle": angle * D, "heading": angle * D}, duration, 30.0)
    return sail(test, VESSEL, ROLL).trial


GEAR = pair("rudder_offset", "propeller_side_force")
CROSS = pair("yaw_drag_var", "yaw_drag_rav")
TEN_TEN = zigzag(10)


def test_what_loses_speed_tells_a_rudder_offset_from_a_side_force():
    """The one acts with the speed, the other with the screw: a zig-zag keeps both as they are."""
    before = likeness(GEAR, [TEN_TEN])
    assert before.cosine > 0.95
    found = separate([STAIRS], GEAR, Limits(heel=15 * D), Search(candidates=60, seed=1))
    assert found.after.cosine < 0.6
    assert found.after.separate
    assert found.after == likeness(GEAR, [sail(t, VESSEL, ROLL).trial for t in found.programme])
    again = separate([STAIRS], GEAR, Limits(heel=15 * D), Search(candidates=60, seed=1))
    assert again == found


def test_the_rate_of_turn_alone_cannot_tell_its_bias_from_wind():
    alone = pair("bias_r", "steady_wind", ("r",), ("Yv", "Nv", "Nr", "Ndelta"))
    assert likeness(alone, [TEN_TEN]).cosine > 0.95
    assert likeness(pair("bias_r", "steady_wind"), [TEN_TEN]).cosine < 0.3


def test_a_steady_turn_never_tells_the_two_cross_terms_apart():
    """V |r| = -r |v| where v and r have opposite signs: refused, with the figures."""
    found = separate([CIRCLE], CROSS, Limits(), Search(candidates=12))
    assert found.after.cosine > 0.99
    assert not found.after.separate
    assert found.sentence.startswith(
        "no feasible test separates yaw_drag_var from yaw_drag_rav: the best found leaves |cos| "
    )
    assert f"where {ENOUGH:g} are needed" in found.sentence


def test_trials_so_far_are_fitted_together_with_the_new():
    limits, search = Limits(), Search(candidates=12)
    alone = separate([CIRCLE], GEAR, limits, search)
    added = separate([CIRCLE], GEAR, limits, search, so_far=[TEN_TEN])
    assert alone.before is None
    assert added.before == likeness(GEAR, [TEN_TEN])
    assert min(added.after.odds) > min(added.before.odds)
    assert f" {min(added.before.odds):.0f} so far" in added.sentence


def test_the_odds_are_what_the_record_loses_by_the_wrong_name():
    """Twice the record, twice the odds; and no rival explains more than there is."""
    once, twice = (likeness(GEAR, [TEN_TEN] * n) for n in (1, 2))
    np.testing.assert_allclose(twice.odds, 2 * np.array(once.odds), rtol=1e-6)
    assert twice.cosine == pytest.approx(once.cosine, abs=1e-9)
    assert min(once.odds) >= 0.0


def test_either_must_be_recognised():
    assert Likeness(0.9, (7.0, 8.0)).separate
    assert not Likeness(0.0, (7.0, 5.0)).separate


def test_effects_of_the_model_are_taken_out_of_it_first():
    assert "Nvar" in MODEL.parameters
    assert CROSS.first == ("Nvar",)
    assert CROSS.goal.model.value("Nvar") == 0.0


def test_effects_that_share_a_number_cannot_be_compared():
    with pytest.raises(DesignError, match="share 'Nvar'"):
        pair("yaw_drag_var", "yaw_drag_var")


def test_no_feasible_test_is_said():
    with pytest.raises(DesignError, match="no test of this kind keeps the limits; heel binds: "):
        separate([CIRCLE], GEAR, Limits(heel=0.1 * D), Search(candidates=8))


def test_the_sentence_of_two_that_come_apart():
    found = Separation(("a", "b"), (), Likeness(0.9876, (1.0, 2.0)), Likeness(0.1, (20.0, 9.0)), 5)
    assert found.sentence == (
        "a and b come apart: log odds for the right one 9, 1 so far, where 6 are enough against "
        "noise alone; |cos| 0.100"
    )


def test_odds_that_would_be_enough_are_not_said_to_have_been():
    """`28127 so far, where 6 are enough` stood beside `cannot tell it from`."""
    found = Separation(("a", "b"), (), Likeness(0.9, (40.0, 50.0)), Likeness(0.1, (200.0, 90.0)), 5)
    assert found.sentence == (
        "a and b come apart: log odds for the right one 90, where 6 are enough against noise "
        "alone; the 40 so far would be, too, were it not for what else is in them; |cos| 0.100"
    )


@pytest.mark.parametrize(("odds", "enough"), [(239.0, False), (241.0, True)])
def test_more_of_the_same_does_not_tell_them_apart(odds: float, enough: bool):
    """By the noise alone those of the trials there are, 120, would have done it long since."""
    found = Separation(
        ("a", "b"), (), Likeness(0.9, (400.0, 120.0)), Likeness(0.8, (900.0, odds)), 5
    )
    assert found.after.separate
    assert found.separate is enough
    assert found.sentence.startswith("a and b come apart") is enough
    assert ("much better than the trials there are" in found.sentence) is not enough


def test_odds_and_cosine_against_least_squares():
    """The wrong effect fitted with all that is free: half the squares it leaves are the odds."""
    rows, names = whiten_sensitivities(GEAR.goal, [TEN_TEN])
    mine, rival = (np.isin(names, part) for part in (GEAR.first, GEAR.second))
    found = likeness(GEAR, [TEN_TEN])
    for odds, true, wrong in ((found.odds[0], mine, rival), (found.odds[1], rival, mine)):
        start = {n: GEAR.goal.model.parameters[n].start for n in (*GEAR.first, *GEAR.second)}
        signs = [np.sign(start[n]) for n, on in zip(names, true, strict=True) if on]
        signal = rows[:, true] @ signs
        others = rows[:, ~true] / np.linalg.norm(rows[:, ~true], axis=0)
        left = signal - others @ np.linalg.lstsq(others, signal, rcond=1e-12)[0]
        assert odds == pytest.approx(0.5 * float(left @ left), rel=1e-4)
        base = rows[:, ~(true | wrong)] / np.linalg.norm(rows[:, ~(true | wrong)], axis=0)
        alone = signal - base @ np.linalg.lstsq(base, signal, rcond=1e-12)[0]
        # of one column each: what the rival leaves is the sine of the angle between the two
        sine = float(np.sqrt((left @ left) / (alone @ alone)))
        assert found.cosine == pytest.approx(np.sqrt(1.0 - sine**2), rel=1e-3)


# A test rated beside a record kept small is as rated beside the record itself

TRIALS = [zigzag(10), zigzag(20), zigzag(5, duration=900.0)]


def gram(A: np.ndarray) -> np.ndarray:
    return A.T @ A


@pytest.mark.parametrize("memory", [0.0, 3.0])
def test_what_is_shown_is_what_all_rows_show(memory: float) -> None:
    goal = GEAR.goal
    noise = {c: Noise(each.sigma, memory) for c, each in goal.noise.items()}
    goal = replace(goal, noise=noise)
    A, names = whiten_sensitivities(goal, TRIALS)
    found = triangles_beside(
        goal, triangles_beside(goal, triangles(goal, TRIALS[:1]), TRIALS[1]), TRIALS[2]
    )
    assert found.names == (*names,)
    assert len({*names}) < len(names)  # two trials are called alike; their unknowns stay apart
    assert found.rows(noise).shape[0] == len(noise) * len(names)
    size = np.sqrt(np.diag(gram(A)))
    off = (gram(found.rows(noise)) - gram(A)) / np.outer(size, size)
    assert np.abs(off).max() < 1e-11


def test_only_the_further_test_is_simulated(monkeypatch: pytest.MonkeyPatch) -> None:
    goal, sailed = GEAR.goal, list[int]()
    before = triangles(goal, TRIALS[:2])
    whole = module.linearisation

    def counted(problem):
        sailed.append(len(problem.trials))
        return whole(problem)

    monkeypatch.setattr(module, "linearisation", counted)
    triangles_beside(goal, before, TRIALS[2])
    assert sailed == [1]
