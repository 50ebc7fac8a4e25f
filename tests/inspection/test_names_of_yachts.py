"""How a yacht's log and a bridge's say what they are of: BSP, a heading to true north, a shaft."""

import pytest

from trialid.ingest.tables.table import head
from trialid.inspection.channel_names import quantity
from trialid.names.unit_words import plain

HEADS = {
    "Heading (T)": ("psi", None),
    "Heading (True) ": ("psi", None),
    "Heading [deg true]": ("psi", "deg"),
    "Heading [degT]": ("psi", "deg"),
    "Magnetic heading [deg mag]": ("psi", "deg"),
    "Boatspeed (kn)": ("u", "kn"),
    "Boat Speed (kn)": ("u", "kn"),
    "BSP (kn)": ("u", "kn"),
    "Main Shaft [rpm]": ("n", "rpm"),
    "Main Shaft [kN]": (None, "kN"),
    "Boat length (m)": (None, "m"),
}


@pytest.mark.parametrize(("text", "told"), HEADS.items())
def test_a_head_is_of_its_quantity(text, told):
    """Of an outsider's logs four of these were not read, as their names said nothing known."""
    expected, unit = told
    known = head(text)
    assert quantity(known.name, known.unit) == expected
    assert (known.unit and plain(known.unit)) == (unit and plain(unit))


def test_a_ton_stays_one():
    assert head("Displacement (t)").unit == "t"
