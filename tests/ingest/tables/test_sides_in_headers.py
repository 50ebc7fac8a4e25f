"""The side that a column counts as positive may stand behind its unit, in brackets of its own."""

import pytest

from trialid.ingest.tables.table import head


@pytest.mark.parametrize(
    ("text", "name", "unit"),
    [
        ("Rudder angle [deg] (port positive)", "Rudder angle", "deg"),
        ("Rudder angle, deg (+PS)", "Rudder angle, deg", None),
        ("Rudder [deg] (+ve stbd)", "Rudder", "deg"),
        ("Ruder (Grad) (+ Steuerbord)", "Ruder", "Grad"),
        ("rudder (deg, + to port)", "rudder", "deg"),
        ("rudder (port)", "rudder (port)", None),
        ("t [s]", "t", "s"),
        ("shaft [P]", "shaft", "P"),
        ("speed (log) [kn]", "speed (log)", "kn"),
        ("cmd_left [-]", "cmd_left", None),  # a dash is how tables write none
        ("cmd_left (\N{EN DASH})", "cmd_left", None),
    ],
)
def test_a_side_is_no_unit(text: str, name: str, unit: str | None) -> None:
    found = head(text)
    assert (found.text, found.name, found.unit) == (text, name, unit)
