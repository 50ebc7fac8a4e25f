"""A rudder that is recorded late: before that is settled nothing that seems missing has a name."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.diagnosis.records.in_doubt import in_doubt, settle
from trialid.diagnosis.records.rudder_late import rudder_in_doubt
from trialid.diagnosis.verdict import Verdict
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings

FREE = ("Nv", "Nr", "Ndelta", "Kdelta", "Kp", "GM")
SETTINGS = Settings(FREE, ("r", "phi"), nuisance=("initial_state", "bias", "delay"))
NAMED = Verdict("missing", "inclinometer_lever", ("inclinometer_lever",), "it is")


def late(y, lag, period):
    """What a feedback with this time constant [s] shows."""
    if not lag:
        return y
    shown = y.copy()
    for k in range(1, len(y)):
        shown[k] = y[k] + (shown[k - 1] - y[k]) * np.exp(-period / lag)
    return shown


def fitted(lag, early=0.0, seed=5):
    """Zig-zags whose rudder is shown late, and whose rate of turn is stamped so much early."""
    made = []
    for angle in (5, 10, 20):
        trial = zigzag(angle)
        trial = with_noise(trial, *white(np.random.default_rng(seed + angle), trial.samples))
        delta = late(trial.signals["delta"], lag, trial.period)
        r = np.interp(trial.t + early, trial.t, trial.signals["r"])
        made.append(replace(trial, signals={**trial.signals, "delta": delta, "r": r}))
    return identify(made, MODEL, SETTINGS)


@pytest.fixture(scope="module")
def lagging():
    return fitted(3.0)


def test_a_feedback_that_lags_comes_first_and_nothing_is_named(lagging):
    """An outsider's by 2 and 3 s was the lever of an inclinometer, three times of three."""
    said = rudder_in_doubt(lagging)
    assert said.startswith("r, phi come ")
    assert 1.5 < float(said.split()[3]) < 3.5
    assert in_doubt(lagging)
    found = settle(lagging, NAMED, CATALOGUE["inclinometer_lever"])
    assert (found.kind, found.effect) == ("cannot tell", None)
    assert found.sentence.endswith("until then no effect is named")


def test_what_is_of_the_rudder_s_record_keeps_its_name(lagging):
    for name in ("rudder_record_delay", "rudder_offset"):
        assert rudder_in_doubt(lagging, CATALOGUE[name]) is None
    assert rudder_in_doubt(lagging, CATALOGUE["lag_r"]) is not None


def test_where_nothing_is_missing_it_changes_nothing(lagging):
    nothing = Verdict("nothing missing", None, (), "no effect stands out")
    assert settle(lagging, nothing) is nothing


@pytest.mark.parametrize(
    ("outputs", "told"), [(("r", "phi"), True), (("r", "psi"), False), (("v", "r"), False)]
)
def test_of_a_turn_alone_it_is_not_said(outputs, told, monkeypatch):
    """A hull that answers sooner makes rate and heading early alike, and hardly the roll."""
    unknowns = [SimpleNamespace(column=f"tau_{c}") for c in outputs]
    fit = SimpleNamespace(problem=SimpleNamespace(outputs=outputs, unknowns=unknowns))
    place = "trialid.diagnosis.records.rudder_late.in_all_trials"
    monkeypatch.setattr(place, lambda fit: dict.fromkeys(fit.problem.outputs, -2.0))
    assert (rudder_in_doubt(fit) is not None) is told


@pytest.mark.study(turn="each")
@pytest.mark.parametrize(("lag", "early"), [(0.0, 0.0), (0.0, 3.0)])
def test_of_a_rudder_in_time_or_one_output_that_is_early_it_is_not_said(lag, early):
    """A rate alone is early by a hull that answers sooner than its model."""
    fit = fitted(lag, early)
    assert rudder_in_doubt(fit) is None
    assert settle(fit, NAMED) is NAMED
