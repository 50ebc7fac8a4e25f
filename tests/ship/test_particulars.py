"""A ship file is read, or refused in one clear line."""

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

from trialid.errors import ShipError
from trialid.ship.particulars import UNCERTAIN, Ship, read_ship

SHIPS = Path(__file__).parents[2] / "sample_data" / "ships"


@pytest.mark.parametrize("file", ["s175q", "s175", "naval"])
def test_the_sample_ships(file: str) -> None:
    ship = read_ship(SHIPS / f"{file}.toml")
    assert ship.source
    assert ship.notes
    assert ship.rudder_positive == "starboard"
    assert ship.coefficients


def test_what_a_file_says_nothing_of_is_uncertain_by_some_per_cent() -> None:
    """No coefficient is exact unless somebody says so."""
    ship = read_ship(SHIPS / "s175q.toml")
    silent = replace(ship, uncertainty={})
    assert 0.02 <= silent.share_off("Yv") <= 0.15
    told = replace(ship, uncertainty={"default": 0.3, "Nr": 0.0})
    assert (told.share_off("Yv"), told.share_off("Nr")) == (0.3, 0.0)


def expect_refusal(read: Callable[[], Ship], says: str) -> None:
    with pytest.raises(ShipError, match=says) as caught:
        read()
    assert "\n" not in str(caught.value)
    assert str(caught.value).startswith("ship file ")


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        ({"rudder_positive": None}, r"'rudder_positive' is missing.*\"port\" \(SNAME"),
        ({"system": None}, '\'system\' is missing; write "prime" or "dimensional"'),
        ({"source": None}, "'source' is missing; say where the numbers come from"),
        ({"name": None}, "'name' is missing"),
        ({"rudder_positive": '"stbd"'}, "rudder_positive = 'stbd'; expected one of"),
        ({"system": '"bis"'}, "system = 'bis'; expected one of"),
        ({"L": None}, r"\[particulars\] lacks L"),
        ({"L": None, "U0": None}, r"\[particulars\] lacks L, U0"),
        ({"m": '"heavy"'}, r"\[mass\] m = 'heavy' is not a number"),
        ({"Yv": "true"}, r"\[coefficients\] Yv = True is not a number"),
        ({"L": "[175.0]"}, r"\[particulars\] L = \[175.0\] is not a number"),
        ({"Yv": ""}, "not valid TOML.*line"),
        ({"L": "nan"}, r"\[particulars\] L"),
        ({"L": "-175.0"}, r"\[particulars\] L"),
        ({"rho": "0"}, r"\[particulars\] rho"),
    ],
)
def test_a_wrong_line(lines: dict[str, str | None], says: str, edited: Callable[..., Ship]) -> None:
    expect_refusal(lambda: edited(**lines), says)


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ('flag = "x"', "unknown key 'flag'; known: "),
        ('rudder_positiv = "port"', "unknown key 'rudder_positiv'; did you mean 'rudder_positive'"),
        ('coefficient_speed = "fast"', "coefficient_speed"),
        ("coefficient_speed = 0.0", "coefficient_speed"),
    ],
)
def test_a_line_too_many(line: str, says: str, edited: Callable[..., Ship]) -> None:
    expect_refusal(lambda: edited(line + "\n"), says)


@pytest.mark.parametrize(
    ("name", "says"),
    [
        ("Yvdott", r"\[mass\].*did you mean 'Yvdot'"),
        ("Ixx", r"\[mass\].*did you mean 'I_xx'"),
    ],
)
def test_a_mass_with_a_slip_in_its_name(name: str, says: str, text: str, tmp_path: Path) -> None:
    """Dropped in silence it would mean an added mass of zero."""
    file = tmp_path / "ship.toml"
    file.write_text(text.replace("[mass]", f"[mass]\n{name} = 0.001"), encoding="utf-8")
    expect_refusal(lambda: read_ship(file), says)


