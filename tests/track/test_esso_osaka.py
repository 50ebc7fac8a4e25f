"""A model ship on a pond: turning tests found, and the track predicted from zig-zags alone."""

from pathlib import Path

import numpy as np
import pytest
from sailed_tracks import accuracy

from trialid.design.imo.recognise import recognise
from trialid.design.imo.trial_measures import measure_trials
from trialid.design.imo.trial_numbers import TurnMeasure
from trialid.design.imo.turns import find_turns
from trialid.design.prediction.likely_spread import likely_spread
from trialid.diagnosis.may_be_off import doubts
from trialid.diagnosis.search.augment import augment
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit, identify
from trialid.identification.problem import Settings
from trialid.ship.model import ShipModel
from trialid.ship.particulars import Ship
from trialid.trial import Trial

ESSO = Path(__file__).parents[3] / "shared" / "data" / "esso_osaka"
pytestmark = [
    pytest.mark.study,
    pytest.mark.real_data,
    pytest.mark.skipif(not ESSO.is_dir(), reason=f"no real records {ESSO}"),
]
LENGTH = 3.0
HELD = ("13_22_52", "13_29_19")
"""Zig-zags at two other revolutions than most, held out with all turning tests."""

SHIP = Ship(
    name="Esso Osaka, 3 m",
    source="FRT-DS-ESSO, its README; added masses and first values those of a tanker",
    system="prime",
    rudder_positive="starboard",
    particulars={"L": LENGTH, "rho": 1000.0, "g": 9.81, "nabla": 0.2446, "U0": 0.4},
    mass={
        **{"m": 0.018119, "x_G": 0.03133, "I_zz": 0.00115},
        **{"Xudot": -0.0013, "Yvdot": -0.0145, "Nrdot": -0.0007},
    },
    coefficients={
        **{"Yv": -0.0205, "Yr": 0.004, "Nv": -0.0089, "Nr": -0.0032},
        **{"Kv": 0.0, "Kr": 0.0, "Kdelta": 0.0, "Ydelta": -0.003, "Ndelta": 0.0015},
    },
)
EFFECTS = (
    *("linear_hull", "linear_rudder", "rudder_slipstream", "apparent_wind", "apparent_wind_yaw"),
    *("sway_drag_vav", "sway_drag_var", "yaw_drag_vav", "yaw_drag_var", "yaw_drag_rar"),
)
FREE = (
    *("Yv", "Yr", "Nv", "Nr", "Ndelta", "Ydelta", "N_slip", "C_aw", "N_aw"),
    *("Yvav", "Yvar", "Nvav", "Nvar", "Nrar"),
)
TWINS = ("13_39", "13_51")
OUTPUTS = ("r", "v", "psi", "x", "y")


def record(path: Path) -> Trial:
    """A run at 2 Hz from where it is under way; without the rows of commas at its end."""
    lines = [x for x in path.read_text(encoding="utf-8").splitlines()[1:] if x.strip(",")]
    table = np.array([[float(x) for x in line.split(",")[:11]] for line in lines])[::5]
    names = ("t", "x", "u", "y", "v", "psi", "r", "n", "delta", "V_aw", "gamma_aw")
    signals = dict(zip(names, table.T, strict=True))
    del signals["t"]
    for angle in ("psi", "gamma_aw"):
        signals[angle] = np.unwrap(signals[angle])
    signals["n"] = signals["n"] * 2.0 * np.pi
    begin = int(np.argmax(signals["u"] > 0.15)) if "zigzag" in path.stem else 0
    signals = {n: x[begin:].copy() for n, x in signals.items()}
    valid = {n: np.ones(len(x), dtype=bool) for n, x in signals.items()}
    held = "turn" in path.stem or any(name in path.stem for name in HELD)
    return Trial(path.stem, "check" if held else "fit", 0.5, signals, valid)


@pytest.fixture(scope="module")
def pond() -> Fit:
    """Fitted to five zig-zags with the speed from the record; all else is held out."""
    trials = [record(p) for p in sorted(ESSO.glob("*.csv")) if "random" not in p.stem]
    model = ShipModel(SHIP, ("v", "r", "psi", "x", "y"), tuple(CATALOGUE[e] for e in EFFECTS))
    small = {"z_slip": 0.0, "z_aw": 0.0, "N_2aw": 0.0}
    settings = Settings(FREE, OUTPUTS, nuisance=("initial_state",))
    return identify(trials, model.with_values(small), settings)


