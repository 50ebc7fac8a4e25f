"""What the page's plots are drawn from: panels of a trial, numbers as base64 float32.

Units are those shown. A gap is NaN in what was measured; the residual is formed on the page.
"""

import base64
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from trialid.arrays import Vector
from trialid.names import labels, units
from trialid.result.finding_rows import FindingRow
from trialid.result.schema import Result
from trialid.result.series import OutputSeries, TrialSeries

Panel = dict[str, Any]


def trial_panels(series: Sequence[TrialSeries], run: Result) -> list[dict[str, Any]]:
    """One entry a trial: its clock and its panels, inputs first."""
    return [
        {
            "name": trial.name,
            "t": clock(trial.t),
            "panels": [*input_panels(trial), *(_output(o, trial, run) for o in trial.outputs)],
        }
        for trial in series
    ]


def clock(t: Vector) -> dict[str, Any]:
    """A uniform clock [s] by start, period and length; another one sample by sample."""
    if len(t) < 2:
        return {"start": float(t[0]) if len(t) else 0.0, "period": 1.0, "samples": len(t)}
    period = float(t[-1] - t[0]) / (len(t) - 1)
    if np.allclose(np.diff(t), period, rtol=1e-6):
        return {"start": float(t[0]), "period": period, "samples": len(t)}
    return {"each": encode_floats(t)}


def input_panels(trial: TrialSeries) -> Iterator[Panel]:
    """A panel an input; what was ordered and what came of it share one."""
    shared: dict[str, list[str]] = {}
    for name in trial.inputs:
        shared.setdefault(name.removesuffix("_order"), []).append(name)
    for names in shared.values():
        yield {
            "kind": "input",
            "title": labels.meaning(names[0]),
            "unit": trial.quantity(names[0]).shown,
            "lines": [_line(trial, name) for name in names],
        }


def _line(trial: TrialSeries, name: str) -> dict[str, str]:
    shown = trial.inputs[name] * units.shown_factor(trial.quantity(name))
    return {"label": labels.symbol(name), "data": encode_floats(shown)}


def _output(output: OutputSeries, trial: TrialSeries, run: Result) -> Panel:
    factor = labels.shown_factor(output.name)
    return {
        "kind": "output",
        "title": labels.meaning(output.name),
        "symbol": labels.symbol(output.name),
        "unit": labels.shown_unit(output.name),
        "measured": encode_floats(output.observed * factor),
        "predicted": encode_floats(output.predicted * factor),
        "noise": _noise(output.name, run, factor),
        "band": _band(output.name, run, factor),
        "stretches": [
            [finding.t_start, finding.t_end]
            for finding in run.where
            if _stands_in(finding, output.name, trial.name)
        ],
    }


def _noise(output: str, run: Result, factor: float) -> float | None:
    """Twice the RMS that noise alone has in an output: what lies beyond is hardly noise."""
    part = run.split.of(output).noise
    size = run.fit.y_rms.get(output)
    return None if part is None or size is None else 2.0 * part * size * factor


def _band(output: str, run: Result, factor: float) -> float | None:
    """Half-width of the 95 % band about the prediction of a trial that was not fitted."""
    half = run.fit.band.get(output)
    return None if half is None else half * factor


def _stands_in(finding: FindingRow, output: str, trial: str) -> bool:
    placed = finding.t_start is not None and finding.t_end is not None
    return placed and finding.trial == trial and finding.output in (output, None)


def encode_floats(values: Vector) -> str:
    """Base64 of little-endian float32: seven digits, 5 kB a thousand samples."""
    return base64.b64encode(values.astype("<f4").tobytes()).decode("ascii")
