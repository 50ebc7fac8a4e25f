"""How she moves at the order of a manoeuvre: as recorded just before it, where that is known."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from trialid.design.imo.calm_air import _motion_at
from trialid.trial import Trial

STATES = ("u", "v", "r", "psi")
SIMULATED = np.array([7.0, 0.2, 0.001, 0.5])


def test_she_begins_with_what_the_record_has_before_the_order() -> None:
    """The model was led elsewhere: its rate and heading are mended, what nobody compared is not."""
    t = np.arange(400.0)
    measured = {"r": np.full(400, 0.003), "psi": np.full(400, 0.65)}
    trial = Trial("turn", "check", 1.0, measured, {n: t >= 0.0 for n in measured})
    response = SimpleNamespace(
        states=np.tile(SIMULATED, (400, 1)), y=np.tile(SIMULATED[2:], (400, 1))
    )
    score = SimpleNamespace(trial=trial, response=response, compared=np.ones((400, 2), dtype=bool))
    model = SimpleNamespace(
        ship=SimpleNamespace(particulars={"L": 175.0, "U0": 7.0}), all_states=STATES
    )
    fit: Any = SimpleNamespace(
        scores=[score],
        model=model,
        problem=SimpleNamespace(outputs=("r", "psi"), simulator=SimpleNamespace(model=model)),
    )
    motion = _motion_at(fit, trial, 200)
    assert motion.values == pytest.approx({"u": 7.0, "v": 0.2, "r": 0.003, "psi": 0.65})
    assert motion.noise == pytest.approx({"r": 0.0, "psi": 0.0}, abs=1e-9)
