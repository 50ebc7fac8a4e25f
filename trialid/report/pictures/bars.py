"""Lengths of the page's small bars, as percentages of the room they have."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from trialid.names import labels
from trialid.result.change_rows import ChangePart, MovedRow
from trialid.result.fit_rows import ParameterRow, PartsRow, SplitPart
from trialid.result.schema import Result

WIDEST = 1.0
"""Share of the value at which a range stops: past 100 % the number says enough."""


@dataclass(frozen=True)
class SplitBar:
    """An error and what it is made of; `noise_share` and `whisker` in % of the bar's length."""

    label: str
    eps: float | None
    noise: float | None
    model: float | None
    length: float
    noise_share: float | None
    whisker: tuple[float, float] | None
    rms: str = ""


@dataclass(frozen=True)
class RangeBar:
    """A likely range in % of its track, the value in the middle, and what noise alone leaves.

    `beyond` says of either end whether it leaves the track.
    """

    likely: tuple[float, float]
    noise: tuple[float, float]
    beyond: tuple[bool, bool]


@dataclass(frozen=True)
class Change:
    """An error before and after."""

    label: str
    before: float | None
    after: float | None
    before_length: float
    after_length: float
    held_out: bool = False


def split_bars(run: Result) -> list[SplitBar]:
    """The error of all outputs and of each; the longest bar is the largest error."""
    fit, split = run.fit, run.split
    errors = fit.eps_rmsn_by_output
    longest = _longest([fit.eps_rmsn, *errors.values()])
    bars = [_split_bar("all outputs", fit.eps_rmsn, split, longest)]
    for name, eps in errors.items():
        bar = _split_bar(labels.label(name), eps, split.of(name), longest)
        bars.append(replace(bar, rms=_rms(name, eps, fit.y_rms)))
    return bars


def _split_bar(
    label: str, eps: float | None, parts: SplitPart | PartsRow, longest: float
) -> SplitBar:
    ends = parts.ends("noise") or ()
    low, high = [_share(end, eps) for end in ends] or (None, None)
    return SplitBar(
        label=label,
        eps=eps,
        noise=parts.noise,
        model=parts.undermodelling,
        length=_length(eps, longest),
        noise_share=_share(parts.noise, eps),
        whisker=None if low is None or high is None else (low, high),
    )


def _rms(name: str, eps: float | None, y_rms: Mapping[str, float]) -> str:
    """The error in the output's own unit."""
    if eps is None or y_rms.get(name) is None:
        return ""
    return labels.shown_text(name, eps * y_rms[name])


def _share(part: float | None, eps: float | None) -> float | None:
    """A part of an error in %: squares add up, noise^2 + model^2 = eps^2."""
    if part is None or not eps:
        return None
    return 100.0 * min(abs(part / eps), 1.0) ** 2  # held before it is squared: a power overflows


def range_bars(parameters: Sequence[ParameterRow]) -> tuple[float, list[RangeBar | None]]:
    """The share of the value at either end of the track, and a bar a parameter, where known."""
    end = min(_longest([row.may_be_off for row in parameters]), WIDEST)
    return end, [_range_bar(row, end) for row in parameters]


def _range_bar(row: ParameterRow, end: float) -> RangeBar | None:
    if row.may_be_off is None or row.likely is None or not row.value:
        return None
    low, high = ((x - row.value) / abs(row.value) for x in row.likely)
    noise = row.off_by_noise or 0.0
    return RangeBar(
        likely=(_place(low, end), _place(high, end)),
        noise=(_place(-noise, end), _place(noise, end)),
        beyond=(not low >= -end, not high <= end),
    )


def _place(share: float, end: float) -> float:
    """Where on the track a share of the value lies, in %, held at its ends."""
    return 50.0 + 50.0 * min(max(share / end, -1.0), 1.0) if math.isfinite(share) else 50.0


def changes(pair: ChangePart) -> list[Change]:
    """The error before and after a change of the model: fitted, held out, by output."""
    rows = [("fitted trials", pair.eps_rmsn, False), ("held out", pair.eps_rmsn_check, True)]
    rows += [(labels.label(name), each, False) for name, each in pair.by_output.items()]
    rows += [
        (f"{labels.label(name)}, held out", each, True)
        for name, each in pair.by_output_check.items()
    ]
    known = [(label, *each, held_out) for label, each, held_out in rows if each is not None]
    longest = _longest([error for _, *each, _ in known for error in each])
    return [
        Change(label, before, after, _length(before, longest), _length(after, longest), held_out)
        for label, before, after, held_out in known
    ]


def foreseen_in_errors(row: MovedRow) -> float | None:
    """A foreseen move in standard errors of the fit before.

    >>> row = MovedRow(name="GM", unit="m", move_foreseen=0.3, standard_error_before=0.1)
    >>> foreseen_in_errors(row)
    3.0
    """
    move, error = row.move_foreseen, row.standard_error_before
    return float(f"{move / error:.12g}") if error and move is not None else None


def _longest(values: Sequence[float | None]) -> float:
    return max((v for v in values if v is not None and math.isfinite(v)), default=0.0) or 1.0


def _length(value: float | None, longest: float) -> float:
    return 0.0 if value is None or not math.isfinite(value) else 100.0 * value / longest
