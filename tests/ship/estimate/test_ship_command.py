"""`trialid ship`: a file with its remarks, or everything that is wrong in one line."""

import tomllib
from pathlib import Path

import pytest
from click.testing import CliRunner
from stated_ships import S175

from trialid.cli.main import commands
from trialid.cli.particulars_options import PARTICULARS
from trialid.errors import ShipError
from trialid.ship.estimate import estimate, ship_from_particulars
from trialid.ship.estimate.particulars_given import WORDS
from trialid.ship.particulars import read_ship

CONTAINER = (
    "--length 175 --beam 25.4 --draught 8.5 --displacement 21752.55 --speed 14.25 --gm 0.3 "
    "--rudder-area 33.04 --rudder-aspect 1.82 --propeller 6.533"
)


def told(*words: str):
    return CliRunner().invoke(commands, ["ship", *words], prog_name="trialid")


def refused(*words: str) -> str:
    """The one line; nothing else was said, and the status is 2."""
    said = told(*words)
    assert said.exit_code == 2
    assert said.stdout == ""
    assert said.stderr.count("\n") == 1
    assert said.stderr.startswith("trialid: ")
    return said.stderr


def test_units_are_those_of_people(tmp_path: Path) -> None:
    """Tonnes and knots at the door, SI inside: the ship of the Python door."""
    out = tmp_path / "s175.toml"
    said = told(str(out), *CONTAINER.split(), "--name", "container ship")
    assert said.exit_code == 0
    assert said.stdout == f"Written: {out}\n"
    assert said.stderr.count("ASSUMED") == 1
    by_command, by_python = read_ship(out), estimate(S175, "container ship").ship
    assert by_command.name == "container ship"
    for rows in ("particulars", "mass", "coefficients"):
        assert getattr(by_command, rows) == pytest.approx(getattr(by_python, rows), rel=2e-3)


def test_the_length_alone_is_enough_and_what_is_assumed_is_said(tmp_path: Path) -> None:
    out = tmp_path / "one.toml"
    said = told(str(out), "--length", "96.5")
    assert said.exit_code == 0
    assert said.stderr.count("ASSUMED:") == 9
    assert read_ship(out).source.startswith("PLACEHOLDER")
    assert max(map(len, said.stderr.splitlines())) <= 100
    assert told(str(tmp_path / "two.toml"), "--length", "96.5", "--quiet").output == ""


def test_nothing_is_ever_replaced(tmp_path: Path) -> None:
    out = tmp_path / "ship.toml"
    out.write_text("mine", encoding="utf-8")
    assert "exists, and is not replaced" in refused(str(out), "--length", "96.5")
    assert out.read_text(encoding="utf-8") == "mine"
    link = tmp_path / "link.toml"
    link.symlink_to(tmp_path / "nowhere.toml")
    assert "exists" in refused(str(link), "--length", "96.5")
    assert sorted(p.name for p in tmp_path.iterdir()) == ["link.toml", "ship.toml"]


def test_everything_that_is_wrong_is_told_at_once(tmp_path: Path) -> None:
    given = "--beam -3 --draught nan --block 1.2 --gm 0 --rho 1.025"
    line = refused(str(tmp_path / "no" / "ship.txt"), *given.split())
    expected = """\
        7 things are wrong
        ship.txt does not end in .toml
        the length is missing
        beam -3 m is not above zero
        draught nan is not a number
        GM 0 m is not above zero
        block coefficient 1.2 is above 1
        density of the water 1.025 kg/m^3 is no water's"""
    assert [words for words in map(str.strip, expected.splitlines()) if words not in line] == []
    assert not list(tmp_path.iterdir())


