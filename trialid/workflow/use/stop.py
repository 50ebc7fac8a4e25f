"""A finished run's model with the engine stopped, or ordered astern."""

from dataclasses import replace
from typing import Final

from trialid.design.prediction.ranged_motion import PredictedMotion
from trialid.design.prediction.stopping import sail_stop
from trialid.identification.remarks import untold_astern
from trialid.names.wording import named_together
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

OF_GAINS: Final = (
    "No trial went astern: thrust astern is likely 60 to 100 % of that ahead, and the ranges "
    "embrace both; what is known of {} is stated as a what-if."
)


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
        untold = _untold(one, what_if)
        band = model.result.fit.band
        return sail_stop(ship, asked.share, spread, band, astern=asked.astern, untold=untold)

    made = with_words(model, asked.name, as_wide_as_others(model, sail), what_if)
    untold = [*_untold(model, what_if)] if asked.astern else []
    said = OF_GAINS.format(named_together(untold))
    return replace(made, words=(*made.words, said)) if untold else made


def _untold(model: FinishedModel, what_if: WhatIf) -> dict[str, str]:
    """Gains astern that neither a trial nor the user tells, each with that ahead."""
    found = untold_astern(model.fit)
    return {name: ahead for name, ahead in found.items() if name not in what_if.values}
