"""The text of a starter pipeline: a comment for each choice, the other choices commented out."""

import os
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Final

from trialid.errors import printable
from trialid.inspection import disagreements
from trialid.inspection.inspected import ChannelInspection
from trialid.inspection.positions import positions
from trialid.inspection.read_alike import unit_and_side
from trialid.names import wording
from trialid.names.quantities import SIGNALS
from trialid.ship.actuators import rudder_signals
from trialid.ship.particulars import Ship
from trialid.toml_text import array, quote
from trialid.workflow.first_pipeline.boats.actuators_begun import main_drives
from trialid.workflow.first_pipeline.boats.boat_model import boat_model
from trialid.workflow.first_pipeline.boats.over_ground import UNITS
from trialid.workflow.first_pipeline.choice import RUDDERS
from trialid.workflow.first_pipeline.chosen import OPEN, Chosen, Signal
from trialid.workflow.first_pipeline.free_lines import free_lines
from trialid.workflow.first_pipeline.held_out import held_out, why_held_out
from trialid.workflow.first_pipeline.roll_decay import decay_model, is_of_decays
from trialid.workflow.first_pipeline.sample_period import align_lines
from trialid.workflow.first_pipeline.signed_speed import FROM_EAST, from_east

HEAD: Final = """\
# Begun by `trialid inspect --init` from what the log{s} hold{not_s}. Read every comment, then
#     trialid run {name}
# It begins with the simplest model. What is missing in it the run says; `trialid add` puts it in.
"""

MOST_OTHERS: Final = 6
"""Other sources of a signal that are written down."""

SWAY: Final = ("Yv", "Ydelta")
"""What a record of sway tells of it; most of Yr goes with the centrifugal force, which is known."""
ROLL: Final = ("Kv", "Kr", "Kdelta", "Kp", "GM")
"""All of the roll: a rudder's heeling moment held at another ship's would drag GM along."""

IMO: Final = "# imo = true  # manoeuvres of MSC.137(76), with ranges: `trialid guide design`"
"""For who wants them: of a ship that a rudder steers."""
GEAR: Final = 0.05
"""Lag of a small ship's gear, as a share of the time in which she goes her own length: that of a
ship of 160 m at 15 knots is 1 s."""


def pipeline_text(
    path: Path,
    ship_path: Path,
    ship: Ship,
    length: float,
    speed: float,
    trials: Sequence[Chosen],
    *,
    left_out: Sequence[str] = (),
) -> str:
    """The pipeline that is to stand at `path`, for a ship of this length [m] and speed [m/s].

    `left_out` says which logs are no trial of it, and why.
    """
    several = len(trials) > 1
    head = HEAD.format(s="s" if several else "", not_s="" if several else "s", name=path.name)
    lines = [
        head + f"name = {quote(path.stem)}",
        f"ship = {quote(_relative(ship_path, path))}",
        *([IMO] if all({"delta", "delta_order"} & {*t.quantities} for t in trials) else []),
        *(f"# left out: {comment(words)}" for words in left_out),
    ]
    names, held = _names(trials), held_out(trials)
    for place, (name, trial) in enumerate(zip(names, trials, strict=True)):
        lines += ["", *_trial(path, name, trial, why_held_out(trials) if place == held else "")]
    lines += [
        "",
        *align_lines(trials, length, speed),
        "",
        *_model(trials, ship, length / max(speed, 0.1)),
    ]
    return "\n".join(lines) + "\n"


def _trial(path: Path, name: str, trial: Chosen, held: str) -> Iterator[str]:
    """The table of a trial; `held` says why it is held out, where it is."""
    yield "[[trial]]"
    yield f"name = {quote(name)}"
    yield f"logs = [{_log(trial, path)}]"
    if held:
        yield f'use = "check"  # held out, {held}: scored, never fitted'
    if trial.states_speed and trial.speed is not None:
        why = ": no log has u" if trial.speed else ""
        yield f"speed = {float(trial.speed):.4g}  # m/s, {comment(trial.speed_words)}{why}"
    yield from _stretch(trial)
    yield from (f"# {comment(remark)}" for remark in _remarks(trial))
    yield "[trial.signals]"
    width = max(len(one.quantity) for one in trial.signals)
    found = disagreements.findings(trial.survey)
    for signal in trial.signals:
        yield f"# {signal.quantity}: {comment(signal.why)}"
        yield from (f"# {comment(one.words)}" for one in found if one.of_slope(signal.quantity))
        yield f"{signal.quantity:<{width}} = {{ {_source(signal, signal.source)} }}"
        for other in signal.others[:MOST_OTHERS]:
            words = f"# or {signal.quantity} = {{ {_source(signal, other)} }}"
            yield f"{words}  # {_facts(other)}"
        yield from _mean(signal)
        if len(signal.others) > MOST_OTHERS:
            more = wording.count_of(len(signal.others) - MOST_OTHERS, "more source")
            yield f"# and {more}: `trialid inspect`"
    for signal, why in trial.beside:
        yield f"# left to you: {signal.quantity}; {comment(why)}"
        yield f"# {signal.quantity} = {{ {_source(signal, signal.source)} }}"
    yield from _track(trial)


