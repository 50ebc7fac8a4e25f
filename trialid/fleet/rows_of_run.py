"""A run's result as rows of a fleet's tables."""

from trialid.result.fit_rows import ParameterRow
from trialid.result.fleet_rows import FittedRow, RunLabel, RunRow
from trialid.result.schema import Result


def run_row(label: RunLabel, key: str, result: Result) -> RunRow:
    """The row of a run that has a result."""
    verdict, fit, split = result.verdict, result.fit, result.split
    return RunRow(
        **vars(label),
        verdict=verdict.kind,
        effect=verdict.effect,
        family=", ".join(verdict.family) or None,
        sentence=verdict.sentence,
        eps_rmsn=fit.eps_rmsn,
        eps_rmsn_check=fit.eps_rmsn_check,
        noise=split.noise,
        undermodelling=split.undermodelling,
        converged=fit.converged,
        trials=len(result.trials),
        samples=fit.samples,
        effects=", ".join(result.model.effects),
        free=", ".join(result.model.free),
        logs=", ".join(
            f"{g.sha256}:{trial.samples}" for trial in result.trials for g in trial.logs
        ),
        key=key,
        version=result.version,
    )


def fitted_rows(label: RunLabel, result: Result) -> tuple[FittedRow, ...]:
    """A row for each parameter, the ship's first."""
    return tuple(_fitted(label, row) for row in (*result.physical, *result.nuisance))


def _fitted(label: RunLabel, row: ParameterRow) -> FittedRow:
    low, high = row.likely or (None, None)
    return FittedRow(
        **vars(label),
        parameter=row.name,
        kind=row.kind,
        unit=row.unit,
        value=row.value,
        standard_error=row.standard_error,
        likely_low=low,
        likely_high=high,
    )
