"""The FMU: the kernel's numbers through FMI's calls, what is wrong and unseen told, valid."""

import ctypes
import io
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from handed_models import (
    GCC,
    NAMES,
    PERIOD,
    TIGHT,
    Case,
    cases,
    handed,
    inputs_of,
    run_sanitized,
    sailed_by_kernel,
)
from handed_models import largest_difference as apart
from test_bad_input import trialid_

from trialid.export.model.equation_steps import own_name
from trialid.export.model.fmu.fmu_file import fmu_bytes, fmu_source
from trialid.simulation.integrate import domain, prepare

OK, ERROR = 0, 3
compiled = pytest.mark.skipif(GCC is None or sys.platform != "linux", reason="no C compiler here")

ALONE = r"""
#include "ferry.c"
#include <stdarg.h>
#include <stdio.h>
static int words = 0;
static void listen(fmi2ComponentEnvironment e, fmi2String n, fmi2Status s, fmi2String c,
                   fmi2String m, ...) {
  (void)e; (void)n; (void)s; (void)c; (void)m;
  words++;
}
int main(void) {
  fmi2CallbackFunctions calls = {listen, NULL, NULL, NULL, NULL};
  fmi2FMUstate kept = NULL;
  fmi2ValueReference r[2] = {2, 4};
  double rudder = 0.2, bad = NAN, then, now;
  fmi2Boolean unseen;
  unsigned flag = FLAG;
  if (fmi2Instantiate("a", fmi2CoSimulation, "wrong", "", &calls, 0, 0)) return 1;
  fmi2Component c = fmi2Instantiate("a", fmi2CoSimulation, "{x}", "", &calls, 0, 0);
  if (!c || fmi2SetupExperiment(c, 0, 0, 0, 0, 0) || fmi2EnterInitializationMode(c)) return 2;
  if (fmi2SetReal(c, r + 1, 1, &rudder) || fmi2ExitInitializationMode(c)) return 3;
  for (int k = 0; k < 20; k++) if (fmi2DoStep(c, 0.5 * k, 0.5, 1)) return 4;
  if (fmi2GetFMUstate(c, &kept) || fmi2DoStep(c, 10, 0.5, 1)) return 5;
  if (fmi2GetReal(c, r, 1, &then)) return 5;
  if (fmi2SetFMUstate(c, kept) || fmi2DoStep(c, 10, 0.5, 1)) return 6;
  if (fmi2GetReal(c, r, 1, &now)) return 6;
  if (then != now || !(now > 0.001)) return 7;
  if (fmi2SetReal(c, r + 1, 1, &bad) != fmi2Error || words != 1) return 8;
  if (fmi2GetBoolean(c, &flag, 1, &unseen) || unseen) return 9;
  rudder = 0.5;
  if (fmi2SetReal(c, r + 1, 1, &rudder) || fmi2DoStep(c, 11, 0.5, 1) || words != 2) return 10;
  if (fmi2GetBoolean(c, &flag, 1, &unseen) || !unseen) return 11;
  flag = ALL;
  if (fmi2GetReal(c, &flag, 1, &now) != fmi2Error) return 12;
  if (fmi2DoStep(c, 11, -1.0, 1) != fmi2Error) return 13;
  if (fmi2Reset(c) || fmi2GetReal(c, r, 1, &now) || now != 0.0) return 14;
  fmi2FreeFMUstate(c, &kept);
  fmi2Terminate(c);
  fmi2FreeInstance(c);
  return 0;
}
"""


def opened(content: bytes, folder: Path) -> tuple[ctypes.CDLL, ElementTree.Element]:
    with zipfile.ZipFile(io.BytesIO(content)) as packed:
        packed.extractall(folder)
    [binary] = (folder / "binaries" / "linux64").glob("*.so")
    library = ctypes.CDLL(str(binary))
    library.fmi2Instantiate.restype = ctypes.c_void_p
    return library, ElementTree.parse(folder / "modelDescription.xml").getroot()


def references(root: ElementTree.Element) -> dict[str, int]:
    found = root.findall("ModelVariables/ScalarVariable")
    return {v.attrib["name"]: int(v.attrib["valueReference"]) for v in found}


class Driver:
    """FMI's calls by name."""

    def __init__(self, library: ctypes.CDLL, root: ElementTree.Element) -> None:
        self.library, self.at = library, references(root)
        guid = root.attrib["guid"].encode()
        made = library.fmi2Instantiate(*(b"x", 1, guid, b""), None, 0, 0)
        assert made
        self.c = ctypes.c_void_p(made)

    def put(self, values: dict[str, float]) -> int:
        places, numbers = self._arrays(list(values), list(values.values()))
        return self.library.fmi2SetReal(self.c, places, len(values), numbers)

    def get(self, names: list[str]) -> list[float]:
        places, numbers = self._arrays(names, [0.0] * len(names))
        assert self.library.fmi2GetReal(self.c, places, len(names), numbers) == OK
        return list(numbers)

    def step(self, t: float, period: float) -> int:
        at, length = ctypes.c_double(t), ctypes.c_double(period)
        return self.library.fmi2DoStep(self.c, at, length, 1)

    def _arrays(self, names: list[str], values: list[float]):
        places = (ctypes.c_uint * len(names))(*(self.at[n] for n in names))
        return places, (ctypes.c_double * len(values))(*values)


