"""A call with what it cannot take is one line that says what was expected."""

from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import trialid as ti
from trialid.errors import TrialidError
from trialid.names.quantities import SIGNALS
from trialid.user_files import path_of
from trialid.workflow.notebook.arguments import changes_of, count_of, order_words
from trialid.workflow.notebook.fit_run import FitRun
from trialid.workflow.notebook.pipeline_run import PipelineRun
from trialid.workflow.notebook.run_view import RunView
from trialid.workflow.use.in_memory import _table

RUN: Any = PipelineRun(None, None, None, ())
FITTED: Any = FitRun(None, None, None, ())


@dataclass(frozen=True)
class Nothing:
    """What nobody expects."""


@pytest.mark.parametrize("given", [None, "", 3, Nothing()])
def test_a_path_that_is_none(given: Any, tmp_path: Path) -> None:
    calls = (
        ti.read,
        ti.read_ship,
        ti.run,
        ti.structures,
        lambda x: ti.batch(x, tmp_path),
        RUN.write,
        FITTED.write,
    )
    for call in calls:
        with pytest.raises(TrialidError, match="expected the path of a file or folder, got "):
            call(given)
    assert path_of(str(tmp_path), "here") == tmp_path


@pytest.mark.parametrize("given", [None, 3, Nothing()])
def test_an_effect_that_has_no_name(given: Any) -> None:
    for call in (RUN.add, RUN.drop):
        with pytest.raises(
            TrialidError, match="expected an effect's name, as 'righting_arm_cubic'"
        ):
            call(given)
    with pytest.raises(TrialidError, match="save it in a file that the pipeline names"):
        RUN.add(ti.CATALOGUE["linear_hull"])


def test_an_output_that_has_no_name() -> None:
    with pytest.raises(TrialidError, match="no output 'None' was compared"):
        RUN.plot(None)


def test_a_run_is_compared_with_a_run() -> None:
    with pytest.raises(TrialidError, match=r"expected another run, .* got 'runs/better'"):
        RUN.compare("runs/better")


def test_orders_on_a_clock_beside_a_manoeuvre_are_not_passed_over() -> None:
    for call in (RunView().simulate, RunView().draw):
        with pytest.raises(TrialidError, match=r"delta: orders on a clock .* 'circle'"):
            call("circle", 35, delta=[0.1, 0.2])
        with pytest.raises(TrialidError, match="period: orders on a clock stand alone"):
            call("circle", 35, period=0.5)
        with pytest.raises(TrialidError, match="None is no part of a manoeuvre"):
            call("circle", None)
    assert order_words(("zigzag", 20, 12.5), {"period": None}) == ("zigzag", "20", "12.5")
    assert order_words((), {"period": 0.5, "delta": [0.1]}) == ()


@pytest.mark.parametrize(
    ("what_if", "without", "said"),
    [
        ({"GM": "a"}, (), "what_if GM: expected a finite number, got 'a'"),
        ({"GM": float("nan")}, (), "what_if GM: expected a finite number, got nan"),
        ("GM=1", (), "what_if: expected numbers by name"),
        ({}, "heel_yaw", "without: expected a list of effects' names, got 'heel_yaw'"),
    ],
)
def test_a_change_that_is_no_number(what_if: Any, without: Any, said: str) -> None:
    with pytest.raises(TrialidError, match=said):
        RunView().simulate("circle", 35, what_if=what_if, without=without)
    assert order_words(("zigzag", np.int64(20), np.float64(20.0)), {}) == ("zigzag", "20", "20")
    assert changes_of({"GM": np.int64(1)}, ["heel_yaw"]).without == ("heel_yaw",)


@pytest.mark.parametrize(
    ("name", "given"), [("seed", -1), ("number", 0), ("number", "a"), ("number", 1.5)]
)
def test_a_count_that_is_none(name: str, given: Any) -> None:
    with pytest.raises(TrialidError, match=f"^{name}={given!r}: expected a whole number, at least"):
        RunView().draw("circle", 35, **{name: given})
    assert count_of(np.int64(3), "seed", 0) == 3


TOLD: Any = SimpleNamespace(quantities=SIGNALS)
"""A model as far as its orders go."""


def test_orders_that_are_no_numbers() -> None:
    with pytest.raises(TrialidError, match=r"delta: 'a' \(row 0\) is no number"):
        _table(TOLD, 0.5, {"delta": ["a", "b"]})
    with pytest.raises(TrialidError, match="inputs of one length and their period"):
        _table(TOLD, "a", {"delta": [0.1, 0.2]})
    with pytest.raises(
        TrialidError, match=r"delta: reaches 20 rad; no rudder is turned half round"
    ):
        _table(TOLD, 0.5, {"delta": [0.0, -20.0]})


def test_a_run_shows_itself_in_a_line() -> None:
    """It was half a million characters of what it holds."""
    result = SimpleNamespace(
        pipeline="her trials", verdict=SimpleNamespace(kind="missing", sentence="a is missing")
    )
    findings = SimpleNamespace(before=SimpleNamespace(fit=SimpleNamespace(eps_rmsn=0.0544)))
    runs: tuple[Any, ...] = (
        PipelineRun(None, findings, result, ()),
        FitRun(None, findings, result, ()),
    )
    for run in runs:
        assert repr(run) == "her trials: error 5.44%; missing: a is missing"


def weave(name: str, use: str) -> ti.Trial:
    t = 0.5 * np.arange(200)
    signals = {"delta": np.sin(t / 10.0), "r": np.cos(t / 10.0)}
    units = {"delta": "deg", "r": "deg/s"}
    side = {"delta": "starboard"}
    return ti.Trial.from_arrays(name, t, signals, units=units, positive=side, use=use)


def test_a_simulation_of_what_cannot_be_simulated() -> None:
    ship = ti.read_ship(str(Path(__file__).parents[2] / "sample_data" / "ships" / "s175q.toml"))
    effects = tuple(ti.CATALOGUE[e] for e in ("linear_hull", "linear_rudder"))
    model = ti.ShipModel(ship, ("v", "r"), effects)
    with pytest.raises(TrialidError, match="got a NoneType and a Trial"):
        ti.simulate(None, weave("a", "fit"))
    with pytest.raises(TrialidError, match="start: no state 'rr' is simulated; did you mean 'r'"):
        ti.simulate(model, weave("a", "fit"), ("r",), start={"rr": 0.1})
    assert [*ti.simulate(model, weave("a", "fit")).columns] == ["r"]  # she has no heel
    fit = ti.identify([weave("a", "fit")], model, free=["Nr"], outputs=["r"], max_iterations=2)
    with pytest.raises(TrialidError, match="trial 'b' has use='fit' and was not fitted"):
        ti.simulate(fit, weave("b", "fit"))
    assert len(ti.simulate(fit, weave("b", "check"))) == 200
