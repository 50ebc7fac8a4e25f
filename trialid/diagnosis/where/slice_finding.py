"""What stands out of the bins of a slice, as a finding."""

from collections.abc import Sequence

from trialid.arrays import Mask, Vector
from trialid.diagnosis.where import words
from trialid.diagnosis.where.bins import bars
from trialid.diagnosis.where.finding import Finding
from trialid.diagnosis.where.leftover import Leftover
from trialid.diagnosis.where.slice_test import Means, Squares


def slice_finding(
    left: Leftover,
    output: int,
    held: Squares,
    standing: Mask,
    *,
    kind: str,
    said: str,
    share: float,
    samples: float,
    by: tuple[str, str],
    edges: Vector,
    mean: Means | None,
    names: Sequence[str] = (),
    trial: str | None = None,
) -> Finding:
    """The finding on the bins that stand out; its chance is corrected where all findings are known.

    Parameters
    ----------
    held, standing
        Squares of all bins, and which of them the finding is about; (bins,).
    kind, share, trial
        As in `Finding`.
    said
        The sentence behind the output's name.
    samples
        Share of the error that bins without a fault would have.
    by, edges, mean, names
        What the picture shows, as in `bars`.
    """
    return Finding(
        output=left.outputs[output],
        kind=kind,
        share=share,
        beyond=share - samples,
        excess=float(held.share[standing].sum() / held.samples[standing].sum()),
        p_value=1.0,
        sentence=f"{words.name(left.outputs[output])}: {said}",
        picture=bars(
            left=left,
            output=output,
            by=by,
            edges=edges,
            held=held,
            mean=mean,
            standing=standing,
            names=names,
        ),
        trial=trial,
    )