def _stretch(trial: Chosen) -> Iterator[str]:
    """What of the log is the trial, and what is made of it."""
    yield _window(trial)
    if trial.made_over_ground:
        yield "over_ground = true  # u and v are made of what is recorded over the ground"


def _window(trial: Chosen) -> str:
    """The manoeuvre alone: as it was found in a log, else for the user to say."""
    if (found := trial.window) is None:
        return f"# window = [0.0, {trial.survey.duration:.0f}.0]  # s, the manoeuvre alone"
    why = found.why or f"{found.kind} deg, as the rudder went"
    return f"window = [{found.begin:.1f}, {found.end:.1f}]  # s, {why}"


def _track(trial: Chosen) -> Iterator[str]:
    """Positions that are not read, commented out: what they are for the guide says."""
    found = positions(trial.survey.channels.values())
    if not found or {*found} <= trial.quantities:
        return
    yield "# the track, its current and the turning circle: `trialid guide track`"
    if "x" in found:
        yield "# (x has to be to the north and y to the east; ROS often has it the other way round)"
    for name, one in found.items():
        keys = {"channel": one.name} | ({} if one.unit else {"unit": UNITS[name][0]})
        yield f"# {name} = {{ {', '.join(f'{k} = {quote(v)}' for k, v in keys.items())} }}"


def _log(trial: Chosen, path: Path) -> str:
    """The log as the pipeline names it, with what the user adds to it."""
    aids = trial.survey.aids
    keys = {"path": _relative(trial.path, path)}
    keys |= {
        name: _relative(file, path)
        for name, file in (("template", aids.template), ("dbc", aids.dbc))
        if file is not None
    }
    if aids.zone is not None:
        keys["zone"] = aids.zone
    if len(keys) == 1:
        return quote(keys["path"])
    return f"{{ {', '.join(f'{key} = {quote(value)}' for key, value in keys.items())} }}"


def _remarks(trial: Chosen) -> Iterator[str]:
    yield from trial.survey.warnings[:3]
    yield from (remark for file in trial.survey.files[:1] for remark in file.remarks[:3])


def _facts(one: ChannelInspection) -> str:
    gaps = f", {wording.count_of(one.gaps.count, 'gap')}" if one.gaps.count else ""
    return f"{one.rate:.3g} Hz{gaps}"


def _mean(signal: Signal) -> Iterator[str]:
    """The mean of the sources that are read like the chosen one, commented out."""
    chosen = _keys(signal, signal.source)
    alike = [
        one.name
        for one in signal.others
        if {**_keys(signal, one), "channel": signal.source.name} == chosen
    ]
    if not alike:
        return
    names = ", ".join(map(quote, [signal.source.name, *alike]))
    rest = _written({key: value for key, value in chosen.items() if key != "channel"})
    yield f'# or {signal.quantity} = {{ channels = [{names}], combine = "mean", {rest} }}'


def _source(signal: Signal, one: ChannelInspection) -> str:
    return _written(_keys(signal, one))


def _written(keys: Mapping[str, str | float | None]) -> str:
    told = ((k, x if isinstance(x, float) else quote(x)) for k, x in keys.items() if x)
    return ", ".join(f"{key} = {value}" for key, value in told)


def _keys(signal: Signal, one: ChannelInspection) -> Mapping[str, str | float | None]:
    """The keys of one signal; of another source than the chosen one, its own unit."""
    unit, positive = (signal.unit, signal.positive) if one is signal.source else _as(signal, one)
    if signal.quantity in SIGNALS and signal.quantity not in RUDDERS and positive == "starboard":
        positive = None  # as the dictionary has it
    return {
        "channel": one.name,
        "as": one.angle,
        "unit": None if one.angle not in (None, "speed") and unit != OPEN else unit,
        "positive": positive,
        "offset": FROM_EAST if from_east(one, positive) else None,
    }


