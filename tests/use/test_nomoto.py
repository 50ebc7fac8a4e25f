"""Nomoto's K and T: what a small order does in time, ranges that follow, unstable ships told."""

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import s175q
from test_bad_input import trialid_
from typical import known_by

from trialid.design.following import approach_speeds
from trialid.design.helm import sail, vessel
from trialid.design.steering.nomoto import NAMES, at_speeds, nomoto
from trialid.effects import CATALOGUE
from trialid.errors import DesignError
from trialid.export.model.nomoto_file import ENDLESS, nomoto_file
from trialid.progress import silent
from trialid.ship.model import ShipModel
from trialid.workflow.use import hand_over
from trialid.workflow.use.finished_model import finished_model
from trialid.workflow.use.steering import Wishes

EFFECTS = ("linear_hull", "linear_rudder", "linear_roll", "heel_yaw", "yaw_drag_rar")
MODEL = ShipModel(s175q.SHIP, ("v", "p", "r", "phi"), tuple(CATALOGUE[n] for n in EFFECTS))
SMALL = np.deg2rad(0.0005)


def ship(model):
    return vessel(model, 0.5, {"u": 7.33}, 1.0)


def test_they_are_what_a_small_order_does():
    """K: the rate it leads to; K T: what of the heading is lost until then. Roll counts, too."""
    found = nomoto(ship(MODEL), known_by("Nr", 0.0))
    assert found.stable
    motion = sail(ship(MODEL), np.append(np.zeros(2), np.full(4000, SMALL)))
    r = motion["r"][2:] / SMALL
    lost = float(np.sum(0.5 * ((r[-1] - r[1:]) + (r[-1] - r[:-1])))) * 0.5
    assert r[-1] == pytest.approx(found.values["K"], rel=1e-3)
    assert lost / r[-1] == pytest.approx(found.values["T"], rel=0.01)
    time = 175.0 / 7.33
    assert found.values["K_prime"] == pytest.approx(found.values["K"] * time)
    assert found.values["T_prime"] == pytest.approx(found.values["T"] / time)
    assert found.values["K"] > 0.0


def test_surge_and_a_gear_in_the_model_change_what_they_change():
    """Surge nothing, a slow gear T by its own time."""
    plain = nomoto(ship(MODEL), known_by("Nr", 0.0)).values
    surge = ShipModel(MODEL.ship, ("u", *MODEL.states), MODEL.effects)
    assert nomoto(ship(surge), known_by("Nr", 0.0)).values == pytest.approx(plain)
    geared = (MODEL + CATALOGUE["rudder_servo"]).with_values({"T_delta": 4.0})
    slow = nomoto(ship(geared), known_by("Nr", 0.0)).values
    assert slow["K"] == pytest.approx(plain["K"])
    assert slow["T"] == pytest.approx(plain["T"] + 4.0)


def test_ranges_are_what_the_parameters_do():
    deviation = 1e-3 * abs(MODEL.value("Nv"))
    found = nomoto(ship(MODEL), known_by("Nv", deviation))
    ends = [
        nomoto(
            ship(MODEL.with_values({"Nv": MODEL.value("Nv") + side * 1.96 * deviation})),
            known_by("Nv", 0.0),
        ).values
        for side in (1.0, -1.0)
    ]
    for name in NAMES:
        low, high = sorted(end[name] for end in ends)
        assert high > low
        assert found.ranges[name] == pytest.approx((low, high), rel=1e-4)


def test_of_a_ship_that_may_be_neither_k_has_no_end():
    """Through infinity no range is told: of a tanker hardly stable 1.2 was the end of it, of 93."""
    Nv = MODEL.value("Nv")
    steps = [Nv * k for k in (1.0, 1.5, 2.0, 3.0, 4.0, 6.0, 8.0)]
    found = [nomoto(ship(MODEL.with_values({"Nv": n})), known_by("Nv", 0.0)) for n in steps]
    stable = [one.stable for one in found]
    assert stable[0]
    assert not stable[-1]
    last = stable.index(False) - 1
    least, wide = 0.01 * abs(Nv), 2.0 * abs(steps[last] - steps[last + 1])
    near = ship(MODEL.with_values({"Nv": steps[last]}))
    told, not_told = (nomoto(near, known_by("Nv", off)).ranges for off in (least, wide))
    for name in ("K", "T", "T1", "K_prime", "T_prime"):
        assert told[name] is not None
        assert not_told[name] is None
    assert not_told["T2"] is not None
    made = SimpleNamespace(name="near", verdict="nothing missing", words=(), origin={})
    for off, words in ((least, ()), (wide, (ENDLESS,))):  # an empty range has its reason
        file = nomoto_file(made, [nomoto(near, known_by("Nv", off))])
        assert (file.words, file.at[0].stable) == (words, None if words else True)


def test_a_ship_that_is_not_stable_is_told():
    wild = MODEL.with_values({"Nv": 4.0 * MODEL.value("Nv")})
    found = nomoto(ship(wild), known_by("Nr", 0.0))
    assert not found.stable
    assert found.values["K"] < 0.0


