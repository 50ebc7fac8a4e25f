"""Standard measures of manoeuvring as plain data."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Final

import numpy as np

from trialid.design.helm import Vessel
from trialid.design.imo.speed_loss import NAMES, loses_speed
from trialid.design.prediction.rudders_zero import ZERO
from trialid.design.rudders import GEAR_STATE
from trialid.design.standard import Measure, in_calm
from trialid.design.steering.nomoto import UNITS, Nomoto
from trialid.names import labels
from trialid.result.imo_rows import ConditionRow, ImoPart, MeasureRow, SailedPart, SteeringRow
from trialid.trial import Trial

if TYPE_CHECKING:
    from trialid.result.build import Findings

UNRELIABLE: Final = "The fit carries no verdict: none of these numbers is to be relied on."

CONDITIONS: Final = ("u", "sog", "n", "n_p", "n_s", "V_aw", "gamma_aw", "h")
"""Signals that a report of a trial asks for, where they were recorded."""


def condition_rows(trials: Sequence[Trial]) -> Iterator[ConditionRow]:
    """What the trials were sailed in, by what was recorded."""
    for trial in trials:
        for name in (n for n in CONDITIONS if n in trial.signals):
            known = trial.signals[name][trial.valid.get(name, np.ones(trial.samples, dtype=bool))]
            known = known[np.isfinite(known)]
            if len(known):
                low, median, high = (float(np.quantile(known, q)) for q in (0.025, 0.5, 0.975))
                yield ConditionRow(
                    trial=trial.name, signal=name, median=median, interval=(low, high)
                )


def measure_rows(measures: Sequence[Measure], *, reliable: bool = True) -> tuple[MeasureRow, ...]:
    """The standard measures beside what is allowed; open where they are not to be relied on."""
    return tuple(
        MeasureRow(
            name=m.criterion.name,
            unit=m.criterion.unit,
            value=m.value,
            interval=m.interval,
            allowed=m.criterion.largest,
            kept=m.kept if reliable else None,
            manoeuvre=m.criterion.words,
            remark=m.remark,
        )
        for m in measures
    )


def sailed_part(ship: Vessel) -> SailedPart:
    """How a ship is sailed: her speed, her gear, what stays as it was."""
    read = [n for n in ship.simulator.equations.inputs if n in ship.constants and n != "u"]
    return SailedPart(
        speed=ship.model.ship.particulars["U0"],
        rudder_rate=None if GEAR_STATE in ship.model.all_states else ship.rudder_rate,
        constants={n: ship.constants[n] for n in read},
        speed_lost={n: ship.model.value(n) for n in NAMES if n in ship.model.parameters},
        rudders_zero=ship.model.value(ZERO) if ZERO in ship.model.parameters else None,
    )


def sailing_words(ship: Vessel) -> str:
    """How the standard measures of a ship were come by, in a sentence."""
    how = sailed_part(in_calm(ship))
    rate = "as its effect has it"
    if how.rudder_rate is not None:
        rate = f"at {np.rad2deg(how.rudder_rate):.3g} deg/s"
    steady = "".join(f", {n} = {labels.shown_text(n, x)}" for n, x in how.constants.items())
    speed = ""
    if "u" not in ship.model.states:
        speed = "; the speed stays: what a turn loses of it is not in these numbers"
        if how.speed_lost:
            speed = "; the speed stays: what a turn may cost of it only widens the ranges"
        if loses_speed(how.speed_lost):
            speed = "; speed is lost in turns as in the logs"
    zero = (
        ""
        if how.rudders_zero is None
        else f", its zero {labels.shown_text('delta', how.rudders_zero)} off as in the trials"
    )
    return (
        f"Sailed by simulation in calm deep water: approach at {how.speed:.3g} m/s, first to "
        f"starboard, rudder {rate}{zero}{steady}{speed}."
    )


def steering_rows(found: Nomoto) -> Iterator[SteeringRow]:
    """Nomoto's numbers, a row each."""
    for name, value in found.values.items():
        yield SteeringRow(
            name=name, value=value, unit=UNITS.get(name, "s"), likely=found.ranges.get(name)
        )


def imo_part(found: "Findings") -> ImoPart | None:
    """Standard measures, predicted; overshoots the trials hold, measured beside predicted."""
    if not found.measures or found.ship is None:
        return None
    reliable = found.verdict.kind != "no fit"
    return ImoPart(
        measures=measure_rows(found.measures, reliable=reliable),
        sailed=sailing_words(found.ship),
        doubt="" if reliable else UNRELIABLE,
        speed_simulated="u" in found.before.fit.model.states,
        overshoots=found.overshoots,
        turns=found.turns,
        manoeuvres=found.manoeuvres,
        measured=found.measured,
        conditions=tuple(condition_rows([s.trial for s in found.before.fit.scores])),
        steering=() if found.steering is None else tuple(steering_rows(found.steering)),
    )
