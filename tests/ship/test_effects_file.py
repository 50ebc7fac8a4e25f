"""Effects from a user's own Python file."""

from pathlib import Path

import pytest

from trialid.effects import CATALOGUE, find, from_file
from trialid.errors import EffectError
from trialid.ship.effect import Parameter

OWN = '''
from trialid.maths import tanh
from trialid.ship.effect import Force, Parameter, effect
from trialid.effects.hull import sway_drag_vav


@effect(source="my towing tank")
def stern_wedge(v, *, Yw=Parameter(-0.01, low=-1.0, high=0.0)):
    """Y = Yw tanh(v / 0.1): a side force that saturates."""
    return Force(Y=Yw * tanh(v / 0.1))
'''


def test_an_effect_of_ones_own(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(OWN, encoding="utf-8")
    own = from_file(file)
    assert list(own) == ["stern_wedge"]
    assert find("stern_wedge", own).parameters["Yw"] == Parameter(-0.01, low=-1.0, high=0.0)
    assert find("linear_hull", own) is CATALOGUE["linear_hull"]
    with pytest.raises(EffectError, match="no effect 'stern_wedg'; did you mean 'stern_wedge'"):
        find("stern_wedg", own)


def test_ones_own_effect_replaces_that_of_the_catalogue(tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(OWN.replace("stern_wedge", "static_list"), encoding="utf-8")
    assert find("static_list", from_file(file)).source == "my towing tank"


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("def (", "invalid syntax"),
        ("import nowhere_at_all", "nowhere_at_all"),
        ("x = 1", "declares no effect"),
        ("from trialid.effects.hull import sway_drag_vav", "declares no effect"),
        (OWN.replace('"""Y = Yw tanh(v / 0.1): a side force that saturates."""', ""), "docstring"),
        (OWN.replace("(v, *", "(vv, *").replace("(v /", "(vv /"), "'vv'.*did you mean 'v'"),
        (OWN.replace("=Parameter(-0.01, low=-1.0, high=0.0)", ""), "'Yw' has no typical value"),
        (OWN.replace("Force(Y=Yw * tanh(v / 0.1))", "Yw * v"), "returns float; expected one of"),
        (OWN.replace("tanh(v / 0.1)", "tan(v)"), "cannot be evaluated.*'tan'"),
        (OWN.replace('tank"', 'tank", system="imperial"'), "system='imperial'; expected 'prime'"),
        (OWN.replace("low=-1.0", "low=1.0"), "from low=1.0 to high=0.0; expected two numbers, low"),
        (OWN.replace("low=-1.0", 'low="a"'), "from low='a' to high=0.0; expected two numbers"),
        (OWN.replace("high=0.0", "high=-0.5"), "-0.01 of parameter 'Yw' is outside its range"),
        ("import sys; sys.exit(0)", "line 1: SystemExit: 0"),
    ],
)
def test_a_faulty_effects_file_is_one_clear_line(text: str, says: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(EffectError, match=says) as caught:
        from_file(file)
    assert "\n" not in str(caught.value)


def test_a_missing_effects_file(tmp_path: Path) -> None:
    with pytest.raises(EffectError, match="cannot be read"):
        from_file(tmp_path / "nowhere.py")


@pytest.mark.parametrize("text", ["1 / 0", "{}['a']", "int('x')", "assert False"])
def test_an_effects_file_that_fails_for_its_own_reasons(text: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.py"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(EffectError, match=r"mine\.py"):
        from_file(file)
