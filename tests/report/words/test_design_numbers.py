"""The numbers of a test in a table have their units."""

from trialid.report.tables.design_tables import numbers_of


def test_numbers_of_a_test_have_units() -> None:
    """`angle 10, period 1164` were of degrees and seconds."""
    one = {
        "numbers": {"angles": [1.0, 2.0], "period": 1164.0, "turn": 3.0},
        "units": {"angles": "deg", "period": "s", "turn": "1"},
    }
    assert numbers_of({"programme": [one]}) == "2 angles, period 1164 s, turn 3"
    two = {"numbers": {"angle": 35.0, "heading": 24.9}, "units": {"angle": "deg", "heading": "deg"}}
    assert numbers_of({"programme": [two]}) == "35\N{DEGREE SIGN}, heading 24.9\N{DEGREE SIGN}"
