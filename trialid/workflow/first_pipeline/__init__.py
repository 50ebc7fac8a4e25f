"""A pipeline to begin with, written from what logs hold: every choice stated, none hidden."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from trialid.errors import LogError
from trialid.inspection import Inspection
from trialid.ship.estimate import Given, estimate
from trialid.ship.estimate.ship_text import ship_text
from trialid.ship.particulars import Ship, read_ship
from trialid.workflow.build_model import LYING_STILL
from trialid.workflow.first_pipeline.axes_of_earth import (
    with_velocities_beside,
    without_axes_of_earth,
)
from trialid.workflow.first_pipeline.boats.actuators_begun import (
    actuator_lines,
    boat_actuators,
    main_drives,
    named_by_ship,
)
from trialid.workflow.first_pipeline.boats.boat_choice import PORT, choose, is_boat
from trialid.workflow.first_pipeline.boats.numbered_drives import with_ports
from trialid.workflow.first_pipeline.boats.one_drive import DRIVE, with_turned_drive
from trialid.workflow.first_pipeline.boats.over_ground import with_speed_by_position
from trialid.workflow.first_pipeline.boats.tunnel_thrusters import tunnels_of, with_tunnels
from trialid.workflow.first_pipeline.boats.turned_drives import AFT, ANGLE
from trialid.workflow.first_pipeline.by_other_logs import (
    with_sides,
    with_units,
    with_unshown,
)
from trialid.workflow.first_pipeline.choice import approach_speed, live_sources, shared_signals
from trialid.workflow.first_pipeline.chosen import Chosen, open_questions
from trialid.workflow.first_pipeline.long_log import Windows
from trialid.workflow.first_pipeline.not_begun import OF_ONE, STILL, TooLittle, no_speed
from trialid.workflow.first_pipeline.pipeline_text import comment, pipeline_text
from trialid.workflow.first_pipeline.read_as_order import with_orders
from trialid.workflow.first_pipeline.revolutions import with_depth, with_revolutions
from trialid.workflow.first_pipeline.roll_decay import decays_among
from trialid.workflow.first_pipeline.small_roll import without_small_roll
from trialid.workflow.first_pipeline.speed_by_track import (
    held_against_track,
    with_doubtful_speeds,
    with_speed_units,
)
from trialid.workflow.first_pipeline.twin_rudders import (
    RUDDERS,
    has_twins,
    twin_actuators,
    with_twins,
)
from trialid.workflow.first_pipeline.unit_by_turning import (
    with_headings,
    with_rate_units,
    with_rudder_units,
)

__all__ = ["Starter", "begun_ship", "starter"]

STEERS: Final = frozenset(("delta", "delta_order", PORT, AFT, f"{DRIVE}{ANGLE}", *RUDDERS.values()))

NO_SERVICE_SPEED: Final = (
    "she rolls at rest, and the numbers of a new ship are made of the speed that she goes at; add "
    "--speed KNOTS"
)
NO_WAY: Final = (
    "she swings, and no log tells whether she makes way; with --speed KNOTS she does, and at that; "
    "of decays at rest make her file first, with her service speed (trialid ship OUT.toml --length "
    "METRES --speed KNOTS), and add --ship OUT.toml"
)
"""Of decays: the number that a new ship is made of would be her speed in the logs too."""


@dataclass(frozen=True)
class Starter:
    """Files to write, text by path, what was chosen, and what the user must still fill in.

    `left_out` says which of several logs are no trial, and why.
    """

    files: dict[Path, str]
    to_fill: tuple[str, ...]
    trials: tuple[Chosen, ...]
    left_out: tuple[str, ...] = ()


def starter(
    surveys: Sequence[Inspection],
    pipeline: Path,
    ship: Path | None,
    given: Given,
    speed: float | None = None,
    windows: Windows = (),
) -> Starter:
    """A pipeline for logs, a trial each, one of several held out.

    Parameters
    ----------
    surveys
        The logs.
    pipeline
        Where it is to stand; nothing is written here.
    ship
        The ship file; None: one is made of the particulars, beside the pipeline.
    given
        Particulars of the ship, where there is no ship file.
    speed
        Approach speed [m/s], where no log tells it.
    windows
        Of each log the manoeuvres that are trials of their own; see `manoeuvre_windows`.

    Raises
    ------
    LogError
        The logs hold too little, or not the same, to begin with, or the ship is not known.
    """
    own = read_ship(ship) if ship is not None else None
    length = given.length if own is None else own.particulars.get("L")
    known = without_axes_of_earth(_with_units(surveys, length, speed))
    decays = decays_among(known, speed, given.length, own)
    trials, left_out = (decays, []) if decays else _steered(known, surveys, own, speed)
    if ship is None and given.length is None:
        raise LogError(
            f"{pipeline}: no log knows the ship; add --ship SHIP.toml, or --length METRES, and "
            "--beam, --draught, --displacement where you have them"
        )
    in_file = own.particulars.get("U0") if decays and own is not None else None
    u0 = max((one.speed for one in trials if one.speed), default=speed or in_file)
    if u0 is None:
        unknown = any("CAREFUL" in one.speed_words for one in decays)
        of_decays = NO_WAY if unknown else NO_SERVICE_SPEED
        raise LogError(f"{pipeline}: {of_decays if decays else no_speed(surveys)}")
    files: dict[Path, str] = {}
    if ship is None or own is None:
        ship = begun_ship(pipeline)
        own, files[ship] = _begun(pipeline, replace(given, speed=u0), trials)
    elif is_boat(shared_signals(trials)):
        trials = [replace(t, signals=named_by_ship(t.signals, own)) for t in trials]
    L = own.particulars["L"]
    if not decays:
        trials, short = _long_enough(*_under_way(trials, u0), L / u0)
        left_out += short
        trials = with_rudder_units(with_rate_units(trials, L, u0), L, u0)
        trials = with_orders(trials, L / u0, main_drives(own))
    trials = with_doubtful_speeds(_cut(trials, windows) if windows else trials, L)
    left_out += filter(None, (one.left_beside for one in trials))
    files[pipeline] = pipeline_text(pipeline, ship, own, L, u0, trials, left_out=left_out)
    return Starter(files, tuple(open_questions(trials)), tuple(trials), tuple(left_out))


def _with_units(
    surveys: Sequence[Inspection], length: float | None, stated: float | None
) -> list[Inspection]:
    """The logs, speeds and headings in the unit that others of them, her way or turning leave."""
    sized = with_units(with_speed_units(surveys, stated))
    speeds = [approach_speed(s, {"u": live_sources(s, "u")}, stated)[0] for s in sized]
    fastest = max((u for u in speeds if u), default=None)
    seconds = length / fastest if length and fastest else None
    return with_units(with_headings(sized, seconds))


def _steered(
    known: Sequence[Inspection],
    surveys: Sequence[Inspection],
    own: Ship | None,
    speed: float | None,
) -> tuple[list[Chosen], list[str]]:
    """What to take from each log of a ship that is steered, and why from some nothing is taken.

    LogError where none holds enough, or where they do not hold the same.
    """
    tried = [_tried(one, speed) for one in known]
    too_little = [one for one in tried if isinstance(one, TooLittle)]
    able = [one for one in tried if isinstance(one, Chosen)]
    if not able:
        raise too_little[0]
    chosen = with_unshown(with_ports(_with_speeds(able, speed)))
    told = with_turned_drive(with_sides(with_twins(chosen, own)), own)
    told = with_speed_by_position(told, speed)
    trials = with_revolutions(without_small_roll(told))
    trials = with_tunnels(with_depth(trials), own)
    as_read = [one for one, found in zip(surveys, tried, strict=True) if isinstance(found, Chosen)]
    trials = [
        with_velocities_beside(held_against_track(one), survey)
        for one, survey in zip(trials, as_read, strict=True)
    ]
    _check_shared(trials)
    return trials, [one.reason for one in too_little]


def _tried(survey: Inspection, speed: float | None) -> Chosen | TooLittle:
    try:
        return choose(survey, speed)
    except TooLittle as error:
        return error


def _under_way(trials: list[Chosen], u0: float) -> tuple[list[Chosen], list[str]]:
    """The trials in which a ship steered by rudders goes, and why others are left out.

    She is let go from a heel there, and no rudder turns her; a boat turns on the spot by thrusters.
    """
    still = [one for one in trials if one.speed is not None and one.speed < LYING_STILL * u0]
    if is_boat(shared_signals(trials)) or len(still) == len(trials):
        return trials, []
    names = " ".join(one.path.name for one in still)
    return [one for one in trials if one not in still], [
        f"{one.path.name}: she lies still, {one.speed:.2g} m/s where others have {u0:.3g}; of roll "
        f"decays at rest begin a pipeline of their own: trialid start {names} --pipeline roll.toml"
        for one in still
    ]


def _long_enough(
    trials: list[Chosen], left_out: list[str], seconds: float
) -> tuple[list[Chosen], list[str]]:
    """The trials in which she goes her own length at least, and why others are left out.

    None is where all are as short: what that is worth the fit says. Of 20 s a log of 4 s, a test of
    the recorder, took the verdict from five trials of 25 minutes; half of it and twice leave out
    the same.
    """
    enough = [one for one in trials if one.survey.duration >= seconds]
    if not enough:
        return trials, left_out
    short = (one for one in trials if one not in enough)
    return enough, left_out + [
        f"{one.path.name}: {one.survey.duration:.3g} s long, and she takes {seconds:.3g} s for her "
        "own length"
        for one in short
    ]


def _cut(trials: Sequence[Chosen], windows: Windows) -> list[Chosen]:
    """Each manoeuvre of a log as a trial; a log without any as the one it is."""
    found = zip(trials, windows, strict=True)
    return [replace(one, window=each) for one, own in found for each in own or (one.window,)]


def _begun(pipeline: Path, given: Given, trials: Sequence[Chosen]) -> tuple[Ship, str]:
    """A ship of these particulars, with what drives and steers her in these logs; and her file."""
    told = (one.speed_words for one in trials if one.speed == given.speed)
    words = next(told, "as stated")
    made = estimate(given, f"ship of {pipeline.stem}")
    ones = tunnels_of(trials, made.ship)
    if is_boat(shared_signals(trials)):
        ones = (*boat_actuators(trials[0].signals, made.ship), *ones)
    elif has_twins(trials[0].signals):
        ones = (*twin_actuators(made.ship), *ones)
    text = ship_text(made, comment(words)) + "\n".join(actuator_lines(ones))
    return replace(made.ship, actuators=ones), text


def begun_ship(pipeline: Path) -> Path:
    """Where the ship of a pipeline stands: `zigzag.toml` has `zigzag_ship.toml`."""
    return pipeline.with_name(f"{pipeline.stem}_ship.toml")


def _with_speeds(trials: list[Chosen], stated: float | None) -> list[Chosen]:
    """One log's speed settles the unit of another's, as trials of one ship are of about a speed."""
    known = [one.speed for one in trials if one.speed]
    if stated is not None or not known:
        return trials
    words = "as in the other logs"
    return [
        one if one.speed else replace(choose(one.survey, known[0]), speed_words=words)
        for one in trials
    ]


def _check_shared(trials: Sequence[Chosen]) -> None:
    both = shared_signals(trials)
    for needed, words in ((STEERS, "rudder"), ({"r", "psi"}, "yaw motion")):
        if not needed & both:
            held = "; ".join(
                f"{one.path.name}: {', '.join(sorted(one.quantities & needed))}" for one in trials
            )
            drives = needed is STEERS and any(is_boat(one.quantities) for one in trials)
            then = STILL if drives else OF_ONE
            raise LogError(f"the logs share no {words} ({held}); {then}")
