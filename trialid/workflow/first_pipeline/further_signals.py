"""What else a log holds: wind, a sway that goes outwards in turns, and what is left to you."""

import dataclasses
from collections.abc import Iterator, Mapping
from typing import Final

import numpy as np

from trialid.inspection.disagreements import findings
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.relations import slope_agreement
from trialid.inspection.sketch import on_one_clock
from trialid.names import units
from trialid.workflow.first_pipeline.choice import SURE, Live, plain_signal, rudder_signal
from trialid.workflow.first_pipeline.chosen import OPEN, Chosen, Reason, Signal
from trialid.workflow.first_pipeline.signed_speed import from_east

LEFT: Final[Mapping[str, str]] = {
    "n": "with it the run seeks what the screw does",
    "n_p": "with both the run seeks what two screws do",
    "n_s": "with both the run seeks what two screws do",
    "psi": "with it the run seeks a steady wind and a current",
    "h": "of the water, not below the keel; with it the run seeks what shallow water does",
}
"""Inputs that no first model asks for, and what for."""

OF_GEAR: Final = "with the order beside the rudder the run seeks what the steering gear does"
"""Of a rudder's order where the rudder is logged."""

IN_SPEED: Final = "with a speed over ground it tells the current in that"
BESIDE_RATE: Final = "tells the offset of the rate; with it the run seeks a steady wind, too"
"""What the heading is read for, beside a speed over ground and beside another."""

COUNTED: Final = (
    "CAREFUL: counted from the east, as ROS has it: where the frame's x axis is another, north "
    "and east of wind and current are not the earth's"
)
"""Of an orientation of ROS."""

WIND: Final[Mapping[str, str]] = {
    "V_aw": "the run seeks what the wind does",
    "gamma_aw": "CAREFUL: where the wind comes from, 0 from ahead, positive from starboard",
}
"""Read where both are there: the wind turned round pushes no ship, and has no name."""

WHOLE_WIND: Final = "the wind's speed and its angle are read together, each with its unit"

OUTWARDS: Final = 0.5
"""Correlation with the rate of turn from which a sway is taken to go outwards, or inwards. Between
them a model of 3 m had -0.77 to -0.94 in twelve trials of eleven minutes and -0.44 under a rudder
moved at random; with half of it that one is told too, with twice none is."""

STRAIGHT: Final = Reason(
    "she goes straight on, and whether the rate goes by it does not show", "unshown"
)
LATE: Final = 2.0
"""[s] No compass is later. A GNSS receiver's heading is 0.1 to 0.5 s late, a filtered gyro's 1; the
leap seconds are 18."""
APART: Final = Reason("its clock is another than that of r, where it is said how far")
TURNED: Final = 10.0
"""Degrees within which the heading of a log straight on stays. A rate that stood still in a turn is
not left beside it for that; at half of it and at twice the same logs are straight on."""


def with_further(trial: Chosen, live: Live) -> Chosen:
    """The trial with what else its log holds: wind, a sway speed, what is left to the user."""
    trial = with_heading(trial, live)
    trial = dataclasses.replace(trial, beside=(*trial.beside, *_left(trial, live)))
    return with_sway(with_wind(trial, live), live)


def with_wind(trial: Chosen, live: Live) -> Chosen:
    """The trial with the wind that its log holds, or with it beside."""
    wind = [plain_signal(name, live, why) for name, why in WIND.items() if live.get(name)]
    if len(wind) == len(WIND) and not any(one.open for one in wind):
        return dataclasses.replace(trial, signals=(*trial.signals, *wind))
    beside = ((one, WHOLE_WIND) for one in wind)
    return dataclasses.replace(trial, beside=(*trial.beside, *beside))


def with_heading(trial: Chosen, live: Live) -> Chosen:
    """The trial with her heading: it tells the rate's offset from forces, and wind and current.

    One that the rate does not go by is left to the user: nobody knows which of them is wrong. Of a
    quaternion the rate also tells the side.
    """
    rate = next((one for one in trial.signals if one.quantity == "r"), None)
    if rate is None or not live.get("psi"):
        return trial
    heading = plain_signal("psi", live, IN_SPEED if trial.over_ground else BESIDE_RATE)
    found = slope_agreement(rate.source, heading.source)
    if heading.open:
        return trial
    if abs(found) <= SURE and _straight_on(heading):
        return _beside(trial, heading, STRAIGHT)
    if abs(found) <= SURE:
        return _with_clocks_apart(trial, rate, heading)
    if (found < 0.0) != (rate.positive == "port"):
        of_side = Reason(COUNTED) if from_east(heading.source, "port") else heading.of_side
        heading = dataclasses.replace(heading, positive="port", of_side=of_side)
    return dataclasses.replace(trial, signals=(*trial.signals, heading))


