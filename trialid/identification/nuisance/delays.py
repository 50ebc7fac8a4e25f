"""How late a sensor is sought to be, and which samples that leaves to compare."""

from collections.abc import Sequence
from typing import Final

from trialid.ship.effect import Parameter
from trialid.simulation.delay import margin
from trialid.simulation.integrate import Simulator
from trialid.trial import Trial

LATE: Final = 0.125
"""Share of a trial by which a sensor in it may be late or early: a delay takes as much off either
end, and a boat's trial of 5 s had nothing left beside the 3 s that are possible. Half of it leaves
a sensor 0.5 s late in such a trial outside, twice leaves half of it to compare."""


def delay_limits(parameter: Parameter, trials: Sequence[Trial]) -> tuple[float, float]:
    """How early and how late [s] a sensor may be: in no trial by more than a share of it."""
    most = LATE * min(trial.duration for trial in trials)
    return max(parameter.low, -most), min(parameter.high, most)


def spoilt_by_delay(simulator: Simulator, output: str, trial: Trial) -> int:
    """Samples to leave out at each end because the output's delay is free or not zero."""
    name = f"tau_{output}"
    if (parameter := simulator.model.parameters.get(name)) is None:
        return 0
    if name in simulator.equations.free:
        return margin(*delay_limits(parameter, [trial]), trial.period)
    value = simulator.model.value(name)
    return margin(value, value, trial.period) if value else 0
