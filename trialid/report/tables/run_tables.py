"""The tables of one run, from its result; numbers rounded by their error."""

from collections.abc import Iterable

from trialid.names import labels, wording
from trialid.report.pictures import error_history
from trialid.report.tables import imo_tables
from trialid.report.tables.rounded_table import Cell, Figure, Table, by_error, percent
from trialid.result.change_rows import MovedRow, StepRow
from trialid.result.finding_rows import ForceEquationRow
from trialid.result.fit_rows import Interval, LeversPart, ParameterRow, PartsRow, SplitPart
from trialid.result.schema import Result

USES = {"fit": "fitted", "check": "held out"}


def tables(run: Result) -> tuple[Table, ...]:
    """Every table the run has something for."""
    made = (
        _parameters(run), _nuisance(run), _weak(run), _levers(run), _split(run), _history(run),
        _change(run), _validation(run), _missing(run), _force(run), imo_tables.measures(run),
        imo_tables.overshoots(run),
        imo_tables.turns(run), imo_tables.track_numbers(run), imo_tables.manoeuvres(run),
        imo_tables.manoeuvre_numbers(run),
        _logs(run), _signals(run),
    )  # fmt: skip
    return tuple(table for table in made if table.rows)


def in_shown_unit(row: ParameterRow | MovedRow, key: str) -> float | None:
    """A number of a parameter in the unit it is shown in."""
    _, factor = wording.shown_unit(row.unit)
    number = getattr(row, key)
    return None if number is None else number * factor


def value(row: ParameterRow) -> Figure:
    """A parameter's value with the digits its error leaves it, in the unit it is shown in."""
    return by_error(in_shown_unit(row, "value"), in_shown_unit(row, "standard_error"))


def rows_of_kind(run: Result, nuisance: bool) -> list[ParameterRow]:
    """The parameters of the ship, or those of trials and sensors."""
    rows = run.accuracy.parameters
    return [row for row in rows if (row.kind == "nuisance") == nuisance]


_HEADINGS = ("parameter", "value", "standard error", "unit")
_LIKELY = ("likely from", "likely to", "may be off [%]", "widened by")
_SENSITIVITY = ("S_i", "S_imin", "R_i")


def likely(row: ParameterRow) -> tuple[Figure, Figure]:
    """Both ends of the likely range in the unit shown, with the digits its width leaves them."""
    if row.likely is None:
        return Figure(None), Figure(None)
    _, factor = wording.shown_unit(row.unit)
    low, high = (end * factor for end in row.likely)
    return by_error(low, 0.25 * (high - low)), by_error(high, 0.25 * (high - low))


def _begun(row: ParameterRow) -> tuple[Cell, ...]:
    unit, _ = wording.shown_unit(row.unit)
    return row.name, value(row), Figure(in_shown_unit(row, "standard_error"), 2), unit


def _sensitivities(row: ParameterRow) -> tuple[Cell, ...]:
    return tuple(Figure(getattr(row, key), 3) for key in _SENSITIVITY)


def _parameters(run: Result) -> Table:
    rows = tuple(
        (
            *_begun(row), *likely(row), percent(row.may_be_off), row.widened_by or "",
            percent(row.relative_error), percent(row.noise_error),
            percent(row.undermodelling_error), *_sensitivities(row),
        )
        for row in rows_of_kind(run, nuisance=False)
    )  # fmt: skip
    headings = ("Eq. 14 [%]", "from noise [%]", "from model, at most [%]")
    return Table("parameters", "Parameters and how far to trust them",
                 (*_HEADINGS, *_LIKELY, *headings, *_SENSITIVITY), rows)  # fmt: skip


def _nuisance(run: Result) -> Table:
    rows = [(*_begun(row), *_sensitivities(row)) for row in rows_of_kind(run, nuisance=True)]
    return Table("nuisance", "Parameters of trials and sensors",
                 (*_HEADINGS, *_SENSITIVITY), tuple(rows))  # fmt: skip


