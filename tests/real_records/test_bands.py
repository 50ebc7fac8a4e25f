"""Bands of predictions on real records: what is measured in held-out trials lies inside."""

import numpy as np
import pytest
from basin import RECORDS, held_in_basin, in_basin
from pond import ESSO, held_on_pond, on_pond
from real_record import DATA

from trialid.diagnosis.prediction_band import prediction_band
from trialid.pipeline_file import load
from trialid.workflow.build_model import available
from trialid.workflow.fit_model import fit_of
from trialid.workflow.read_trials import align_trials

pytestmark = [
    pytest.mark.study(turn=6),
    pytest.mark.real_data,
    pytest.mark.skipif(not DATA.is_dir(), reason=f"no real records {DATA}"),
]
CHOICES = 6
"""Which trials are held out: so many choices of each kind of record."""


def inside(path):
    """Share of each held-out trial's samples in the band of the fit of the others, by output."""
    pipeline = load(path)
    trials = align_trials(pipeline, lambda words, share: None)
    fit = fit_of(pipeline, trials, available(pipeline), lambda words, share: None)
    band = prediction_band(fit)
    found = []
    for score in (s for s in fit.scores if s.trial.use == "check"):
        for c, name in enumerate(fit.problem.outputs):
            kept = score.compared[:, c]
            off = np.abs(score.trial.signals[name] - score.response.y[:, c])[kept]
            found.append(float(np.mean(off <= band[name])))
    return found


def told(what, shares):
    """The mean over trials, with an interval from draws of whole trials; printed."""
    rng, shares = np.random.default_rng(1), np.asarray(shares)
    drawn = shares[rng.integers(len(shares), size=(2000, len(shares)))].mean(axis=1)
    low, high = np.quantile(drawn, (0.025, 0.975))
    of = f"({low:.0%}-{high:.0%}) of {len(shares)} series, worst {shares.min():.0%}"
    print(f"{what}: {shares.mean():.1%} {of}")
    return float(low), float(high)


def assert_calibrated(what, shares):
    """90 to 97 % is asked for: the interval of what was counted reaches into that."""
    low, high = told(what, shares)
    assert low <= 0.97
    assert high >= 0.90
    assert np.mean(shares) > 0.85


@pytest.mark.skipif(not ESSO.is_dir(), reason="no records of the Esso Osaka")
def test_zigzags_on_a_pond_in_wind(tmp_path):
    """A linear model that leaves a third of the motion: a band that is honest is wide."""
    pairs, shares = on_pond(tmp_path), []
    for held in pairs[:: len(pairs) // CHOICES]:
        shares += inside(held_on_pond(tmp_path, held))
    assert_calibrated("Esso Osaka", shares)


@pytest.mark.skipif(not RECORDS.is_dir(), reason="no records of the KVLCC2")
def test_zigzags_in_a_basin(tmp_path):
    """From 5 to 30 degrees, any four fitted by a linear model: some are foretold from far off."""
    names = sorted({n for held in in_basin(tmp_path) for n in held})
    rng, shares = np.random.default_rng(0), []
    for _ in range(CHOICES):
        shares += inside(held_in_basin(tmp_path, tuple(rng.permutation(names)[4:])))
    assert_calibrated("KVLCC2", shares)
