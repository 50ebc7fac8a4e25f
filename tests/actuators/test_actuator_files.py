"""`[[actuator]]` of a ship file: what it says, and what is refused in one line."""

from pathlib import Path

import numpy as np
import pytest

from trialid.errors import ShipError
from trialid.ship.actuators import Actuator, actuator_quantities, actuator_tables
from trialid.ship.particulars import read_ship

HEAD = """
name = "boat"
source = "made up"
system = "prime"
rudder_positive = "starboard"
particulars = { L = 10.0, nabla = 10.0, rho = 1000.0, g = 9.81, U0 = 3.0 }
mass = { m = 0.02, I_zz = 0.0006 }
"""
ONE = '[[actuator]]\nname = "left"\nkind = "thruster"\nat = [-4.0, -1.0]\n'
AFT = '[[actuator]]\nname = "aft"\nkind = "rudder"\nat = [-5, 0]\n'
BOW = '[[actuator]]\nname = "bow"\nkind = "tunnel"\nat = [4, 0]\ncommand = "share"\n'


def ship(folder: Path, text: str):
    path = folder / "boat.toml"
    path.write_text(HEAD + text, encoding="utf-8")
    return read_ship(path)


def test_actuators_are_read(tmp_path: Path) -> None:
    left, bow = ship(tmp_path, ONE + BOW).actuators
    assert left == Actuator(name="left", kind="thruster", x=-4.0, y=-1.0)
    assert (left.command, left.own, bow.command) == ("revolutions", False, "share")
    assert bow.direction == pytest.approx(np.pi / 2)
    assert ship(tmp_path, "").actuators == ()


def test_what_is_written_reads_back_as_it_was(tmp_path: Path) -> None:
    text = (
        ONE
        + "direction = 7.5\nown = true\nlimit = 900.0\nrate = 60.0\n"
        + BOW
        + AFT
        + 'behind = "left"\n'
    )
    first = ship(tmp_path, text).actuators
    again = ship(tmp_path, "\n".join(actuator_tables(first))).actuators
    assert again == first


def test_their_signals_have_units_and_sides(tmp_path: Path) -> None:
    pod = '[[actuator]]\nname = "pod"\nkind = "azimuth"\nat = [0, 0]\ncommand = "thrust"\n'
    found = actuator_quantities(ship(tmp_path, ONE + pod + AFT).actuators)
    units = {n: q.unit for n, q in found.items() if "_order" not in n}
    assert units == {"left": "rad/s", "pod": "N", "pod_angle": "rad", "aft": "rad"}
    assert [n for n, q in found.items() if q.steers] == ["aft", "aft_order"]
    assert found["left"].mirror == 1
    assert found["pod_angle"].mirror == -1


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (ONE.replace("at =", "place ="), "actuator[0]: unknown key 'place'"),
        (ONE.replace('name = "left"\n', ""), "'name' is missing; Its name"),
        (ONE.replace("thruster", "sail"), "kind = 'sail'; expected one of rudder, thruster"),
        (ONE.replace("-1.0]", '"a"]'), "write [metres ahead, metres to starboard]"),
        (ONE.replace('"left"', '"Left"'), "name = 'Left'; Its name"),
        (ONE.replace('"left"', '"n"'), "actuator 'n' has the name of a quantity"),
        (ONE.replace('"left"', '"left_angle"'), "a name does not end in _order, _angle or _bucket"),
        (ONE + ONE, "signal 'left' is there twice"),
        (ONE + 'command = "rpm"\n', "command = 'rpm'; expected one of revolutions, share, thrust"),
        (ONE + "limit = 0\n", "limit = 0; write a number above zero"),
        (ONE + "own = 1\n", "own = 1; write true or false"),
        (ONE + 'direction = "aft"\n', "write degrees from ahead, clockwise"),
        (ONE.replace("thruster", "rudder") + 'command = "share"\n', "a rudder has no command"),
        (ONE + 'behind = "bow"\n', "only a rudder stands in a race; leave 'behind' out"),
        (AFT + 'behind = "lift"\n' + ONE, "behind = 'lift' is no thruster of this ship; did you"),
        (ONE + BOW.replace("tunnel", "thruster"), "the thrusters share their parameters, and"),
        ("[actuator]\n", "write a table [[actuator]] for each"),
    ],
)
def test_what_is_wrong_is_one_line(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(ShipError) as caught:
        ship(tmp_path, text)
    assert says in str(caught.value)
    assert "\n" not in str(caught.value)
    assert "boat.toml" in str(caught.value)
