"""A wind that an anemometer logged is fitted, whatever its slope says of it."""

from types import SimpleNamespace

import pytest
from s175q import MODEL

from trialid.diagnosis.search.score import Candidate
from trialid.diagnosis.search.stand_in import further_winds
from trialid.effects import CATALOGUE

WINDS = ("apparent_wind", "apparent_wind_yaw")


def candidate(name):
    """One whose slope foretells nothing, beyond its physical range."""
    return Candidate(
        effect=CATALOGUE[name],
        expected={},
        eps_predicted=0.4,
        score=0.0,
        p_value=1.0,
        visibility=0.5,
        family=(name,),
        allowed=False,
    )


def fitted(model=MODEL):
    return SimpleNamespace(model=model)


RANKING = tuple(map(candidate, ("yaw_froude_r", *WINDS, "steady_wind")))


def test_both_are_fitted_though_their_slopes_are_unphysical():
    found = further_winds(fitted(), RANKING, ())
    assert tuple(c.effect.name for c in found) == WINDS
    assert all(c.allowed for c in found)


@pytest.mark.parametrize("name", WINDS)
def test_none_beside_a_wind_of_the_model_nor_twice(name):
    assert further_winds(fitted(MODEL + CATALOGUE[name]), RANKING, ()) == []
    done = (SimpleNamespace(candidate=candidate(name)),)
    [other] = further_winds(fitted(), RANKING, done)
    assert other.effect.name != name
