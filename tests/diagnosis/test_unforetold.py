"""What the test shows more surely is fitted although no slope foretells a fall."""

from types import SimpleNamespace

import pytest

from trialid.diagnosis import diagnose
from trialid.diagnosis.diagnosed import DiagnoseSettings


def candidate(name, p_value, falls, states=()):
    return SimpleNamespace(
        effect=SimpleNamespace(name=name, states=states, forms=(), signals=()),
        allowed=True,
        p_value=p_value,
        carried=SimpleNamespace(falls=falls),
        shown=lambda level: p_value < level,
        worth_a_name=lambda level: p_value < level and falls,
    )


@pytest.mark.parametrize(
    ("ranking", "fitted"),
    [
        ([("a", 0.01, True), ("b", 0.02, False)], ["a"]),  # less sure than what is named
        ([("a", 0.01, True), ("b", 0.002, False)], ["a", "b"]),
        ([("a", 0.2, True), ("b", 0.01, False)], ["b"]),  # nothing else is shown
        ([("a", 0.2, True), ("b", 0.2, False)], []),
        # only orders are recorded: no rudder stands where it is told at once
        ([("a", 0.01, True), ("b", 0.9, False), ("gear", 0.9, False, ["delta"])], ["a", "gear"]),
        ([("gear", 0.01, True, ["delta"]), ("other", 0.9, False, ["delta"])], ["gear"]),
        ([("a", 0.2, True), ("gear", 0.9, False, ["delta"])], ["gear"]),  # nor where none is named
    ],
)
def test_which_candidates_are_fitted(monkeypatch, ranking, fitted):
    asked = []

    def refit(fit, worth, *more):
        asked.extend(c.effect.name for c in worth)
        return [SimpleNamespace(candidate=c, effects=(c.effect,)) for c in worth]

    def likeliest(fit, done, *more):
        return min(done, key=lambda r: r.candidate.p_value, default=None)

    monkeypatch.setattr(diagnose, "refit_best", refit)
    monkeypatch.setattr(diagnose, "likeliest_refit", likeliest)
    monkeypatch.setattr(diagnose, "refit", refit)
    monkeypatch.setattr(diagnose, "foretell_far_more", lambda *given: ())
    monkeypatch.setattr(diagnose, "to_fit", lambda *given: ())
    monkeypatch.setattr(diagnose, "look_beside", lambda *given, **named: None)
    made = [candidate(*each) for each in ranking]
    without_gear = SimpleNamespace(model=SimpleNamespace(effects=()))
    diagnose.refits_of(without_gear, made, DiagnoseSettings(candidates={}), lambda words: None)
    assert asked == fitted
    asked.clear()
    gear = SimpleNamespace(states=["delta"], signals=())  # no hull was fitted for want of one
    with_gear = SimpleNamespace(model=SimpleNamespace(effects=(gear,)))
    diagnose.refits_of(with_gear, made, DiagnoseSettings(candidates={}), lambda words: None)
    named = [name for name in fitted if name != "gear" or ranking[0][0] == "gear"]
    assert asked == named