@pytest.mark.parametrize("section", ["particulars", "mass"])
def test_a_section_that_is_a_number(section: str, text: str, tmp_path: Path) -> None:
    head = text.split("[particulars]", maxsplit=1)[0]
    other = {"particulars": "mass", "mass": "particulars"}[section]
    keep = "L = 1.0\nrho = 1.0\ng = 1.0\nnabla = 1.0\nU0 = 1.0\n"
    file = tmp_path / "ship.toml"
    file.write_text(f"{head}{section} = 3.0\n[{other}]\n{keep}", encoding="utf-8")
    expect_refusal(lambda: read_ship(file), section)


def test_a_file_that_is_not_there(tmp_path: Path) -> None:
    expect_refusal(lambda: read_ship(tmp_path / "nowhere.toml"), "nowhere.toml: cannot be read")
    expect_refusal(lambda: read_ship(tmp_path), "cannot be read")


def test_a_file_that_is_not_text(tmp_path: Path) -> None:
    file = tmp_path / "ship.toml"
    file.write_bytes(b'name = "\xff\xfe"\n')
    expect_refusal(lambda: read_ship(file), "not valid TOML|UTF-8")


def test_coefficients_may_be_left_out(text: str, tmp_path: Path) -> None:
    """A ship whose coefficients are all to be found."""
    file = tmp_path / "ship.toml"
    file.write_text(text.split("[coefficients]", maxsplit=1)[0], encoding="utf-8")
    assert read_ship(file).coefficients == {}
    assert read_ship(file).coefficient_speed == 1.0


def test_what_is_said_of_the_numbers_themselves(text: str, tmp_path: Path) -> None:
    """Of one number, of all others, and where nothing is said."""
    file = tmp_path / "ship.toml"
    file.write_text(text, encoding="utf-8")
    assert read_ship(file).share_off("Yv") == UNCERTAIN
    file.write_text(text + "\n[uncertainty]\nYv = 0.15\nm = 0\ndefault = 0.02\n", encoding="utf-8")
    ship = read_ship(file)
    assert [ship.share_off(n) for n in ("Yv", "m", "Nv")] == [0.15, 0.0, 0.02]


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("Yvv = 0.1", r"\[uncertainty\] Yvv is no number of it; did you mean 'Yvav'"),
        ("Yv = -0.1", r"\[uncertainty\] Yv = -0.1; expected a share of the number from 0 to 3"),
        ("Yv = 15", r"\[uncertainty\] Yv = 15; expected a share of the number from 0 to 3"),
        ('Yv = "15 %"', r"\[uncertainty\] Yv = '15 %' is not a number"),
    ],
)
def test_a_wrong_uncertainty(line: str, says: str, text: str, tmp_path: Path) -> None:
    file = tmp_path / "ship.toml"
    file.write_text(f"{text}\n[uncertainty]\n{line}\n", encoding="utf-8")
    expect_refusal(lambda: read_ship(file), says)


@pytest.mark.parametrize(
    ("changed", "said"),
    [
        ({"L": 17.5}, r"nabla = 21222 m3 is more than L B T = 3778"),
        ({"L": 1e308}, r"\[mass\] m = 0\.00792, and she floats at 0 by nabla and L"),
        ({"L": 574.0}, r"\[mass\] m = 0\.00792, and she floats at 0\.0002244 by nabla and L"),
        ({"m": 7.9}, r"\[mass\] m = 7\.9, and she floats at 0\.00792"),
    ],
    ids=["a tenth", "beyond numbers", "feet", "of another system"],
)
def test_a_hull_that_cannot_be_is_refused(
    changed: dict[str, float], said: str, tmp_path: Path
) -> None:
    """A length of 18 for 180 m ended in `check the sides of rudder and turn`."""
    text = (SHIPS / "s175q.toml").read_text(encoding="utf-8")
    for key, value in changed.items():
        text = re.sub(rf"(?m)^{key} = .*$", f"{key} = {value}", text)
    (path := tmp_path / "ship.toml").write_text(text, encoding="utf-8")
    with pytest.raises(ShipError, match=said):
        read_ship(path)
