"""Turning numbers less the wind: what the same ship would have done in calm air."""

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from sailed_tracks import EXACT, OUTPUTS, SHIP, accuracy, sailed, spread
from sailed_wind import SETTINGS, WATERS, WINDY, blown, noisy

from trialid.design.helm import Passage
from trialid.design.imo.calm_air import _motion_at
from trialid.design.imo.measures import overshoots
from trialid.design.imo.recognise import recognise
from trialid.design.imo.sailed_trial import is_wind
from trialid.design.imo.trial_measures import TrialMeasures, measure_trials
from trialid.design.imo.turns import find_turns, measure
from trialid.diagnosis.search.freed import free_coefficient
from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.simulation.integrate import prepare, respond
from trialid.trial import Trial


def in_calm_air() -> dict[str, float]:
    """Measures of the true ship that comes to the order as fast as in the wind, and straight."""
    windy, (*names,) = blown("circle"), (*OUTPUTS, "u")
    inputs = {n: windy.signals[n] for n in ("delta", "n", "V_aw", "gamma_aw")}
    in_wind = Trial("circle", "fit", 2.0, inputs, {})
    y = respond(prepare(WINDY, (), names), in_wind, {}, {"psi": 0.7}, sensitivities=False).y
    k, speed = 15, float(y[15, -1])
    turn = Trial("circle", "fit", 2.0, {n: x[k:] for n, x in inputs.items()}, {})
    start = dict.fromkeys(SHIP.states, 0.0) | {"u": speed, "psi": 0.7}
    y = respond(prepare(SHIP, (), OUTPUTS), turn, {}, start, sensitivities=False).y
    run = 2.0 * speed * np.arange(-k, 0)
    straight = {"psi": np.full(k, 0.7), "x": run * np.cos(0.7), "y": run * np.sin(0.7)}
    track = {n: np.append(x, y[:, OUTPUTS.index(n)]) for n, x in straight.items()}
    return measures_of(replace(windy, signals={**windy.signals, **track}))


def measures_of(trial: Trial) -> dict[str, float]:
    [turn] = find_turns(trial, recognise(trial, 175.0, 7.33))
    return measure(replace(turn, t=30.0), trial.t, trial.signals)


def measured(seed: int, but: str | None = None) -> TrialMeasures:
    """Of the trials as logged, or as they would be were the noise of all but one output nothing."""
    rng = np.random.default_rng([31, seed])
    logs = [noisy(blown(n), rng, air=1.0 if but is None else 0.0) for n in WATERS]
    if but is not None:
        logs = [without_noise(t, blown(t.name), but) for t in logs]
    exact = replace(WINDY, ship=replace(WINDY.ship, uncertainty=EXACT))
    fit = identify(logs, exact, SETTINGS)
    errors = {p.name: p.standard_error for p in accuracy(fit).parameters}
    return measure_trials(fit, errors, spread(fit, {}))


def without_noise(noisy: Trial, clean: Trial, but: str) -> Trial:
    """A thousandth of it is left: with none at all nothing could be told of its size."""
    left = {n: 1.0 if n == but else 0.001 for n in clean.signals}
    less = {n: x + left[n] * (noisy.signals[n] - x) for n, x in clean.signals.items()}
    return replace(clean, signals=less)


@pytest.mark.study(turn="each")
def test_the_drift_taken_off_goes_on_from_how_she_lay_and_is_as_open_as_her_gyro_leaves_it() -> (
    None
):
    """She comes to the order heeled by the wind; of 60 records drifts scattered by 1.26 m."""
    calm, wind = in_calm_air(), measures_of(blown("circle"))
    advance, *_ = measured(1, "none").turns
    drift = (advance.corrected or 0.0) - advance.measured
    assert drift == pytest.approx(calm["advance"] - wind["advance"], abs=0.2)
    advance, *_ = measured(1, "r").turns
    assert 1.1 < np.ptp(advance.corrected_interval or (0.0, 0.0)) / 3.92 < 1.6


