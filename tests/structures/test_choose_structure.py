"""The rule by hand: paired differences, one standard error, the fewest parameters."""

import numpy as np
import pytest

from trialid.diagnosis.one_standard_error import choose_structure
from trialid.effects import CATALOGUE
from trialid.effects.usual_structures import HULLS, TELLING, usual_structures

EASY_TO_HARD = np.array([0.02, 0.05, 0.10, 0.20])


def choice(parameters=None, **errors):
    made = {name: np.asarray(each, dtype=float) for name, each in errors.items()}
    return choose_structure(made, parameters or dict.fromkeys(made, 3))


def test_mean_and_standard_error_are_of_the_paired_differences() -> None:
    """Differences 0.01, 0.03, 0.02, 0.02: mean 0.02, variance 2/3 e-4, over four trials."""
    found = choice(a=EASY_TO_HARD, b=EASY_TO_HARD + np.array((0.01, 0.03, 0.02, 0.02)))
    assert found.best == "a"
    assert found.behind["a"] == (0.0, 0.0)
    assert found.behind["b"] == pytest.approx((0.02, np.sqrt(2.0 / 3.0) * 0.01 / 2.0))
    assert found.as_good == ("a",)


def test_trials_that_differ_in_difficulty_do_not_hide_a_sure_difference() -> None:
    """The scatter over trials is ten times the difference, which is the same in each."""
    found = choice({"small": 1, "large": 9}, large=EASY_TO_HARD, small=EASY_TO_HARD + 0.008)
    assert found.simplest == found.best == "large"


def test_within_one_standard_error_the_fewest_parameters_win() -> None:
    scattered = EASY_TO_HARD + np.array(
        (0.02, -0.02, 0.03, -0.01)
    )  # mean 0.005, standard error 0.012
    given = {"large": EASY_TO_HARD, "small": scattered, "middle": scattered - 0.001}
    found = choice({"small": 4, "large": 9, "middle": 6}, **given)
    assert (found.best, found.simplest) == ("large", "small")
    assert set(found.as_good) == {"large", "small", "middle"}
    swapped = choice({"small": 9, "large": 4, "middle": 6}, **given)
    assert swapped.simplest == "large"


def test_a_sure_difference_that_nobody_would_notice_pays_for_no_parameter() -> None:
    """0.7 % of the error is hardly anything, 0.9 % is something."""
    sizes = {"small": 1, "large": 9}
    assert choice(sizes, large=EASY_TO_HARD, small=1.007 * EASY_TO_HARD).simplest == "small"
    flat = np.full(4, 0.1)
    assert choice(sizes, large=flat, small=1.009 * flat).simplest == "large"


def test_an_erratic_structure_does_not_win_by_its_own_large_standard_error() -> None:
    """Behind by 0.015 of 0.1, and its standard error is 0.019: yet 15 % is a lot."""
    flat, sizes = np.full(4, 0.1), {"small": 1, "large": 9}
    erratic = flat + np.array((0.06, -0.02, 0.04, -0.02))
    found = choice(sizes, large=flat, small=erratic)
    mean, error = found.behind["small"]
    assert error > mean > 0.01
    assert found.simplest == "large"
    calmer = choice(sizes, large=flat, small=flat + (erratic - flat) / 3.0)
    assert calmer.simplest == "small"


def test_nothing_is_chosen_from_one_trial_or_no_structure() -> None:
    assert choose_structure({}, {}) is None
    assert choice(a=[0.1], b=[0.2]) is None


# --- the usual structures -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("speed", "names", "left_out"),
    [
        ("recorded", {"", ", race"}, "with surge"),
        ("simulated", {"", ", race"}, "with surge"),
        ("stated", {"", ", surge", ", race, surge"}, "with race"),
    ],
)
def test_the_usual_ones_by_where_the_speed_comes_from(speed, names, left_out) -> None:
    found, why = usual_structures(("v", "r"), (), speed)
    assert set(found) == {hull + more for hull in HULLS for more in names}
    assert set(why) == {left_out}
    assert found["linear"] == ()
    assert found[next(n for n in found if n.startswith("cross-flow"))] == ("cross_flow_drag",)


def test_only_what_acts_on_a_simulated_motion_is_in_a_list() -> None:
    both, _ = usual_structures(("v", "r"), (), "recorded")
    rolling, _ = usual_structures(("v", "p", "r", "phi"), (), "recorded")
    yaw, _ = usual_structures(("r",), (), "recorded")
    assert {*rolling["cubic"]} - {*both["cubic"]} == {"roll_cubic"}
    assert {n.partition("_")[0] for n in yaw["modulus"]} == {"yaw"}
    assert {n.partition("_")[0] for n in both["modulus"]} == {"sway", "yaw"}


def test_what_adds_nothing_to_another_is_not_tried() -> None:
    assert set(usual_structures((), (), "stated")[0]) == {
        "linear",
        "linear, surge",
        "linear, race, surge",
    }
    assert set(usual_structures(("p", "phi"), (), "recorded")[0]) == {
        "linear",
        "linear, race",
        "modulus",
        "modulus, race",
        "cubic",
        "cubic, race",
    }


def test_a_rudder_that_stands_in_the_race_gets_no_second_one() -> None:
    found, why = usual_structures(("v", "r"), ("linear_hull", "rudder_race"), "stated")
    assert set(found) == {hull + more for hull in HULLS for more in ("", ", surge")}
    assert why == {"with race": "rudder_race has it already"}


def test_every_usual_effect_is_in_the_catalogue() -> None:
    assert CATALOGUE.keys() >= TELLING
