"""The error of the model shown as one number, as far as it is known, beside the one before."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

from trialid.pipeline_file import Pipeline
from trialid.result.change_rows import Pair
from trialid.result.schema import Result
from trialid.workbench.shown import Shown
from trialid.workflow.outcome import Outcome


@dataclass(frozen=True)
class ErrorNumber:
    """Errors of the fitted and of the held-out trials, now and before; None where not known.

    `alike` says whether both are errors of the same: else neither is the better.
    """

    eps: float | None
    check: float | None
    old: float | None
    old_check: float | None
    alike: bool


def error_number(shown: Shown) -> ErrorNumber:
    """The error: known with the fit, before what it is made of is."""
    return ErrorNumber(*_now(shown), *_old(shown), alike=_alike(shown))


def _alike(shown: Shown) -> bool:
    """Whether the model before was fitted to the same trials, by the same outputs."""
    if shown.before is None:
        return True
    return _scored(shown.before.pipeline) == _scored(shown.pipeline)


def _scored(pipeline: Pipeline) -> tuple[object, ...]:
    fitted = [trial for trial in pipeline.trials if trial.use == "fit"]
    return fitted, pipeline.identify.outputs


def _now(shown: Shown) -> tuple[float | None, float | None]:
    if shown.run is not None:
        return _of_run(shown.run)
    if shown.fit is not None:
        return shown.fit.eps_rmsn, _finite(shown.fit.eps_check)
    return None, None


def _of_run(run: Outcome) -> tuple[float | None, float | None]:
    return run.result.fit.eps_rmsn, run.result.fit.eps_rmsn_check


def _old(shown: Shown) -> tuple[float | None, float | None]:
    """Of the model before, or of the one that a change kept in the result began with."""
    if shown.before is not None and shown.before.pipeline.content != shown.pipeline.content:
        return _of_run(shown.before)
    change = shown.run.result.change if shown.run else None
    if change is None:
        return None, None
    return _first(change.eps_rmsn), _first(change.eps_rmsn_check)


def _first(pair: Pair | None) -> float | None:
    return pair[0] if pair else None


def _finite(value: float | None) -> float | None:
    return value if value is not None and math.isfinite(value) else None


def by_output(shown: Shown, trial: str, run: Result) -> dict[str, float | None]:
    """A trial's error by output; `run` is that of the model before where no fit is known yet."""
    if shown.run is None and shown.fit is not None:
        found = [s for s in shown.fit.scores if s.trial.name == trial]
        return {output: _finite(eps) for s in found for output, eps in s.eps_rmsn.items()}
    return next((dict(row.eps_rmsn) for row in run.trials if row.name == trial), {})


def pool_errors(errors: Mapping[str, float | None]) -> float | None:
    """The error of all outputs of a trial, each counting alike.

    >>> pool_errors({"r": 0.3, "phi": 0.4}), pool_errors({})
    (0.3535533905932738, None)
    """
    known = [eps for eps in errors.values() if eps is not None]
    if not known or len(known) < len(errors):
        return None
    return math.sqrt(sum(eps**2 for eps in known) / len(known))
