"""Where a trial begins is not `unlike what is likely` for its sensor's zero."""

from types import SimpleNamespace

import pytest
from test_stands_off import MODEL, SETTINGS, trials

from trialid.identification.adequacy import _sensor_at_bound
from trialid.identification.fit import identify
from trialid.identification.remarks import _begins_off, remarks


def test_a_ship_upright_below_a_sensor_that_stands_off_begins_as_she_is():
    """`phi(0) = 0.003 deg is 6.3 deviations below what is likely` was said beside its zero of 2."""
    fit = identify(trials(MODEL, 3.0, 3.0), MODEL, SETTINGS)
    begins = [name for name in fit.contradicted if name.startswith("phi(0)")]
    assert len(begins) == 2
    assert not any("phi(0)" in line for line in remarks(fit))
    plain = SimpleNamespace(estimates={"phi(0) [a]": 0.0, "b_r [a]": 0.0, "b_phi [b]": 0.0})
    assert not any(_begins_off(plain, name) for name in ("phi(0) [a]", "b_r [a]", "p(0) [b]"))
    assert _begins_off(plain, "r(0) [a]")


@pytest.mark.parametrize(("outputs", "told"), [(("r", "phi"), True), (("phi",), False)])
def test_a_delay_of_the_roll_at_its_end_may_be_of_a_swell(monkeypatch, outputs, told):
    """Of ships in a sea perfect sensors were doubted, and a good fit of the yaw went with it."""
    end = "trialid.identification.adequacy.at_the_end"
    monkeypatch.setattr(end, lambda unknowns, theta: {"tau_phi [a]": 3.0})
    unknown = SimpleNamespace(name="tau_phi [a]", unit="s")
    fit = SimpleNamespace(problem=SimpleNamespace(unknowns=[unknown], outputs=outputs), theta=[3.0])
    assert ("where a swell rolls her, leave phi out" in str(_sensor_at_bound(fit))) is told