def test_every_turning_test_is_found_and_no_zigzag_is_one(pond: Fit) -> None:
    for score in pond.scores:
        found = list(find_turns(score.trial, recognise(score.trial, LENGTH, 0.4)))
        assert len(found) == ("turn" in score.trial.name), score.trial.name
        assert all(abs(np.rad2deg(one.rudder)) == pytest.approx(35.0, abs=0.5) for one in found)


def test_the_track_of_runs_that_were_not_fitted(pond: Fit) -> None:
    """The authors' own model leaves 2.9 and 3.6 ship lengths on two zig-zags."""
    places, errors = [OUTPUTS.index(c) for c in ("x", "y")], {}
    for score in pond.scores:
        track = np.column_stack([score.trial.signals[c] for c in ("x", "y")])
        off = np.hypot(*(track - score.response.y[:, places]).T)
        errors[score.trial.name] = float(np.sqrt(np.mean(off**2))) / LENGTH
        print(f"{score.trial.use} {score.trial.name}: {errors[score.trial.name]:.2f} lengths rms")
    held = {n: e for n, e in errors.items() if "turn" in n or any(h in n for h in HELD)}
    assert float(np.median([*held.values()])) < 0.6
    assert max(held.values()) < 2.0
    assert max(e for n, e in errors.items() if n not in held) < 0.25


def test_two_turns_alike_and_the_model_beside_them(pond: Fit) -> None:
    """Less the wind they agree within their intervals, which are wide: the wind is hardly known.

    As recorded they differ by more than noise of the sensors: in one the approach is 9 % faster,
    and the wind, at three to four times her speed, blows from another side. The model never saw a
    turn; what may be missing of it is any effect of the catalogue.
    """
    others = {n: e for n, e in CATALOGUE.items() if n not in EFFECTS}
    off = doubts(pond, augment(pond, others))
    known = accuracy(pond).covariance
    spread = likely_spread(pond, known, off.standing, off.held, off.missing)
    found: dict[str, dict[str, TurnMeasure]] = {}
    covered = []
    for m in measure_trials(pond, {}, spread).turns:
        assert m.predicted is not None
        assert m.corrected is not None
        assert m.corrected_for == "wind"
        low, high = m.predicted_interval or (np.nan, np.nan)
        covered.append(low < m.corrected < high)
        calm = f"{m.measured:.2f} m, without wind {m.corrected:.2f} {m.corrected_interval}"
        told = f"model {m.predicted:.2f} m ({m.predicted / m.corrected - 1.0:+.1%})"
        print(f"{m.trial} {m.name}: {calm}, {told}, {low:.2f} to {high:.2f}")
        found.setdefault(m.trial, {})[m.name] = m
        assert m.predicted == pytest.approx(m.corrected, rel=0.2)
    print(f"{sum(covered)} of {len(covered)} within the model's bands")
    assert sum(covered) >= 10
    first, second = (next(x for n, x in found.items() if h in n) for h in TWINS)
    for name, one in first.items():
        assert second[name].measured == pytest.approx(one.measured, rel=0.13)
        (a, b), (c, d) = (x.corrected_interval or (0.0, 0.0) for x in (one, second[name]))
        assert a < d
        assert c < b


def test_why_two_turns_alike_differ(pond: Fit) -> None:
    """What was recorded of both: revolutions and rudder are one, speed and wind are not."""
    told = []
    for trial in (s.trial for s in pond.scores if any(h in s.trial.name for h in TWINS)):
        [one] = recognise(trial, LENGTH, 0.4)
        g, turn = trial.signals, slice(one.execute, one.end)
        blown = [
            (np.gradient(g[place], trial.period) - g["V_aw"] * side)[turn].mean()
            for place, side in (
                ("x", np.cos(g["psi"] + g["gamma_aw"])),
                ("y", np.sin(g["psi"] + g["gamma_aw"])),
            )
        ]
        speed = float(g["u"][one.execute - 20 : one.execute].mean())
        told.append((np.rad2deg(one.rudder), float(np.median(g["n"][turn])), speed, *blown))
        print(f"{trial.name}: {speed:.3f} m/s at the order, wind {blown[0]:+.2f} {blown[1]:+.2f}")
    (rudder, n, speed, north, _), (same, also, faster, south, _) = told
    assert rudder == pytest.approx(same, abs=0.1)
    assert n == pytest.approx(also, rel=0.01)
    assert faster > 1.07 * speed
    assert north < -2.0 * speed
    assert south > 2.0 * speed
