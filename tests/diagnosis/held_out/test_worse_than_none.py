"""When a trial that was held out is foretold worse than by no model."""

import pytest

from trialid.identification import adequacy


@pytest.mark.parametrize(
    ("left", "lost"),
    [
        ((0.74, 2.25, 1.61), True),
        ((0.74, 0.9, 1.61), False),
        ((0.1, 3.0), False),
        ((1.1, 3.0), True),
    ],
)
def test_most_of_what_moves_must_be_foretold_better_than_by_its_mean(monkeypatch, left, lost):
    """A boat that turned to the other side kept some of her speed; one output alone says less."""
    shares = dict(zip("uvr", left, strict=False))
    monkeypatch.setattr(adequacy, "unexplained_share", lambda fit, scores: shares)
    monkeypatch.setattr(adequacy, "over_noise", lambda fit, scores: dict.fromkeys(shares, 9.0))
    assert bool(adequacy.worse_than_none(None, None)) is lost