@compiled
@pytest.mark.parametrize("name", NAMES)
def test_its_numbers_are_the_kernel_s(name: str, tmp_path: Path) -> None:
    """Inputs are held over a step, as co-simulation has it; steps of twice the run's are halved."""
    case: Case = cases(tmp_path)[name]
    made = handed(case)
    driver = Driver(*opened(fmu_bytes(made, "ferry"), tmp_path))
    u = inputs_of(made)[:200]
    simulator = prepare(made.model, (), case.outputs)
    states, theta = made.equations.states, np.array([p.value for p in made.parameters])
    x = np.array([7.33 if s == "u" else 0.0 for s in states])
    driver.put(dict(zip(states, x.tolist(), strict=True)))
    run, limit, largest = simulator.engine, domain(made.model), np.zeros(len(states))
    off = np.zeros(len(states))
    for k, row in enumerate(u):
        assert driver.put(dict(zip(made.inputs, row.tolist(), strict=True))) == OK
        assert driver.step(2.0 * PERIOD * k, 2.0 * PERIOD) == OK
        both = np.array([row, row])
        x = run.simulate(theta, x, both, limit, 2.0 * PERIOD, 2)[0][1]
        off = np.maximum(off, np.abs(x - driver.get(list(states))))
        largest = np.maximum(largest, np.abs(x))
    assert largest.min() > 0.0
    assert (off / largest).max() < TIGHT


@compiled
def test_nothing_of_it_is_out_of_bounds(tmp_path: Path) -> None:
    """Every call, with the address and undefined-behaviour sanitizers where there are any."""
    source = fmu_source(handed(cases(tmp_path)["shipped"]), "ferry", "{x}")
    assert run_sanitized(tmp_path, source, ALONE) == (0, "")


def test_it_says_what_it_is(tmp_path: Path) -> None:
    """Tunable parameters, units, what was seen, how sure; the same bytes each time."""
    made = handed(cases(tmp_path)["a gear with a state"])
    content = fmu_bytes(made, "my ferry")
    assert content == fmu_bytes(made, "my ferry")
    with zipfile.ZipFile(io.BytesIO(content)) as packed:
        root = ElementTree.fromstring(packed.read("modelDescription.xml"))
        assert "sources/my_ferry.c" in packed.namelist()
        assert b'"trialid-model/1"' in packed.read("resources/model.json")
    variables = root.findall("ModelVariables/ScalarVariable")
    assert len({v.attrib["valueReference"] for v in variables}) == len(variables)
    by_name = {v.attrib["name"]: v for v in variables}
    assert by_name["Nr"].attrib["variability"] == "tunable"
    assert by_name["Nr"].attrib["description"] == "fitted, likely -0.002971 to -0.002228"
    assert float(by_name["Nr"][0].attrib["start"]) == made.model.value("Nr")
    assert by_name["r"][0].attrib["unit"] == "rad/s"
    seen = {s.attrib["name"]: s.attrib for s in root.iter("Seen")}
    assert float(seen["delta"]["high"]) == 0.35
    [row] = root.iter("Row")
    assert float(row.text) == pytest.approx(made.covariance[0, 0])


@compiled
@pytest.mark.study
def test_an_importer_takes_it(run_folder: Path, tmp_path: Path) -> None:
    fmpy = pytest.importorskip("fmpy")
    validate_fmu = pytest.importorskip("fmpy.validation").validate_fmu
    out = tmp_path / "ferry.fmu"
    told = trialid_("export", str(run_folder), "--as", "fmu", "--out", str(out))
    assert told.exit_code == 0, told.stderr
    assert validate_fmu(str(out)) == []
    found = fmpy.simulate_fmu(
        str(out), stop_time=60.0, step_size=0.5, output_interval=0.5, start_values={"delta": 0.2}
    )
    assert found["r"][-1] > 0.001
    assert not found["unseen"][-1]
    for name in NAMES:
        path = tmp_path / "case.fmu"
        path.write_bytes(fmu_bytes(handed(cases(tmp_path)[name]), "case"))
        assert validate_fmu(str(path)) == [], name


@compiled
@pytest.mark.study
def test_another_importer_sails_it_to_the_same_numbers(tmp_path: Path) -> None:
    """libcosim, on the FMI Library: what the kernel makes of a rudder that is held."""
    pytest.importorskip("libcosimpy")
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.ERROR)
    for name in NAMES:
        made = handed(cases(tmp_path)[name])
        path = tmp_path / f"{own_name(name)}.fmu"
        path.write_bytes(fmu_bytes(made, "case"))
        sailing = CosimExecution.from_step_size(step_size=PERIOD * 1e9)
        ship = sailing.add_local_slave(CosimLocalSlave(str(path), "ferry"))
        helm, log = CosimManipulator.create_override(), CosimObserver.create_last_value()
        sailing.add_manipulator(helm)
        sailing.add_observer(log)
        at = {n: i for i, n in enumerate((*made.equations.states, *made.inputs))}
        rudder = next(
            i for n, i in at.items() if n in ("delta", "delta_order") and n in made.inputs
        )
        helm.slave_real_values(ship, [rudder], [0.2])
        sailing.step(120)
        found = log.last_real_values(ship, [at[n] for n in made.equations.states])
        assert apart(np.array([found]), sailed_by_kernel(made, 0.2, 120)[None]) < TIGHT, name
