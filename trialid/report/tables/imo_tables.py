"""The tables of the standard measures of a run, and of the overshoots its trials hold."""

from typing import Final

from trialid.design.imo.trial_numbers import Manoeuvre, ManoeuvreNumber, Overshoot, TurnMeasure
from trialid.names import wording
from trialid.report.tables.rounded_table import Cell, Figure, Table
from trialid.result.imo_rows import ImoPart, MeasureRow
from trialid.result.schema import Result

ON_TRACK: Final = ("Williamson turn", "stop")
CORRECTED: Final = {
    "current": "Corrected for current: through the water, by the current that the fit found "
    "(a trial held out finds its own).",
    "wind": "Corrected for wind: less what the model drifts by it under the recorded rudder, from "
    "the order on.",
}
UNCORRECTED: Final = {
    "current": "Not corrected for current: the fit finds none.",
    "wind": "Not corrected for wind: the model has none in it.",
}
NONE: Final = "nothing held or reversed by more than 3 deg of heading out of a straight course"
READINGS: Final = (
    *("measured", "95 % from", "to", "corrected", "95 % from", "to", "corrected for"),
    *("model", "95 % from", "to"),
)


def measures(run: Result) -> Table:
    """Every standard measure beside what is allowed, how sure it is, and whether it is kept."""
    rows = tuple(_measure(each) for each in (run.imo or ImoPart()).measures)
    headings = (
        *("measure", "manoeuvre", "predicted", "95 % from", "to"),
        *("allowed", "unit", "criterion"),
    )
    return Table("imo", "Standard measures of MSC.137(76)", headings, rows)


def _measure(each: MeasureRow) -> tuple[Cell, ...]:
    low, high = each.interval or (None, None)
    numbers = tuple(Figure(x, 3) for x in (each.value, low, high, each.allowed))
    return each.name, each.manoeuvre, *numbers, each.unit, criterion(each)


def criterion(each: MeasureRow) -> str:
    """Whether a measure keeps what is allowed, or why that is not known."""
    if each.value is None or each.allowed is None:
        return each.remark or "no limit"
    if each.kept is None:
        return "open"
    return "kept" if each.kept else "not kept"


def overshoots(run: Result) -> Table:
    """Every overshoot of the trials, measured and of the model."""
    rows = tuple(_overshoot(each) for each in (run.imo or ImoPart()).overshoots)
    headings = ("trial", "t [s]", "rudder [deg]", "measured [deg]", "model [deg]")
    return Table("overshoots", "Overshoots in the trials", headings, rows)


def _overshoot(each: Overshoot) -> tuple[Cell, ...]:
    angles = (_degrees(x) for x in (each.rudder, each.measured, each.predicted))
    return each.trial, Figure(each.t), *(Figure(x, 3) for x in angles)


def turns(run: Result) -> Table:
    """Every measure of a turning circle in the trials, as recorded, corrected, and the model's."""
    rows = tuple(_turn(each) for each in (run.imo or ImoPart()).turns)
    headings = (
        *("trial", "t [s]", "rudder [deg]", "turning circle", "measured [m]", "95 % from", "to"),
        *("corrected [m]", "95 % from", "to", "corrected for", "model [m]", "95 % from", "to"),
    )
    return Table("turns", "Turning circles in the trials", headings, rows)


def _turn(each: TurnMeasure) -> tuple[Cell, ...]:
    angle = Figure(_degrees(each.rudder), 3)
    return each.trial, Figure(each.t), angle, each.name, *_corrected(each, 1.0)


def _corrected(each: TurnMeasure | ManoeuvreNumber, factor: float) -> tuple[Cell, ...]:
    """As recorded, corrected and for what, and the model's, each with its interval."""
    nothing = None, None
    measured, corrected, predicted = (
        tuple(
            Figure(None if x is None else x * factor, 4 if factor == 1.0 else 3)
            for x in (value, *(ends or nothing))
        )
        for value, ends in (
            (each.measured, each.interval),
            (each.corrected, each.corrected_interval),
            (each.predicted, each.predicted_interval),
        )
    )
    return (*measured, *corrected, each.corrected_for or "nothing", *predicted)


