"""What a fitted model can be written as: names, how the files end, what each is for."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final


@dataclass(frozen=True)
class Kind:
    """A form of a model: what it is in a few words, its files' endings, what has to be said.

    What has to be said of a boat that thrusters steer is another thing. `steered`: it is of a ship
    that answers a rudder angle, or two thrusters alike, by a turn.
    """

    words: str
    suffixes: tuple[str, ...]
    needs: str = ""
    needs_by_thrusters: str = ""
    steered: bool = False


KINDS: Final[Mapping[str, Kind]] = {
    "ship": Kind("a ship file for a next pipeline", (".toml",)),
    "json": Kind("plain data, with a schema", (".json",)),
    "python": Kind("one file that needs NumPy alone", (".py",)),
    "c": Kind("C99 with a header, no dependencies", (".c", ".h")),
    "fmu": Kind("FMI 2.0 for co-simulation, C source and binaries", (".fmu",)),
    "fmu3": Kind("the same as FMI 3.0", (".fmu",)),
    "modelica": Kind("one Modelica model that reads like the equations", (".mo",)),
    "nomoto": Kind("Nomoto's K, T, T1 to T3 and the state space", (".json",), steered=True),
    "pid": Kind("a heading autopilot's gains with what they promise", (".json",), steered=True),
    "ardupilot": Kind(
        "steering gains of ArduPilot Rover",
        (".param",),
        "--full-rudder 35",
        "--full-command 1000",
        steered=True,
    ),
    "gazebo": Kind("Gazebo's Hydrodynamics, with what it costs", (".sdf",)),
}
"""By the word that `--as` takes."""
