"""Nomoto's K and T: what a small order does in time, ranges that follow, unstable ships told."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import s175q
from test_bad_input import trialid_
from test_simulate import known_by

from trialid.design.helm import sail, vessel
from trialid.design.steering.nomoto import NAMES, nomoto
from trialid.effects import CATALOGUE
from trialid.errors import DesignError
from trialid.ship.model import ShipModel

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


def test_a_ship_that_is_not_stable_is_told():
    wild = MODEL.with_values({"Nv": 4.0 * MODEL.value("Nv")})
    found = nomoto(ship(wild), known_by("Nr", 0.0))
    assert not found.stable
    assert found.values["K"] < 0.0


def test_without_a_rudder_there_is_none():
    with pytest.raises(DesignError):
        nomoto(ship(MODEL - "linear_rudder"), known_by("Nr", 0.0))


def test_the_command_writes_them(run_folder: Path, tmp_path: Path):
    out = tmp_path / "nomoto.json"
    told = trialid_("export", str(run_folder), "--as", "nomoto", "--out", str(out))
    assert told.exit_code == 0, told.stderr
    found = json.loads(out.read_text(encoding="utf-8"))
    assert (found["schema"], found["speed"], found["stable"]) == ("trialid-nomoto/1", 7.33, True)
    for number in found["numbers"].values():
        low, high = number["likely"]
        assert low < number["value"] < high
    true = nomoto(ship(replace(MODEL, effects=MODEL.effects[:3])), known_by("Nr", 0.0)).values
    low, high = found["numbers"]["K"]["likely"]
    assert low < true["K"] < high