def track_numbers(run: Result) -> Table:
    """Numbers of Williamson turns and stops, read from the track as those of turns are."""
    found = (run.imo or ImoPart()).measured
    rows = tuple(_on_track(each) for each in found if each.kind in ON_TRACK)
    headings = (
        *("trial", "manoeuvre", "t [s]", "number", "unit"),
        *READINGS,
    )
    return Table("track_numbers", "Williamson turns and stops in the trials", headings, rows)


def _on_track(each: ManoeuvreNumber) -> tuple[Cell, ...]:
    unit, factor = wording.shown_unit(each.unit)
    start = each.trial, each.kind, Figure(each.t), each.name, unit
    return (*start, *_corrected(each, factor))


def further_tables(run: Result) -> tuple[Table, ...]:
    """What was recognised, and its numbers besides those of turning circles."""
    return manoeuvres(run), track_numbers(run), manoeuvre_numbers(run)


def corrections(run: Result) -> str:
    """What the numbers read from tracks are corrected for and what not, in sentences."""
    imo = run.imo or ImoPart()
    words = [each.corrected_for for each in imo.turns]
    words += [each.corrected_for for each in imo.measured if each.kind in ON_TRACK]
    causes = {cause for each in words for cause in each.split(" and ")}
    seen = "wind" not in causes and any(each.signal == "V_aw" for each in imo.conditions)
    told = [words for cause, words in CORRECTED.items() if cause in causes]
    told += [words for cause, words in UNCORRECTED.items() if cause not in causes]
    if seen:
        told.append("The wind was recorded: an effect of it, as apparent_wind, can be fitted.")
    return " ".join(told)


def manoeuvres(run: Result) -> Table:
    """Every manoeuvre that was recognised in the trials, and a line for each trial without any."""
    found = () if run.imo is None else run.imo.manoeuvres
    rows = [_manoeuvre(each) for each in found]
    named, nothing = {each.trial for each in found}, (Figure(None),) * 5
    if run.imo is not None:
        rows += [(t.name, "none", *nothing, "", NONE) for t in run.trials if t.name not in named]
    places = {trial.name: k for k, trial in enumerate(run.trials)}
    rows.sort(key=lambda row: places.get(str(row[0]), len(places)))
    headings = (
        *("trial", "manoeuvre", "order [s]", "end [s]", "rudder [deg]", "course before [deg]"),
        *("approach speed [m/s]", "speed by", "remark"),
    )
    return Table("manoeuvres", "Manoeuvres in the trials", headings, tuple(rows))


def _manoeuvre(each: Manoeuvre) -> tuple[Cell, ...]:
    times = Figure(each.t), Figure(each.end)
    angles = Figure(_degrees(each.rudder), 3), Figure(_course(each.course), 4)
    speed = Figure(each.speed, 3)
    return each.trial, each.kind, *times, *angles, speed, each.speed_by, each.remark or "whole"


def manoeuvre_numbers(run: Result) -> Table:
    """Numbers of zig-zags, pull-outs and spirals, of the record and of the model."""
    found = (run.imo or ImoPart()).measured
    rows = tuple(_measured(each) for each in found if each.kind not in ON_TRACK)
    headings = (
        *("trial", "manoeuvre", "t [s]", "rudder [deg]", "number", "unit"),
        *READINGS,
    )
    return Table("measured", "Zig-zags, pull-outs and spirals in the trials", headings, rows)


def _measured(each: ManoeuvreNumber) -> tuple[Cell, ...]:
    unit, factor = wording.shown_unit(each.unit)
    start = (Figure(each.t), Figure(_degrees(each.rudder), 3))
    return each.trial, each.kind, *start, each.name, unit, *_corrected(each, factor)


def _degrees(angle: float) -> float:
    _, factor = wording.shown_unit("rad")
    return angle * factor


def _course(angle: float | None) -> float | None:
    """In degrees from 0 to 359.9, to the tenth."""
    return None if angle is None else round(_degrees(angle), 1) % 360.0
