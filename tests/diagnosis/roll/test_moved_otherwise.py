"""A roll that a swell makes is left by every model, and what it does to the yaw has no name."""

from dataclasses import replace

import numpy as np
import pytest
import s175q
from scipy.signal import lfilter

from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.examine import examine_fit
from trialid.diagnosis.objections import BESIDE, objection, outputs_beside
from trialid.diagnosis.search.carried import Carried
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.score import Candidate
from trialid.diagnosis.verdict import Verdict, decide
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.progress import silent
from trialid.simulation.integrate import prepare, respond

FREE = ("Nv", "Nr", "Ndelta", "Kv", "Kr", "Kdelta", "Kp", "GM")
ASKED = replace(s175q.SETTINGS, free=FREE)
HIDDEN = CATALOGUE["yaw_drag_rar"]
LACKS = s175q.MODEL - HIDDEN.name


def swell(rng: np.random.Generator, n: int, size: float) -> np.ndarray:
    """A heel of her own period, 12 s, that comes and goes [rad]; (n,)."""
    pole = np.exp((-0.03 + 1j) * 2.0 * np.pi / 12.0 * 0.5)
    e = lfilter([1.0], [1.0, -2.0 * pole.real, abs(pole) ** 2], rng.standard_normal(n + 500))[500:]
    return np.asarray(size * e / np.std(e))


def fitted(model, size: float) -> Fit:
    """Two zig-zags of the whole ship, with that much of a swell in her roll, fitted by a model."""
    trials = []
    for i, angle in enumerate((10, 20)):
        rng, trial = np.random.default_rng([41, i]), s175q.zigzag(angle)
        r, phi = s175q.white(rng, trial.samples)
        moved = phi + swell(rng, trial.samples, size * np.std(trial.signals["phi"]))
        trials.append(s175q.with_noise(trial, r, moved))
    return identify(trials, model, ASKED)


def refitted(fit: Fit, whole: Fit) -> Refit:
    """The whole ship's fit as what the search for the effect that lacks would give."""
    said = {"eps_predicted": 0.1, "score": 90.0, "p_value": 1e-3, "visibility": 0.5}
    carried = Carried((1.0,) * 8, (0.5,) * 8)
    one = Candidate(HIDDEN, {"Nrar": -0.01}, **said, family=(), allowed=True, carried=carried)
    return Refit(one, whole, carried)


def said_of(before: Fit, found: Refit) -> Verdict:
    """The verdict where nothing else was tried."""
    asked = DiagnoseSettings(candidates={}, coefficients=False)
    split = examine_fit(before, asked, silent)[0].split
    return decide(before, [found.candidate], [found], split, None, 0.05)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize(
    ("size", "beside"),
    [
        pytest.param(0.0, (), marks=pytest.mark.study(turn="each")),
        (0.3, ()),
        (1.2, ("phi",)),
    ],
)
def test_an_effect_of_the_yaw_has_a_name_where_the_roll_is_explained(size, beside) -> None:
    before, after = fitted(LACKS, size), fitted(s175q.MODEL, size)
    found = refitted(before, after)
    assert outputs_beside(before, found) == beside
    assert (objection(before, found, 0.05) == BESIDE) is bool(beside)
    if beside:
        said = said_of(before, found)
        assert (said.kind, said.effect) == ("cannot tell", None)
        assert "of phi is left as before: something else moves that" in said.sentence


@pytest.mark.study(turn="each")
def test_what_makes_the_output_has_a_part_in_it() -> None:
    """A list that is most of the heel, which the model lacks: with it nothing is left."""
    listed = (s175q.MODEL + CATALOGUE["static_list"]).with_values({"a_0": 0.05})
    trials = []
    for i, angle in enumerate((10, 20)):
        blank = s175q.zigzag(angle)
        simulator = prepare(listed, (), s175q.OUTPUTS)
        y = respond(simulator, blank, {}, {"u": 7.33}, sensitivities=False).y
        signals = {**blank.signals, "r": y[:, 0], "phi": y[:, 1]}
        rng = np.random.default_rng([43, i])
        trials.append(
            s175q.with_noise(replace(blank, signals=signals), *s175q.white(rng, blank.samples))
        )
    before = identify(trials, s175q.MODEL, ASKED)
    after = identify(trials, listed, replace(ASKED, free=(*FREE, "a_0")))
    assert outputs_beside(before, refitted(before, after)) == ()
