"""Samples too far apart for a boat, where her logs have more, are told before anything is named."""

from dataclasses import replace

import pytest
import s175q

from trialid.diagnosis.records.in_doubt import in_doubt, settle
from trialid.diagnosis.records.sampling_in_doubt import sampling_in_doubt
from trialid.diagnosis.verdict import Verdict
from trialid.identification.fit import identify

NAMED = Verdict("missing", "lag_u", ("lag_u",), "lag_u is missing")
OWN = s175q.SHIP.particulars["L"] / s175q.SHIP.particulars["U0"]


@pytest.fixture(scope="module")
def fit():
    return identify([s175q.zigzag(10)], s175q.MODEL, replace(s175q.SETTINGS, free=("Nr",)))


def sampled(fit, share, logged):
    """The same with samples so far apart, by her own time, of logs that have so many a sample."""
    period = share * OWN
    finer = replace(fit.trials[0], period=period, logged_every=period / logged if logged else 0.0)
    return replace(fit, scores=(replace(fit.scores[0], trial=finer),))


@pytest.mark.parametrize(
    ("share", "logged", "told"),
    [(0.3, 5, True), (0.2, 5, False), (0.3, 1, False), (0.3, 0, False), (0.3, 2, True)],
)
def test_samples_of_half_a_second_are_long_for_a_boat_whose_logs_have_more(
    fit, share, logged, told
):
    found = sampled(fit, share, logged)
    doubt = sampling_in_doubt(found)
    assert (doubt is not None) is told is in_doubt(found)
    if doubt is None:
        assert settle(found, NAMED) is NAMED
    else:
        assert f"write period = {share * OWN / logged:.2g} under [align]" in doubt
        assert settle(found, NAMED).doubts == (doubt,)
