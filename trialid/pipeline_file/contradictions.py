"""What no single key of a pipeline file shows: contradictions, repetitions, unknown quantities."""

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping

from trialid.errors import UnitError, nearest
from trialid.names import units
from trialid.names.quantities import POSITIONS, SIGNALS, Quantity
from trialid.pipeline_file.complaints import Problem, dotted_key
from trialid.pipeline_file.form import ClockSection, Pipeline, SignalSource, TrialSection
from trialid.pipeline_file.own_quantities import ship_quantities

Quantities = Mapping[str, Quantity]


def contradictions(pipeline: Pipeline) -> Iterator[Problem]:
    """Everything wrong that no single key shows."""
    yield from _ship_problems(pipeline)
    yield from _trial_problems(pipeline)
    known = ship_quantities(pipeline)
    own = bool(pipeline.model.effects_from)  # which may read signals of their own
    yield from _signal_problems(pipeline.signals, known, own, "signals")
    for place, trial in enumerate(pipeline.trials):
        yield from _signal_problems(trial.signals, known, own, "trial", place, "signals")
        yield from _clock_problems(trial, place)
    yield from _output_problems(pipeline, known)
    yield from _repetitions(pipeline)
    yield from _quiet_problems(pipeline)
    if len(pipeline.structures) == 1:
        yield "structures", "one structure has nothing to be compared with; write two or more"


def _ship_problems(pipeline: Pipeline) -> Iterator[Problem]:
    if pipeline.ship is None and pipeline.model.states:
        states = ", ".join(pipeline.model.states)
        yield (
            "ship",
            (
                f"missing; {states} can be simulated for a ship only: name her file, or write "
                "states = [] to compare sensors"
            ),
        )


def _trial_problems(pipeline: Pipeline) -> Iterator[Problem]:
    first: dict[str, int] = {}
    for place, trial in enumerate(pipeline.trials):
        if first.setdefault(trial.name, place) != place:
            at = dotted_key("trial", first[trial.name])
            yield dotted_key("trial", place, "name"), f"{trial.name!r} is already the name of {at}"
    if all(trial.use == "check" for trial in pipeline.trials):
        yield "trial", 'no trial to fit; at least one must have use = "fit"'


def _clock_problems(trial: TrialSection, place: int) -> Iterator[Problem]:
    for number, log in enumerate(trial.logs):
        if log.clock is not None and (trouble := _clock_trouble(log.clock)):
            yield dotted_key("trial", place, "logs", number, "clock"), trouble
    if all(log.clock is not None for log in trial.logs):
        yield (
            dotted_key("trial", place, "logs"),
            "every log has a clock of its own; leave the one that keeps the trial's clock without",
        )


def _clock_trouble(clock: ClockSection) -> str:
    ways = [key for key in ("offset", "events", "match") if getattr(clock, key) is not None]
    if len(ways) != 1:
        found = " and ".join(ways) or "none"
        return f"write one of offset, events, match; found {found}"
    for key, of in (("drift", "offset"), ("within", "match")):
        if getattr(clock, key) is not None and of not in ways:
            return f"{key} goes with {of}, and {ways[0]} is given; leave {key} out"
    if clock.events == ():
        return "events is empty; write at least one, [[seconds here, seconds there]]"
    return ""


def _signal_problems(
    signals: Mapping[str, SignalSource], known: Quantities, own: bool, *steps: str | int
) -> Iterator[Problem]:
    for name, source in signals.items():
        if name not in known:
            if not own:
                yield dotted_key(*steps, name), f"unknown quantity; {nearest_signal(name, known)}"
                continue
            for key, words in _source_problems(source, Quantity(name, name, "1", "1", name)):
                yield dotted_key(*steps, name, key), words
            continue
        for key, words in _source_problems(source, known[name]):
            yield dotted_key(*steps, name, key), words
        if trouble := _side_trouble(known[name], source.positive):
            yield dotted_key(*steps, name, "positive"), trouble
        if trouble := _unit_trouble(known[name], source.unit):
            yield dotted_key(*steps, name, "unit"), trouble