def _weak(run: Result) -> Table:
    rows = tuple(
        (w.sentence or "", ", ".join(w.parameters), percent(w.relative_error))
        for w in run.accuracy.weak
    )
    return Table("weak_directions", "Weak directions: what can move together unseen",
                 ("direction", "parameters", "relative error [%]"), rows)  # fmt: skip


def _levers(run: Result) -> Table:
    levers = run.accuracy.stability
    found: list[tuple[str, LeversPart]] = [("plain", levers)] if levers else []
    if levers and levers.roll_coupled:
        found.append(("with heel", levers.roll_coupled))
    rows = tuple((form, *_levers_row(each)) for form, each in found)
    heads = ["form", "L_r", "L_v", "L_r - L_v", "standard error", "likely from", "to", "stable"]
    title = "Directional stability (Eq. 15 and 16), primed"
    return Table("stability", title, tuple(heads), rows)


def _levers_row(levers: LeversPart) -> tuple[Cell, ...]:
    low, high = levers.likely or (None, None)
    return (
        Figure(levers.L_r),
        Figure(levers.L_v),
        by_error(levers.margin, levers.standard_error),
        Figure(levers.standard_error, 2),
        Figure(low, 2),
        Figure(high, 2),
        _said(levers.stable, "yes", "no", "not known"),
    )


def _said(known: bool | None, yes: str, no: str, unknown: str) -> str:
    return unknown if known is None else (yes if known else no)


def ends(interval: Interval | None) -> tuple[Cell, Cell]:
    """Both ends of an interval of fractions, in percent."""
    low, high = interval or (None, None)
    return percent(low), percent(high)


def _split(run: Result) -> Table:
    split, fit = run.split, run.fit
    rows: list[tuple[str, float | None, SplitPart | PartsRow]] = [
        ("all outputs", fit.eps_rmsn, split)
    ]
    rows += [
        (labels.label(name), eps, split.of(name)) for name, eps in fit.eps_rmsn_by_output.items()
    ]
    return Table(
        "error", f"The error and what it is made of: {split.method or 'not told apart'}",
        ("output", "error [%]", "noise [%]", "noise from", "noise to", "model [%]", "model from",
         "model to"),
        tuple(
            (
                name, percent(eps), percent(parts.noise),
                *ends(parts.ends("noise")), percent(parts.undermodelling),
                *ends(parts.ends("undermodelling")),
            )
            for name, eps, parts in rows
        ),
    )  # fmt: skip


def _history(run: Result) -> Table:
    rows = tuple(
        (
            Figure(place), _step(row, run), percent(row.eps_rmsn), percent(row.noise),
            percent(row.undermodelling), *ends(error_history.interval(row, run)),
            percent(row.eps_rmsn_check), row.verdict or "",
        )
        for place, row in enumerate(run.history)
    )  # fmt: skip
    headings = ("step", "what was done", "error [%]", "noise [%]", "model [%]", "model from",
                "model to", "held out [%]", "verdict on it")  # fmt: skip
    return Table("history", "How the error fell", headings, rows)


def _step(row: StepRow, run: Result) -> str:
    """What was done, or only proposed, or done for other logs."""
    words = error_history.step_words(row)
    if row.step == "proposed":
        return f"{words} (proposed, not in the file)"
    return words if row in run.comparable else f"{words} (on other logs)"


def _change(run: Result) -> Table:
    """Before and after: what this command did to the model, else what the verdict proposes."""
    pair = run.change or run.before_after
    headings = ("quantity", "unit", "before", "after", "standard error")
    if pair is None:
        return Table("change", "Before and after", headings, ())
    errors = [("error, fitted", pair.eps_rmsn), ("error, held out", pair.eps_rmsn_check),
              ("noise part", pair.noise), ("model part", pair.undermodelling)]  # fmt: skip
    errors += [(f"error, {labels.label(c)}", both) for c, both in pair.by_output.items()]
    rows: list[tuple[Cell, ...]] = [
        (name, "%", percent(both[0]), percent(both[1]), Figure(None))
        for name, both in errors
        if both
    ]
    rows += [_moved(row) for row in pair.parameters]
    return Table("change", f"Before and after {pair.effect or ''}".rstrip(), headings,
                 tuple(rows))  # fmt: skip


