"""Steps as bars: squares add up, lengths are errors, and the last is the model shown."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from trialid.result.change_rows import StepRow
from trialid.result.fit_rows import FitPart
from trialid.result.schema import Result
from trialid.workbench import error_number
from trialid.workbench.steps.step_rows import steps

FIRST = StepRow(step="as written", eps_rmsn=0.10, noise=0.06, undermodelling=0.08)
SECOND = StepRow(step="added", added="heel_yaw", eps_rmsn=0.05, noise=0.04, undermodelling=0.03)
RUN = Result(fit=FitPart(eps_rmsn=0.05, eps_rmsn_check=0.07), history=(FIRST, SECOND))
SHOWN = SimpleNamespace(run=SimpleNamespace(result=RUN), fit=None, before=None, named={})


def test_noise_takes_its_part_of_the_squares():
    first, second = steps(SHOWN, RUN).rows
    assert first.bar.noise_share == pytest.approx(36.0)  # of 0.06^2 + 0.08^2 = 0.10^2
    assert second.bar.noise_share == pytest.approx(64.0)
    assert (first.bar.length, second.bar.length) == pytest.approx((100.0, 50.0))
    assert [row.kind for row in (first, second)] == ["step", "present"]


def test_the_bar_of_what_is_being_computed_is_as_long_as_its_error():
    """Beside those of the model before; its parts are not known yet."""
    pending = SimpleNamespace(
        run=None, before=None, named={}, fit=SimpleNamespace(eps_rmsn=0.03, eps_check=0.04)
    )
    *_, last = steps(pending, RUN).rows
    assert (last.kind, last.check, last.bar.noise) == ("pending", 0.04, None)
    assert last.bar.length == pytest.approx(30.0)


def test_the_number_is_that_of_the_fitted_trials_and_beside_it_the_held_out():
    found = error_number.error_number(SHOWN)
    assert (found.eps, found.check) == (0.05, 0.07)


def test_a_bad_step_leaves_the_others_their_length():
    """Whether it is shown and no fit, or folded away."""
    wild = replace(SECOND, eps_rmsn=4.0, verdict="no fit")
    run = replace(RUN, history=(FIRST, wild, SECOND))
    first, bad, second = steps(SHOWN, run).rows
    assert (first.bar.length, bad.bar.length, second.bar.length) == pytest.approx((100, 100, 50))
    assert bad.bar.eps == 4.0
    long_ago = replace(FIRST, eps_rmsn=1.0)
    shown = steps(SHOWN, replace(RUN, history=(long_ago, *[FIRST] * 5, SECOND)))
    assert len(shown.earlier) == 1
    assert [row.bar.length for row in shown.rows] == pytest.approx([100.0] * 5 + [50.0])


def test_a_step_is_named_by_what_was_done_here_else_by_what_the_history_tells():
    free = replace(SECOND, step="as written", added=None, effects=("a",), free=("Yv",))
    held = replace(free, free=(), eps_rmsn=0.06)
    added = replace(FIRST, effects=("a",))
    run = replace(RUN, history=(added, free, held, held))
    named = SimpleNamespace(run=SHOWN.run, fit=None, before=None, named={3: "zigzag held out"})
    words = ["as written", "free Yv", "fix Yv", "zigzag held out"]
    assert [row.words for row in steps(named, run).rows] == words
    assert [row.words for row in steps(SHOWN, run).rows] == [*words[:3], "as written"]