def test_less_current_and_wind_it_is_the_ship_in_calm() -> None:
    calm, wind = in_calm_air(), measures_of(blown("circle"))
    rows = measured(1).turns
    assert [m.name for m in rows] == ["advance", "transfer", "tactical diameter"]
    for m in rows:
        assert m.corrected_for == "current and wind"
        assert m.interval[0] < wind[m.name] < m.interval[1]
        for low, high in (m.corrected_interval or (0.0, 0.0), m.predicted_interval or (0.0, 0.0)):
            assert low < calm[m.name] < high
            assert high - low < 40.0
    assert max(abs(wind[m.name] - calm[m.name]) for m in rows) > 60.0  # what it is about


def test_an_overshoot_less_the_wind_is_that_of_calm_air() -> None:
    """Under the same rudder, which is that of a helmsman in calm air; nothing for the current."""
    calm = sailed("zigzag", (0.0, 0.0))
    truth = overshoots(Passage(calm, calm.signals["x"], calm.signals["y"], None))[0]
    [row] = [m for m in measured(1).numbers if m.name == "first overshoot"]
    assert row.interval[1] < truth - np.deg2rad(0.5)  # what it is about
    assert row.corrected_for == "wind"
    assert row.corrected == pytest.approx(truth, abs=np.deg2rad(0.5))
    for low, high in (row.corrected_interval or (0.0, 0.0), row.predicted_interval or (0.0, 0.0)):
        assert low < truth < high
        assert high - low < np.deg2rad(4.0)


def test_what_is_wind_and_what_is_not() -> None:
    """What frees a held coefficient has its own name, and blows no less."""
    steady = {"F_N": 0.001, "F_E": 0.0, "x_wind": 0.05, "k_wind": 0.3, "z_wind": 0.05}
    windy = (SHIP + CATALOGUE["steady_wind"]).with_values(steady)
    assert is_wind(free_coefficient(windy, "x_wind"))
    assert is_wind(free_coefficient(WINDY, "z_aw"))
    known = {n for n, e in CATALOGUE.items() if is_wind(e)}
    assert known == {"steady_wind", *(n for n in CATALOGUE if n.startswith("apparent_wind"))}
    assert not is_wind(free_coefficient(WINDY, "Nphi"))


@pytest.mark.study(turn=14)
def test_corrected_intervals_hold_the_calm_truth() -> None:
    calm, inside = in_calm_air(), []
    for seed in range(1, 25):
        for m in measured(seed).turns:
            low, high = m.corrected_interval or (np.nan, np.nan)
            least, most = m.predicted_interval or (np.nan, np.nan)
            inside.append((low < calm[m.name] < high, least < calm[m.name] < most))
    record, model = np.mean(inside, axis=0)
    print(
        f"{len(inside)} less current and wind within 95 %: record {record:.3f}, model {model:.3f}"
    )
    assert record >= 0.9
    assert model >= 0.9


def test_she_begins_with_what_the_record_has_before_the_order() -> None:
    """The model was led elsewhere: its rate and heading are mended, what nobody compared is not."""
    t, simulated = np.arange(400.0), np.array([7.0, 0.2, 0.001, 0.5])
    measured = {"r": np.full(400, 0.003), "psi": np.full(400, 0.65)}
    trial = Trial("turn", "check", 1.0, measured, {n: t >= 0.0 for n in measured})
    response = SimpleNamespace(
        states=np.tile(simulated, (400, 1)), y=np.tile(simulated[2:], (400, 1))
    )
    score = SimpleNamespace(trial=trial, response=response, compared=np.ones((400, 2), dtype=bool))
    model = SimpleNamespace(
        ship=SimpleNamespace(particulars={"L": 175.0, "U0": 7.0}), all_states=("u", "v", "r", "psi")
    )
    fit: Any = SimpleNamespace(
        scores=[score],
        model=model,
        problem=SimpleNamespace(outputs=("r", "psi"), simulator=SimpleNamespace(model=model)),
    )
    motion = _motion_at(fit, trial, 200)
    assert motion.values == pytest.approx({"u": 7.0, "v": 0.2, "r": 0.003, "psi": 0.65})
    assert motion.noise == pytest.approx({"r": 0.0, "psi": 0.0}, abs=1e-9)