def _moved(row: MovedRow) -> tuple[Cell, ...]:
    error = in_shown_unit(row, "standard_error")
    unit, _ = wording.shown_unit(row.unit)
    before, after = (by_error(in_shown_unit(row, key), error) for key in ("before", "after"))
    return row.name, unit, before, after, Figure(error, 2)


def outputs_of(run: Result) -> list[str]:
    """Every output an error is stated for."""
    names = dict.fromkeys(run.fit.eps_rmsn_by_output)
    for trial in run.trials:
        names |= dict.fromkeys(trial.eps_rmsn)
    return list(names)


def _validation(run: Result) -> Table:
    names, fit = outputs_of(run), run.fit
    held_out = fit.eps_rmsn_check_by_output or {}
    rows: list[tuple[Cell, ...]] = [
        (
            trial.name or "", USES.get(trial.use, ""),
            *(percent(trial.eps_rmsn.get(name)) for name in names), Figure(None),
        )
        for trial in run.trials
    ]  # fmt: skip
    sums = [("fitted", fit.eps_rmsn_by_output, fit.eps_rmsn),
            ("held out", held_out, fit.eps_rmsn_check)]  # fmt: skip
    rows += [
        ("all", use, *(percent(each.get(name)) for name in names), percent(eps))
        for use, each, eps in sums
        if eps is not None
    ]
    headings = ("trial", "use", *(f"{labels.label(n)} [%]" for n in names), "all outputs [%]")
    title = "Error by trial, as a share of the RMS of the fitted trials"
    title += "; x, y of her length" if {"x", "y"} & {*names} else ""
    return Table("validation", title, headings, tuple(rows))


def _missing(run: Result) -> Table:
    rows = tuple(
        (
            Figure(row.rank), row.effect or "", row.verdict or "",
            percent(row.eps_rmsn_predicted), percent(row.eps_rmsn_refitted),
            percent(row.eps_rmsn_check), Figure(row.p_value, 2), percent(row.visibility),
        )
        for row in run.missing
    )  # fmt: skip
    headings = ("rank", "effect", "verdict", "error foreseen [%]", "fitted [%]", "held out [%]",
                "p", "visible [%]")  # fmt: skip
    return Table("missing", "Which effect may be missing", headings, rows)


def _force(run: Result) -> Table:
    found = run.missing_force
    rows = tuple(_terms(found.equations)) if found else ()
    headings = ("equation", "explains [%]", "p of the equation", "term", "coefficient",
                "standard error", "p of the term")  # fmt: skip
    return Table("missing_force", "The missing force, SI", headings, rows)


def _terms(equations: Iterable[ForceEquationRow]) -> Iterable[tuple[Cell, ...]]:
    for each in equations:
        begun = (each.equation or "", percent(each.explains), Figure(each.p_value, 2))
        for term in each.shape:
            error = term.standard_error
            yield (*begun, term.term or "", by_error(term.coefficient, error),
                   Figure(error, 2), Figure(term.p_value, 2))  # fmt: skip
        if not each.shape:
            yield (*begun, "no simple shape", Figure(None), Figure(None), Figure(None))


def _logs(run: Result) -> Table:
    rows = [
        (trial.name or "", log.path or "", log.adapter or "", log.sha256 or "")
        for trial in run.trials
        for log in trial.logs
    ]
    rows += [("", each.path or "", "", each.sha256 or "") for each in run.sources]
    return Table("logs", "Files the run rests on", ("trial", "path", "format", "SHA-256"),
                 tuple(rows))  # fmt: skip


def _signals(run: Result) -> Table:
    rows = tuple(
        (each.trial or "", labels.label(each.signal or ""), each.channel or "")
        for each in run.signals
    )
    return Table("signals", "Channels the signals were read from",
                 ("trial", "signal", "channel"), rows)  # fmt: skip
