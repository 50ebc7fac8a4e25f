"""A rudder that keeps a boat on her course answers gusts, and looks as if small angles did nothing.

Missions of seeds 70 and on; the rule was found on an outsider's missions and on seeds up to 61.
"""

from dataclasses import replace
from types import SimpleNamespace

import missions
import numpy as np
import pytest

from trialid.diagnosis import objections
from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.objections import more_on_course
from trialid.diagnosis.records.course_keeping import (
    by_the_rudder,
    gained_on_course,
    mostly_on_course,
    stretches_on_course,
    zigzag_first,
)
from trialid.diagnosis.records.rudder_jumps import own_time
from trialid.diagnosis.verdict import Verdict
from trialid.effects import CATALOGUE
from trialid.identification.inadequate import Inadequate
from trialid.identification.output_error import stretches
from trialid.trial import Trial

SEEDS = (70, 71, 72)


def sailed(seed: int, *, kept: bool, dead: float = 0.0) -> Trial:
    boat = missions.Boat(dead=np.deg2rad(dead))
    return missions.mission(boat, np.random.default_rng(seed), "mission", kept=kept)


def share_kept(trial: Trial) -> float:
    """Share of a trial in which the rudder is found to follow the heading."""
    [kept] = stretches_on_course([trial], 8.0 / 5.5)
    return float(kept.mean())


@pytest.mark.parametrize("seed", SEEDS)
def test_a_rudder_that_follows_the_heading_is_found_between_the_turns(seed: int) -> None:
    assert 0.4 < share_kept(sailed(seed, kept=True)) < 0.9


@pytest.mark.parametrize("seed", SEEDS)
def test_one_that_is_put_over_and_held_is_not(seed: int) -> None:
    """Nor one that would turn her as it goes: it does not stop her."""
    assert share_kept(sailed(seed, kept=False)) == 0.0
    kept = sailed(seed, kept=True)
    turned = replace(kept, signals={**kept.signals, "r": -kept.signals["r"]})
    assert share_kept(turned) == 0.0


@pytest.mark.parametrize("seed", SEEDS)
def test_so_it_is_where_turns_are_rare(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """What few angles exceed is then small itself: of four such records a fifth at most was."""
    monkeypatch.setattr(missions, "LEG", 600.0)
    monkeypatch.setattr(missions, "DURATION", 2000.0)
    rare = sailed(seed, kept=True)
    turned = np.abs(rare.signals["delta"]) > np.deg2rad(8.0)
    assert 0.0 < turned.mean() < 0.05
    assert share_kept(rare) > 0.8


def test_where_the_rate_was_not_measured_nothing_is_known() -> None:
    kept = sailed(70, kept=True)
    rest = {n: x for n, x in kept.signals.items() if n != "r"}
    assert share_kept(replace(kept, signals=rest)) == 0.0
    lost = np.ones(kept.samples, dtype=bool)
    lost[::20] = False
    assert share_kept(replace(kept, valid={**kept.valid, "r": lost})) == 0.0


def test_what_goes_by_the_angle_of_the_rudder() -> None:
    by_it = {n for n, e in CATALOGUE.items() if by_the_rudder(e)}
    assert {"rudder_deadband", "rudder_cubic", "linear_rudder"} <= by_it
    assert not {"rudder_offset", "steady_wind", "yaw_drag_rar", "delay_r"} & by_it


def verdict_of(seed: int, *, kept: bool, dead: float = 0.0) -> Verdict:
    boat = missions.Boat(dead=np.deg2rad(dead))
    return diagnose(missions.mission_fit(boat, seed, kept=kept)).verdict


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("dead", [0.0, 1.0])
@pytest.mark.parametrize("seed", [70, *SEEDS[1:]])
def test_no_dead_band_is_named_where_the_rudder_keeps_her_on_course(seed: int, dead: float) -> None:
    """Whether she has one or not: nothing else is named in its place, and a zig-zag would tell.

    A play behind the indicator looks the same, and needs no order on record.
    """
    found = verdict_of(seed, kept=True, dead=dead)
    assert (found.kind, found.effect, found.together) == ("cannot tell", None, ())
    assert found.sentence.startswith(("with rudder_deadband the ", "with rudder_backlash the "))
    assert "while the rudder keeps her on her course" in found.sentence


@pytest.mark.study(turn="each")
def test_what_is_named_does_more_than_what_looks_like_the_rudder() -> None:
    """Two effects at once, too; else they stand in for what the rudder may have."""
    fit = missions.mission_fit(missions.Boat(dead=np.deg2rad(1.0)), 70, kept=True)
    found = diagnose(fit)
    band = next(r for r in found.refits if r.candidate.effect.name == "rudder_deadband")
    less = next(r for r in found.refits if 1.1 * band.fit.eps_rmsn < r.fit.eps_rmsn)
    assert more_on_course(fit, [band, less], 0.05, less) is band
    assert more_on_course(fit, [band, less], 0.05, None) is band
    assert more_on_course(fit, [band, less], 0.05, band) is None


def test_what_is_gained_in_turns_is_not_gained_on_course() -> None:
    fit = missions.mission_fit(missions.Boat(), 70, kept=True)
    kept = stretches_on_course(fit.problem.trials, own_time(fit))
    on_course = np.concatenate([kept[p.trial][p.compared] for p in stretches(fit.problem)])
    for better, gained in ((on_course, True), (~on_course, False)):
        after = SimpleNamespace(residual=np.where(better, 0.5, 1.0) * fit.residual)
        assert gained_on_course(fit, after) is gained


@pytest.mark.parametrize("converged", [True, False])
@pytest.mark.parametrize(("kept", "told"), [(True, True), (False, False)])
def test_of_no_fit_on_course_a_zigzag_is_the_way_out(
    kept: bool, told: bool, converged: bool
) -> None:
    """The first one where the search failed."""
    fit = missions.mission_fit(missions.Boat(), 71, kept=kept)
    failed = Inadequate("the search did not converge", "free fewer parameters")
    found = zigzag_first(replace(fit, converged=converged), failed)
    assert (found == failed) is not told
    assert found.reason == failed.reason
    assert ("fit a zig-zag" in found.advice) == told
    assert found.advice.endswith(failed.advice) == (not told or not converged)
    assert len(mostly_on_course(fit)) == told
    assert all("% of the time an autopilot keeps her" in one for one in mostly_on_course(fit))


@pytest.mark.study(turn=1)
def test_where_nobody_looks_one_is_named_that_she_does_not_have(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(objections, "gained_on_course", lambda *_: False)
    assert verdict_of(70, kept=True).effect == "rudder_deadband"


@pytest.mark.study(turn=1)
@pytest.mark.parametrize("seed", SEEDS)
def test_a_dead_band_is_named_where_the_rudder_is_put_over(seed: int) -> None:
    assert verdict_of(seed, kept=False, dead=1.0).effect == "rudder_deadband"
    assert verdict_of(seed, kept=False).effect != "rudder_deadband"
