"""Speeds by the slope of positions: as well as they tell, and refused where she has turned on."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.alignment.track.body_velocity import slope_of_positions, with_velocity
from trialid.errors import AlignmentError
from trialid.trial import Trial

PERIOD = 0.2


def circled(rate: float, scatter: float = 0.02, speed: float = 2.0) -> SimpleNamespace:
    """Positions of a boat that turns at so many rad/s, each off by so many metres."""
    t = PERIOD * np.arange(600)
    psi, rng = rate * t, np.random.default_rng(4)
    north = speed / rate * np.sin(psi) + scatter * rng.standard_normal(len(t))
    east = speed / rate * (1.0 - np.cos(psi)) + scatter * rng.standard_normal(len(t))
    return SimpleNamespace(north=north, east=east, psi=psi, known=np.ones(len(t), np.bool_))


def test_the_slope_is_her_velocity() -> None:
    one = circled(0.2)
    made = slope_of_positions(one.north, one.east, one.psi, one.known, PERIOD)
    assert made is not None
    assert not made.known[[0, 1, -2, -1]].any()  # a parabola tells less at its ends
    assert made.known.sum() > 580
    np.testing.assert_allclose((made.north - 2.0 * np.cos(one.psi))[made.known], 0.0, atol=0.2)
    np.testing.assert_allclose((made.east - 2.0 * np.sin(one.psi))[made.known], 0.0, atol=0.2)


def test_a_fix_that_the_log_repeats_is_one() -> None:
    """A receiver of 1 Hz in a table of 5: 0, 0, 0 and 6 m/s were taken of a boat at 2."""
    one = circled(0.1)
    held = np.arange(600) // 5 * 5
    made = slope_of_positions(one.north[held], one.east[held], one.psi, one.known, PERIOD)
    assert made is not None
    assert made.known.sum() > 500
    speed = np.hypot(made.north, made.east)[made.known]
    np.testing.assert_allclose(speed, 2.0, atol=0.15)


def test_a_position_that_is_no_number_is_not_known() -> None:
    one = circled(0.2)
    one.north[100] = np.nan
    one.known[100] = False
    made = slope_of_positions(one.north, one.east, one.psi, one.known, PERIOD)
    assert made is not None
    assert np.isfinite(made.north[made.known]).all()
    assert not made.known[100]


def test_a_slope_is_no_chord_of_a_turn() -> None:
    """Five samples of a second's turn of 1.5 rad: a chord a tenth shorter than her way."""
    one = circled(1.5)
    assert slope_of_positions(one.north, one.east, one.psi, one.known, PERIOD) is None


def test_a_fix_that_is_lost_takes_the_slopes_across_it_away() -> None:
    one = circled(0.2)
    one.known[300] = False
    made = slope_of_positions(one.north, one.east, one.psi, one.known, PERIOD)
    assert made is not None
    assert not made.known[299:302].any()
    assert made.known[20:280].all()


@pytest.mark.parametrize(
    ("lacks", "more", "said"),
    [
        ("psi", (), "turns a velocity by her heading; map psi"),
        ("x", (), "needs sog and cog, or a position"),
        ("", ("u",), "a signal is mapped to u"),
    ],
)
def test_what_is_wrong_is_one_line(lacks: str, more: tuple[str, ...], said: str) -> None:
    one = circled(0.2)
    signals = {"x": one.north, "y": one.east, "psi": one.psi, **dict.fromkeys(more, one.psi)}
    signals = {n: x for n, x in signals.items() if n != lacks}
    trial = Trial("pond", "fit", PERIOD, signals, dict.fromkeys(signals, one.known))
    with pytest.raises(AlignmentError, match=said) as told:
        with_velocity(trial)
    assert "\n" not in str(told.value)


def test_in_her_own_axes_a_steady_turn_has_one_velocity() -> None:
    one = circled(0.2)
    signals = {"x": one.north, "y": one.east, "psi": one.psi + 0.1}  # she drifts by 0.1 rad
    made = with_velocity(Trial("pond", "fit", PERIOD, signals, dict.fromkeys(signals, one.known)))
    u, v = (made.signals[name][made.valid[name]] for name in ("u", "v"))
    assert np.mean(u) == pytest.approx(2.0 * np.cos(0.1), abs=0.02)
    assert np.mean(v) == pytest.approx(-2.0 * np.sin(0.1), abs=0.02)
    assert "over the ground by positions" in made.remarks[-1]
