"""A plain offset: an output that is off on average in a trial, as a sensor's zero is."""

from typing import Final

import numpy as np

from trialid.diagnosis.where import words
from trialid.diagnosis.where.bins import in_reports, share_of_means, weights
from trialid.diagnosis.where.finding import Examined
from trialid.diagnosis.where.leftover import Leftover
from trialid.diagnosis.where.slice_finding import slice_finding
from trialid.diagnosis.where.slice_test import Colour, means, squares

LEVEL: Final = 0.05


def offset(left: Leftover, colour: Colour, output: int) -> Examined:
    """Whether an output is off on average in any of the trials."""
    inside = np.zeros((len(left.eps), len(left.spans)), dtype=bool)
    for k, span in enumerate(left.spans):
        inside[span, k] = True
    mean = means(left, colour, output, weights(inside, left.compared[:, output]))
    least = min(float(mean.p.min()) * len(mean.p), 1.0)
    if least > LEVEL:
        return Examined(least)
    held = squares(left, colour, output, inside)
    standing = mean.p <= LEVEL / len(mean.p)
    worst = int(np.argmin(mean.p))
    share = share_of_means(left, output, np.where(standing, mean.value, 0.0), held)
    names = [r.trial.name for r in left.parts]
    value = float(mean.value[worst]) * in_reports(left, output)
    said = (
        f"in {names[worst]!r} the prediction is on average {words.how_far_off(left, output, value)}"
    )
    others = int(standing.sum()) - 1
    said += f", and {others} more of the trials" if others else ""
    said += f"; such offsets are {words.share(share)} of its squared error"
    finding = slice_finding(
        left,
        output,
        held,
        standing,
        kind="mean offset",
        said=said,
        share=share,
        samples=0.0,
        by=("trial", ""),
        edges=np.arange(len(names) + 1.0),
        mean=mean,
        names=names,
        trial=names[worst],
    )
    return Examined(least, (finding,))
