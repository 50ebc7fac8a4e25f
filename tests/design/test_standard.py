import numpy as np
import pytest
from s175q import MODEL, SHAFT
from waters import VESSEL, D

from trialid.design import manoeuvres
from trialid.design.helm import Passage, carry_out, vessel
from trialid.design.imo import measures
from trialid.design.imo.measures import Criterion
from trialid.design.standard import Measure, in_calm, predict, sail_all
from trialid.trial import Trial


def test_the_measures_are_those_of_the_manoeuvres():
    """Sailed by hand every half a second, where the helmsman is later than on the ship's clock."""
    found = {m.criterion.name: m for m in predict([VESSEL])}
    circle = measures.turning(carry_out(VESSEL, manoeuvres.turning_circle(35 * D), 20.0, 2000.0))
    for name in ("advance", "tactical diameter"):
        assert found[name].value == pytest.approx(circle[name], rel=0.005)
    over = measures.overshoots(carry_out(VESSEL, manoeuvres.zigzag(10 * D, 10 * D), 20.0, 800.0))
    assert found["second overshoot 10/10"].value == pytest.approx(over[1] / D, rel=0.02)
    assert all(m.interval is None for m in found.values())
    allowed = [m for m in found.values() if m.criterion.largest is not None]
    assert len(allowed) == len(found) - 1
    assert all(m.kept for m in allowed)
    assert found["second overshoot 20/20"].kept is None
    assert found["second overshoot 20/20"].value > found["second overshoot 10/10"].value


@pytest.mark.parametrize("period", [0.1, 2.0])
def test_a_ship_has_one_number_whatever_the_clock_of_her_logs(period):
    other = vessel(MODEL, period, {"n": SHAFT}, 5 * D)
    assert [m.value for m in predict([other])] == [m.value for m in predict([VESSEL])]


def test_she_heads_ahead_whatever_she_headed_in_her_trials():
    """Of an outsider's ship psi began at 340 deg, and her track at 0: the two did not agree."""
    trialled = vessel(MODEL, 0.5, {"n": SHAFT, "psi": 5.93}, 5 * D)
    for one in sail_all(in_calm(trialled)).values():
        assert one.trial.signals["psi"][0] == 0.0
    assert [m.value for m in predict([trialled])] == [m.value for m in predict([VESSEL])]


def test_a_ship_that_never_turns_back_is_a_line_and_no_crash():
    """With hardly any rudder she turns by 10 deg in no reasonable time: no reversal, no overshoot.

    Nor is there a circle; and each measure says why it has no number.
    """
    lame = {n: 1e-3 * MODEL.value(n) for n in ("Ydelta", "Ndelta", "Kdelta")}
    ship = vessel(MODEL.with_values(lame), 0.5, {"n": SHAFT}, 5 * D)
    passage = carry_out(ship, manoeuvres.zigzag(10 * D, 10 * D), 20.0, 600.0)
    assert measures.overshoots(passage) == []
    for one in predict([ship]):
        assert (one.value, one.interval, one.kept) == (None, None, None)
    said = {m.criterion.name: m.remark for m in predict([ship])}
    assert said["first overshoot 10/10"] == "no such overshoot in 90 ship lengths"
    assert said["tactical diameter"].startswith("the turn ends at ")
    assert said["initial turning"].startswith("the heading changes by ")


def test_a_ship_that_leaves_her_model_is_a_line():
    wild = vessel(MODEL.with_values({"Nr": 0.01}), 0.5, {"n": SHAFT}, 5 * D)
    said = {m.criterion.name: (m.value, m.remark) for m in predict([wild])}
    value, remark = said["advance"]
    assert value is None
    assert remark.startswith("the ship leaves her model: ")


def test_a_second_overshoot_without_a_first_is_none():
    """A heading that does not go on at the first reversal, and does at the second."""
    k = np.arange(300.0)
    psi = np.where(k < 200, 10 - np.maximum(k - 50, 0) / 5, -20 - 3 + ((k - 225) / 14.4) ** 2) * D
    order = np.where(k < 50, 10 * D, np.where(k < 200, -10 * D, 10 * D))
    trial = Trial("z", "fit", 0.5, {"psi": psi, "delta_order": order}, {})
    assert measures.overshoots(Passage(trial, 0 * k, 0 * k, None)) == []


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


def test_what_has_no_limit_is_neither_kept_nor_broken():
    assert Measure(Criterion("x", None, "deg", ""), 12.0, (11.0, 13.0)).kept is None
