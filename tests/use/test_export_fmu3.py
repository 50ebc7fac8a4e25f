"""The FMU of FMI 3.0: valid, the kernel's numbers, nothing out of bounds, every call there."""

import io
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from handed_models import GCC, PERIOD, TIGHT, cases, handed, run_sanitized, sailed_by_kernel
from handed_models import largest_difference as apart
from test_bad_input import trialid_

from trialid.export.model.fmu.fmu_file import fmu_bytes, fmu_source

pytestmark = pytest.mark.skipif(GCC is None or sys.platform != "linux", reason="no C compiler here")

ALONE = r"""
#include "ferry.c"
static int words = 0;
static void listen(fmi3InstanceEnvironment e, fmi3Status s, fmi3String c, fmi3String m) { words++; }
static fmi3Instance begin(const char *token) {
  return fmi3InstantiateCoSimulation("a", token, "", 0, 0, 0, 0, NULL, 0, NULL, listen, NULL);
}
int main(void) {
  fmi3FMUState kept = NULL;
  unsigned r[2] = {2, 4}, flag = FLAG, time = TIME;
  double rudder = 0.2, bad = NAN, then, now;
  bool unseen, event, ended, early;
  if (begin("wrong")) return 1;
  fmi3Instance c = begin("{x}");
  if (!c || fmi3EnterInitializationMode(c, 0, 0, 0, 0, 0)) return 2;
  if (fmi3SetFloat64(c, r + 1, 1, &rudder, 1) || fmi3ExitInitializationMode(c)) return 3;
  for (int k = 0; k < 20; k++)
    if (fmi3DoStep(c, 0.5 * k, 0.5, 1, &event, &ended, &early, &now)) return 4;
  if (now != 10.0 || fmi3GetFloat64(c, &time, 1, &now, 1) || now != 10.0) return 5;
  if (fmi3GetFMUState(c, &kept)) return 6;
  if (fmi3DoStep(c, 10, 0.5, 1, &event, &ended, &early, &now)) return 6;
  if (fmi3GetFloat64(c, r, 1, &then, 1)) return 6;
  if (fmi3SetFMUState(c, kept)) return 7;
  if (fmi3DoStep(c, 10, 0.5, 1, &event, &ended, &early, &now)) return 7;
  if (fmi3GetFloat64(c, r, 1, &now, 1) || then != now || !(now > 0.001)) return 7;
  if (fmi3SetFloat64(c, r + 1, 1, &bad, 1) != fmi3Error || words != 1) return 8;
  if (fmi3GetBoolean(c, &flag, 1, &unseen, 1) || unseen) return 9;
  rudder = 0.5;
  if (fmi3SetFloat64(c, r + 1, 1, &rudder, 1)) return 10;
  if (fmi3DoStep(c, 11, 0.5, 1, &event, &ended, &early, &now) || words != 2) return 10;
  if (fmi3GetBoolean(c, &flag, 1, &unseen, 1) || !unseen) return 11;
  if (fmi3GetFloat64(c, &flag, 1, &now, 1) != fmi3Error) return 12;
  if (fmi3SetFloat64(c, &time, 1, &now, 1) != fmi3Error) return 12;
  if (fmi3DoStep(c, 11, -1.0, 1, &event, &ended, &early, &now) != fmi3Error) return 13;
  if (fmi3Reset(c) || fmi3GetFloat64(c, r, 1, &now, 1) || now != 0.0) return 14;
  fmi3FreeFMUState(c, &kept);
  fmi3Terminate(c);
  fmi3FreeInstance(c);
  return 0;
}
"""


def test_nothing_of_it_is_out_of_bounds(tmp_path: Path) -> None:
    """Every call that does something, with the sanitizers where there are any."""
    source = fmu_source(handed(cases(tmp_path)["shipped"]), "ferry", "{x}", "3.0")
    assert run_sanitized(tmp_path, source, ALONE) == (0, "")


@pytest.mark.parametrize("name", ["shipped", "a gear with a state", "surge and heading"])
@pytest.mark.study
def test_an_importer_sails_it_to_the_kernel_s_numbers(name: str, tmp_path: Path) -> None:
    """FMPy finds nothing wrong with it, every call of the standard in it, and the same motion."""
    fmpy = pytest.importorskip("fmpy")
    validate_fmu = pytest.importorskip("fmpy.validation").validate_fmu
    made = handed(cases(tmp_path)[name])
    path = tmp_path / "case.fmu"
    path.write_bytes(fmu_bytes(made, "case", "3.0"))
    assert validate_fmu(str(path)) == []
    rudder = next(n for n in ("delta", "delta_order") if n in made.inputs)
    found = fmpy.simulate_fmu(
        str(path),
        stop_time=60.0,
        step_size=PERIOD,
        output_interval=PERIOD,
        start_values={rudder: 0.2},
    )
    assert found["time"][-1] == 60.0
    last = np.array([[found[n][-1] for n in made.equations.states]])
    assert apart(last, sailed_by_kernel(made, 0.2, 120)[None]) < TIGHT


def test_it_says_what_it_is(run_folder: Path, tmp_path: Path) -> None:
    """As the command writes it: one token in words and binary, ranges, how it is compiled."""
    out = tmp_path / "my ferry.fmu"
    told = trialid_("export", str(run_folder), "--as", "fmu3", "--out", str(out))
    assert told.exit_code == 0, told.stderr
    with zipfile.ZipFile(io.BytesIO(out.read_bytes())) as packed:
        root = ElementTree.fromstring(packed.read("modelDescription.xml"))
        build = ElementTree.fromstring(packed.read("sources/buildDescription.xml"))
        binary = packed.read("binaries/x86_64-linux/my_ferry.so")
    assert root.attrib["fmiVersion"] == "3.0"
    assert root.attrib["instantiationToken"].encode() in binary
    assert {s.attrib["name"] for s in root.iter("Seen")} >= {"delta", "r", "phi"}
    assert [f.attrib["name"] for f in build.iter("SourceFile")] == ["my_ferry.c"]
    free = [v.attrib["name"] for v in root.iter("Float64") if "likely" in v.get("description", "")]
    assert {*free} == {"Nr", "Nv", "Ndelta", "GM"}
