"""KVLCC2 in a tank: her track integrated from a model that never saw a position or a heading."""

from pathlib import Path

import numpy as np
import pytest

from trialid.design.imo.recognise import recognise
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.identification.trial_score import of_trial
from trialid.ship.model import ShipModel
from trialid.ship.particulars import read_ship
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial

HERE = Path(__file__).parent
HSVA = HERE.parents[2] / "shared" / "data" / "kvlcc2_hsva_zigzag"
pytestmark = [
    pytest.mark.study,
    pytest.mark.real_data,
    pytest.mark.skipif(not HSVA.is_dir(), reason=f"no real records {HSVA}"),
]
LENGTH = 7.0
HELD = ("Z_10_10", "Z_15_05", "Z_20_10")
FREE = ("Yv", "Yr", "Nv", "Nr", "N_un", "N_nn", "N_n", "delta_0", "Nrar", "Yvav")
EFFECTS = (
    *("linear_hull", "yaw_drag_rar", "sway_drag_vav"),
    *("rudder_race_shaft", "rudder_offset", "propeller_side_force"),
)
"""One screw, whose revolutions are recorded: its race, and its push to the side."""
TRACK = ("x", "y")


def record(path: Path) -> Trial:
    """A run at 4 Hz; the speeds along and across the tank turned by the heading."""
    lines = path.read_bytes().decode("cp1252").splitlines()[4:]
    c = np.array([[float(x) for x in line.split()[:10]] for line in lines if line.strip()])[::5]
    psi = np.deg2rad(c[:, 3])
    u = c[:, 4] * np.cos(psi) + c[:, 5] * np.sin(psi)
    v = c[:, 5] * np.cos(psi) - c[:, 4] * np.sin(psi)
    signals = {"x": c[:, 1], "y": c[:, 2], "psi": psi, "u": u, "v": v}
    signals |= {"r": np.deg2rad(c[:, 6]), "delta": -np.deg2rad(c[:, 8])}
    signals["n"] = 2.0 * np.pi * c[:, 9]
    signals = {n: x.copy() for n, x in signals.items()}
    valid = {n: np.ones(len(x), dtype=bool) for n, x in signals.items()}
    name = path.stem.removeprefix("HSVA_CPMC_KVLCC2_")
    held = name.startswith(HELD)
    return Trial(name, "check" if held else "fit", 0.25, signals, valid)


def test_the_track_follows_from_rates_alone() -> None:
    """Fitted to r and v; heading and place of every run are integrals that nothing corrected."""
    ship = read_ship(HERE.parent / "real_records" / "kvlcc2_hsva.toml")
    model = ShipModel(ship, ("v", "r"), tuple(CATALOGUE[e] for e in EFFECTS), {"z_race": 0.0})
    trials = [record(p) for p in sorted(HSVA.glob("*.dat"))]
    fit = identify(trials, model, Settings(FREE, ("r", "v"), nuisance=("initial_state",)))
    sailed = ShipModel(ship, ("v", "r", "psi", "x", "y"), fit.model.effects, fit.model.values)
    simulator = prepare(sailed, (), TRACK)
    errors = {}
    for trial in trials:
        _, start = of_trial(fit, trial)
        response = respond(simulator, trial, {}, start, sensitivities=False)
        assert response.departure is None
        there = np.column_stack([trial.signals[c] for c in TRACK])
        off = float(np.sqrt(np.mean(np.sum((there - response.y) ** 2, axis=1)))) / LENGTH
        sailed_for = float(np.hypot(*np.diff(there, axis=0).T).sum()) / LENGTH
        errors[trial.name] = off / sailed_for
        print(f"{trial.use} {trial.name}: {off:.2f} lengths rms in {sailed_for:.0f} sailed")
    held = [e for n, e in errors.items() if n.startswith(HELD)]
    assert len(held) == 3
    assert max(held) < 0.02
    assert max(errors.values()) < 0.04


def test_zigzags_that_were_recorded_from_a_second_before_the_order_are_known() -> None:
    """Six of seven; of the 5/1 the heading changes by less than a course is kept within."""
    for path in HSVA.glob("*.dat"):
        trial = record(path)
        kinds = [(m.kind, m.remark) for m in recognise(trial, LENGTH, 1.18)]
        assert kinds == ([] if "05_01" in trial.name else [("zig-zag", "")]), trial.name
