"""Where a trial begins is not `unlike what is likely` for its sensor's zero."""

from types import SimpleNamespace

from test_stands_off import MODEL, SETTINGS, trials

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
