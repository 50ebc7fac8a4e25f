"""Which effects can be tried on a model and its record, and why the others cannot."""

from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np

from trialid.names.quantities import ACCELERATIONS, PARTICULARS
from trialid.ship.effect import Delayed, Effect, Lagged, Steered
from trialid.ship.model import STATES, ShipModel, takes_place
from trialid.simulation.integrate import record_for, signals_of
from trialid.trial import Trial

TABLES: Final = frozenset({"csv", "excel", "parquet"})
"""Adapters whose logs are a table with one column of times."""

AT_ZERO: Final = 0.01
"""Share of the largest up to which an input is at zero: revolutions of a motor that stands still
are logged with noise."""
WHILE: Final = 0.01
"""Share of the samples that lie near zero for a while. A motor of 0.3 s that is turned round ten
times in two minutes passes there in 0.003 of them, so that half of it tells the same; one order of
3 s in a trial of two minutes is 0.025, which twice takes too."""


def candidates_for(
    model: ShipModel, trial: Trial, catalogue: Mapping[str, Effect]
) -> tuple[dict[str, Effect], dict[str, str]]:
    """Effects that can be tried on this model and record, and why the others cannot."""
    able: dict[str, Effect] = {}
    left_out: dict[str, str] = {}
    present = {e.name for e in model.effects}
    for name, effect in catalogue.items():
        if name in present:
            continue
        reason = _why_not(model, trial, effect, able)
        if reason:
            left_out[name] = reason
        else:
            able[name] = effect
    return able, left_out


def out_of_reach(trials: Sequence[Trial], able: Mapping[str, Effect]) -> dict[str, str]:
    """Effects that small values of an input show, of which these trials have next to none."""
    return {
        name: f"needs {', '.join(effect.within)} below {max(effect.within.values()):.0%} of the "
        "largest for a while, and not at zero"
        for name, effect in able.items()
        if effect.within and not any(_small(trials, n, x) for n, x in effect.within.items())
    }


def of_one_clock(trials: Sequence[Trial], able: Mapping[str, Effect]) -> dict[str, str]:
    """Clocks that drift, where each trial is one table: all its columns have the same times.

    Of a Mariner whose rudder stalls the rudder's clock had been named 1340 ppm fast.
    """
    if not all(len(t.logs) == 1 and t.logs[0].adapter in TABLES for t in trials):
        return {}
    drifting = [n for n, e in able.items() if Delayed in e.forms and "t" in e.signals]
    return dict.fromkeys(drifting, "needs two clocks, and each trial is one table with one")


def undriven(
    model: ShipModel, trials: Sequence[Trial], outputs: Sequence[str], able: Mapping[str, Effect]
) -> dict[str, str]:
    """Sensors that are late, where one motion is recorded and nothing drives her.

    A free motion that is late is one that began later. Of a roll decay held for 3 s before the
    release the roll was named 3 s late.
    """
    driving = {*model.recorded} - {"u"}
    moving = [n for t in trials for n, y in t.signals.items() if n in driving and np.ptp(y) > 0.0]
    if moving or len(outputs) > 1:
        return {}
    late = [n for n, e in able.items() if {*e.acts_on(Delayed, Lagged)} & {*outputs}]
    return dict.fromkeys(late, "needs what drives her, or a second motion, to be late against")


def _small(trials: Sequence[Trial], name: str, below: float) -> bool:
    """Whether an input lies near zero, and not at it, for a while of these trials."""
    held = [t.signals[source] for t in trials if (source := record_for(t, name))]
    size = np.abs(np.concatenate(held or [np.zeros(1)]))
    share = size / (size.max() or 1.0)
    return float(np.mean((share > AT_ZERO) & (share < below))) >= WHILE


def _why_not(model: ShipModel, trial: Trial, effect: Effect, able: Mapping[str, Effect]) -> str:
    if effect.held is not None:
        return ""
    if not effect.scanned and not linear_parameters(effect):
        return "nothing in it can be zero"
    if trouble := why_unusable(model, trial, effect):
        return trouble
    others = [e for e in able.values() if not e.scanned]
    taken = {*model.parameters, *(p for e in others for p in e.parameters)}
    clash = sorted(taken & set(effect.parameters))
    return f"parameter {clash[0]!r} is already there" if clash else ""


def why_unusable(model: ShipModel, trial: Trial, effect: Effect) -> str:
    """Why this effect has no place in a model of this record, empty where it has one."""
    if unknown := missing_signals(model, trial, effect):
        where = "ship file" if set(unknown) <= set(PARTICULARS) else "record"
        return f"needs {', '.join(unknown)}, which the {where} does not hold"
    given = {*model.all_states}
    if effect.scanned:  # it is tried in the place of the other
        given -= {s for e in model.effects if takes_place(effect, e) for s in e.states}
    gives = {*effect.states, *filter(None, [effect.stands_for])}
    doubled = sorted(gives & {*given, *trial.signals})
    if doubled:
        held = "simulated" if doubled[0] in model.all_states else "recorded"
        return f"gives {doubled[0]}, which is {held} already"
    if effect.corrects and effect.corrects not in model.parameters:
        return f"corrects {effect.corrects}, which the model does not have"
    return _steers_wrongly(model, trial, effect)


def missing_signals(model: ShipModel, trial: Trial, effect: Effect) -> list[str]:
    """Signals and particulars that an effect is a function of, and this record does not hold."""
    known = {*model.all_states, *effect.states, *model.ship.particulars, "U", "u", "t"}
    known |= set(ACCELERATIONS)
    asked = dict.fromkeys((*signals_of(effect), *filter(None, effect.states.values())))
    return [s for s in asked if s not in known and not record_for(trial, s)]


def _steers_wrongly(model: ShipModel, trial: Trial, effect: Effect) -> str:
    """Why an effect cannot change a motion that is an input: it needs a record, or is instead."""
    for s in sorted({*effect.acts_on(Steered)} & set(STATES)):
        if s in model.states:
            return f"acts on the record of {s}, which is simulated"
        if _varies(trial, s) is bool(effect.states):
            return f"stands in for a record of {s}" if effect.states else f"needs a record of {s}"
    return ""


def _varies(trial: Trial, signal: str) -> bool:
    """Whether a motion is recorded: a stated approach speed is one number all along."""
    return bool(np.ptp(trial.signals.get(signal, np.zeros(1))) > 0.0)


def linear_parameters(effect: Effect) -> tuple[str, ...]:
    """The parameters by which it is scored: at zero it is absent, or as it is held."""
    if effect.scanned:
        return ()
    absent = effect.held or 0.0
    return tuple(n for n, p in effect.parameters.items() if p.null == absent)