def _with_clocks_apart(trial: Chosen, rate: Signal, heading: Signal) -> Chosen:
    """The trial where a heading is late: no compass is by so much, and its log's clock is."""
    of_rate = (x for x in findings(trial.survey) if x.kind == "lag" and x.of_slope("r"))
    late = next((x for x in of_rate if x.evidence.get("lag", 0.0) < -LATE), None)
    if late is None:
        return trial
    said = (
        f"CAREFUL: {late.sentence}: no compass is so late, two clocks are apart; `{late.mend}` in "
        "psi and in all that is logged with it would mend it"
    )
    told = dataclasses.replace(rate, further=(*rate.further, said))
    signals = tuple(told if one is rate else one for one in trial.signals)
    return _beside(dataclasses.replace(trial, signals=signals), heading, APART)


def _straight_on(heading: Signal) -> bool:
    """Whether a heading stays where it is; that of a quaternion is in radians."""
    size = units.factor(heading.unit or "rad", "rad")
    return float(np.ptp(np.unwrap(heading.source.sketch.y * size))) < np.deg2rad(TURNED)


def _left(trial: Chosen, live: Live) -> Iterator[tuple[Signal, str]]:
    there = trial.quantities | {one.quantity for one, _ in trial.beside}
    for name, why in LEFT.items():
        if live.get(name) and name not in there:
            yield plain_signal(name, live, ""), why
    if "delta" in there and live.get("delta_order"):
        rate = next((one for one in trial.signals if one.quantity == "r"), None)
        order = rudder_signal("delta_order", live, rate)
        reasons = (order.of_unit, order.of_side)
        asked = (why.words for why in reasons if why.rests_on("asked", "counts"))
        yield order, "; ".join((*asked, OF_GEAR))


def with_sway(trial: Chosen, live: Live) -> Chosen:
    """The trial with her sway speed, where one is logged, as a signal or left to the user with why.

    A hull goes outwards in her turns. Inwards it may be positive to port, or that of her bow, and
    nobody can tell.
    """
    if not live.get("v"):
        return trial
    plain = plain_signal("v", live, "")
    by_format = plain.source.guess.positive if plain.source.guess else None
    sway = dataclasses.replace(plain, positive="port" if by_format == "port" else None)
    rate = next((one for one in trial.signals if one.quantity == "r"), None)
    found = _correlation(rate.source, sway.source) if rate else 0.0
    found = -found if rate and (rate.positive == "port") != (by_format == "port") else found
    told = f"correlation with the rate of turn {found:+.2f}"
    if sway.unit == OPEN:
        why = Reason("the log states no unit")
    elif found <= -OUTWARDS:
        outwards = Reason(f"outwards in turns ({told})", "measured")
        sure = dataclasses.replace(sway, of_side=outwards)
        return dataclasses.replace(trial, signals=(*trial.signals, sure))
    elif found >= OUTWARDS:
        words = f"it goes inwards in turns ({told}): positive to port, or measured at her bow?"
        why = Reason(words, "denied")
    else:
        why = Reason(f"whether it goes outwards in turns does not show ({told})", "unshown")
    return _beside(trial, sway, why)


def _beside(trial: Chosen, signal: Signal, why: Reason) -> Chosen:
    left = dataclasses.replace(signal, of_side=why)
    return dataclasses.replace(trial, beside=(*trial.beside, (left, why.words)))


def _correlation(rate: ChannelInspection, sway: ChannelInspection) -> float:
    """Of both where both are there; 0 where they have too little in common."""
    common = on_one_clock(rate.sketch, sway.sketch)
    if common is None:
        return 0.0
    _, (r, v), whole = common
    if whole.sum() < 3 or not (np.ptp(r[whole]) and np.ptp(v[whole])):
        return 0.0
    return float(np.corrcoef(r[whole], v[whole])[0, 1])
