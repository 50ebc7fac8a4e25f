"""Something outside the catalogue is not claimed of what nobody would notice."""

from dataclasses import replace
from types import SimpleNamespace

import pytest
from made_up_fits import NO_ROUTE, fit, refit, split

from trialid.diagnosis.gap_untold import without_gap
from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.completeness import Completeness
from trialid.diagnosis.verdict import decide

GAP = Completeness(catalogue=340.0, any_shape=1000.0)


@pytest.mark.parametrize(("left", "kind"), [(0.00015, False), (0.0025, True)])
def test_a_record_without_noise_leaves_rounding(left: float, kind: bool) -> None:
    """Of a linear ship with two needless coefficients free 0.015 % were left: a gap was claimed."""
    assert GAP.gap
    found = decide(fit(left), (), [], NO_ROUTE, GAP, 0.05)
    assert (found.kind == "not in catalogue") is kind


@pytest.mark.parametrize(("better", "gap"), [(2, False), (3, False), (4, True)])
def test_what_most_blocks_do_not_follow_is_not_claimed(better: int, gap: bool) -> None:
    after = tuple(0.7 if i < better else 1.01 for i in range(6))
    found = replace(GAP, carried=Carried((1.0,) * 6, after))
    assert (found.gap, found.carries_over) == (True, gap)
    claimed = decide(fit(0.10), (), [], NO_ROUTE, found, 0.05)
    assert (claimed.kind == "not in catalogue") is gap


@pytest.mark.parametrize(
    ("foretold", "allowed", "kind"),
    [(0.06, True, "cannot tell"), (0.095, True, "not in catalogue"), (0.06, False, "not in c")],
)
def test_what_chance_does_as_well_is_not_outside_the_catalogue(foretold, allowed, kind) -> None:
    """A waterjet's push went with her revolutions in one trial alone: p = 1, and most of it."""
    one = refit("rudder_race_shaft", 0.5, foretold).candidate
    one.shown, one.allowed = (lambda level: False), allowed
    one.p_value, one.eps_predicted = 1.0, foretold
    claimed = decide(fit(0.10), (one,), [], split(0.03), None, 0.05)
    assert claimed.kind == "not in catalogue"
    found = without_gap(fit(0.10), claimed, (one,), split(0.03), None, 0.05)
    assert found.kind.startswith(kind)
    assert found.family == (("rudder_race_shaft",) if kind == "cannot tell" else ())


def test_what_stands_out_and_was_denied_is_not_said_to_be_chance() -> None:
    one = refit("rudder_race_shaft", 0.5, 0.06).candidate
    one.eps_predicted = 0.06
    claimed = decide(fit(0.10), (), [], split(0.03), None, 0.05)
    assert one.p_value < 0.05
    assert without_gap(fit(0.10), claimed, (one,), split(0.03), None, 0.05) == claimed


@pytest.mark.parametrize(("possible", "kind"), [((), "cannot tell"), (("N",), "not in catalogue")])
def test_no_gap_is_claimed_where_no_force_stands_out(possible, kind) -> None:
    """A compass that jumped had a force in no equation, and the advice to draft one led nowhere."""
    claimed = decide(fit(0.10), (), [], NO_ROUTE, GAP, 0.05)
    force = SimpleNamespace(possible=possible, sentence="no force stands out")
    found = without_gap(fit(0.10), claimed, (), NO_ROUTE, force, 0.05)
    assert found.kind == kind
    assert ("a fault of a sensor" in found.sentence) is (not possible)
    assert without_gap(fit(0.10), claimed, (), NO_ROUTE, None, 0.05) == claimed


def test_what_is_not_noise_is_not_said_to_be_noise() -> None:
    claimed = decide(fit(0.10), (), [], split(0.03), None, 0.05)
    force = SimpleNamespace(possible=(), sentence="no force stands out")
    found = without_gap(fit(0.10), claimed, (), split(0.03), force, 0.05)
    assert found.kind == "cannot tell"
    assert found.sentence == f"{claimed.sentence}; nor does a force: no force stands out"
