"""A model ship on a pond: turning tests found, and the track predicted from zig-zags and chance."""

from collections.abc import Sequence

import numpy as np
import pytest
from pond_model import ESSO, HELD, LENGTH, OUTPUTS, fitted
from sailed_tracks import spread

from trialid.design.imo.recognise import recognise
from trialid.design.imo.trial_measures import measure_trials
from trialid.design.imo.trial_numbers import TurnMeasure
from trialid.design.imo.turns import find_turns
from trialid.effects import CATALOGUE
from trialid.identification.fit import Fit

pytestmark = [
    pytest.mark.study(turn=10),
    pytest.mark.real_data,
    pytest.mark.skipif(not ESSO.is_dir(), reason=f"no real records {ESSO}"),
]
TWINS = ("13_39", "13_51")


@pytest.fixture(scope="module")
def pond() -> Fit:
    return fitted()


def test_every_turning_test_is_found_and_no_zigzag_is_one(pond: Fit) -> None:
    for score in pond.scores:
        found = list(find_turns(score.trial, recognise(score.trial, LENGTH, 0.4)))
        assert len(found) == ("turn" in score.trial.name), score.trial.name
        assert all(abs(np.rad2deg(one.rudder)) == pytest.approx(35.0, abs=0.5) for one in found)


def test_the_fit_stands_by_published_formulas(pond: Fit) -> None:
    assert pond.converged
    assert not pond.at_bounds
    assert not {n: z for n, z in pond.contradicted.items() if "[" not in n}


def errors_of_track(pond: Fit) -> dict[str, float]:
    """Of each run, in lengths rms."""
    places, errors = [OUTPUTS.index(c) for c in ("x", "y")], {}
    for score in pond.scores:
        track = np.column_stack([score.trial.signals[c] for c in ("x", "y")])
        off = np.hypot(*(track - score.response.y[:, places]).T)
        errors[score.trial.name] = float(np.sqrt(np.mean(off**2))) / LENGTH
        print(f"{score.trial.use} {score.trial.name}: {errors[score.trial.name]:.2f} lengths rms")
    return errors


def test_the_track_of_runs_that_were_not_fitted(pond: Fit) -> None:
    """Half a length was the goal; the authors' own model leaves 2.9 and 3.6 on two zig-zags."""
    errors = errors_of_track(pond)
    held = [e for n, e in errors.items() if any(h in n for h in HELD)]
    assert len(held) == 2
    assert max(held) < 0.5
    assert max(e for n, e in errors.items() if "turn" not in n) < 0.5


@pytest.mark.xfail(
    reason="1.76 lengths: since 43098525 the search ends lower (0.03739 for 0.03748), where turns "
    "that were not fitted are followed worse (held out 56 % for 44); no fault was found in it yet",
)
def test_the_track_of_turning_tests(pond: Fit) -> None:
    """They go on for six minutes, four times as long as anything that was fitted."""
    assert max(e for n, e in errors_of_track(pond).items() if "turn" in n) < 1.2


@pytest.fixture(scope="module")
def turns(pond: Fit) -> Sequence[TurnMeasure]:
    """What may be missing is any effect of the catalogue."""
    return measure_trials(pond, {}, spread(pond, CATALOGUE)).turns


def test_what_zigzags_foretell_of_turning_tests(turns: Sequence[TurnMeasure]) -> None:
    """No turn was fitted; one of the advances lies apart from the three others."""
    covered, errors = list[bool](), dict[str, list[float]]()
    for m in turns:
        assert m.predicted is not None
        assert m.corrected is not None
        assert m.corrected_for == "wind"
        low, high = m.predicted_interval or (np.nan, np.nan)
        covered.append(bool(low < m.corrected < high))
        ends = "to".join(f" {x:.2f} " for x in m.corrected_interval or ())
        print(
            f"{m.trial} {m.name}: {m.measured:.2f} m, without wind {m.corrected:.2f} ({ends}), "
            f"model {m.predicted:.2f} m ({m.predicted / m.corrected - 1.0:+.0%}), "
            f"{low:.2f} to {high:.2f}"
        )
        assert m.predicted == pytest.approx(m.corrected, rel=0.2)
        assert high - low < 0.6 * m.predicted + 0.25 * LENGTH
        errors.setdefault(m.name, []).append(m.predicted / m.corrected - 1.0)
    print(f"{sum(covered)} of {len(covered)} within the model's bands")
    assert sum(covered) == 12
    for name, off in errors.items():
        assert abs(np.mean(off)) < 0.08, name


def test_two_turns_alike_agree_without_the_wind(turns: Sequence[TurnMeasure]) -> None:
    """As recorded they differ by more than noise of the sensors.

    In one the approach is 9 % faster, and the wind, at three to four times her speed, blows from
    another side.
    """
    first, second = ({m.name: m for m in turns if h in m.trial} for h in TWINS)
    apart = []
    for name, one in first.items():
        (a, b), (c, d) = (x.corrected_interval or (0.0, 0.0) for x in (one, second[name]))
        (e, f), (g, h) = one.interval, second[name].interval
        apart.append(f < g or h < e)
        assert a < d
        assert c < b
    assert sum(apart) == 2


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
