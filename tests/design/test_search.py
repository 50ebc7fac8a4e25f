from dataclasses import replace

import numpy as np
import pytest
from s175q import MODEL, OUTPUTS
from waters import NOISE, ROLL, SHIP, SPEED, VESSEL, D

from trialid.design import search as searching
from trialid.design.helm import vessel
from trialid.design.kinds import Test
from trialid.design.limits import Limits
from trialid.design.rating import goal
from trialid.design.search import Search, Ship, natural_roll, optimise, outcome, score
from trialid.errors import DesignError
from trialid.identification.problem import Settings

THREE = ("Nv", "Nr", "Ndelta")
SMALL = Ship(VESSEL, goal(MODEL, Settings(THREE, OUTPUTS), NOISE), ROLL, SPEED)
ZIGZAG = Test("zigzag", {}, 250.0, 20.0, {"angle": (5 * D, 30 * D), "heading": (5 * D, 30 * D)})
STAIRS = Test(
    "modified_spiral", {"angles": (0.0,) * 3}, 250.0, 20.0,
    {"angles": (-30 * D, 30 * D), "period": (60.0, 240.0)}, "stairs",
)  # fmt: skip
CIRCLE = Test("turning_circle", {}, 250.0, 20.0, {"angle": (5 * D, 35 * D)}, "circle")
ANY = Limits()


def rated(programme, ship=SMALL, limits=ANY):
    return outcome(programme, ship, limits).rating


def test_the_same_seed_gives_the_same_programme():
    first, again, other = (
        optimise([STAIRS], [SMALL], ANY, Search(candidates=30, seed=seed)) for seed in (4, 4, 5)
    )
    assert first == again
    assert other.programme != first.programme


def test_an_open_list_is_chosen_number_by_number_inside_its_limits():
    [test] = optimise([STAIRS], [SMALL], ANY, Search(candidates=60, seed=1)).programme
    angles = np.array(test.values["angles"])
    assert len({*angles}) == 3
    assert np.abs(angles).max() <= 30 * D
    assert 60.0 <= test.values["period"] <= 240.0


def test_a_list_of_unknown_length_and_nothing_open_are_refused():
    bare = replace(STAIRS, values={})
    with pytest.raises(DesignError, match="test 'stairs': say how many 'angles'"):
        optimise([bare], [SMALL], ANY, Search(candidates=5))
    with pytest.raises(DesignError, match="no number of the tests is left open"):
        optimise([replace(ZIGZAG, open={})], [SMALL], ANY, Search(candidates=5))


def test_an_open_duration_grows_as_far_as_its_limit_lets_it():
    wave = Test("square_wave", {"angle": 0.2, "period": 100.0}, 300.0, 20.0,
                {"duration": (100.0, 300.0)})  # fmt: skip
    limits = Limits(duration=200.0)
    [test] = optimise([wave], [SMALL], limits, Search(candidates=60)).programme
    assert 165.0 < test.duration <= 200.5


def test_progress_is_told_for_every_candidate():
    told = []
    found = optimise([STAIRS], [SMALL], ANY, Search(candidates=20), lambda *seen: told.append(seen))
    assert [n for n, _ in told] == list(range(1, found.tried + 1))
    best = [b for _, b in told]
    assert best == sorted(best, reverse=True)
    assert best[-1] == found.score


@pytest.mark.parametrize(
    ("limits", "test", "words"),
    [
        (Limits(rudder=2 * D), ZIGZAG, "rudder binds: .* deg of rudder are ordered, 2 are allowed"),
        (Limits(rudder_rate=2 * D), ZIGZAG, "rudder rate binds: 5 deg/s .*, 2 are allowed"),
        (Limits(heel=0.5 * D), ZIGZAG, "heel binds: .* deg of heel are reached, 0.5 are allowed"),
        (Limits(speed_loss=0.01), CIRCLE, "speed loss binds: .* % of speed are lost, 1 are"),
        (Limits(room=(90.0, 1e4, 1e4)), CIRCLE, "room ahead binds: .* m are run ahead, 90 are"),
        (Limits(room=(1e4, 9.0, 1e4)), CIRCLE, "room to the side binds: .* to the side, 9 are"),
        (Limits(duration=100.0), ZIGZAG, "duration binds: it takes 250 s, 100 s are allowed"),
    ],
)
def test_a_wish_that_no_candidate_grants_names_the_limit_that_binds(limits, test, words):
    with pytest.raises(DesignError, match=words):
        optimise([test], [SMALL], limits, Search(candidates=12))


def test_running_back_needs_room_astern():
    turned = Test("turning_circle", {"turn": 9.0}, 900.0, 0.0, {"angle": (25 * D, 35 * D)})
    with pytest.raises(DesignError, match=r"room astern binds: .* m are run back, 1 are allowed"):
        optimise([turned], [SMALL], Limits(room=(1e4, 1e4, 1.0)), Search(candidates=6))


