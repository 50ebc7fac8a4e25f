"""A finished run's model with the engine stopped, or ordered astern."""

from trialid.design.prediction.ranged_motion import PredictedMotion
from trialid.design.prediction.stopping import sail_stop
from trialid.threads import one_thread
from trialid.workflow.use.finished_model import FinishedModel
from trialid.workflow.use.orders import Stop
from trialid.workflow.use.predict import (
    Prediction,
    as_wide_as_others,
    ready_ship,
    spread_of,
    with_words,
)
from trialid.workflow.use.what_if import AS_FITTED, WhatIf, changed_ship, known_changes


@one_thread
def predict_stop(model: FinishedModel, asked: Stop, what_if: WhatIf = AS_FITTED) -> Prediction:
    """The ship with her engine stopped or astern, rudder amidships, in calm deep water.

    Raises
    ------
    DesignError
        The model does not simulate the speed, nothing drives her, or nothing known drives astern.
    """

    def sail(one: FinishedModel) -> PredictedMotion:
        ship = changed_ship(ready_ship(one.fit), what_if)
        spread = known_changes(spread_of(one), what_if)
        return sail_stop(ship, asked.share, spread, model.result.fit.band, astern=asked.astern)

    return with_words(model, asked.name, as_wide_as_others(model, sail), what_if)
