"""What drives and steers a ship: rudders, thrusters and pods, each with a place and a direction."""

import math
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final, Literal, get_args

from trialid.errors import ShipError, nearest
from trialid.names import units
from trialid.names.quantities import QUANTITIES, Quantity

Kind = Literal["rudder", "thruster", "azimuth", "tunnel", "waterjet"]
Command = Literal["revolutions", "share", "thrust"]

KINDS: Final[tuple[str, ...]] = get_args(Kind)
TURNED: Final = ("azimuth", "waterjet")
"""Kinds that have an angle beside what drives them."""
COMMANDS: Final = {"revolutions": "rad/s", "share": "1", "thrust": "N"}
"""What drives an actuator, and its unit."""
ORDERS: Final = tuple(COMMANDS.items())
SHOWN: Final = {"rad": "deg", "rad/s": "rpm", "1": "1", "N": "N"}
NAME: Final = re.compile(r"[a-z][a-z0-9_]*")
ENDINGS: Final = ("_order", "_angle", "_bucket")

KEYS: Final = {
    "name": "needed. Its name, and that of its signal in a trial; small letters, digits and `_`.",
    "kind": f"needed. What it is: {', '.join(f'`{kind}`' for kind in KINDS)}.",
    "at": "needed. Where it stands, `[ahead, to starboard]` of the origin [m].",
    "direction": "Where its push points, clockwise from ahead [deg]; 0, and 90 of a tunnel.",
    "command": "What its signal is: `revolutions` (thrust k n |n|), `share` of the full ones "
    "(likewise), or a stated `thrust`; a rudder's is its angle.",
    "own": "Whether it has parameters of its own, `k_ahead_NAME`, where others of its kind share.",
    "behind": "Of a rudder: the name of the thruster in whose race it stands.",
    "limit": "The most that is ordered of it to either side: revolutions [rpm], share, thrust [N], "
    "a rudder's angle [deg]; designed tests keep to it.",
    "rate": "How much of that it follows its order by in a second; designed tests count with it.",
}
"""What each key of an `[[actuator]]` means; the guide's page of keys is made of it."""


@dataclass(frozen=True, kw_only=True)
class Actuator:
    """One rudder, thruster, pod, tunnel or jet.

    Attributes
    ----------
    x, y
        Its place ahead and to starboard of the origin [m].
    direction
        Where its push points, clockwise from ahead [rad].
    command
        What its signal is; of a rudder, whose signal is its angle, without meaning.
    own
        Whether its parameters are its own and not shared with its kind.
    behind
        Of a rudder, the thruster in whose race it stands; empty where in none.
    limit, rate
        The most that is ordered of it [SI], and how fast it follows [SI/s]; infinite: not said.
    """

    name: str
    kind: Kind
    x: float
    y: float
    direction: float = 0.0
    command: Command = "revolutions"
    own: bool = False
    behind: str = ""
    limit: float = math.inf
    rate: float = math.inf

    @property
    def unit(self) -> str:
        """Unit of what is ordered of it: its drive, or a rudder's angle."""
        return "rad" if self.kind == "rudder" else COMMANDS[self.command]

    @property
    def angle(self) -> str:
        """The signal of its angle, empty where it has none."""
        if self.kind == "rudder":
            return self.name
        return f"{self.name}_angle" if self.kind in TURNED else ""

    @property
    def bucket(self) -> str:
        """The signal of a jet's bucket."""
        return f"{self.name}_bucket"

    @property
    def drive(self) -> str:
        """The signal of what drives it, empty of a rudder."""
        return "" if self.kind == "rudder" else self.name

    @property
    def signals(self) -> tuple[str, ...]:
        """All that drives and turns it."""
        return tuple(dict.fromkeys(s for s in (self.drive, self.angle) if s))


def actuator_quantities(actuators: Iterable[Actuator]) -> dict[str, Quantity]:
    """Signals of these actuators, as fed back and as ordered, by name."""
    return {row.name: row for one in actuators for row in _quantities(one)}