def _as(signal: Signal, one: ChannelInspection) -> tuple[str | None, str | None]:
    """Unit and side of another source: its own, else by how it moves beside the chosen."""
    by_format = (one.guess and one.guess.positive) or signal.positive
    stated = one.stated_unit or one.unit_by_size
    if signal.quantity not in SIGNALS:
        return stated or signal.unit, by_format
    measured, mirrored = unit_and_side(one, signal.source, signal.unit, signal.quantity)
    unit = stated or measured or (signal.unit and OPEN)
    sided = SIGNALS[signal.quantity].mirror < 0 and signal.positive != OPEN
    if mirrored is None or not sided:
        return unit, by_format
    return unit, "port" if mirrored != (signal.positive == "port") else "starboard"


def _model(trials: Sequence[Chosen], ship: Ship, own_time: float) -> Iterator[str]:
    known = frozenset.intersection(*(one.quantities for one in trials))
    if is_of_decays(trials):
        yield from decay_model(trials, ship)
        return
    if known & {n for d in main_drives(ship) for n in (d, f"{d}_order")}:
        yield from boat_model(trials, ship)
        return
    several = bool(known & rudder_signals(ship.actuators))
    outputs = ["r" if "r" in known else "psi", *(n for n in ("v", "phi") if n in known)]
    rolls, order_only = "phi" in known, not several and "delta" not in known
    states = ["v", *(["p"] if rolls else []), "r", *(["phi"] if rolls else [])]
    states += ["psi"] if "psi" in outputs else []
    over_ground = all(one.over_ground for one in trials)
    effects = _effects(several=several, rolls=rolls, over_ground=over_ground)
    yield "[model]"
    yield f"states = {array(states)}  # what is simulated; the speed is read from the log"
    if order_only:
        yield "# only the order is logged: the rudder follows it with a lag, T_delta"
        effects.insert(0, "rudder_servo")
    yield f"effects = {array(effects)}  # `trialid effects` lists what there is"
    if order_only:
        lag = min(1.0, GEAR * own_time)
        words = "s, typical; put it into free once the rest fits"
        yield f"values = {{ T_delta = {lag:.2g} }}  # {words}"
    free = ["Nv", "Nr", "Ndelta", *(SWAY if "v" in known else []), *(ROLL if rolls else [])]
    yield ""
    yield "[identify]"
    if "v" in known:
        yield "# Masses stay as the ship file has them: motions tell forces over masses alone."
    else:
        yield "# Masses and the sway coefficients stay as the ship file has them: the yaw alone"
        yield "# does not tell them apart. Free them where the speed v is recorded."
    yield from free_lines(free, ship)
    yield f"outputs = {array(outputs)}"
    offset = [] if several else ["rudder_offset"]  # of one rudder; of several `NAME_misaligned`
    water = ["current"] if over_ground and "psi" in known else []  # in the speed
    nuisance = ["initial_state", "bias", *offset, "delay", *water]
    yield f"nuisance = {array(nuisance)}  # of each trial, estimated too"


def _effects(*, several: bool, rolls: bool, over_ground: bool) -> list[str]:
    """The simplest model: linear, and with a speed over ground read as one."""
    return [
        "linear_hull",
        "rudders" if several else "linear_rudder",
        *(["linear_roll"] if rolls else []),
        *(["drift_in_speed_record"] if over_ground else []),
    ]


def _names(trials: Sequence[Chosen]) -> list[str]:
    """A name a trial, from its file; two files of one name are numbered."""
    names: list[str] = []
    for trial in trials:
        stem = comment(trial.name)
        name, count = stem, 1
        while name in names:
            count += 1
            name = f"{stem}-{count}"
        names.append(name)
    return names


def _relative(path: Path, pipeline: Path) -> str:
    """A path as the pipeline's folder sees it."""
    folder = pipeline.resolve().parent
    return Path(os.path.relpath(path.resolve(), folder)).as_posix()


def comment(text: str) -> str:
    r"""Text of a log as a comment may hold it: on one line, nothing that steers a terminal.

    >>> comment("rud\nder")
    'rud\\nder'
    """
    return printable(text)
