"""The table of candidates: what the verdict names comes first, with what it leaves when fitted."""

from dataclasses import replace
from types import SimpleNamespace

import pytest

from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.score import Candidate
from trialid.diagnosis.verdict import Verdict
from trialid.result.missing_rows import missing_rows, place_in_ranking
from trialid.ship.effect import Parameter


def candidate(name, visibility=1.0):
    parameters = {name[0]: Parameter(0.1)}
    effect = SimpleNamespace(name=name, parameters=parameters, equation="", held=None)
    return Candidate(
        effect=effect,
        expected={name[0]: 0.1},
        eps_predicted=0.02,
        score=1.0,
        p_value=0.5,
        visibility=visibility,
        family=(name,),
        allowed=True,
        carried=Carried((1.0,), (0.9,)),
    )


def refit(of, eps):
    return SimpleNamespace(
        candidate=of, fit=SimpleNamespace(eps_rmsn=eps, eps_check=None, estimates={})
    )


def rows():
    """Ranked a to e; c is named, e fitted does as well, b is of its family and was not fitted."""
    ranking = tuple(candidate(n, 0.0 if n == "e" else 1.0) for n in "abcde")
    refits = tuple(refit(ranking[i], eps) for i, eps in ((0, 0.025), (2, 0.015), (4, 0.012)))
    fit = SimpleNamespace(eps_rmsn=0.03)
    verdict = Verdict("missing", "c", ("c", "b", "e"), "")
    return missing_rows(
        SimpleNamespace(
            ranking=ranking,
            refits=refits,
            verdict=verdict,
            before=SimpleNamespace(fit=fit),
        )
    )


def test_the_named_then_what_fitted_does_as_well_then_the_others_by_rank():
    assert [(r.rank, r.effect) for r in rows()] == [*enumerate("ceabd", 1)]


def test_what_no_slope_showed_is_told_with_what_it_leaves_when_fitted():
    named, hidden, *_ = rows()
    assert "fitted, it brings it to 1.50%" in named.sentence
    assert "no trace" not in named.sentence
    assert "leaves no trace" in hidden.sentence
    assert hidden.sentence.endswith("but fitted it brings the error from 3.00% to 1.20%")
    assert hidden.verdict == "same family"


@pytest.mark.parametrize(
    ("after", "said"),
    [
        ((0.99, 0.99, 0.999), "significant and small"),
        ((0.70, 1.10, 1.05), "not in most blocks"),
        ((1.10, 1.10, 0.99), "does not carry over"),
    ],
)
def test_what_is_not_worth_a_name_is_called_small_only_where_it_is(after, said):
    """A wind that took a fifth of the squared error off, in three blocks of six, was small."""
    carried = Carried((1.0,) * 3, after)
    one = replace(candidate("w"), p_value=0.001, carried=carried)
    found = SimpleNamespace(verdict=Verdict("cannot tell", None, (), ""), refits=())
    assert place_in_ranking(one, found) == said
    fitted = SimpleNamespace(candidate=one, carried=Carried((1.0,) * 6, (0.7,) * 6))
    assert place_in_ranking(one, SimpleNamespace(**vars(found) | {"refits": [fitted]})) == (
        "stands out"  # what was fitted tells more than what its slope foretold
    )
