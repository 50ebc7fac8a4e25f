"""Lengths of the page's small bars, as percentages of the room they have."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from trialid.report import labels
from trialid.report.shape import Run

WIDEST = 1.0
"""Relative error at which a parameter bar stops: past 100 % the number says enough."""


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
class ParameterBar:
    """The two terms of Eq. 14 for one parameter; `beyond` where they leave the axis."""

    noise: float
    model: float
    beyond: bool


@dataclass(frozen=True)
class Change:
    """An error before and after."""

    label: str
    before: float | None
    after: float | None
    before_length: float
    after_length: float
    held_out: bool = False


def split_bars(run: Run) -> list[SplitBar]:
    """The error of all outputs and of each; the longest bar is the largest error."""
    fit, split = run["fit"], run["split"]
    errors = fit["eps_rmsn_by_output"]
    longest = _longest([fit["eps_rmsn"], *errors.values()])
    bars = [_split_bar("all outputs", fit["eps_rmsn"], split, longest)]
    for name, eps in errors.items():
        bar = _split_bar(labels.labelled(name), eps, split["by_output"].get(name) or {}, longest)
        bars.append(replace(bar, rms=_rms(name, eps, fit["y_rms"])))
    return bars


def _split_bar(label: str, eps: float | None, parts: Mapping[str, Any], longest: float) -> SplitBar:
    ends = (parts.get("interval") or {}).get("noise") or ()
    low, high = [_share(end, eps) for end in ends] or (None, None)
    return SplitBar(
        label=label,
        eps=eps,
        noise=parts.get("noise"),
        model=parts.get("undermodelling"),
        length=_length(eps, longest),
        noise_share=_share(parts.get("noise"), eps),
        whisker=None if low is None or high is None else (low, high),
    )


def _rms(name: str, eps: float | None, y_rms: Mapping[str, float]) -> str:
    """The error in the output's own unit."""
    if eps is None or y_rms.get(name) is None:
        return ""
    return labels.shown(name, eps * y_rms[name])


def _share(part: float | None, eps: float | None) -> float | None:
    """A part of an error in %: squares add up, noise^2 + model^2 = eps^2."""
    if part is None or not eps:
        return None
    return 100.0 * min((part / eps) ** 2, 1.0)


def parameter_bars(parameters: Sequence[Mapping[str, Any]]) -> tuple[float, list[ParameterBar]]:
    """The relative error at the end of the axis, and one bar a parameter."""
    totals = [_total(row) for row in parameters]
    end = min(_longest(totals), WIDEST)
    bars = []
    for row, total in zip(parameters, totals, strict=True):
        noise = min(_length(row["noise_error"], end), 100.0)
        model = _length(row["undermodelling_error"], end)
        bars.append(ParameterBar(noise, min(model, 100.0 - noise), total > end))
    return end, bars


def _total(row: Mapping[str, Any]) -> float:
    return (row["noise_error"] or 0.0) + (row["undermodelling_error"] or 0.0)


def changes(pair: Mapping[str, Any]) -> list[Change]:
    """The error before and after a change of the model: fitted, held out, by output."""
    rows = [("fitted trials", pair["eps_rmsn"], False), ("held out", pair["eps_rmsn_check"], True)]
    rows += [(labels.labelled(name), each, False) for name, each in pair["by_output"].items()]
    rows += [
        (f"{labels.labelled(name)}, held out", each, True)
        for name, each in pair["by_output_check"].items()
    ]
    known = [(label, *each, held_out) for label, each, held_out in rows if each is not None]
    longest = _longest([error for _, *each, _ in known for error in each])
    return [
        Change(label, before, after, _length(before, longest), _length(after, longest), held_out)
        for label, before, after, held_out in known
    ]


def foreseen_in_errors(row: Mapping[str, Any]) -> float | None:
    """A foreseen move in standard errors of the fit before.

    >>> foreseen_in_errors({"move_foreseen": 0.3, "standard_error_before": 0.1})
    3.0
    """
    move, error = row["move_foreseen"], row["standard_error_before"]
    return float(f"{move / error:.12g}") if error and move is not None else None


def _longest(values: Sequence[float | None]) -> float:
    return max((v for v in values if v is not None and math.isfinite(v)), default=0.0) or 1.0


def _length(value: float | None, longest: float) -> float:
    return 0.0 if value is None or not math.isfinite(value) else 100.0 * value / longest
