"""One turn of the loop on two short trials: what is shown at each stage of it."""

from dataclasses import dataclass, replace

import numpy as np
import pandas as pd
import s175q
from test_bad_input import CHECK, EFFECTS, PIPELINE, STATES

from trialid.effects import CATALOGUE
from trialid.pipeline_file import load
from trialid.result.series import OutputSeries
from trialid.ship.model import ShipModel
from trialid.workbench.shown import Shown
from trialid.workflow import edit_model, edit_pipeline
from trialid.workflow.build_model import available, build_model
from trialid.workflow.fit_model import fit_of, time_series
from trialid.workflow.read_trials import align_trials
from trialid.workflow.run import examine

ADDED = "yaw_drag_rar"
TRIED = (ADDED, "yaw_drag_vav", "heel_yaw", "static_list")
"""What is looked for; few, so that a run takes a second."""

WITH_CHECK = (
    PIPELINE.replace("[align]", f"{CHECK}[align]")
    .replace('outputs = ["r"]', 'outputs = ["r", "phi"]')
    .replace('candidates = "none"', f"candidates = {list(TRIED)}")
)


@dataclass(frozen=True)
class Turn:
    """An effect is added: everything that is on the screen on the way."""

    reading: Shown
    opening: Shown
    before: Shown
    measured: Shown
    fitted: Shown
    after: Shown

    @property
    def stages(self):
        """All of them by name."""
        return vars(self)


def quiet(words, share):
    """Nobody listens."""


def write_folder(folder, pipeline):
    """A pipeline, its ship, and the logs of two zig-zags with an effect that the model lacks."""
    names = (*EFFECTS, ADDED)
    model = ShipModel(s175q.SHIP, STATES, tuple(CATALOGUE[name] for name in names))
    ship = s175q.ROOT / "sample_data" / "ships" / "s175q.toml"
    (folder / "ship.toml").write_bytes(ship.read_bytes())
    (folder / "short.toml").write_text(pipeline, encoding="utf-8")
    for angle, log in ((20, "log.csv"), (10, "check.csv")):
        trial = s175q.zigzag(angle, model)
        noise = s175q.white(np.random.default_rng(angle), trial.samples)
        trial = s175q.with_noise(trial, *noise)
        columns = {
            "t[s]": trial.t,
            "rudder[deg]": np.rad2deg(trial.signals["delta"]),
            "rot[deg/s]": np.rad2deg(trial.signals["r"]),
            "heel[deg]": np.rad2deg(trial.signals["phi"]),
            "stw[m/s]": np.full(trial.samples, 7.33),
        }
        pd.DataFrame(columns)[:1200].to_csv(folder / log, index=False)
    return folder / "short.toml"


def opened(path):
    """A pipeline worked out."""
    recipe = load(path)
    catalogue, trials = available(recipe), align_trials(recipe, quiet)
    fit = fit_of(recipe, trials, catalogue, quiet)
    run = examine(recipe, trials, quiet, fit)
    return Shown(recipe, catalogue, fit.model, trials, run.series, fit, run.outcome)


def turned(path):
    """The effect added to a pipeline, stage by stage."""
    before = opened(path)
    edit = edit_pipeline.add_to_pipeline(before.pipeline, ADDED)
    foreseen = edit_model.foresee_edit(edit, before.fit)
    edit, fit = edit_model.fit_edit(edit, before.trials, foreseen, quiet)
    run = examine(edit.after, before.trials, quiet, fit).outcome
    result, _ = edit_model.set_beside(edit, run.result, before.run.result, foreseen)
    model = build_model(edit.after, before.catalogue)
    measured = Shown(
        edit.after, before.catalogue, model, before.trials, before.series, before=before.run
    )
    fitted = replace(measured, fit=fit, model=fit.model, series=time_series(fit))
    return Turn(
        reading=Shown(before.pipeline, before.catalogue),
        opening=replace(before, series=_unpredicted(before.series), fit=None, run=None),
        before=before,
        measured=measured,
        fitted=fitted,
        after=replace(fitted, run=replace(run, result=result)),
    )


def _unpredicted(series):
    """The curves before there is a prediction."""
    return tuple(
        replace(
            trial,
            outputs=tuple(
                OutputSeries(o.name, o.measured, np.full(len(o.measured), np.nan), o.compared)
                for o in trial.outputs
            ),
        )
        for trial in series
    )
