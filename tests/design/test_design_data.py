"""What a plan hands to the crew: numbers in the units of its file, sea room to the right side."""

import numpy as np
import pytest

from trialid.design.helm import Passage
from trialid.design.kinds import Test
from trialid.report.files import design_data
from trialid.trial import Trial

D = np.deg2rad(1.0)


def test_numbers_of_a_test_are_in_the_units_of_design_files():
    told = design_data.of_test(
        Test("zigzag", {"angle": 20 * D, "heading": 10 * D}, 600.0, 30.0, name="z")
    )
    assert told["numbers"] == pytest.approx({"angle": 20.0, "heading": 10.0})
    assert told["units"] == {"angle": "deg", "heading": "deg"}
    assert (told["approach"], told["duration"]) == (30.0, 600.0)
    wave = design_data.of_test(Test("square_wave", {"angle": 5 * D, "period": 40.0}, 600.0))
    assert wave["numbers"] == pytest.approx({"angle": 5.0, "period": 40.0})
    rates = design_data.of_test(Test("reversed_spiral", {"rates": (0.5 * D, -0.2 * D)}, 600.0))
    assert rates["numbers"]["rates"] == pytest.approx([0.5, -0.2])


def test_room_is_where_she_goes():
    """500 m ahead and 20 back, 300 to starboard and 40 to port."""
    x, y = np.array([0.0, 500.0, 200.0, -20.0]), np.array([0.0, -40.0, 300.0, 100.0])
    signals = {
        "psi": 0.1 * np.arange(4),
        "delta_order": np.array([0.0, 0.2, 0.2, -0.1]),
        "r": np.array([0.0, 0.01, -0.02, 0.0]),
    }
    told = design_data._expected(Passage(Trial("z", "fit", 10.0, signals, {}), x, y, None))
    assert told["room"] == {"ahead": 500.0, "astern": 20.0, "starboard": 300.0, "port": 40.0}
    assert told["largest"] == {"r": 0.02}
    assert [order["t"] for order in told["orders"]] == [10.0, 30.0]
