"""What the model with a named effect says of a parameter lies in its likely range."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from trialid.accuracy.parameter_table import Accuracy, ParameterAccuracy
from trialid.accuracy.ranges import USUAL_FORCES
from trialid.accuracy.widened import embrace
from trialid.design.imo.measures import Criterion
from trialid.design.standard import Measure
from trialid.diagnosis import diagnosed
from trialid.workflow import findings


def row(name, likely, kind="physical"):
    known = dict.fromkeys(("S_i", "S_imin", "R_i", "standard_error", "white_error"), 1.0)
    return ParameterAccuracy(
        name=name,
        kind=kind,
        unit="1",
        value=1.0,
        reference=1.0,
        noise_error=None,
        undermodelling_error=None,
        n_effective=9.0,
        likely=likely,
        widened_by="another",
        **known,
    )


def table(*rows):
    return Accuracy(rows, 1.0, 1.0, 1.0, 9.0, weak=(), covariance=np.eye(len(rows)))


@pytest.mark.parametrize(
    ("own", "there", "both"),
    [
        ((0.0, 2.0), (1.5, 3.0), (0.0, 3.0)),
        ((0.0, 2.0), (-4.0, -3.0), (-4.0, 2.0)),
        ((0.0, 2.0), (0.5, 1.0), (0.0, 2.0)),
        (None, (0.5, 1.0), None),
        ((0.0, 2.0), None, (0.0, 2.0)),
    ],
)
def test_a_range_embraces_what_the_model_with_the_effect_says(own, there, both):
    [found] = embrace(
        table(row("Nv", own)), [("cross_flow_drag", table(row("Nv", there)))]
    ).parameters
    assert found.likely == both
    assert found.widened_by == ("another" if both == own else "cross_flow_drag")


def test_a_diagnosis_beside_the_model_with_its_effect(monkeypatch):
    tables = {"without": table(row("Nv", (0.0, 2.0))), "with": table(row("Nv", (1.5, 3.0)))}
    tables["all"] = table(row("Nv", (-1.0, 1.0)))
    monkeypatch.setattr(diagnosed, "accuracy_of", lambda fit, split, averaged: tables[fit])
    doubts = SimpleNamespace(averaged=None)
    before, after, usual = (diagnosed.Diagnosed(fit, None, (), doubts) for fit in tables)
    beside = {"without": (usual,), "with": ()}
    monkeypatch.setattr(diagnosed, "beside_usual_forces", lambda fit, examine: beside[fit])
    monkeypatch.setattr(diagnosed, "beside_in_time", lambda fit, examine: ())
    assert before.beside("cross_flow_drag", after).accuracy.parameters[0].likely == (0.0, 3.0)
    assert before.beside(None, after).accuracy.parameters[0].likely == (-1.0, 2.0)
    assert before.own_accuracy.parameters[0].likely == (0.0, 2.0)
    assert before.others == ((USUAL_FORCES, usual),)
    beside["with"] = (usual,)
    named = before.beside("cross_flow_drag", diagnosed.Diagnosed("with", None, (), doubts))
    assert [what for what, _ in named.others] == ["cross_flow_drag", USUAL_FORCES]
    assert named.accuracy.parameters[0].likely == (-1.0, 3.0)


def test_a_range_is_widened_by_the_model_that_reaches_furthest():
    others = [
        (name, table(row("Nv", ends))) for name, ends in (("a", (0.0, 4.0)), ("b", (-1.0, 3.0)))
    ]
    for said in (others, others[::-1]):
        [found] = embrace(table(row("Nv", (0.0, 2.0))), said).parameters
        assert (found.likely, found.widened_by) == ((-1.0, 4.0), "a")
    [same] = embrace(table(row("Nv", (0.0, 4.0))), others[1:]).parameters
    assert (same.likely, same.widened_by) == ((-1.0, 4.0), "another")


def test_a_parameter_that_the_other_model_has_not_stays():
    [found] = embrace(
        table(row("Nv", (0.0, 2.0))), [("x", table(row("Nr", (5.0, 6.0))))]
    ).parameters
    assert found == replace(row("Nv", (0.0, 2.0)))


@pytest.mark.parametrize(("effect", "low"), [("cross_flow_drag", 3.5), (None, 4.0)])
def test_standard_measures_embrace_what_the_model_with_the_effect_says(monkeypatch, effect, low):
    """A criterion is kept or not by the range, which was that of the model without the effect."""
    criterion = Criterion("advance", 5.0, "m", "turning circle")
    ranges = {"without": (4.0, 5.0), "with": (3.5, 4.5)}

    def measures(fit, spread):
        del spread
        return (Measure(criterion, 4.5, ranges[fit]),)

    nothing = SimpleNamespace(numbers=(), turns=(), manoeuvres=())
    for name, value in (
        ("likely_spread", lambda *args: None),
        ("measure_trials", lambda *args: nothing),
        ("_ship", lambda fit: None),
    ):
        monkeypatch.setattr(findings, name, value)
    monkeypatch.setattr(findings.following, "measures_within", measures)
    monkeypatch.setattr(findings.observed, "overshoots", lambda fit: ())
    accuracy = SimpleNamespace(parameters=(), covariance=None)
    doubts = SimpleNamespace(standing=None, held=(), missing=())
    kept = {"own_accuracy": accuracy, "doubts": doubts}
    after = SimpleNamespace(fit="with", **kept)
    others = () if effect is None else ((effect, after),)
    before = SimpleNamespace(fit="without", others=others, **kept)
    found = SimpleNamespace(before=before)
    [measure] = findings._imo(SimpleNamespace(imo=True), found, None)["measures"]
    assert measure.interval == (low, 5.0)
