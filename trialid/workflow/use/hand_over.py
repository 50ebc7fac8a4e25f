"""A finished run's model as files: which there are, and what each holds."""

import zipfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from io import BytesIO
from typing import Final

from trialid.design.following import STEERED, approach_speeds, sailed_ship
from trialid.design.helm import Vessel
from trialid.design.steering.gains import heading_gains, rate_gains
from trialid.design.steering.nomoto import at_speeds
from trialid.errors import TrialidError
from trialid.export.model.c_text import c_texts
from trialid.export.model.fitted_model import FittedModel, fitted_model
from trialid.export.model.fitted_ship import fitted_ship, fitted_ship_text
from trialid.export.model.fmu.binaries import platform_words
from trialid.export.model.fmu.fmu_file import fmu_bytes
from trialid.export.model.gain_files import ardupilot_text, pid_file
from trialid.export.model.gazebo import gazebo_hull, gazebo_text
from trialid.export.model.json_model import model_file
from trialid.export.model.modelica_text import modelica_text
from trialid.export.model.nomoto_file import nomoto_file
from trialid.export.model.numpy_text import numpy_text
from trialid.result.json_file import text_of
from trialid.workflow.use.finished_model import FinishedModel
from trialid.workflow.use.predict import spread_of

Files = Mapping[str, str | bytes]
"""By the suffix that follows the name of what is written."""


@dataclass(frozen=True)
class Wishes:
    """What somebody who wants a file has to say, or may: bandwidth [rad/s], full rudder [rad]."""

    bandwidth: float | None = None
    full_rudder: float | None = None


def taken_up(model: FinishedModel) -> FittedModel:
    """The model with all that its files say of it."""
    done = model.done
    unknowns = [p.name for p in done.accuracy.parameters]
    covariance = done.accuracy.covariance
    return fitted_model(model.fit, unknowns, covariance, model.result, model.seen, model.doubts)


def _ship(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del name, wishes
    made = fitted_ship(model.fit.model, model.result)
    return {".toml": fitted_ship_text(made, model.doubts)}


def _python(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del name, wishes
    return {".py": numpy_text(taken_up(model))}


def _json(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del name, wishes
    return {".json": text_of(model_file(taken_up(model)))}


def _c(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del wishes
    return {**c_texts(taken_up(model), name)}


def _fmu(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del wishes
    return {".fmu": fmu_bytes(taken_up(model), name, everywhere=True)}


def _fmu3(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del wishes
    return {".fmu": fmu_bytes(taken_up(model), name, "3.0", everywhere=True)}


def _modelica(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del wishes
    return {".mo": modelica_text(taken_up(model), name)}


def _by_rudder(model: FinishedModel) -> Vessel:
    """The ship, steered by a rudder.

    Raises
    ------
    TrialidError
        She is steered by something else, of which there is no K and no T.
    """
    if STEERED & {*model.fit.model.recorded}:
        return sailed_ship(model.fit)
    drives = [a.name for a in model.fit.model.ship.actuators]
    steered = f"; this model is steered by {', '.join(drives)}" if drives else ""
    raise TrialidError(
        f"{model.where}: K, T and gains are those of a rudder angle{steered}; export her as "
        "fmu, c, python or modelica and design her heading control with that"
    )


def _nomoto(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del name, wishes
    found = at_speeds(_by_rudder(model), spread_of(model), approach_speeds(model.fit))
    return {".json": text_of(nomoto_file(taken_up(model), found))}


def _ardupilot(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del name
    if wishes.full_rudder is None:
        raise TrialidError(
            "--as ardupilot needs the rudder angle at full steering output, which no log of a "
            "rudder holds; add --full-rudder 35 [deg]"
        )
    gains = rate_gains(_by_rudder(model), spread_of(model), wishes.bandwidth)
    return {".param": ardupilot_text(taken_up(model), gains, wishes.full_rudder)}


def _pid(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del name
    gains = heading_gains(_by_rudder(model), spread_of(model), wishes.bandwidth)
    return {".json": text_of(pid_file(taken_up(model), gains))}


def _gazebo(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del name, wishes
    made = taken_up(model)
    return {".sdf": gazebo_text(made, gazebo_hull(model.fit, made))}


Write = Callable[[FinishedModel, str, Wishes], Files]

WRITERS: Final[Mapping[str, Write]] = {
    "ship": _ship,
    "json": _json,
    "python": _python,
    "c": _c,
    "fmu": _fmu,
    "fmu3": _fmu3,
    "modelica": _modelica,
    "nomoto": _nomoto,
    "pid": _pid,
    "ardupilot": _ardupilot,
    "gazebo": _gazebo,
}
"""What each kind's files hold; `trialid.names.model_kinds` says what they are."""


def beside_words(files: Files) -> str | None:
    """What to say of files that were made, where they are not all that they could be."""
    unit = files.get(".fmu")
    if not isinstance(unit, bytes):
        return None
    with zipfile.ZipFile(BytesIO(unit)) as packed:
        return platform_words(packed.namelist())
