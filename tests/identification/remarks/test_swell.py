"""A roll's delay that ran to its end may be of a swell, which no clock makes."""

from types import SimpleNamespace

import pytest

from trialid.identification.adequacy import _sensor_at_bound


@pytest.mark.parametrize(("outputs", "told"), [(("r", "phi"), True), (("phi",), False)])
def test_a_delay_of_the_roll_at_its_end_may_be_of_a_swell(monkeypatch, outputs, told):
    """Of ships in a sea perfect sensors were doubted, and a good fit of the yaw went with it."""
    end = "trialid.identification.adequacy.at_the_end"
    monkeypatch.setattr(end, lambda unknowns, theta: {"tau_phi [a]": 3.0})
    unknown = SimpleNamespace(name="tau_phi [a]", unit="s")
    fit = SimpleNamespace(problem=SimpleNamespace(unknowns=[unknown], outputs=outputs), theta=[3.0])
    assert ("where a swell rolls her, leave phi out" in str(_sensor_at_bound(fit))) is told