HULL = "--length 175 --beam 25.4 --draught 8.5 --block 0.56"


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ("", "the length is missing"),
        ("--length 0", "length 0 m is not above zero"),
        ("--length inf", "length inf is not a number"),
        ("--length 175000", "length 175000 m is no ship's; was it in millimetres?"),
        ("--length 0.175", "length 0.175 m is no ship's; was it in kilometres?"),
        ("--length 175 --beam 254", "beam 254 m is more than the length 175 m"),
        ("--length 175 --draught 850", "draught 850 m is more than the length 175 m"),
        ("--length 175 --beam 25 --draught 85", "draught 85 m is 3.4 times the beam 25 m; a slip?"),
        ("--length 175 --beam 2.54", "makes a hull of 175 x 2.54 x"),
        ("--length 175 --block 1.01", "block coefficient 1.01 is above 1"),
        ("--length 175 --block 0.03", "block coefficient 0.03 is below 0.05"),
        (f"{HULL} --displacement 21752550", "is a block coefficient of 562 with"),
        (f"{HULL} --displacement 21.75", "is a block coefficient of 0.000562 with"),
        (f"{HULL} --displacement 15000", "coefficient of 0.387, and block coefficient 0.56"),
        (f"{HULL} --displacement 30000", "coefficient of 0.775, and block coefficient 0.56"),
        ("--length 175 --displacement 21752550", "displacement 21752550 t makes a hull of"),
        ("--length 5 --beam 2.2 --displacement 0.00032", "displacement 0.00032 t makes a hull of"),
        ("--length 400 --beam 60 --displacement 4000", "makes a hull of 400 x 60 x 0.25 m"),
        ("--length 175 --displacement -1", "displacement -1 t is not above zero"),
        (f"{HULL} --gm 30", "GM 30 m would put gravity below the keel"),
        (f"{HULL} --roll-period 2", "m, would put gravity below the keel"),
        (f"{HULL} --gm 3 --roll-period 60", "contradict each other: a radius of gyration of 2"),
        (f"{HULL} --rudder-area 1500", "is no less than the lateral plane of 1488 m^2"),
        ("--length 175 --rudder-area 2000", "is no less than the lateral plane"),
        (f"{HULL} --propeller 65.33", "propeller diameter 65.33 m is more than the draught 8.5 m"),
        (f"{HULL} --speed 733", "speed 733 kn is a Froude number of 9.1"),
        (f"{HULL} --x-g -100", "is outside a ship of 175 m"),
        (f"{HULL} --rho 1.025", "is no water's"),
    ],
)
def test_what_no_ship_has(given: str, words: str, tmp_path: Path) -> None:
    line = refused(str(tmp_path / "ship.toml"), *given.split())
    assert words in line
    assert "no ship can be made of this: " in line
    assert not list(tmp_path.iterdir())


def test_what_odd_craft_have_is_taken(tmp_path: Path) -> None:
    """A catamaran over both hulls, a rowing shell, a model, a full barge, a fast boat."""
    for i, given in enumerate(
        (
            "--length 2 --beam 1.08 --draught 0.13 --displacement 0.055 --speed 6",
            "--length 17 --beam 0.6 --draught 0.2",
            "--length 3.147 --beam 0.384 --draught 0.112 --displacement 0.0726 --gm 0.0422",
            "--length 60 --beam 11 --draught 3 --block 0.98",
            "--length 12 --beam 3.8 --draught 0.9 --block 0.4 --speed 32",
        )
    ):
        out = tmp_path / f"{i}.toml"
        assert told(str(out), *given.split()).exit_code == 0, given
        assert read_ship(out).mass["m"] > 0.0
    assert "OUTSIDE" in (tmp_path / "0.toml").read_text(encoding="utf-8")


def test_a_ship_from_python() -> None:
    ship = ship_from_particulars(length=96.5, beam=16.2, draught=5.2, block=0.6, speed=8.2)
    assert ship.name == "ship of 96.5 m"
    assert ship.uncertainty["Yv"] == 0.3
    with pytest.raises(ShipError, match=r"2 things are wrong: \(1\) the length .* \(2\) block"):
        ship_from_particulars(block=1.5)


def test_options_particulars_and_words_are_the_same() -> None:
    """One list each at the command line, in Python and in messages."""
    assert [p.name for p in PARTICULARS.values()] == list(WORDS)
    for particular in PARTICULARS.values():
        assert 1.0 / particular.factor == pytest.approx(WORDS[particular.name].factor)


def test_a_name_can_neither_break_the_file_nor_a_line(tmp_path: Path) -> None:
    out = tmp_path / "ship.toml"
    name = 'a"b\\c\nd\x1b[31m\x7f'
    assert told(str(out), "--length", "96.5", "--name", name).exit_code == 0
    text = out.read_text(encoding="utf-8")
    assert tomllib.loads(text)["name"] == name
    assert "\x1b" not in text
    assert "\x7f" not in text


@pytest.mark.parametrize(
    "words", ["5 --beam 2.2 --displacement 0.32", "4.9 --beam 2.4 --displacement 0.18"]
)
def test_a_light_catamaran_is_a_hull(words: str, tmp_path: Path) -> None:
    """Over her whole beam she is 50 and 106 times as broad as deep: `check the units` was said."""
    out = tmp_path / "cat.toml"
    said = told(str(out), *f"--length {words} --speed 4".split())
    assert said.exit_code == 0, said.output
    assert read_ship(out).particulars["T"] < 0.05
