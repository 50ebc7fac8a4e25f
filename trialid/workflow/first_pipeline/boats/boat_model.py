"""The model a boat begins with that is steered by what pushes her: surge, sway where told, yaw."""

from collections.abc import Iterator, Sequence
from typing import Final

from trialid.effects.actuators.astern_gains import ASTERN
from trialid.effects.actuators.instances import typical_drive, typical_gain
from trialid.effects.actuators.push_kinds import PUSHES
from trialid.effects.actuators.pushes import push_effects
from trialid.inspection.own_scale import at_rest
from trialid.inspection.usual_units import to_si
from trialid.ship.particulars import Ship
from trialid.workflow.first_pipeline.boats.actuators_begun import main_drives
from trialid.workflow.first_pipeline.boats.one_drive import TURNED
from trialid.workflow.first_pipeline.chosen import Chosen, Signal
from trialid.workflow.first_pipeline.held_out import held_out

UNUSUAL: Final = 1.5
"""Times the usual revolutions of a boat of her length, either way, from which on a gain starts by
those of her log. An outsider's catamarans of 12 m have 3.8 to 4.3 times that, and begun with the
usual gain left for 35 m/s; a boat of 2 m with 1.9 arrives either way. Half as far beyond one tells
the same of all, twice that of the catamarans."""

BY_LOG: Final = "her gain starts where the most of her log drives her"

DRAGGED: Final = ("still_water_surge", "surge_resistance")
"""What holds her back, by the speed and by its square. Without the first an offset of her log
stands in for it: of 18 simulated boats that have both drags and run at 0 to 1.5 m/s `bias_u` had
the name in eight, her drag in six."""

DAMPED: Final = ("still_water_yaw", "still_water_yaw_quadratic")
SWAYING: Final = ("surge_turning", "linear_hull", "sway_drag_vav")
OF_SWAY: Final = ("Xvr", "Yv", "Yvav", "Nv")
"""Where sway is recorded: the way that a turn costs, and drift with the moment of it, which has
either sign. Of three simulated boats of 2 to 12 m it left 13 to 22 % of trials held out, what was
hidden in them included; with damping at rest and Munk's moment in its place 13 to 29 %, and a
memory of the flow had the name of a fin."""
NONE: Final = ("Yr", "Nr", "Nv")
AT_REST: Final = "for a ship's: Nr0 and Nrar0 damp turns, at rest too, and Nv begins at none"


def boat_model(trials: Sequence[Chosen], ship: Ship) -> Iterator[str]:
    """Lines of `[model]` and `[identify]`."""
    kinds = {one.kind for one in ship.actuators}
    kind = PUSHES[next((one for one in TURNED if one in kinds), "thruster")].effect
    gains = next(one for one in push_effects(ship) if one.name == kind).parameters
    astern = _goes_astern(trials, ship)
    free = [name for name in gains if astern or "ahead" in name]
    as_logged = _gain_as_logged(trials, ship)
    stated = {n: as_logged or p.start for n, p in gains.items() if as_logged or n not in free}
    reasons = [] if astern else ["no fitted trial goes astern: nothing tells it"]
    reasons += [BY_LOG] if as_logged else []
    sway = _all_have("v", trials)
    turn = "r" if _all_have("r", trials) else "psi"  # then the heading is fitted
    outputs = ["u", *(["v"] if sway else []), turn]
    states = [*outputs[:-1], "r", *(["psi"] if turn == "psi" else [])]
    if sway:
        stated |= dict.fromkeys(NONE, 0.0)
        reasons += [AT_REST]
    values = ", ".join(f"{name} = {x:.4g}" for name, x in stated.items())
    unlogged = "" if sway else "  # not every log has sway; the run says if it shows"
    yield "[model]"
    yield f"states = [{_quoted(states)}]{unlogged}"
    yield "# thrust k n |n| (k T where thrust is logged) at the places the ship file states"
    yield f"effects = [{_quoted([kind, *DRAGGED, *(SWAYING if sway else ()), *DAMPED])}]"
    if values:
        yield f"values = {{ {values} }}  # {'; '.join(reasons)}"
    yield ""
    yield "[identify]"
    yield "# A record of motions gives accelerations, never forces: with the mass held, gains and"
    yield "# damping are relative to it, and the inertia in yaw to the arm of the thrusters."
    hull = ["Xu0", "Xuu", *(OF_SWAY if sway else ()), "I_zz", "Nr0", "Nrar0"]
    yield f"free = [{_quoted([*free, *hull])}]"
    yield "bounds = { I_zz = [0.0, inf] }"
    yield f"outputs = [{_quoted(outputs)}]"
    over_ground = sway and all(one.made_over_ground for one in trials)
    nuisance = ["initial_state", *(["current"] if over_ground else [])]
    yield f"nuisance = [{_quoted(nuisance)}]  # of each trial, estimated too"


def _gain_as_logged(trials: Sequence[Chosen], ship: Ship) -> float | None:
    """Gain of a screw that drives her at the most revolutions of any log [N s^2]; None if usual.

    None, too, where no revolutions are logged: a share of full and a thrust are known of any boat.
    """
    found = [
        size * max(abs(one.source.low), abs(one.source.high))
        for one in _drives(trials, ship)
        if (size := to_si(one.unit or "", "rad/s")) is not None
    ]
    most, usual = max(found, default=0.0), typical_drive(ship, "revolutions")
    if not most or 1.0 / UNUSUAL < most / usual < UNUSUAL:
        return None
    return typical_gain(ship, "share") / most**2


def _quoted(names: Sequence[str]) -> str:
    return ", ".join(f'"{name}"' for name in names)


def _all_have(quantity: str, trials: Sequence[Chosen]) -> bool:
    return all(quantity in trial.quantities for trial in trials)


def _goes_astern(trials: Sequence[Chosen], ship: Ship) -> bool:
    """Whether any thruster of any trial that is fitted does: the gain is one of all of them."""
    held = held_out(trials)
    fitted = [trial for place, trial in enumerate(trials) if place != held]
    drives = [one.source for one in _drives(fitted, ship)]
    return any(
        one.low - rest < -ASTERN * (one.high - rest) for one in drives for rest in [at_rest(one)]
    )


def _drives(trials: Sequence[Chosen], ship: Ship) -> list[Signal]:
    """What drives her, measured or ordered, in each of them."""
    names = {n for drive in main_drives(ship) for n in (drive, f"{drive}_order")}
    return [one for trial in trials for one in trial.signals if one.quantity in names]
