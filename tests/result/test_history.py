"""A step of a model's history: when it is the one before, and what was free the last time."""

from dataclasses import replace

import pytest

from trialid.result.change_rows import StepRow
from trialid.workflow.history import continue_steps, free_before

WRITTEN = StepRow(step="as written", effects=("a",), eps_rmsn=0.05, free=("Ka",))
ADDED = StepRow(step="added", added="b", effects=("a", "b"), eps_rmsn=0.04, free=("Ka", "Kb"))


@pytest.mark.parametrize(
    ("eps", "steps"),
    [(0.04 * (1.0 + 1e-5), 2), (0.04 * 1.001, 3), (0.04 * 0.95, 3)],
)
def test_a_model_that_fits_otherwise_is_a_step_of_its_own(eps: float, steps: int) -> None:
    """Another processor rounds differently; a thousandth is another model or other logs."""
    found = continue_steps((WRITTEN, ADDED), replace(ADDED, step="as written", eps_rmsn=eps))
    assert len(found) == steps
    assert found[-1].step == ("added" if steps == 2 else "as written")
    assert found[-1].eps_rmsn == eps


def test_an_effect_comes_back_with_what_was_free_when_it_was_last_there() -> None:
    without = replace(WRITTEN, step="dropped", dropped="b")
    assert free_before((WRITTEN, ADDED, without), "b", ("Kb", "Kbb")) == ("Kb",)
    assert free_before((WRITTEN, ADDED, without), "c", ("Kc",)) == ("Kc",)
