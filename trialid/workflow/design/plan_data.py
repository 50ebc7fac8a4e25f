"""A plan as plain data: what is sailed, rated and recorded."""

from typing import Any

import numpy as np

from trialid.design.ordered_signals import ordered_signals
from trialid.names.quantities import SIGNALS, Quantity
from trialid.report.files import design_data
from trialid.version import VERSION
from trialid.workflow.design import design_imo
from trialid.workflow.design.design_run import Plan, Rated
from trialid.workflow.design.error_doubt import error_doubt


def steering(plan: Plan) -> dict[str, Quantity]:
    """What the tests order, and what comes of it, by the signal's name."""
    return ordered_signals([p for rated in plan.rated for p in rated.outcome.passages])


def _recorded(plan: Plan) -> list[str]:
    """What the crew must record, in words."""
    known = SIGNALS | steering(plan)
    outputs, still = plan.pipeline.identify.outputs, plan.ship.vessel.constants
    names = [*steering(plan), *outputs, *(n for n in still if n in known), "psi", "u"]
    return [known[n].meaning.partition(",")[0] for n in dict.fromkeys(names)]


def _error_doubt(plan: Plan, best: Rated) -> str:
    """What the errors of the best programme rest on."""
    return error_doubt(best.outcome.rating, plan.ship.goal.wanted, plan.run)


def plain(plan: Plan) -> dict[str, Any]:
    """A plan as plain data, schema `trialid-design/1`."""
    best = plan.best
    tests = [
        {
            "name": rated.name,
            "programme": [design_data.of_test(t) for t in rated.programme],
            "searched": None if rated.found is None else rated.found.tried,
            "remarks": list(rated.remarks),
            **design_data.of_outcome(rated.outcome),
        }
        for rated in plan.rated
    ]
    return {
        "schema": design_data.SCHEMA,
        "version": VERSION,
        "name": plan.pipeline.name,
        "design": plan.pipeline.path.name,
        "ship": plan.ship.vessel.model.ship.name,
        "wanted": list(plan.ship.goal.wanted),
        "outputs": list(plan.pipeline.identify.outputs),
        "recorded": _recorded(plan),
        "roll_period": 2.0 * np.pi / plan.ship.roll_frequency,
        "tests": tests,
        "best": None if best is None else best.name,
        "error_doubt": "" if best is None else _error_doubt(plan, best),
        "separation": design_data.of_separation(plan.separation),
        **design_imo.plain(plan.imo),
    }