def test_what_is_found_keeps_the_limits_that_the_best_would_break():
    free = optimise([STAIRS], [SMALL], ANY, Search(candidates=60)).programme
    heel = max(np.abs(p.trial.signals["phi"]).max() for p in outcome(free, SMALL, ANY).passages)
    limits = Limits(heel=0.6 * float(heel))
    assert outcome(free, SMALL, limits).rating is None
    kept = optimise([STAIRS], [SMALL], limits, Search(candidates=60)).programme
    assert outcome(kept, SMALL, limits).excesses == ()


@pytest.mark.parametrize("criterion", ["error", "S_imin", "R", "D", "A"])
def test_each_criterion_makes_its_own_measure_better(criterion):
    """Of forty candidates the chosen one beats the middle of the range by the criterion itself."""
    found = optimise([STAIRS], [SMALL], ANY, Search(criterion, candidates=40, seed=2))
    middle = replace(STAIRS, values={"angles": (15 * D, -15 * D, 8 * D), "period": 150.0}, open={})
    best = rated(found.programme)
    assert found.score == pytest.approx(score(best, criterion, THREE))
    assert found.score < score(rated([middle]), criterion, THREE)


def test_the_scores_by_hand():
    rating = rated([replace(ZIGZAG, values={"angle": 0.2, "heading": 0.2}, open={})])
    errors = [rating.of(n).error for n in THREE]
    assert score(rating, "error", THREE) == pytest.approx(np.log(max(errors)))
    assert score(rating, "A", THREE) == pytest.approx(np.log(np.sqrt(np.mean(np.square(errors)))))
    assert score(rating, "R", THREE) == pytest.approx(np.log(rating.S_max / rating.S_min))
    smallest = min(rating.of(n).S_imin for n in THREE)
    assert score(rating, "S_imin", THREE) == pytest.approx(-np.log(smallest))
    assert score(rating, "error", ("Nr",)) == pytest.approx(np.log(rating.of("Nr").error))


def test_tests_of_a_programme_are_fitted_together():
    tests = [replace(STAIRS, duration=150.0, name=n) for n in "ab"]
    found = optimise(tests, [SMALL], ANY, Search(candidates=60, seed=3))
    both = rated(found.programme)
    assert len(found.programme) == 2
    for test in found.programme:
        alone = rated([test])
        assert all(both.of(n).error < alone.of(n).error for n in THREE)


def other_ships():
    """Two more ships she might be: the rudder's moment off by a third to either side."""
    made = []
    for factor in (0.7, 1.3):
        model = MODEL.with_values({"Ndelta": factor * MODEL.value("Ndelta")})
        asked = goal(model, Settings(THREE, OUTPUTS), NOISE)
        sailed = vessel(model, 0.5, VESSEL.constants, 5 * D)
        made.append(Ship(sailed, asked, ROLL, SPEED))
    return made


def test_over_several_ships_the_mean_or_the_worst_counts():
    ships = [SMALL, *other_ships()]
    mean, worst = (
        optimise([STAIRS], ships, ANY, Search(over=over, candidates=20, seed=1))
        for over in ("mean", "worst")
    )
    each = [[score(rated(f.programme, s), "error", THREE) for s in ships] for f in (mean, worst)]
    assert mean.score == pytest.approx(np.mean(each[0]))
    assert worst.score == pytest.approx(max(each[1]))


def test_a_limit_must_be_kept_on_every_ship_she_might_be():
    ships = [SMALL, *other_ships()]
    test = [replace(CIRCLE, open={}, values={"angle": 20 * D})]
    heels = [np.abs(outcome(test, s, ANY).passages[0].trial.signals["phi"]).max() for s in ships]
    assert heels[2] > heels[0]
    limits = Limits(heel=float(heels[0] + heels[2]) / 2)
    assert outcome(test, SMALL, limits).rating is not None
    narrow = [replace(CIRCLE, open={"angle": (19.9 * D, 20.1 * D)})]
    with pytest.raises(DesignError, match="heel binds"):
        optimise(narrow, ships, limits, Search(candidates=5))


def test_a_candidate_that_moves_nothing_is_never_chosen():
    """The rudder may stay amidships: that is the least that is worth rating, and no error."""
    still = Test("square_wave", {"period": 50.0}, 200.0, 20.0, {"angle": (-30 * D, 0.0)})
    [test] = optimise([still], [SMALL], Limits(rudder=20 * D), Search(candidates=40)).programme
    assert -20 * D <= test.values["angle"] < -5 * D
    never = Test("square_wave", {"angle": 0.0}, 200.0, 20.0, {"period": (20.0, 50.0)})
    with pytest.raises(DesignError, match="the test moves too little to find anything: output 'r'"):
        optimise([never], [SMALL], ANY, Search(candidates=5))


def test_a_candidate_that_leaves_the_model_is_never_chosen(monkeypatch):
    def lost(programme, vessel, roll_frequency):
        raise DesignError("the model to be fitted cannot follow this test")

    monkeypatch.setattr(searching, "sail_all", lost)
    with pytest.raises(DesignError, match="cannot follow"):
        optimise([STAIRS], [SMALL], ANY, Search(candidates=5))


def test_the_natural_roll_of_s175q():
    assert 2 * np.pi / natural_roll(VESSEL) == pytest.approx(28.8, abs=0.5)
    assert natural_roll(VESSEL) == SHIP.roll_frequency
