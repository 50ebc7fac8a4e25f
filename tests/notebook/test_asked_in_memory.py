"""What a notebook asks of a fit is held against the rules of a pipeline file."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import trialid as ti
from trialid.errors import TrialidError
from trialid.pipeline_file.form import DiagnoseSection
from trialid.workflow.notebook.asked_settings import (
    asked_diagnosis,
    asked_settings,
    checked_trials,
)

SHIP = Path(__file__).parents[2] / "sample_data" / "ships" / "s175q.toml"
ASKED = {"free": ["Nr"], "outputs": ["r"]}


def weave(name: str = "weave", use: str = "fit", speed: float = 7.3) -> ti.Trial:
    t = 0.5 * np.arange(200)
    signals = {"delta": np.sin(t / 10.0), "r": np.cos(t / 10.0), "u": np.full(200, speed)}
    units = {"delta": "deg", "r": "deg/s", "u": "m/s"}
    side = {"delta": "starboard"}
    return ti.Trial.from_arrays(name, t, signals, units=units, positive=side, use=use)


@pytest.fixture(scope="module")
def model() -> ti.ShipModel:
    effects = tuple(ti.CATALOGUE[e] for e in ("linear_hull", "linear_rudder"))
    return ti.ShipModel(ti.read_ship(str(SHIP)), ("v", "r"), effects)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"nuisance": ["initial_state", "biass"]}, r"nuisance\[1\]: 'biass' is not allowed"),
        ({"bounds": {"Nr": (1, 0)}}, r"bounds.Nr: \[1, 0\] runs backwards"),
        ({"bounds": {"Nr": (5, 6)}}, "bounds.Nr: .* leaves out the start"),
        ({"bounds": {"Nx": (0, 1)}}, "bounds.Nx: 'Nx' is not free"),
        ({"priors": {"Nx": (0, 1)}}, "priors.Nx: 'Nx' is not free"),
        ({"priors": {"Nr": (0, -1)}}, "priors.Nr.std: must be greater than 0"),
        ({"loss": "hubber"}, "loss: 'hubber' is not allowed; did you mean 'huber'"),
        ({"norm": "x"}, "norm: 'x' is not allowed"),
        ({"engine": "x"}, "engine: 'x' is not allowed"),
        ({"starts": 0}, "starts: must be greater than or equal to 1"),
        ({"weights": {"r": -1}}, "weights.r: must be greater than 0"),
        ({"weights": {"rr": 1}}, "weights.rr: not one of identify.outputs"),
        ({"free": ["Nr", "Nr"]}, "free: 'Nr' stands there 2 times"),
        ({"free": []}, "free: must not be empty"),
        ({"free": "Nr"}, "free: must be a list"),
    ],
)
def test_what_a_pipeline_may_not_ask_a_notebook_may_not(model, change: dict, said: str) -> None:
    with pytest.raises(TrialidError, match=f"^ti.identify: identify.{said}"):
        ti.identify([weave()], model, **{**ASKED, **change})


@pytest.mark.parametrize(
    ("trials", "said"),
    [
        ([], "no trial to fit"),
        ([weave(use="check")], "no trial to fit"),
        ([weave(), weave()], "is already the name of"),
        ([weave(speed=0.1)], "the ship lies still"),
        (weave(), "expected a list of ti.Trial"),
        (["zigzag"], "got a list with a str"),
    ],
)
def test_trials_are_held_against_the_rules_of_a_pipeline(model, trials, said: str) -> None:
    with pytest.raises(TrialidError, match=said):
        ti.identify(trials, model, **ASKED)


def test_a_model_is_none_by_its_name() -> None:
    with pytest.raises(TrialidError, match=r"expected a ti\.ShipModel, got 'ship'"):
        ti.identify([weave()], "ship", **ASKED)


def test_settings_of_numpy_are_what_a_file_would_say(model) -> None:
    more = {"bounds": {"Nr": np.array([-1.0, 0.0])}, "priors": {"Nr": (-0.002, np.float64(0.001))}}
    asked = asked_settings([weave()], model, {**ASKED, **more, "starts": np.int64(2)})
    assert asked.bounds == {"Nr": (-1.0, 0.0)}
    assert asked.priors == {"Nr": (-0.002, 0.001)}
    assert (asked.starts, asked.nuisance) == (2, ("initial_state",))


def test_a_diagnosis_takes_what_a_pipeline_takes() -> None:
    assert asked_diagnosis({})["family_cos"] == DiagnoseSection().family_cos
    with pytest.raises(TrialidError, match=r"^ti\.diagnose: level: must be less than 1"):
        asked_diagnosis({"level": 5})
    with pytest.raises(TrialidError, match="no setting 'levels'; did you mean 'level'"):
        asked_diagnosis({"levels": 0.1})


def test_a_rudder_that_is_not_recorded_for_long_is_refused(model: ti.ShipModel) -> None:
    """As a pipeline cuts the trial there: half her length takes her 11.9 s."""
    whole = weave()
    for samples, refused in ((30, False), (36, True)):
        known = np.ones(200, np.bool_)
        known[80 : 80 + samples] = False
        holed = replace(whole, valid={**whole.valid, "delta": known})
        if refused:
            with pytest.raises(
                TrialidError, match=r"'weave': delta not recorded in \[40.0, 57.5\]"
            ):
                ti.identify([holed], model, **ASKED)
        else:
            assert checked_trials([holed], model) == (holed,)


def turning(factor: float, late: int = 0) -> ti.Trial:
    """A weave whose rate is so many times the slope of her heading, and late by so many samples."""
    t = 0.5 * np.arange(400)
    rate = 0.02 * np.cos(t / 7.0) * np.cos(t / 31.0)
    heading = np.concatenate([[0.0], 0.25 * np.cumsum(rate[1:] + rate[:-1])])
    signals = {"delta": rate, "r": factor * np.roll(rate, late), "psi": heading, "u": 0.0 * t + 7.3}
    units = {"delta": "rad", "r": "rad/s", "psi": "rad", "u": "m/s"}
    return ti.Trial.from_arrays("weave", t, signals, units=units, positive={"delta": "starboard"})


@pytest.mark.parametrize("factor", [57.3, 1.0 / 57.3, 60.0])
def test_a_rate_in_another_unit_than_its_angle_is_refused(model: ti.ShipModel, factor: float):
    with pytest.raises(
        TrialidError, match=r"'weave': r is \S+ times the slope of psi .* a unit is"
    ):
        checked_trials([turning(factor)], model)


def test_a_rate_that_contradicts_its_angle_is_told_by_the_verdict_of_arrays_too(
    model: ti.ShipModel,
) -> None:
    [off] = checked_trials([turning(0.9)], model)
    assert [(c.rate, c.angle) for c in off.contradictions] == [("r", "psi")]
    assert off.contradictions[0].factor == pytest.approx(0.9, abs=0.01)
    [right] = checked_trials([turning(1.0)], model)
    assert right.contradictions == ()
