"""The NumPy file alone, without trialid: the numbers of the kernel, checks, the range seen."""

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from handed_models import NAMES, PERIOD, TIGHT, by_kernel, cases, handed, inputs_of
from handed_models import largest_difference as apart
from test_bad_input import trialid_

from trialid.errors import TrialidError
from trialid.export.model.numpy_text import numpy_text
from trialid.workflow.notebook.front import run

ALONE = f"""
import sys
import numpy as np
import ship

given = np.load("given.npz")
states = ship.simulate(given["x0"], given["u"], {PERIOD})
outputs = np.array([ship.outputs(x, u) for x, u in zip(states, given["u"])])
many = ship.derivatives(states.T, given["u"].T)
one = np.array([ship.derivatives(x, u) for x, u in zip(states, given["u"])]).T
assert "trialid" not in sys.modules
assert np.allclose(many, one, rtol=1e-14, atol=0.0)
np.savez("found.npz", states=states, outputs=outputs)
"""


def run_alone(folder: Path, code: str) -> None:
    """In a process that sees this folder and NumPy, and nothing else of ours."""
    (folder / "alone.py").write_text(code, encoding="utf-8")
    start = (
        f"import sys; sys.path.insert(0, {str(folder)!r}); import runpy; runpy.run_path('alone.py')"
    )
    told = subprocess.run(
        [sys.executable, "-I", "-c", start],
        cwd=folder,
        env={"PATH": os.defpath},
        capture_output=True,
        text=True,
        check=False,
    )
    assert told.returncode == 0, told.stderr


@pytest.mark.parametrize("name", NAMES)
def test_its_numbers_are_the_kernel_s(name: str, tmp_path: Path) -> None:
    made = handed(cases(tmp_path)[name])
    u = inputs_of(made)
    x0, states, outputs = by_kernel(made, u)
    (tmp_path / "ship.py").write_text(numpy_text(made), encoding="utf-8")
    np.savez(tmp_path / "given.npz", x0=x0, u=u)
    run_alone(tmp_path, ALONE)
    found = np.load(tmp_path / "found.npz")
    assert np.ptp(states, axis=0).min() > 0.0
    assert apart(found["states"], states) < TIGHT
    assert apart(found["outputs"], outputs) < TIGHT


def test_it_reads_like_the_equations(tmp_path: Path) -> None:
    """Each effect by its name and its equation, the totals, and no line that is too long."""
    text = numpy_text(handed(cases(tmp_path)["righting_arm_cubic"]))
    assert "    Y_linear_hull = q * (" in text or "* q\n" in text
    assert "Yv * v_prime + Yr * r_prime" in text
    assert "# righting_arm_cubic: K = " in text
    assert "R_N = (\n        N_linear_hull + N_linear_rudder" in text
    code = [line for line in text.splitlines() if "sha256" not in line]
    assert max(map(len, code)) <= 100
    assert "'Nr': -0.00247579,  # [1] fitted, likely -0.002971 to -0.002228" in text


def test_it_checks_its_inputs_and_knows_what_was_seen(tmp_path: Path) -> None:
    made = handed(cases(tmp_path)["shipped"])
    scope: dict[str, object] = {}
    exec(compile(numpy_text(made), "ship.py", "exec"), scope)
    x, u = np.zeros(4), np.array([0.1, 7.0])
    with pytest.raises(ValueError, match="expected finite delta, u"):
        scope["step"](x, u, np.array([np.nan, 7.0]), 0.5)
    with pytest.raises(ValueError, match="a period > 0"):
        scope["step"](x, u, u, -0.5)
    assert scope["unseen"](x, u) == []
    assert scope["unseen"](np.array([0.0, 0.0, -0.03, 0.0]), np.array([0.4, 7.0])) == ["delta", "r"]


def test_the_command_writes_it(run_folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "ferry.py"
    told = trialid_("export", str(run_folder), "--as", "python", "--out", str(out))
    assert (told.exit_code, told.stdout) == (0, f"Written: {out}\n")
    scope: dict[str, object] = {}
    exec(compile(out.read_text(encoding="utf-8"), "ferry.py", "exec"), scope)
    assert scope["FITTED"] == ("Nv", "Nr", "Ndelta", "GM")
    assert scope["simulate"](np.zeros(4), np.array([[0.2, 7.33]] * 50), 0.5)[-1, 2] > 0.003
    again = trialid_("export", str(run_folder), "--as", "python", "--out", str(out))
    assert (again.exit_code, again.stderr.count("\n")) == (2, 1)
    other = trialid_("export", str(run_folder), "--as", "python", "--out", str(tmp_path / "x.c"))
    assert "the suffix says the format, .py; " in other.stderr


@pytest.mark.study(turn="each")
def test_a_run_in_python_hands_over_the_same(
    run_folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of a run that no folder holds there was no way out."""
    monkeypatch.chdir(tmp_path)
    found = run(run_folder.parents[1] / "used.toml")
    told = trialid_("export", str(run_folder), "--as", "python", "--out", "by_command.py")
    assert told.exit_code == 0, told.stderr
    assert found.export("python", "in_python.py") == Path("in_python.py")
    own, same = (Path(name).read_text("utf-8") for name in ("in_python.py", "by_command.py"))
    assert own == same
    assert found.export("json") == Path("used_json.json")
    for wrong, words in (
        (("pyton",), "'pyton' is no kind of file; did you mean 'python'"),
        (("python", "in_python.py"), "in_python.py exists; name another, or say force=True"),
        (("python", "ship.txt"), "out = ship.txt: the suffix says the format, .py"),
    ):
        with pytest.raises(TrialidError, match=re.escape(words)):
            found.export(*wrong)
    with pytest.raises(TrialidError, match=r"^full_rudder -3: expected an angle above 0"):
        found.export("ardupilot", full_rudder=-3)
    there = {"in_python.py", "by_command.py", "used_json.json"}
    assert {one.name for one in tmp_path.iterdir()} == there
