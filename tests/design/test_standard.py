import numpy as np
import pytest
from s175q import MODEL, SHAFT
from waters import VESSEL, D

from trialid.design import manoeuvres, measures
from trialid.design.helm import carry_out, vessel
from trialid.design.measures import Criterion
from trialid.design.standard import Measure, predict


def test_the_measures_are_those_of_the_manoeuvres():
    found = {m.criterion.name: m for m in predict([VESSEL])}
    circle = measures.turning(carry_out(VESSEL, manoeuvres.turning_circle(35 * D), 20.0, 2000.0))
    for name in ("advance", "tactical diameter"):
        assert found[name].value == pytest.approx(circle[name])
    over = measures.overshoots(carry_out(VESSEL, manoeuvres.zigzag(10 * D, 10 * D), 20.0, 800.0))
    assert found["second overshoot 10/10"].value == pytest.approx(over[1] / D)
    assert all(m.interval is None for m in found.values())
    assert all(m.kept for m in found.values())


def test_what_she_might_be_gives_the_interval():
    draw = np.random.default_rng(1)
    others = [
        vessel(
            MODEL.with_values({"Nr": MODEL.value("Nr") * (1 + 0.05 * z)}), 0.5, {"n": SHAFT}, 5 * D
        )
        for z in draw.standard_normal(12)
    ]
    found = predict([VESSEL, *others])
    by_hand = [next(m.value for m in predict([o]) if m.criterion.name == "advance") for o in others]
    advance = next(m for m in found if m.criterion.name == "advance")
    low, high = advance.interval
    assert high - low == pytest.approx(2 * 1.96 * np.std(by_hand, ddof=1))
    assert low < advance.value < high


@pytest.mark.parametrize(
    ("value", "interval", "kept"),
    [(8.0, None, True), (12.0, None, False), (8.0, (6.0, 9.9), True), (9.0, (7.0, 11.0), None),
     (12.0, (10.5, 13.5), False), (None, None, None)],
)  # fmt: skip
def test_a_criterion_is_kept_broken_or_open(value, interval, kept):
    assert Measure(Criterion("x", 10.0, "deg", ""), value, interval).kept is kept
