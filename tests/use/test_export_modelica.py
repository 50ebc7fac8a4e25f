"""The Modelica file under a compiler that knows nothing of us: the kernel's numbers, how sure."""

import gc
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from handed_models import NAMES, TIGHT, Case, cases, handed
from handed_models import largest_difference as apart
from test_bad_input import trialid_

from trialid.export.model.equation_steps import own_name
from trialid.export.model.fitted_model import FittedModel
from trialid.export.model.modelica_text import modelica_text
from trialid.export.model.numpy_text import numpy_text
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

rumoca = pytest.importorskip("rumoca")


@pytest.fixture(scope="module", autouse=True)
def dropped_where_it_was_made():
    """A model of rumoca's must not be let go by another thread, as those of other tests may do."""
    yield
    gc.collect()


pytestmark = pytest.mark.study

DRAWS = 4
END, STEP = 60.0, 0.05
TOLERANCE = 1e-10
NEAR = 1e-6
"""Of the largest value, by which two integrators may differ at that tolerance."""


def compiled(made: FittedModel, ships: str, equations: str):
    """A model that holds the exported ones as parts."""
    text = f"{modelica_text(made, 'ferry')}\nmodel Sea\n{ships}\nequation\n{equations}\nend Sea;\n"
    return rumoca.Session().loads(text, model="Sea")


@pytest.mark.parametrize("name", NAMES)
def test_its_rates_and_outputs_are_those_of_the_model(name: str, tmp_path: Path) -> None:
    """At states drawn at random, by the names of the file, with what was not seen told."""
    made = handed(cases(tmp_path)[name])
    states, inputs = made.equations.states, made.inputs
    rng = np.random.default_rng(5)
    x = [made.starts[n] for n in states] + 0.02 * rng.standard_normal((DRAWS, len(states)))
    u = [made.starts[n] for n in inputs] + 0.3 * rng.standard_normal((DRAWS, len(inputs)))
    ships, equations = [], []
    for k in range(DRAWS):
        begun = ", ".join(
            f"{own_name(n)}(start={v!r})" for n, v in zip(states, x[k].tolist(), strict=True)
        )
        ships.append(f"ferry s{k}({begun});")
        ships += [f"Real f{k}_{n};" for n in states]
        equations += [
            f"s{k}.{own_name(n)} = {v!r};" for n, v in zip(inputs, u[k].tolist(), strict=True)
        ]
        equations += [f"f{k}_{n} = der(s{k}.{own_name(n)});" for n in states]
    found = compiled(made, "\n".join(ships), "\n".join(equations)).simulate((0, 1e-6), dt=1e-6)
    alone: dict = {}
    exec(numpy_text(made), alone)
    rates = [[found[f"f{k}_{n}"][0] for n in states] for k in range(DRAWS)]
    shown = [[found[f"s{k}.{n}_sensor"][0] for n in made.equations.outputs] for k in range(DRAWS)]
    pairs = [*zip(x, u, strict=True)]
    assert apart(np.array(rates), np.array([alone["derivatives"](a, b) for a, b in pairs])) < TIGHT
    assert apart(np.array(shown), np.array([alone["outputs"](a, b) for a, b in pairs])) < TIGHT
    for k, (a, b) in enumerate(pairs):
        assert bool(found[f"s{k}.unseen"][0]) == bool(alone["unseen"](a, b))


@pytest.mark.parametrize("name", ["shipped", "a gear with a state", "surge and heading"])
def test_it_sails_as_the_kernel_does(name: str, tmp_path: Path) -> None:
    """A minute of a rudder that is put over slowly, by an integrator of its own."""
    made = handed(cases(tmp_path)[name])
    t = np.arange(round(END / STEP) + 1) * STEP
    order = 0.2 * t / END
    steered = {n for n in made.inputs if n.startswith("delta")}
    signals = {n: np.full(len(t), made.starts[n]) for n in made.inputs}
    signals |= dict.fromkeys(steered, order)
    simulator = prepare(made.model, (), tuple(made.equations.outputs))
    begun = {n: x for n, x in made.starts.items() if n in made.equations.states}
    sailed = respond(simulator, Trial("x", "fit", STEP, signals, {}), {}, {}, False).states
    assert [*begun] == [*made.equations.states]
    begins = [f"{own_name(n)}(start={v!r})" for n, v in zip(begun, sailed[0].tolist(), strict=True)]
    orders = {n: repr(made.starts[n]) for n in made.inputs}
    orders |= dict.fromkeys(steered, f"0.2 * time / {END}")
    given = [f"s.{n} = {order};" for n, order in orders.items()]
    ship = compiled(made, f"ferry s({', '.join(begins)});", "\n".join(given))
    config = rumoca.SimConfig(solver="bdf", rtol=TOLERANCE, atol=1e-12)
    found = ship.simulate((0, END), dt=1.0, config=config)
    states = np.array([found[f"s.{n}"] for n in begun]).T[: round(END) + 1]
    assert np.max(np.abs(sailed[-1, :3])) > 1e-3
    assert apart(states, sailed[:: round(1.0 / STEP)]) < NEAR


def test_parameters_say_how_sure_they_are(tmp_path: Path) -> None:
    made = handed(cases(tmp_path)["shipped"])
    text = modelica_text(made, "my ferry")
    ferry = rumoca.Session().loads(text, model="my_ferry")
    row = next(p for p in ferry.parameters if p.name == "Nr")
    assert row.value == made.model.value("Nr")
    assert row.description == "fitted, likely -0.002971 to -0.002228, standard error 0.000248"
    assert {p.name: p.unit for p in ferry.parameters}["GM"] == "m"
    assert {v.name: v.unit for v in ferry.inputs} == {"delta": "rad", "u": "m/s"}
    assert "seen(r={-0.02, 0.02}, delta={-0.35, 0.35})," in text
    assert f"covariance={{{{{made.covariance.item()!r}}}}}" in text
    assert ferry.structure().is_balanced
    assert max(len(line) for line in text.splitlines() if '"' not in line) <= 100


def test_words_end_no_string(tmp_path: Path) -> None:
    made = handed(cases(tmp_path)["shipped"])
    wild = 'x"; end ferry; \\ */ // \n model'
    made = replace(made, name=wild, words=(wild,), origin={"ship": wild})
    assert rumoca.Session().loads(modelica_text(made, "model"), model="model_")


def test_a_sure_ship_and_a_free_one_have_no_range_to_leave(tmp_path: Path) -> None:
    """Nothing seen: nothing is watched; nothing fitted: no covariance."""
    made = handed(Case(cases(tmp_path)["shipped"].model))
    rows = tuple(replace(p, fitted=False, likely=None) for p in made.parameters)
    made = replace(made, seen={}, parameters=rows, covariance=np.zeros((0, 0)))
    text = modelica_text(made, "ferry")
    assert "unseen" not in text
    assert "covariance" not in text
    assert rumoca.Session().loads(text, model="ferry")


def test_the_command_writes_it(run_folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "ferry.mo"
    told = trialid_("export", str(run_folder), "--as", "modelica", "--out", str(out))
    assert (told.exit_code, told.stdout) == (0, f"Written: {out}\n")
    ferry = rumoca.Session().load(str(out), model="ferry")
    assert ferry.states.names == ["v", "p", "r", "phi"]
    assert "// fitted to: " in out.read_text(encoding="utf-8")
