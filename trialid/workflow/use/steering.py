"""What steers a finished run's model, and what a full order is that a file of gains speaks of."""

from dataclasses import dataclass

from trialid.design.following import sailed_ship
from trialid.design.helm import Vessel
from trialid.design.steering.steered_by import SteeredBy, steered_by
from trialid.design.steering.straight_course import LinearShip
from trialid.errors import DesignError, TrialidError
from trialid.export.model.order_words import command_unit, command_words
from trialid.names.quantities import RUDDERS
from trialid.workflow.use.finished_model import FinishedModel
from trialid.workflow.use.predict import ready_ship


@dataclass(frozen=True)
class Wishes:
    """What somebody who wants a file has to say, or may.

    Bandwidth [rad/s], full rudder [rad], full command of a thruster [unit that reports show it in].
    """

    bandwidth: float | None = None
    full_rudder: float | None = None
    full_command: float | None = None


def steered_ship(model: FinishedModel) -> Vessel:
    """The ship, steered by a rudder or by two thrusters.

    Raises
    ------
    TrialidError
        She is steered by something else, of which there is no K and no T.
    """
    if not RUDDERS.isdisjoint(model.fit.model.recorded):
        return sailed_ship(model.fit)
    ship = ready_ship(model.fit)
    try:
        steered_by(ship)
    except DesignError as error:
        raise TrialidError(
            f"{model.where}: {error}; or export her as fmu, c, python or modelica and design her "
            "heading control with that"
        ) from error
    return ship


def full_order(
    model: FinishedModel, ship: Vessel, wishes: Wishes, *, of_autopilot: bool = False
) -> float:
    """The order that gains of a file are shares of [SI].

    For an autopilot that is what it gives at full output; else 1 rad of a rudder, and the largest
    command of thrusters in the trials, unless another is wished for.

    Raises
    ------
    TrialidError
        An autopilot's is not said, or it is said of what does not steer her.
    """
    by = steered_by(ship)
    if by.thrusters:
        return _full_command(model, by, wishes, of_autopilot=of_autopilot)
    if wishes.full_command is not None:
        raise TrialidError(
            "--full-command is of thrusters; this model is steered by a rudder, so --full-rudder 35"
        )
    if not of_autopilot:
        return 1.0
    if wishes.full_rudder is None:
        raise TrialidError(
            "--as ardupilot needs the rudder angle at full steering output, which no log of a "
            "rudder holds; add --full-rudder 35 [deg]"
        )
    return wishes.full_rudder


def check_full(ship: LinearShip, full: float) -> None:
    """Refuse a full command that does not hold the speed.

    Raises
    ------
    TrialidError
        So says it, with the command that does.
    """
    if full < ship.held:
        raise TrialidError(
            f"--full-command: {command_words(ship, full)} is less than the "
            f"{command_words(ship, ship.held)} of both thrusters that hold {ship.speed:.3g} m/s"
        )


def _full_command(
    model: FinishedModel, by: SteeredBy, wishes: Wishes, *, of_autopilot: bool
) -> float:
    pair, one = " and ".join(by.inputs), by.thrusters[0]
    factor, unit = command_unit(one)
    if wishes.full_rudder is not None:
        raise TrialidError(
            f"--full-rudder is of a rudder, and this model is steered by {pair}; say instead their "
            f"command at full output, --full-command 1000 [{unit}]"
        )
    if wishes.full_command is not None:
        return wishes.full_command / factor
    if one.command == "share":
        return 1.0
    if of_autopilot:
        raise TrialidError(
            f"--as ardupilot needs the command of {pair} at full output, which no log need have "
            f"come to; add --full-command 1000 [{unit}]"
        )
    seen = [model.seen[n] for n in by.inputs]
    return max(max(abs(x.low), abs(x.high)) for x in seen)
