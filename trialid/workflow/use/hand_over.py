"""A finished run's model as files: which there are, and what each holds."""

import zipfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import replace
from io import BytesIO
from typing import Final

from trialid.design.following import approach_speeds
from trialid.design.steering.gains import Uncertain, heading_gains, rate_gains
from trialid.design.steering.nomoto import at_speeds
from trialid.errors import DesignError, TrialidError
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
from trialid.workflow.use.steering import Wishes, check_full, full_order, steered_ship

UNTOLD: Final = (
    "Whether she is directionally stable this record does not tell; K and T are those of the model "
    "as it was fitted."
)
Files = Mapping[str, str | bytes]
"""By the suffix that follows the name of what is written."""


def taken_up(model: FinishedModel) -> FittedModel:
    """The model with all that its files say of it."""
    done = model.done
    unknowns = [p.name for p in done.own_accuracy.parameters]
    covariance = done.own_accuracy.covariance
    return fitted_model(model.fit, unknowns, covariance, model.result, model.seen, model.doubts)


def _others(model: FinishedModel) -> list[Uncertain]:
    """Other models of the ship that can be steered as she is, beside which her fit stands."""
    found = list[Uncertain]()
    for other in model.others:
        with suppress(TrialidError):
            found.append((steered_ship(other), spread_of(other)))
    return found


def _steered(model: FinishedModel) -> FittedModel:
    """The same where K and T are made use of: what is said of a ship that may be unstable."""
    made = taken_up(model)
    return made if _tells_stability(model) else replace(made, words=(UNTOLD, *made.words))


def _tells_stability(model: FinishedModel) -> bool:
    part = model.result.accuracy.stability
    return part is None or part.stable is not None


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


def _nomoto(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del name, wishes
    speeds = approach_speeds(model.fit)
    found = at_speeds(steered_ship(model), spread_of(model), speeds)
    for other in _others(model):
        with suppress(DesignError):
            pairs = zip(found, at_speeds(*other, speeds), strict=True)
            found = tuple(one.embracing(there) for one, there in pairs)
    return {".json": text_of(nomoto_file(_steered(model), found, _tells_stability(model)))}


def _ardupilot(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del name
    ship = steered_ship(model)
    full = full_order(model, ship, wishes, of_autopilot=True)
    gains = rate_gains(ship, spread_of(model), wishes.bandwidth, _others(model))
    check_full(gains.ship, full)
    return {".param": ardupilot_text(_steered(model), gains, full)}


def _pid(model: FinishedModel, name: str, wishes: Wishes) -> Files:
    del name
    ship = steered_ship(model)
    full = full_order(model, ship, wishes)
    gains = heading_gains(ship, spread_of(model), wishes.bandwidth, _others(model))
    check_full(gains.ship, full)
    return {".json": text_of(pid_file(_steered(model), gains, full))}


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
