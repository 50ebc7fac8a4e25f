import math

import pytest

from trialid.names import wording
from trialid.names.wording import DASH, MINUS, THIN


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (-0.0023456, f"{MINUS}0.002346"),
        (12_000, f"12{THIN}000"),
        (-5, f"{MINUS}5"),
        (1.5e-7, f"1.500{THIN}\N{MULTIPLICATION SIGN}{THIN}10⁻⁷"),
        (9.99996, "10.00"),
        (99999.6, f"1.000{THIN}\N{MULTIPLICATION SIGN}{THIN}10⁵"),
        (0.0, "0"),
        (None, DASH),
        (math.nan, DASH),
        (math.inf, DASH),
    ],
)
def test_number(value, words):
    assert wording.number(value) == words


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (0.12345, "12.3"),
        (1.0, "100"),
        (9.994, "999"),
        (12.3456, f">{THIN}1000"),
        (3.2e14, f">{THIN}1000"),
        (1e307, f">{THIN}1000"),
        (-70766.27, f"below{THIN}{MINUS}1000"),
        (0.00004, "0.0040"),
        (2.34e-6, "0.00023"),
        (-0.05, f"{MINUS}5.00"),
    ],
)
def test_percent(value, words):
    assert wording.percent(value) == f"{words}{THIN}%"


def test_unknown_fraction_is_a_dash():
    assert wording.percent(None) == wording.percent(math.nan) == DASH


def test_interval():
    assert wording.percent_range([0.039, 0.0441]) == f"3.90 to 4.41{THIN}%"
    assert wording.percent_range(None) == wording.percent_range([0.1, None]) == ""


def test_a_value_has_the_digits_its_error_leaves():
    assert wording.by_error(-0.00234567, 0.000062) == f"{MINUS}0.002346"
    assert wording.by_error(-0.00234567, None) == f"{MINUS}0.002346"
    assert wording.by_error(0.0, 0.1) == "0"
    assert wording.by_error(None, 0.1) == DASH


def test_angles_are_shown_in_degrees():
    unit, factor = wording.shown_unit("rad/s")
    assert unit == "deg/s"
    assert math.pi * factor == pytest.approx(180)
    assert wording.shown_unit(None) == ("", 1.0)


def test_percent_signs_stay_with_their_numbers():
    assert wording.prose("from 12 % to 8.7 %") == f"from 12{THIN}% to 8.7{THIN}%"


def test_angles_are_shown_in_degrees_of_360_to_a_turn():
    for unit, shown in (("rad", "deg"), ("rad/s", "deg/s")):
        name, factor = wording.shown_unit(unit)
        assert name == shown
        assert factor == pytest.approx(360.0 / (2.0 * math.pi))
    assert wording.shown_unit("m/s") == ("m/s", 1.0)
