"""Steps as bars: squares add up, lengths are errors, and the last is the model shown."""

from types import SimpleNamespace

import pytest

from trialid.result.change_rows import StepRow
from trialid.result.fit_rows import FitPart
from trialid.result.schema import Result
from trialid.workbench import error_number
from trialid.workbench.step_rows import steps

FIRST = StepRow(step="as written", eps_rmsn=0.10, noise=0.06, undermodelling=0.08)
SECOND = StepRow(step="added", added="heel_yaw", eps_rmsn=0.05, noise=0.04, undermodelling=0.03)
RUN = Result(fit=FitPart(eps_rmsn=0.05, eps_rmsn_check=0.07), history=(FIRST, SECOND))
SHOWN = SimpleNamespace(run=SimpleNamespace(result=RUN), fit=None, before=None)


def test_noise_takes_its_part_of_the_squares():
    first, second = steps(SHOWN, RUN).rows
    assert first.bar.noise_share == pytest.approx(36.0)  # of 0.06^2 + 0.08^2 = 0.10^2
    assert second.bar.noise_share == pytest.approx(64.0)
    assert (first.bar.length, second.bar.length) == pytest.approx((100.0, 50.0))
    assert [row.kind for row in (first, second)] == ["step", "present"]


def test_the_bar_of_what_is_being_computed_is_as_long_as_its_error():
    """Beside those of the model before; its parts are not known yet."""
    pending = SimpleNamespace(
        run=None, before=None, fit=SimpleNamespace(eps_rmsn=0.03, eps_check=0.04)
    )
    *_, last = steps(pending, RUN).rows
    assert (last.kind, last.check, last.bar.noise) == ("pending", 0.04, None)
    assert last.bar.length == pytest.approx(30.0)


def test_the_number_is_that_of_the_fitted_trials_and_beside_it_the_held_out():
    found = error_number.error_number(SHOWN)
    assert (found.eps, found.check) == (0.05, 0.07)
