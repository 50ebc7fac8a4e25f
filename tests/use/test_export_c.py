"""The C file alone: compiled without a warning, the kernel's numbers, checks, the range seen."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
from handed_models import NAMES, PERIOD, TIGHT, by_kernel, cases, handed, inputs_of
from handed_models import largest_difference as apart
from test_bad_input import trialid_

from trialid.export.model.c_text import c_texts

GCC = shutil.which("gcc") or shutil.which("cc")
STRICT = ["-std=c99", "-O2", "-Wall", "-Wextra", "-Werror", "-pedantic", "-Wconversion", "-Wshadow"]

pytestmark = pytest.mark.skipif(GCC is None, reason="no C compiler here")

ALONE = r"""
#include <stdio.h>
#include "ferry.h"
int main(void) {
  double x[FERRY_STATES], u[2][FERRY_INPUTS], y[FERRY_OUTPUTS];
  int n, told = 0;
  if (scanf("%d", &n) != 1) return 1;
  for (int i = 0; i < FERRY_STATES; i++) if (scanf("%lf", &x[i]) != 1) return 1;
  for (int k = 0; k < n; k++) {
    for (int i = 0; i < FERRY_INPUTS; i++) if (scanf("%lf", &u[k % 2][i]) != 1) return 1;
    if (k) told = ferry_step(x, u[(k + 1) % 2], u[k % 2], ferry_parameters, PERIOD, 1);
    ferry_outputs(x, u[k % 2], ferry_parameters, y);
    printf("%d", told);
    for (int i = 0; i < FERRY_STATES; i++) printf(" %.17g", x[i]);
    for (int i = 0; i < FERRY_OUTPUTS; i++) printf(" %.17g", y[i]);
    printf("\n");
  }
  return 0;
}
"""

WRONG = r"""
#include <math.h>
#include <stdio.h>
#include "ferry.h"
int main(void) {
  double x[FERRY_STATES] = {0}, u[FERRY_INPUTS] = {0.1, 7.0}, bad[FERRY_INPUTS] = {NAN, 7.0};
  double wild[FERRY_STATES] = {0.0, 0.0, 0.0, 1.5};
  printf("%d", ferry_step(x, u, bad, ferry_parameters, 0.5, 1));
  printf(" %d", ferry_step(x, u, u, ferry_parameters, -0.5, 1));
  printf(" %d", ferry_step(x, u, u, ferry_parameters, 0.5, 0));
  printf(" %d", x[0] == 0.0 && x[1] == 0.0 && x[2] == 0.0 && x[3] == 0.0);
  printf(" %d", ferry_step(x, u, u, ferry_parameters, 0.5, 1));
  u[0] = 0.5;
  printf(" %d", ferry_step(x, u, u, ferry_parameters, 0.5, 1));
  printf(" %d", ferry_step(wild, u, u, ferry_parameters, 0.5, 1));
  printf(" %d\n", wild[3] == 1.5);
  return 0;
}
"""


def built(folder: Path, texts: dict[str, str], main: str, *more: str) -> Path:
    for suffix, text in texts.items():
        (folder / f"ferry{suffix}").write_text(text, encoding="utf-8")
    (folder / "main.c").write_text(main, encoding="utf-8")
    command = [GCC, *STRICT, f"-DPERIOD={PERIOD}", *more, "ferry.c", "main.c", "-lm", "-o", "run"]
    told = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert (told.returncode, told.stderr) == (0, "")
    return folder / "run"


def told_by(program: Path, given: str = "") -> str:
    """What it prints, in an environment that holds nothing."""
    done = subprocess.run(
        [program], input=given, env={}, capture_output=True, text=True, check=True
    )
    assert done.stderr == ""
    return done.stdout


@pytest.mark.parametrize("name", NAMES)
def test_its_numbers_are_the_kernel_s(name: str, tmp_path: Path) -> None:
    made = handed(cases(tmp_path)[name])
    u = inputs_of(made)
    x0, states, outputs = by_kernel(made, u)
    program = built(tmp_path, c_texts(made, "ferry"), ALONE)
    rows = [" ".join(map(repr, row)) for row in (x0.tolist(), *u.tolist())]
    lines = told_by(program, "\n".join([str(len(u)), *rows])).splitlines()
    found = np.array([[float(x) for x in line.split()] for line in lines])
    n = states.shape[1]
    assert apart(found[:, 1 : 1 + n], states) < TIGHT
    assert apart(found[:, 1 + n :], outputs) < TIGHT
    signals = dict(zip(made.inputs, u.T, strict=True))
    signals |= dict(zip(made.equations.states, states.T, strict=True))
    seen = (np.abs(signals["delta"]) <= 0.35) & (np.abs(signals["r"]) <= 0.02)
    assert (found[1:, 0] == np.where(seen, 0, 1)[1:]).all()


def test_it_checks_its_inputs_and_says_what_it_left(tmp_path: Path) -> None:
    """Nothing is done with what is no number; what was not seen and what diverges is told."""
    made = handed(cases(tmp_path)["shipped"])
    sanitized = ("-fsanitize=address,undefined", "-g")
    try:
        program = built(tmp_path, c_texts(made, "ferry"), WRONG, *sanitized)
    except AssertionError:  # a compiler without sanitizers
        program = built(tmp_path, c_texts(made, "ferry"), WRONG)
    assert told_by(program) == "4 4 4 1 0 1 2 1\n"


def test_names_of_a_file_end_no_comment(tmp_path: Path) -> None:
    made = handed(cases(tmp_path)["shipped"])
    spoilt = made.__class__(
        **{**vars(made), "name": "*/ int main(", "words": ("??/ a \\",), "origin": {"ship": "*/"}}
    )
    built(tmp_path, c_texts(spoilt, "ferry"), "int main(void) { return 0; }")


def test_the_command_writes_both(run_folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "ferry.c"
    told = trialid_("export", str(run_folder), "--as", "c", "--out", str(out))
    assert (told.exit_code, told.stdout) == (0, f"Written: {out}, {out.with_suffix('.h')}\n")
    texts = {s: out.with_suffix(s).read_text(encoding="utf-8") for s in (".c", ".h")}
    built(tmp_path, texts, "int main(void) { return 0; }")
    out.unlink()
    again = trialid_("export", str(run_folder), "--as", "c", "--out", str(out))
    assert (again.exit_code, again.stderr.count("\n")) == (2, 1)
    assert "ferry.h exists" in again.stderr
    assert not out.exists()
