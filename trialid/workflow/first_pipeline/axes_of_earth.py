"""Velocities that are called u and v and go to the north and to the east: left to the user."""

import dataclasses
from collections.abc import Sequence

from trialid.inspection.disagreements import findings
from trialid.inspection.inspected import Inspection
from trialid.workflow.first_pipeline.choice import plain_signal
from trialid.workflow.first_pipeline.chosen import Chosen

WHY = "it goes round with the heading: a velocity to the north or the east, not along the ship"


def without_axes_of_earth(surveys: Sequence[Inspection]) -> list[Inspection]:
    """The logs in which such channels are nothing known; one log tells of all of one recorder."""
    said = [(one, quantity) for one in surveys for quantity in _of_earth(one)]
    names = {source.name for one, quantity in said for source in one.sources(quantity)}
    return [_without(one, names) for one in surveys] if names else list(surveys)


def _of_earth(survey: Inspection) -> set[str]:
    """Quantities of which the turns of a log say so; with u goes v, that no turn tells of alone."""
    told = any(one.kind == "axes" for one in findings(survey))
    return {"u", "v"} if told else set()


def _without(survey: Inspection, names: set[str]) -> Inspection:
    channels = {
        key: dataclasses.replace(one, guess=None) if one.name in names else one
        for key, one in survey.channels.items()
    }
    return dataclasses.replace(survey, channels=channels)


def with_velocities_beside(trial: Chosen, survey: Inspection) -> Chosen:
    """The trial with what was left out of its log beside, with why."""
    unknown = {c.name for c in trial.survey.channels.values() if c.guess is None}
    left = {q: tuple(c for c in survey.sources(q) if c.name in unknown) for q in ("u", "v")}
    beside = tuple((plain_signal(q, left, ""), WHY) for q, found in left.items() if found)
    return dataclasses.replace(trial, survey=survey, beside=(*trial.beside, *beside))
