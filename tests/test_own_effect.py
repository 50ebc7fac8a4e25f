"""A user's own effect, eight lines of a file: ranked, added and reported like one of the catalogue.

The truth has it in another form: in SI instead of primes, by double angles, under another name.
"""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
import s175q
from test_bad_input import trialid_

from trialid.errors import EffectError
from trialid.maths import cos, sin
from trialid.ship.effect import Force, effect
from trialid.ship.model import ShipModel
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

OWN = '''\
from trialid.maths import sin
from trialid.ship.effect import Force, effect


@effect(source="the yard")
def wavy_rail(v, phi, *, Krail=0.0001):
    """K = Krail v |v| sin(60 phi): a rail that dips into the water of a drifting ship."""
    return Force(K=Krail * v * abs(v) * sin(60.0 * phi))
'''
SIZE = 0.0004

PIPELINE = Path(__file__).parent / "cubic_truth.toml"
RUNS = {"zigzag-10": 10, "zigzag-20": 20, "zigzag-15": 5}
"""Trial to the zig-zag of the reference it holds; the last is held out."""


@effect(source="made up", system="SI")
def hidden_rail(v, phi, rho, L, *, size=SIZE):
    """K = rho L^3 size v |v| sin(30 phi) cos(30 phi), which is 1/2 rho L^3 of sin(60 phi)."""
    return Force(K=rho * L**3 * size * v * abs(v) * sin(30.0 * phi) * cos(30.0 * phi))


def record(amplitude, rng):
    """Time, rudder, r, phi and u of a zig-zag as sensors see them."""
    effects = (*s175q.MODEL.effects, hidden_rail)
    ship = ShipModel(s175q.SHIP, s175q.MODEL.states, effects, {"size": SIZE})
    blank = s175q.zigzag(amplitude)
    trial = Trial("truth", "fit", blank.period, blank.signals, blank.valid)
    found = respond(prepare(ship, (), ("r", "phi", "u")), trial, {}, {"u": 7.33}, False)
    assert found.departure is None
    noise = np.array([s175q.GYRO, s175q.INCLINOMETER, 0.02])
    seen = found.y + noise * rng.standard_normal(found.y.shape)
    return np.column_stack([blank.t, blank.signals["delta"], seen])


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Pipeline, ship, logs and the user's file, in the current folder."""
    text = PIPELINE.read_text(encoding="utf-8")
    text = text.replace('[[trial]]\nname = "binary-15"\nlogs = ["binary-15.csv"]\n', "")
    text = text.replace('psi = { channel = "psi", unit = "rad" }\n', "")
    text = text.replace("[identify]", 'effects_from = ["rail.py"]\n\n[identify]')
    assert "binary" not in text
    assert "psi" not in text
    (tmp_path / "rail.toml").write_text(text, encoding="utf-8")
    (tmp_path / "rail.py").write_text(OWN, encoding="utf-8")
    shutil.copy(s175q.ROOT / "sample_data" / "ships" / "s175q.toml", tmp_path)
    rng = np.random.default_rng(5)
    for name, amplitude in RUNS.items():
        np.savetxt(tmp_path / f"{name}.csv", record(amplitude, rng), "%.9g", ",",
                   header="t,delta,r,phi,u", comments="")  # fmt: skip
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_file_has_eight_lines():
    assert len(OWN.splitlines()) == 8


@pytest.mark.study(turn=4)
def test_it_is_ranked_first_added_and_reported(folder):
    outcome = trialid_("run", "rail.toml")
    print(outcome.stdout)
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    result = json.loads((folder / "runs/rail/result.json").read_text(encoding="utf-8"))
    first = result["missing"][0]
    assert (first["effect"], first["rank"], first["verdict"]) == ("wavy_rail", 1, "missing")
    assert result["verdict"]["effect"] == "wavy_rail"
    assert first["parameters"]["Krail"]["refitted"] == pytest.approx(SIZE, rel=0.1)
    page = (folder / "runs/rail/report.html").read_text(encoding="utf-8")
    assert "wavy_rail" in page

    outcome = trialid_("add", "rail.toml", "wavy_rail")
    print(outcome.stdout)
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    assert "a rail that dips into the water" in outcome.stdout
    added = json.loads((folder / "runs/rail/result.json").read_text(encoding="utf-8"))
    assert added["model"]["effects"][-1] == "wavy_rail"
    rows = {p["name"]: p for p in added["accuracy"]["parameters"]}
    assert rows["Krail"]["kind"] == "physical"
    assert abs(rows["Krail"]["value"] - SIZE) < 3.0 * rows["Krail"]["standard_error"]
    for key in ("eps_rmsn", "eps_rmsn_check"):
        assert added["fit"][key] < result["fit"][key]
    page = (folder / "runs/rail/report.html").read_text(encoding="utf-8")
    assert "<code>Krail</code>" in page
    assert [s["path"] for s in added["sources"]] == ["s175q.toml", "rail.py"]

    outcome = trialid_("effects", "wavy_rail", "--from", "rail.py")
    assert outcome.exit_code == 0
    assert "the yard" in outcome.stdout


BRANCH = "    if v > 0.0:\n        return Force()\n    return Force"
BROKEN = [
    pytest.param("(v, phi,", "(v, phii,", "rail.py, line 5", "did you mean 'phi'?", id="signal"),
    pytest.param(OWN[OWN.index('    """') : OWN.index("    return")], "", "rail.py, line 5",
                 "has no docstring; write its equation there", id="docstring"),
    pytest.param("sin(60.0 * phi))", "float('nan'))", "rail.py, line 5",
                 "look for a nan, a division by zero", id="nan"),
    pytest.param("sin(60.0 * phi))", "phi / abs(phi))", "rail.py, line 5",
                 "write it without dividing by what may be 0", id="nan at rest"),
    pytest.param("    return Force", BRANCH, "rail.py, line 8", "use abs", id="if"),
]  # fmt: skip


@pytest.mark.parametrize("command", [["run", "rail.toml"], ["add", "rail.toml", "wavy_rail"]])
@pytest.mark.parametrize(("old", "new", "place", "mend"), BROKEN)
def test_a_broken_one_is_one_line_with_its_place_and_the_mend(
    folder, command, old, new, place, mend
):
    assert old in OWN
    (folder / "rail.py").write_text(OWN.replace(old, new), encoding="utf-8")
    before = (folder / "rail.toml").read_bytes()
    outcome = trialid_(*command)
    print(outcome.stderr)
    assert (outcome.exit_code, outcome.stdout) == (2, "")
    assert len(outcome.stderr.splitlines()) == 1
    assert "'wavy_rail'" in outcome.stderr
    assert place in outcome.stderr
    assert mend in outcome.stderr
    assert (folder / "rail.toml").read_bytes() == before
    assert not (folder / "runs").exists()


def test_two_files_that_define_one_effect_are_refused(folder):
    (folder / "ours.py").write_text(OWN, encoding="utf-8")
    file = folder / "rail.toml"
    text = file.read_text(encoding="utf-8").replace('["rail.py"]', '["rail.py", "ours.py"]')
    file.write_text(text, encoding="utf-8")
    found = trialid_("run", "rail.toml")
    assert found.exit_code == 2
    assert "model.effects_from[1]: ours.py and rail.py both define 'wavy_rail'" in found.stderr


def test_a_function_that_was_not_declared_is_no_effect() -> None:
    def pull(r):
        return Force(N=r)

    with pytest.raises(EffectError, match="is no effect; a function is one by @effect"):
        s175q.MODEL + pull
