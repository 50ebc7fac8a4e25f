"""A pipeline to begin with, written from what logs hold: every choice stated, none hidden."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from trialid.errors import LogError
from trialid.inspection import Inspection
from trialid.ship.particulars import read_ship
from trialid.workflow.first_pipeline.choice import Chosen, choose_signals, shared_signals, size_unit
from trialid.workflow.first_pipeline.pipeline_text import comment, pipeline_text
from trialid.workflow.first_pipeline.placeholder_ship import placeholder, placeholder_path

__all__ = ["Starter", "starter"]


@dataclass(frozen=True)
class Starter:
    """Files to write, text by path, and what the user must still fill in, in words."""

    files: dict[Path, str]
    to_fill: tuple[str, ...]


def starter(
    surveys: Sequence[Inspection],
    pipeline: Path,
    ship: Path | None,
    length: float | None,
    speed: float | None,
) -> Starter:
    """A pipeline for logs, a trial each, the last of several held out.

    Parameters
    ----------
    surveys
        The logs.
    pipeline
        Where it is to stand; nothing is written here.
    ship
        The ship file; None: a placeholder of the length is made beside the pipeline.
    length
        Of the ship [m], where there is no ship file.
    speed
        Approach speed [m/s], where no log tells it.

    Raises
    ------
    LogError
        The logs hold too little, or not the same, to begin with, or the ship is not known.
    """
    trials = _with_speeds([choose_signals(one, speed) for one in surveys], speed)
    _check_shared(trials)
    if ship is None and length is None:
        raise LogError(
            f"{pipeline}: no log knows the ship; add --ship SHIP.toml, or --length METRES to begin "
            "with a placeholder of that length"
        )
    u0 = next((one.speed for one in trials if one.speed), None)
    if u0 is None:
        raise LogError(
            f"{pipeline}: no log tells the speed in a stated unit; add --speed KNOTS, the approach "
            "speed"
        )
    own = read_ship(ship).particulars["L"] if ship else length
    assert own is not None
    trials = [size_unit(one, own, u0) for one in trials]
    files: dict[Path, str] = {}
    if ship is None:
        ship = placeholder_path(pipeline)
        words = next(one.speed_words for one in trials if one.speed)
        files[ship] = placeholder(own, u0, comment(words))
    files[pipeline] = pipeline_text(pipeline, ship, own, u0, trials)
    return Starter(files, tuple(_to_fill(trials)))


def _with_speeds(trials: list[Chosen], stated: float | None) -> list[Chosen]:
    """One log's speed settles the unit of another's, as trials of one ship are of about a speed."""
    known = [one.speed for one in trials if one.speed]
    if stated is not None or not known:
        return trials
    words = "as in the other logs"
    return [
        one if one.speed else replace(choose_signals(one.survey, known[0]), speed_words=words)
        for one in trials
    ]


def _check_shared(trials: Sequence[Chosen]) -> None:
    both = shared_signals(trials)
    for needed, words in (({"delta", "delta_order"}, "rudder"), ({"r", "psi"}, "yaw motion")):
        if not needed & both:
            held = "; ".join(
                f"{one.path.name}: {', '.join(sorted(one.quantities & needed))}" for one in trials
            )
            raise LogError(f"the logs share no {words} ({held}); begin with logs of one recorder")


def _to_fill(trials: Sequence[Chosen]) -> list[str]:
    return [
        f"{one.path.name}: {signal.quantity}, {comment(signal.why)}"
        for one in trials
        for signal in one.signals
        if signal.open
    ]
