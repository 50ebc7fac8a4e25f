"""The standard measures of the ship that a design file is for."""

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, Final

from trialid.design.helm import Vessel, vessel
from trialid.design.imo.speed_loss import with_speed_loss
from trialid.design.prediction.rudders_zero import with_zero_at
from trialid.design.search import Ship
from trialid.design.standard import Measure, predict
from trialid.pipeline_file.finished_run import FinishedRun
from trialid.result.imo import UNRELIABLE, measure_rows, sailing_words

SAME: Final = 1e-6
"""Share of a measure that the run's own differs by where it is of the same ship."""


@dataclass(frozen=True)
class Imo:
    """The standard measures of a ship, how she is sailed, and whether they may be relied on."""

    measures: tuple[Measure, ...]
    vessel: Vessel
    reliable: bool


def imo(ships: Sequence[Ship], run: FinishedRun) -> Imo:
    """The measures of the first ship; the others are what she might be as well.

    Of a single ship that a run fitted the run knows how sure they are.
    """
    vessels = [_as_in_run(ship.vessel, run) for ship in ships]
    measures = predict(vessels)
    if len(ships) == 1 and run.intervals:
        there = replace(vessels[0], rudder_rate=run.gear_rate(None))
        known = measures if there.rudder_rate == vessels[0].rudder_rate else predict([there])
        pairs = zip(measures, known, strict=True)
        measures = tuple(_with_range(m, in_run, run) for m, in_run in pairs)
    return Imo(measures, vessels[0], reliable=run.verdict != "no fit")


def _as_in_run(ship: Vessel, run: FinishedRun) -> Vessel:
    """The ship with what the run's trials had beside her model."""
    if run.rudders_zero is not None:
        model = with_zero_at(ship.model, run.rudders_zero)
        ship = vessel(model, ship.period, ship.constants, ship.rudder_rate)
    return with_speed_loss(ship, run.speed_lost)


def _with_range(measure: Measure, known: Measure, run: FinishedRun) -> Measure:
    """A measure with the run's range, where it is of the run's ship.

    She is if with the run's gear her measure is the run's. By another gear the range grows, by as
    much about her own: of a boat whose file states 4 deg/s of rudder, where her trials have 4.01,
    an overshoot of 8.65 deg was called kept, that the run leaves open at 8.11 to 10.5.
    """
    value, (low, high) = run.intervals.get(measure.criterion.name, (None, (0.0, 0.0)))
    if value is None or measure.value is None or known.value is None:
        return measure
    if abs(value - known.value) > SAME * abs(value):
        return measure
    share = measure.value / value if value else 1.0
    return replace(measure, interval=(min(low, low * share), max(high, high * share)))


def plain(found: Imo | None) -> dict[str, Any]:
    """The measures as plain data; empty where nobody asked."""
    if found is None:
        return {"imo": [], "imo_sailed": "", "imo_doubt": ""}
    return {
        "imo": [asdict(row) for row in measure_rows(found.measures, reliable=found.reliable)],
        "imo_sailed": sailing_words(found.vessel),
        "imo_doubt": "" if found.reliable else UNRELIABLE,
    }