def _quantities(one: Actuator) -> Iterable[Quantity]:
    for signal in one.signals:
        is_angle = signal == one.angle
        unit = "rad" if is_angle else COMMANDS[one.command]
        what = f"{'angle' if is_angle else one.command} of the {one.kind} {one.name}"
        told = f"{what}, positive {_positive(one, is_angle=is_angle)}"
        for name, word in ((signal, ""), (f"{signal}_order", "ordered ")):
            yield Quantity(
                name,
                name,
                unit,
                SHOWN[unit],
                f"{word}{told}",
                mirror=-1 if is_angle else 1,
                steers=one.kind == "rudder",
                commands=() if is_angle else ORDERS,
            )
    if one.kind == "waterjet":
        words = f"bucket of the waterjet {one.name}, 0 open, 1 all of the jet turned back"
        yield Quantity(one.bucket, one.bucket, "1", "1", words)


def _positive(one: Actuator, *, is_angle: bool) -> str:
    if one.kind == "azimuth" and is_angle:
        return "where its push turns clockwise from ahead"
    if is_angle:
        return "turns the ship to starboard"
    return "along its direction"


def rudder_signals(actuators: Iterable[Actuator]) -> frozenset[str]:
    """Angles of rudders, as fed back and as ordered."""
    return frozenset(n for n, q in actuator_quantities(actuators).items() if q.steers)


def actuators_of(table: Mapping[str, Any], where: str) -> tuple[Actuator, ...]:
    """The `[[actuator]]` tables of a ship file.

    Raises
    ------
    ShipError
        In one line: the table, the key, what is expected.
    """
    rows = table.get("actuator", [])
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise ShipError(f"{where}: actuator = {rows!r}; write a table [[actuator]] for each")
    made = tuple(_actuator(row, f"{where}: actuator[{i}]") for i, row in enumerate(rows))
    _check_names(made, where)
    _check_shared(made, where)
    _check_races(made, where)
    return made


def _actuator(row: Mapping[str, Any], where: str) -> Actuator:
    for key in row:
        if key not in KEYS:
            raise ShipError(f"{where}: unknown key {key!r}; {nearest(key, KEYS)}")
    for key in ("name", "kind", "at"):
        if key not in row:
            raise ShipError(f"{where}: {key!r} is missing; {_plain(KEYS[key])}")
    kind = _one_of(row["kind"], KINDS, f"{where}: kind")
    usual = {"command": "revolutions", "own": False, "behind": "", "limit": math.inf}
    usual |= {"rate": math.inf, "direction": 90.0 if kind == "tunnel" else 0.0}
    full = {**usual, **row}
    _check_row(row, full, where)
    one = Actuator(
        name=row["name"],
        kind=kind,
        x=float(row["at"][0]),
        y=float(row["at"][1]),
        direction=math.radians(full["direction"]),
        command=_one_of(full["command"], tuple(COMMANDS), f"{where}: command"),
        own=full["own"],
        behind=full["behind"],
    )
    size = units.factor(SHOWN[one.unit], one.unit)
    return replace(one, limit=size * full["limit"], rate=size * full["rate"])


def _check_row(row: Mapping[str, Any], full: Mapping[str, Any], where: str) -> None:
    """Refuse values of the wrong form, each with what to write."""
    name, at = row["name"], row["at"]
    if row["kind"] == "rudder" and "command" in row:
        raise ShipError(f"{where}: a rudder has no command, its signal is its angle; leave it out")
    if row["kind"] != "rudder" and "behind" in row:
        raise ShipError(f"{where}: only a rudder stands in a race; leave 'behind' out")
    if not isinstance(name, str) or not NAME.fullmatch(name):
        raise ShipError(f"{where}: name = {name!r}; {_plain(KEYS['name'])}")
    if not isinstance(full["own"], bool):
        raise ShipError(f"{where}: own = {full['own']!r}; write true or false")
    if not isinstance(at, list) or len(at) != 2 or not all(map(_is_number, at)):
        raise ShipError(f"{where}: at = {at!r}; write [metres ahead, metres to starboard]")
    if not _is_number(full["direction"]):
        told = f"direction = {full['direction']!r}"
        raise ShipError(f"{where}: {told}; write degrees from ahead, clockwise")
    for key in ("limit", "rate"):
        _check_size(row, key, where)


