"""The sway speed of a log, held against the turn: a hull goes outwards."""

import dataclasses
from typing import Final

import numpy as np

from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.sketch import on_one_clock
from trialid.workflow.first_pipeline.choice import Chosen, Live, Signal, plain_signal

OUTWARDS: Final = 0.5
"""Correlation with the rate of turn from which a sway is taken to go outwards, or inwards. Between
them a model of 3 m had -0.77 to -0.94 in twelve trials of eleven minutes and -0.44 under a rudder
moved at random; with half of it that one is told too, with twice none is."""


def with_sway(trial: Chosen, live: Live) -> Chosen:
    """The trial with her sway speed, where the log has one that goes outwards in her turns.

    Inwards it may be positive to port, or that of her bow, and nobody can tell: it is left to the
    user.
    """
    if not live.get("v"):
        return trial
    plain = plain_signal("v", live, "")
    sway = dataclasses.replace(plain, positive=_to_port(plain) or None)
    rate = next((one for one in trial.signals if one.quantity == "r"), None)
    if rate is None:
        why = "no rate of turn is logged to tell her side by"
        return dataclasses.replace(trial, beside=(*trial.beside, (sway, why)))
    found = _correlation(rate.source, sway.source)
    found = -found if bool(sway.positive) != bool(_to_port(rate)) else found
    told = f"correlation with the rate of turn {found:+.2f}"
    if found <= -OUTWARDS:
        sure = dataclasses.replace(sway, why=f"{sway.why}; outwards in turns ({told})")
        return dataclasses.replace(trial, signals=(*trial.signals, sure))
    inwards = f"it goes inwards in turns ({told}): positive to port, or measured at her bow?"
    unclear = f"whether it goes outwards in turns does not show ({told})"
    why = inwards if found >= OUTWARDS else unclear
    return dataclasses.replace(trial, beside=(*trial.beside, (sway, why)))


def _to_port(signal: Signal) -> str:
    """`port` where it is positive to port, as chosen or by its format; else nothing."""
    by_format = signal.source.guess.positive if signal.source.guess else None
    return "port" if "port" in (signal.positive, by_format) else ""


def _correlation(rate: ChannelInspection, sway: ChannelInspection) -> float:
    """Of both where both are there; 0 where they have too little in common."""
    common = on_one_clock(rate.sketch, sway.sketch)
    if common is None:
        return 0.0
    _, (r, v), whole = common
    if whole.sum() < 3 or not (np.ptp(r[whole]) and np.ptp(v[whole])):
        return 0.0
    return float(np.corrcoef(r[whole], v[whole])[0, 1])
