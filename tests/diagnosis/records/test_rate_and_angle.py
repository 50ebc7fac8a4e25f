"""A rate that is not the slope of its angle: before that is settled no effect has a name."""

from dataclasses import replace

import pytest
import s175q

from trialid.diagnosis.records.in_doubt import in_doubt, settle
from trialid.diagnosis.records.rate_and_angle import rate_in_doubt
from trialid.diagnosis.verdict import Verdict
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.trial import Contradiction

NAMED = Verdict("missing", "rudder_cubic", ("rudder_cubic",), "rudder_cubic is missing")
SETTINGS = replace(s175q.SETTINGS, free=("Nr",))
LATE = Contradiction(rate="r", angle="psi", late=6.0, sentence="r comes 6 s later")
OWN_TIME = 175.0 / 7.33


@pytest.fixture(scope="module")
def fit() -> Fit:
    return identify([s175q.zigzag(5), s175q.zigzag(10)], s175q.MODEL, SETTINGS)


def with_contradictions(fit: Fit, *of_each: tuple[Contradiction, ...]) -> Fit:
    made = zip(fit.scores, of_each, strict=True)
    scores = (replace(s, trial=replace(s.trial, contradictions=c)) for s, c in made)
    return replace(fit, scores=tuple(scores))


def settled(fit: Fit, found: Contradiction, verdict: Verdict = NAMED) -> Verdict:
    return settle(with_contradictions(fit, (found,), (found,)), verdict)


def test_nothing_has_a_name_where_the_rate_is_late(fit: Fit) -> None:
    said = settled(fit, LATE)
    assert (said.kind, said.effect, said.doubts) == ("cannot tell", None, ("r comes 6 s later",))
    assert said.sentence == "r comes 6 s later; until then no effect is named"
    nothing = Verdict("nothing missing", None, (), "no effect stands out")
    assert settled(fit, LATE, nothing).kind == "cannot tell"
    failed = settled(fit, LATE, Verdict("no fit", None, (), "no fit: another ship"))
    assert (failed.kind, failed.doubts) == ("no fit", ("r comes 6 s later",))
    assert failed.sentence == "no fit: r comes 6 s later; another ship"


def test_nor_where_it_reads_less(fit: Fit) -> None:
    assert settled(fit, replace(LATE, late=0.0, factor=0.9)).kind == "cannot tell"


@pytest.mark.parametrize(
    "found",
    [
        replace(LATE, late=0.05 * OWN_TIME),
        replace(LATE, late=-6.0),
        replace(LATE, rate="p", angle="phi", late=6.0),
    ],
    ids=["by little", "the heading is", "of what is not fitted"],
)
def test_a_name_stays_where_it_is_no_matter_of_the_fit(fit: Fit, found: Contradiction) -> None:
    """No sensor is early: where the rate comes first the angle is late, which is not fitted."""
    assert settled(fit, found) is NAMED


def test_an_angle_that_is_late_counts_where_it_is_fitted(fit: Fit) -> None:
    assert settled(fit, replace(LATE, rate="p", angle="phi", late=-6.0)).kind == "cannot tell"


def test_of_some_trials_it_is_told_which(fit: Fit) -> None:
    one = with_contradictions(fit, (LATE,), ())
    assert rate_in_doubt(one) == "in zigzag-5 r comes 6 s later"
    assert in_doubt(one)
    assert not in_doubt(held_out(one, 0))


def held_out(fit: Fit, place: int) -> Fit:
    kept = [*fit.scores]
    kept[place] = replace(kept[place], trial=replace(kept[place].trial, use="check"))
    return replace(fit, scores=tuple(kept))


def test_of_several_trials_the_middle_one_is_told(fit: Fit) -> None:
    three = replace(fit, scores=(*fit.scores, fit.scores[0]))
    found = [replace(LATE, late=x, sentence=f"{x:g} s") for x in (9.0, 5.0, 6.0)]
    assert rate_in_doubt(with_contradictions(three, *((one,) for one in found))) == "6 s"


@pytest.mark.parametrize("sensor", ["delay_r", "lag_r"])
def test_an_effect_of_the_sensor_settles_it(fit: Fit, sensor: str) -> None:
    """In the model, or named."""
    late = with_contradictions(fit, (LATE,), (LATE,))
    named = replace(NAMED, effect=sensor)
    assert settle(late, named, CATALOGUE[sensor]) is named
    assert settle(late, NAMED, CATALOGUE["rudder_cubic"]).kind == "cannot tell"
    effect = CATALOGUE[sensor]
    typical = {n: p.start for n, p in effect.parameters.items()}
    beside = (s175q.MODEL + effect).with_values(typical)
    again = identify([s175q.zigzag(5), s175q.zigzag(10)], beside, SETTINGS)
    assert not in_doubt(replace(again, scores=late.scores))


def test_a_trial_held_out_is_asked_by_its_name(fit: Fit) -> None:
    """An outsider's gyro read 1.08 of the heading's slope there, and no word was said of it."""
    found = with_contradictions(fit, (), (LATE,))
    held = replace(found.scores[1], trial=replace(found.scores[1].trial, use="check"))
    found = replace(found, scores=(found.scores[0], held))
    assert rate_in_doubt(found) is None
    assert rate_in_doubt(found, held="zigzag-10") == "in zigzag-10 r comes 6 s later"
    assert rate_in_doubt(found, held="zigzag-5") is None
