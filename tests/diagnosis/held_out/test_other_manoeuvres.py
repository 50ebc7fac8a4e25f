"""Trials held out of another size than those fitted: a name must hold there, too, or there is none.

The truth is the S175Q with a yaw damping that is mostly quadratic; the model has it linear.
"""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from s175q import MODEL, white, with_noise, zigzag

from trialid.diagnosis.diagnose import diagnose
from trialid.diagnosis.left_by_check import with_held_out
from trialid.diagnosis.noise import thinning
from trialid.diagnosis.search.falls import fall, fall_of_check
from trialid.identification.adequacy import why_no_fit
from trialid.identification.fit import identify
from trialid.identification.inadequate import Inadequate
from trialid.identification.problem import Settings

LINEAR = MODEL - "yaw_drag_rar"
SETTINGS = Settings(("Nv", "Nr", "Ndelta"), ("r",), nuisance=("initial_state",))


def sailed(angles, held=2, *, of_file, linear, rudder=1.0, ahead=1.0, noise=1.0):
    """Zig-zags fitted by the linear model, and one held out whose rudder is logged so many times.

    The yaw damping's two parts and the rudder are so many times those of the file, the noise so
    many times a gyro's.
    """
    times = {"Nrar": of_file, "Nr": linear, "Ndelta": rudder}
    truth = MODEL.with_values({n: k * MODEL.value(n) for n, k in times.items()})
    made = []
    for angle in (*angles, held):
        trial = zigzag(angle, truth, use="check" if angle == held else "fit")
        sensors = white(np.random.default_rng(angle), trial.samples)
        trial = with_noise(trial, *(noise * e for e in sensors))
        if angle == held:
            signals = {**trial.signals, "delta": ahead * trial.signals["delta"]}
            trial = replace(trial, signals=signals)
        made.append(trial)
    return identify(made, LINEAR, SETTINGS)


@pytest.fixture(scope="module")
def mended():
    return sailed((10, 20), of_file=4, linear=0.1, rudder=1.5)


@pytest.fixture(scope="module")
def found(mended):
    return diagnose(mended)


def test_what_a_name_mends_is_no_failed_fit(mended, found):
    """The smallest zig-zag is foretold worse than by no model, and as the others with the name."""
    assert "'zigzag-2' is foretold worse than by no model" in why_no_fit(mended).reason
    assert found.verdict.kind == "missing"
    assert found.verdict.effect == "yaw_drag_rar"
    assert found.after.fit.eps_check < 0.2 * mended.eps_check
    assert why_no_fit(found.after.fit) is None


def test_what_no_name_mends_stays_a_failed_fit():
    """One large zig-zag has nothing that tells quadratic damping from linear."""
    fit = sailed((20,), of_file=4, linear=0.1, rudder=1.5)
    found = diagnose(fit)
    assert found.verdict.kind == "no fit"
    assert str(why_no_fit(fit)) in found.verdict.sentence
    assert found.ranking == found.refits == ()
    assert found.after is None


@pytest.mark.study(turn="each")
def test_a_name_with_which_the_fit_fails_as_before_mends_nothing(mended, found, monkeypatch):
    assert found.verdict.kind == "missing"
    lost = Inadequate("a held-out trial is foretold by nothing", "look at it", may_lack=True)
    monkeypatch.setattr("trialid.diagnosis.diagnose.why_no_fit", lambda fit: lost)
    assert diagnose(mended).verdict.kind == "no fit"


@pytest.mark.study(turn="each")
def test_a_rudder_logged_the_wrong_way_stays_one_beside_a_hidden_effect():
    fit = sailed((10, 20), 5, of_file=4, linear=0.5, ahead=-1.0)
    assert "wrong" not in str(why_no_fit(fit))
    assert diagnose(fit).verdict.kind == "no fit"


@pytest.mark.study(turn="each")
def test_the_damping_is_named_although_its_slope_foretells_less_than_a_late_gyro():
    """The gyro takes 11 % off and leaves the trial held out as it is; it is shown less surely."""
    found = diagnose(sailed((20,), 5, of_file=12, linear=0.05, rudder=2.0))
    assert (found.verdict.kind, found.verdict.effect) == ("missing", "yaw_drag_rar")
    assert found.after is not None
    assert found.after.fit.eps_check < 0.5 * found.before.fit.eps_check


@pytest.mark.study(turn="each")
def test_a_name_that_explains_little_where_others_leave_much_is_none():
    """A roll by the rudder took 3 % off; the damping would take 85 %."""
    found = diagnose(sailed((20,), 2, of_file=8, linear=0.3))
    assert found.verdict.kind == "cannot tell"
    assert found.after is None
    assert "of the squared error off the fitted trials" in found.verdict.sentence
    assert "something greater is missing that acts there" in found.verdict.sentence


def test_a_name_stays_by_what_it_takes_off_either(mended, found):
    """Of the trials held out, or of the fitted ones; in a record that leaves much in both."""
    named = next(r for r in found.refits if r.candidate.effect.name == found.verdict.effect)

    def judged(off_fitted, off_held):
        """The verdict, were the falls of the squared errors these."""
        fitted, held = (np.sqrt(1.0 - x) for x in (off_fitted, off_held))
        changed = SimpleNamespace(
            eps_rmsn=fitted * mended.eps_rmsn, eps_check=held * mended.eps_check
        )
        changed.examined = changed
        other = replace(named, fit=changed)
        covariance = found.before.accuracy.covariance
        return with_held_out(mended, found.verdict, lambda: covariance, 0.05, other).kind

    assert fall(mended, named) > 0.8
    assert fall_of_check(mended, named) > 0.8
    assert judged(0.05, 0.02) == "cannot tell"
    assert judged(0.05, 0.2) == "missing"
    assert judged(0.99, 0.05) == "missing"


@pytest.mark.study(turn="each")
def test_of_a_long_record_means_are_held_against_means(monkeypatch):
    """Most of what every sample leaves is noise here, and means hold little of that."""
    monkeypatch.setattr(thinning, "LONGEST", 600)
    fit = sailed((5, 10), 20, of_file=4, linear=0.5, noise=3.0)
    found = diagnose(fit)
    assert found.before.fit.examined.eps_rmsn < 0.6 * found.before.fit.eps_rmsn
    assert (found.verdict.kind, found.verdict.effect) == ("missing", "yaw_drag_rar")
