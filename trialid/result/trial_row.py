"""One trial of a fit as a row of a result."""

from collections.abc import Mapping

import numpy as np

from trialid.identification.trial_score import Score
from trialid.result.fit_rows import LogRow, TrialRow


def trial_row(score: Score, band: Mapping[str, float]) -> TrialRow:
    """What was logged, its error, and how much of it the band holds."""
    trial = score.trial
    return TrialRow(
        name=trial.name,
        use=trial.use,
        logs=tuple(LogRow(path=g.path, sha256=g.sha256, adapter=g.adapter) for g in trial.logs),
        samples=trial.samples,
        period=trial.period,
        duration=trial.duration,
        remarks=(*trial.remarks, *_departure(score)),
        eps_rmsn=dict(score.eps_rmsn),
        inside=_inside(score, band),
    )


def _inside(score: Score, band: Mapping[str, float]) -> dict[str, float | None]:
    """Share of the compared samples that lie within the band, by output; none where it was lost."""
    if score.response.departure is not None:
        return {}
    shares = dict[str, float | None]()
    for c, (name, half) in enumerate(band.items()):
        compared = score.compared[:, c]
        off = np.abs(score.trial.signals[name] - score.response.y[:, c])[compared]
        shares[name] = float(np.mean(off <= half)) if off.size else None
    return shares


def _departure(score: Score) -> list[str]:
    departure = score.response.departure
    return [] if departure is None else [f"simulation: {departure}; so the trial has no score"]