def test_the_second_order_is_that_of_sway_and_yaw():
    """T1 + T2 - T3 = T without roll; the transfer function is that of A and B at any frequency."""
    flat = ShipModel(MODEL.ship, ("v", "r"), MODEL.effects[:2])
    found = nomoto(ship(flat), known_by("Nr", 0.0))
    T1, T2, T3 = (found.values[n] for n in ("T1", "T2", "T3"))
    assert found.values["T"] == pytest.approx(T1 + T2 - T3)
    assert T1 > T2 > 0.0
    A, B = found.ship.A, found.ship.B
    for omega in (0.003, 0.05, 1.0):
        s = 1j * omega
        exact = np.linalg.solve(s * np.eye(2) - A, B)[found.ship.turning]
        reduced = found.values["K"] * (1 + T3 * s) / ((1 + T1 * s) * (1 + T2 * s))
        assert exact == pytest.approx(reduced, rel=1e-9)
    geared = (flat + CATALOGUE["rudder_servo"]).with_values({"T_delta": 4.0})
    slow = nomoto(ship(geared), known_by("Nr", 0.0)).values
    assert [slow[n] for n in ("T1", "T2", "T3")] == pytest.approx([T1, T2, T3])
    rolling = nomoto(ship(MODEL), known_by("Nr", 0.0)).values
    assert rolling["T1"] + rolling["T2"] - rolling["T3"] == pytest.approx(rolling["T"], rel=0.1)


def test_numbers_of_the_prime_system_hold_at_other_speeds():
    plain, fast = at_speeds(ship(MODEL - "heel_yaw"), known_by("Nr", 0.0), (7.33, 14.66))
    assert fast.values["K_prime"] == pytest.approx(plain.values["K_prime"], rel=0.02)
    assert fast.values["K"] == pytest.approx(2.0 * plain.values["K"], rel=0.02)
    assert fast.values["T3"] == pytest.approx(0.5 * plain.values["T3"], rel=0.02)


def test_matrices_hold_another_model_s_ranges_where_it_has_the_same_states():
    known = known_by("Nr", 0.1 * abs(MODEL.value("Nr")))
    own, other = (
        nomoto(ship(MODEL.with_values({"Nr": x * MODEL.value("Nr")})), known) for x in (1.0, 1.5)
    )

    both = own.embracing(other)
    assert both.A_likely[..., 0] == pytest.approx(np.minimum(own.A_likely, other.A_likely)[..., 0])
    assert both.A_likely[..., 1] == pytest.approx(np.maximum(own.A_likely, other.A_likely)[..., 1])
    assert (both.A_likely != own.A_likely).any()
    assert both.ranges["T"][0] < own.ranges["T"][0]
    flat = nomoto(ship(MODEL - "heel_yaw"), known)
    assert own.embracing(flat).B_likely.shape == own.B_likely.shape
    unknown = replace(own, A_likely=np.full_like(own.A_likely, np.nan))
    assert np.isnan(unknown.embracing(other).A_likely).all()


def test_speeds_are_those_of_the_trials(run_folder: Path):
    """The file's own, and another where a trial was approached at it."""
    fit = finished_model(run_folder, silent).fit
    assert approach_speeds(fit) == (7.33,)
    score = fit.scores[0]
    slow = replace(score.trial, signals={**score.trial.signals, "u": np.full(600, 5.0)}, valid={})
    other = replace(fit, scores=(replace(score, trial=slow), *fit.scores[1:]))
    assert approach_speeds(other) == (7.33, 5.0)


def test_without_a_rudder_there_is_none():
    with pytest.raises(DesignError):
        nomoto(ship(MODEL - "linear_rudder"), known_by("Nr", 0.0))


def test_the_command_writes_them(run_folder: Path, tmp_path: Path):
    out = tmp_path / "nomoto.json"
    told = trialid_("export", str(run_folder), "--as", "nomoto", "--out", str(out))
    assert told.exit_code == 0, told.stderr
    found = json.loads(out.read_text(encoding="utf-8"))
    [at] = found["at"]
    assert (found["schema"], at["speed"], at["stable"]) == ("trialid-nomoto/1", 7.33, True)
    assert set(at["numbers"]) == {*NAMES}
    for number in at["numbers"].values():
        low, high = number["likely"]
        assert low < number["value"] < high
    space = at["state_space"]
    A, B = np.array(space["A"]), np.array(space["B"])
    assert (np.array(space["A_from"]) <= A).all()
    assert (np.array(space["A_to"]) >= A).all()
    r = space["states"].index("r")
    steady = -np.linalg.solve(A, B)[r]
    assert steady == pytest.approx(at["numbers"]["K"]["value"])
    true = nomoto(ship(replace(MODEL, effects=MODEL.effects[:3])), known_by("Nr", 0.0)).values
    low, high = at["numbers"]["K"]["likely"]
    assert low < true["K"] < high


@pytest.mark.parametrize("told", [True, False, None])
def test_what_the_record_does_not_tell_the_file_does_not(run_folder: Path, told: bool | None):
    model = finished_model(run_folder, silent)
    part = replace(model.result.accuracy.stability, stable=told)
    accuracy = replace(model.result.accuracy, stability=part)
    doubted = replace(model, result=replace(model.result, accuracy=accuracy))
    found = json.loads(hand_over.WRITERS["nomoto"](doubted, "ship", Wishes())[".json"])
    assert found["at"][0]["stable"] is (None if told is None else True)
    assert (hand_over.UNTOLD in found["words"]) is (told is None)
