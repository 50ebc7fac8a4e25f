"""The finished run that a design file builds on."""

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from trialid import user_files
from trialid.accuracy.ranges import share_off
from trialid.design.rudder_rate import GEAR
from trialid.errors import PipelineError
from trialid.pipeline_file.design_file import DesignFile


@dataclass(frozen=True, kw_only=True)
class FinishedRun:
    """What a design takes over from a run; SI.

    Attributes
    ----------
    values
        Of the fitted parameters, by name.
    rudder_rate, constants, speed_lost, rudders_zero
        How the ship is sailed where she is predicted.
    intervals
        The value of each standard measure with its 95 % range.
    model_errors
        How far what the model lacks may move each fitted parameter, a share of its size; of runs
        whose noise and model are not told apart by their likely ranges.
    steps
        Rows of its history, without what was only proposed.
    """

    values: Mapping[str, float] = field(default_factory=dict)
    rudder_rate: float | None = None
    constants: Mapping[str, float] = field(default_factory=dict)
    speed_lost: Mapping[str, float] = field(default_factory=dict)
    rudders_zero: float | None = None
    intervals: Mapping[str, tuple[float, tuple[float, float]]] = field(default_factory=dict)
    model_errors: Mapping[str, float] = field(default_factory=dict)
    verdict: str = ""
    effects: tuple[str, ...] = ()
    steps: tuple[Mapping[str, Any], ...] = ()

    def gear_rate(self, given: float | None) -> float:
        """Of the rudder [rad/s]: as a file gives it in deg/s, else as in the run, else usual."""
        if given is not None:
            return float(np.deg2rad(given))
        return GEAR if self.rudder_rate is None else self.rudder_rate


def finished_run(pipeline: DesignFile) -> FinishedRun:
    """The finished run that the design builds on; an empty one where there is none.

    Raises
    ------
    PipelineError
        The folder holds no run, or one of another model: its values hold in no other.
    """
    if pipeline.run is None:
        return FinishedRun()
    found = _read(pipeline, pipeline.path.parent / pipeline.run / "result.json")
    if apart := sorted({*found.effects} ^ {*pipeline.model.effects}):
        raise PipelineError(
            f"{pipeline.path}: run: {pipeline.run} is of another model (apart in "
            f"{', '.join(apart)}); name a run of this one, or give [model] the effects of that one"
        )
    return found


def _read(pipeline: DesignFile, file: Path) -> FinishedRun:
    try:
        result = json.loads(user_files.text(file, user_files.MOST_OF_A_RESULT))
        rows = result["accuracy"]["parameters"]
        values = {p["name"]: float(p["value"]) for p in rows if p["kind"] == "physical"}
        effects = tuple(map(str, result["model"]["effects"]))
        sailed = result.get("sailed") or {}  # runs of before have none
        rate, zero = sailed.get("rudder_rate"), sailed.get("rudders_zero")
        return FinishedRun(
            values=values,
            rudder_rate=None if rate is None else float(rate),
            constants=_numbers(sailed.get("constants")),
            speed_lost=_numbers(sailed.get("speed_lost")),
            rudders_zero=None if zero is None else float(zero),
            intervals=_intervals(result.get("imo")),
            model_errors={p["name"]: _model_error(p) for p in rows},
            verdict=str((result.get("verdict") or {}).get("kind", "")),
            effects=effects,
            steps=tuple(s for s in result.get("history", ()) if s["step"] != "proposed"),
        )
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise PipelineError(
            f"{pipeline.path}: run: {file} is no result of a run; give the folder that "
            "`trialid run` wrote"
        ) from error


def _model_error(row: Mapping[str, Any]) -> float:
    """How far a parameter may be off by what the model lacks, a share of it.

    Where noise and model were not told apart, by how much more than two standard errors its likely
    range reaches.
    """
    told = row.get("undermodelling_error")
    if told is not None:
        return float(told)
    likely, value = row.get("likely"), row["value"]
    off = share_off(value, None if likely is None else (float(likely[0]), float(likely[1])))
    return 0.0 if off is None else max(0.0, off - 2.0 * abs((row["standard_error"] or 0.0) / value))


def _numbers(rows: Mapping[str, Any] | None) -> dict[str, float]:
    return {str(n): float(x) for n, x in (rows or {}).items()}


def _intervals(imo: Mapping[str, Any] | None) -> dict[str, tuple[float, tuple[float, float]]]:
    found = {}
    for row in (imo or {}).get("measures", ()):
        if row["interval"] is not None:
            low, high = row["interval"]
            found[row["name"]] = float(row["value"]), (float(low), float(high))
    return found