def nearest_signal(name: str, known: Quantities = SIGNALS) -> str:
    """Words for an unknown signal; a name that logs use leads to ours.

    >>> nearest_signal("heading")
    "did you mean 'psi'?"
    """
    for own, signal in known.items():
        if name.lower() in signal.aliases:
            return f"did you mean {own!r}?"
    return nearest(name, known)


def _source_problems(source: SignalSource, quantity: Quantity) -> Iterator[Problem]:
    """Which key says wrongly what the signal is read from and how, and why."""
    yield from _channel_problems(source, quantity)
    yield from _curve_problems(source)


def _channel_problems(source: SignalSource, quantity: Quantity) -> Iterator[Problem]:
    """Which key says wrongly what the signal is read from, and why."""
    if not source.names:
        yield "channel", "missing; the pipeline needs it"
    elif source.channel is not None:
        if source.channels:
            yield "channels", "channel is given too; write one of the two"
        elif source.combine:
            yield "combine", "one channel has nothing to be combined with; leave it out"
    elif len({*source.channels}) < max(2, len(source.channels)):
        yield "channels", f"write two or more, each once, got {[*source.channels]}"
    elif source.combine is None:
        yield "combine", 'missing; write combine = "mean" where the channels measure the same'
    elif quantity.name in POSITIONS:
        yield "channels", "two antennas stand in two places; take one"


def _curve_problems(source: SignalSource) -> Iterator[Problem]:
    """What stands beside a curve that says the same, and what it needs."""
    if source.curve is None:
        return
    if (source.gain, source.offset) != (1.0, 0.0):
        yield "curve", "gain or offset is given too; the curve says it all, leave them out"
    if source.unit is None:
        yield "unit", "missing; write the unit of the second number of each point of the curve"


def _side_trouble(quantity: Quantity, positive: str | None) -> str:
    if quantity.mirror == 1 and positive is not None:
        return f"{quantity.name!r} has no port or starboard ({quantity.meaning}); leave it out"
    if quantity.steers and positive is None:
        return (
            'missing; write the side the ship turns to when it is positive: "starboard" or "port"'
        )
    return ""


def _unit_trouble(quantity: Quantity, unit: str | None) -> str:
    try:
        units.factor_of(unit or quantity.unit, quantity)
    except UnitError as error:
        return str(error)
    return ""


def _output_problems(pipeline: Pipeline, known: Quantities) -> Iterator[Problem]:
    outputs = pipeline.identify.outputs
    mapped = {*pipeline.signals, *(name for trial in pipeline.trials for name in trial.signals)}
    for place, name in enumerate(outputs):
        key = dotted_key("identify", "outputs", place)
        if name in mapped - {*known}:
            yield (
                key,
                (
                    f"{name!r} is a signal of your own, and no equation of the ship gives it; take "
                    f"it out, or choose from {', '.join(pipeline.model.states)}"
                ),
            )
        elif name not in known:
            yield key, f"unknown quantity {name!r}; {nearest_signal(name, known)}"
    for section, table in (
        (("identify", "weights"), pipeline.identify.weights),
        (("diagnose", "noise"), pipeline.diagnose.noise),
    ):
        for name in table:
            if name not in outputs:
                hint = nearest(name, outputs)
                yield dotted_key(*section, name), f"not one of identify.outputs; {hint}"


def _repetitions(pipeline: Pipeline) -> Iterator[Problem]:
    lists: dict[str, Iterable[object]] = {
        "model.states": pipeline.model.states,
        "model.effects": pipeline.model.effects,
        "identify.free": pipeline.identify.free,
        "identify.outputs": pipeline.identify.outputs,
        "identify.nuisance": pipeline.identify.nuisance,
        **{dotted_key("structures", n): each for n, each in pipeline.structures.items()},
    }
    for key, entries in lists.items():
        for entry, times in Counter(entries).items():
            if times > 1:
                yield key, f"{str(entry)!r} stands there {times} times; once is enough"


def _quiet_problems(pipeline: Pipeline) -> Iterator[Problem]:
    names = [trial.name for trial in pipeline.trials]
    for place, stretch in enumerate(pipeline.diagnose.quiet):
        if stretch.trial not in names:
            key = dotted_key("diagnose", "quiet", place, "trial")
            yield key, f"no trial {stretch.trial!r}; {nearest(stretch.trial, names)}"
