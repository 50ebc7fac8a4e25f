"""A plain offset: an output that is off on average in a trial, as a sensor's zero is."""

from typing import Final

import numpy as np

from trialid.diagnosis.leftover import words
from trialid.diagnosis.leftover.bins import bars, explained, in_reports, weights
from trialid.diagnosis.leftover.chance import Colour, means, squares
from trialid.diagnosis.leftover.finding import Examined, Finding
from trialid.diagnosis.leftover.record import Leftover

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
    share = explained(left, output, np.where(standing, mean.value, 0.0), held)
    names = [r.trial.name for r in left.parts]
    value = float(mean.value[worst]) * in_reports(left, output)
    said = f"in {names[worst]!r} the prediction is on average {words.off(left, output, value)}"
    others = int(standing.sum()) - 1
    said += f", and {others} more of the trials" if others else ""
    said += f"; such offsets are {words.share(share)} of its squared error"
    excess = float(held.share[standing].sum() / held.samples[standing].sum())
    picture = bars(left, output, ("trial", ""), np.arange(len(names) + 1.0), held, mean, standing,
                   names)  # fmt: skip
    finding = Finding(
        left.outputs[output], "mean offset", share, share, excess, 1.0,
        f"{words.name(left.outputs[output])}: {said}", picture, names[worst],
    )  # fmt: skip
    return Examined(least, (finding,))