def _check_size(row: Mapping[str, Any], key: str, where: str) -> None:
    if key in row and not (_is_number(row[key]) and row[key] > 0.0):
        raise ShipError(f"{where}: {key} = {row[key]!r}; write a number above zero")


def actuator_tables(actuators: Iterable[Actuator]) -> Iterator[str]:
    """Lines of a ship file; `actuators_of` reads the same."""
    for one in actuators:
        yield "[[actuator]]"
        yield f'name = "{one.name}"'
        yield f'kind = "{one.kind}"'
        yield f"at = [{one.x!r}, {one.y!r}]  # m ahead, m to starboard"
        yield f"direction = {_degrees(one.direction)!r}"
        if one.kind != "rudder":
            yield f'command = "{one.command}"'
        yield f"own = {str(one.own).lower()}"
        if one.behind:
            yield f'behind = "{one.behind}"'
        for key, value in (("limit", one.limit), ("rate", one.rate)):
            if math.isfinite(value):
                yield f"{key} = {value * units.factor(one.unit, SHOWN[one.unit])!r}"
        yield ""


def _degrees(angle: float) -> float:
    """The angle [deg] of which `math.radians` makes this one, short where it can be.

    >>> _degrees(math.radians(-359.7)), _degrees(math.radians(7.5))
    (-359.7, 7.5)
    """
    near = math.degrees(angle)
    tried = (float(f"{near:.12g}"), near, *(math.nextafter(near, e) for e in (-1e9, 1e9)))
    return next((degrees for degrees in tried if math.radians(degrees) == angle), near)


def _plain(words: str) -> str:
    return words.removeprefix("needed. ").replace("`", "").removesuffix(".")


def _one_of(given: Any, known: Sequence[str], where: str) -> Any:
    if given not in known:
        raise ShipError(f"{where} = {given!r}; expected one of {', '.join(known)}")
    return given


def _is_number(given: Any) -> bool:
    return isinstance(given, int | float) and type(given) is not bool and math.isfinite(given)


def _check_names(made: Sequence[Actuator], where: str) -> None:
    taken: dict[str, str] = {}
    for one in made:
        if one.name in QUANTITIES:
            raise ShipError(
                f"{where}: actuator {one.name!r} has the name of a quantity "
                f"({QUANTITIES[one.name].meaning}); choose another"
            )
        if one.name.endswith(ENDINGS):
            raise ShipError(
                f"{where}: actuator {one.name!r}: a name does not end in "
                "_order, _angle or _bucket, which its signals do"
            )
        for signal in one.signals:
            if signal in taken:
                raise ShipError(f"{where}: actuator {one.name!r}: signal {signal!r} is there twice")
            taken[signal] = one.name


def _check_shared(made: Sequence[Actuator], where: str) -> None:
    """One gain for newtons and revolutions would be no gain."""
    for kind in KINDS:
        shared = [one for one in made if one.kind == kind and not one.own]
        commands = sorted({one.command for one in shared})
        if len(commands) > 1:
            raise ShipError(
                f"{where}: the {kind}s share their parameters, and their commands are "
                f"{' and '.join(commands)}; write own = true to those that differ"
            )


def _check_races(made: Sequence[Actuator], where: str) -> None:
    """A race is that of a thruster of this ship, and rudders that share it share its unit."""
    screws = {one.name: one for one in made if one.kind == "thruster"}
    behind = [one for one in made if one.behind]
    for one in behind:
        if one.behind not in screws:
            raise ShipError(
                f"{where}: actuator {one.name!r}: behind = {one.behind!r} is no thruster of this "
                f"ship; {nearest(one.behind, screws)}"
            )
    commands = sorted({screws[one.behind].command for one in behind if not one.own})
    if len(commands) > 1:
        raise ShipError(
            f"{where}: the rudders share k_race, and the commands of their thrusters are "
            f"{' and '.join(commands)}; write own = true to those that differ"
        )
