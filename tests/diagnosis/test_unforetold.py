"""What the test shows although no slope foretells a fall is fitted before it is given up."""

from types import SimpleNamespace

import pytest

from trialid.diagnosis import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings


def candidate(name, *, shown, falls):
    carried = SimpleNamespace(falls=falls)
    effect = SimpleNamespace(name=name)
    return SimpleNamespace(
        effect=effect,
        carried=carried,
        shown=lambda level: shown,
        worth_a_name=lambda level: shown and falls,
    )


@pytest.mark.parametrize(
    ("ranking", "fitted"),
    [
        ([("a", True, True), ("b", True, False)], ["a"]),
        ([("a", False, True), ("b", True, False)], ["b"]),
        ([("a", False, True), ("b", False, False)], []),
    ],
)
def test_which_candidates_are_fitted_first(monkeypatch, ranking, fitted):
    asked = []

    def best(fit, worth, most, level, progress):
        asked.extend(c.effect.name for c in worth)
        return ()

    monkeypatch.setattr(diagnose, "refit_best", best)
    monkeypatch.setattr(diagnose, "likeliest_refit", lambda *given: None)
    monkeypatch.setattr(diagnose, "refit", lambda *given: ())
    monkeypatch.setattr(diagnose, "look_beside", lambda *given, **named: None)
    made = [candidate(name, shown=shown, falls=falls) for name, shown, falls in ranking]
    diagnose.refits_of(None, made, DiagnoseSettings(candidates={}), lambda words: None)
    assert asked == fitted
