"""What was known before the record, in words: what speaks against it, how much of it is left."""

from collections.abc import Sequence
from typing import Final

from trialid.names import wording
from trialid.result.fit_rows import ParameterRow

CONTRADICTS: Final = 3.0
"""Standard deviations at which the record speaks against a prior."""

BOTH: Final = 2.0
"""Standard deviations that hold 95 %. With half of it one in fourteen that is as known is told, by
a likely range that just does not hold it; with twice what is off by four is taken for as known."""

LEAST: Final = 0.01
"""Share that is worth a word."""

NAMED: Final = 8
"""Parameters that a sentence names before it only counts them."""


def prior_words(parameters: Sequence[ParameterRow]) -> str:
    r"""Which priors the record contradicts, and how much of each parameter is its prior's.

    >>> rows = [ParameterRow(name="Yr", value=2.9, prior=(3.0, 1.0), prior_share=0.9),
    ...         ParameterRow(name="Nr", value=-6.0, prior=(-2.0, 1.0), prior_share=0.04)]
    >>> print(prior_words(rows).replace(wording.THIN, " ").replace(". ", ".\n"))
    The record contradicts what was known of Nr: -6, where -2 +-1 was expected (4.1 deviations).
    Known beforehand, as a share of what is known now: Yr 90 %, Nr 4.0 %.
    >>> prior_words(rows[:0])
    ''
    """
    held = [r for r in parameters if r.kind == "physical" and r.prior_share is not None]
    held.sort(key=lambda row: -(row.prior_share or 0.0))
    if not held:
        return ""
    telling = [r for r in held if (r.prior_share or 0.0) >= LEAST][:NAMED]
    shares = [f"{r.name} {wording.percent(r.prior_share or 0.0, 2)}" for r in telling]
    if not telling:
        shares = [f"less than {wording.percent(LEAST, 1)} of each"]
    more = f" and {len(held) - len(telling)} more, less" if 0 < len(telling) < len(held) else ""
    listed = f"Known beforehand, as a share of what is known now: {', '.join(shares)}{more}."
    return " ".join([*contradictions(held), listed])


def contradictions(parameters: Sequence[ParameterRow]) -> list[str]:
    """A sentence for each prior, worst first, that the record contradicts or the fit alone left.

    An estimate that may be off as far contradicts nothing: of a GM that was known, where the
    inertia in roll was not, the record tells their ratio alone.
    """
    far = [row for row in parameters if abs(row.off_prior or 0.0) > CONTRADICTS]
    far.sort(key=lambda row: -abs(row.off_prior or 0.0))
    return [_away(row) if _may_be_as_known(row) else _against(row) for row in far]


def _may_be_as_known(row: ParameterRow) -> bool:
    """Whether where the value likely lies reaches into what was known of it, both 95 %."""
    assert row.prior is not None
    if row.likely is None:
        return False
    mean, deviation = row.prior
    low, high = row.likely
    return low <= mean + BOTH * deviation and high >= mean - BOTH * deviation


def _against(row: ParameterRow) -> str:
    return f"The record contradicts what was known of {row.name}: {_beside_the_known(row)}."


def _away(row: ParameterRow) -> str:
    return (
        f"The fit ends far from what was known of {row.name}: {_beside_the_known(row)}. "
        "Where it is likely holds that as well: what the model lacks may have moved it, and what "
        "was known stands."
    )


def _beside_the_known(row: ParameterRow) -> str:
    assert row.prior is not None
    unit, factor = wording.shown_unit(row.unit)
    mean, deviation = (x * factor for x in row.prior)
    value, off = (row.value or 0.0) * factor, row.off_prior or 0.0
    unit = "" if unit == "1" else f" {unit}"
    expected = f"{mean:.4g} +-{deviation:.2g}{unit} was expected"
    return f"{value:.4g}, where {expected} ({abs(off):.1f} deviations)"
