"""What a first pipeline chooses by numbers: what is held out, how far apart samples are, sides."""

from functools import partial
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from trialid.workflow.first_pipeline.choice import approach_speed
from trialid.workflow.first_pipeline.held_out import held_out, why_held_out
from trialid.workflow.first_pipeline.sample_period import period
from trialid.workflow.first_pipeline.twin_rudders import sides_of


def logged(
    travel: float = 40.0,
    unit: str = "deg",
    rate: float = 10.0,
    mean: float = 0.0,
    steering: str = "delta",
) -> Any:
    """A trial whose rudder goes so far from one side to the other, all sampled so fast [Hz].

    To one side alone where it has a mean.
    """
    low = 0.0 if mean else -travel / 2.0
    sketch = SimpleNamespace(y=np.array([mean]))
    source = SimpleNamespace(high=low + travel, low=low, rate=rate, unit=unit, sketch=sketch)
    signals = [SimpleNamespace(quantity=n, unit=unit, source=source) for n in (steering, "r")]
    return SimpleNamespace(signals=signals, window=None)


def test_the_trial_in_the_middle_is_held_out() -> None:
    """Of an even number the smaller of the middle two; alone none."""
    assert held_out([logged(40.0), logged(20.0), logged(70.0)]) == 0
    assert held_out([logged(70.0), logged(30.0), logged(40.0), logged(20.0)]) == 1
    assert held_out([logged()]) is None


@pytest.mark.parametrize("steering", ["delta", "rudder_port", "nozzle"])
def test_a_turn_counts_for_more_than_a_zigzag_at_the_same_rudder(steering: str) -> None:
    """And at 35 deg for more than any zig-zag of the usual ones, though its rudder goes 35 deg.

    Of a ferry with two rudders her largest turn was held out, which no zig-zag foretells.
    """
    one = partial(logged, steering=steering)
    zigzags = [one(10.0), one(20.0), one(40.0)]
    assert held_out([zigzags[2], one(35.0, mean=30.0), zigzags[0]]) == 0
    assert held_out([one(20.0, mean=18.0), zigzags[2], zigzags[0]]) == 1
    assert held_out([*zigzags, one(35.0, mean=30.0), one(35.0, mean=-30.0)]) == 2
    assert held_out([one(3.0), *zigzags, one(3.0)]) == 2  # a decay on a course is not steered


def test_of_two_trials_the_one_that_excites_her_more_is_fitted() -> None:
    """A zig-zag and not a steady turn at a larger rudder; of two zig-zags the larger."""
    zigzag, smaller, turn = varied(20.0, -20.0), varied(10.0, -10.0), varied(33.0, 35.0)
    assert [held_out(two) for two in ([zigzag, turn], [turn, zigzag])] == [1, 0]
    assert [held_out(two) for two in ([zigzag, smaller], [smaller, zigzag])] == [1, 0]
    assert why_held_out([zigzag, turn]) == "the one whose rudder varies less"
    assert why_held_out([zigzag, turn, smaller]) == "the middle one by its rudder"
    assert held_out([varied(0.35, -0.35, "rad"), smaller]) == 1


def test_a_decay_is_held_out_only_where_hardly_any_trial_is_steered() -> None:
    """She is let go and her rudder keeps the course: that tells nothing of how she steers."""
    zigzags, decays = [logged(20.0), logged(40.0), logged(30.0)], [logged(3.0)] * 3
    assert held_out([*decays, *zigzags]) == 5
    assert why_held_out([*decays, *zigzags]) == (
        "the middle one of those that are steered, by its rudder"
    )
    assert held_out([*decays, *zigzags[:2]]) == 2
    assert why_held_out([*decays, *zigzags[:2]]) == "the middle one by its rudder"
    assert held_out(decays) == 1


def varied(low: float, high: float, unit: str = "deg") -> Any:
    """A trial whose rudder lies at one angle and at another, as often."""
    made = logged(unit=unit)
    made.signals[0].source.sketch.y = np.array([low, high])
    return made


def test_rudders_count_in_one_unit() -> None:
    """A radian is 57 degrees, not one."""
    assert held_out([logged(1.0, "rad"), logged(20.0), logged(70.0)]) == 0
    assert held_out([logged(0.2, "rad"), logged(20.0), logged(70.0)]) == 1


@pytest.mark.parametrize(
    ("rates", "length", "speed", "wanted"),
    [
        ((10.0, 1.0), 175.0, 7.3, 1.0),  # the slowest signal
        ((100.0, 50.0), 175.0, 7.3, 0.5),  # no faster than a ship
        ((100.0, 50.0), 2.0, 1.0, 0.05),  # than a boat
        ((10.0, 4.0), 2.0, 1.0, 0.25),
    ],
)
def test_samples_are_as_far_apart_as_signals_and_ship_allow(
    rates: tuple[float, ...], length: float, speed: float, wanted: float
) -> None:
    assert period([logged(rate=rate) for rate in rates], length, speed) == wanted


def test_a_slow_compass_beside_a_rate_sets_no_pace() -> None:
    """A heading once a second beside a gyro of 10 Hz; where it alone tells the turn it does."""
    quick, slow = (logged(rate=rate).signals for rate in (10.0, 1.0))
    heading = SimpleNamespace(quantity="psi", unit="deg", source=slow[1].source)
    rated = SimpleNamespace(signals=[*quick, heading], window=None)
    alone = SimpleNamespace(signals=[quick[0], heading], window=None)
    assert period([rated], 2.0, 1.0) == 0.1
    assert period([alone], 2.0, 1.0) == 1.0


def test_a_stated_speed_is_taken_as_it_is() -> None:
    nothing = SimpleNamespace(channels={})
    live: dict[str, Any] = {"u": ()}
    assert approach_speed(nothing, live, 7.33) == (7.33, "as stated")
    assert approach_speed(nothing, live, None) == (None, "")


@pytest.mark.parametrize("share", [0.045, 0.2, 0.6])
def test_a_short_approach_is_one(share: float) -> None:
    """Of trials of 7 minutes of which 20 s were her approach her speed was 1.1 % low."""
    rng = np.random.default_rng(3)
    y = np.where(np.arange(4000) < share * 4000, 5.965, 4.5) + rng.normal(0.0, 0.02, 4000)
    log = SimpleNamespace(
        key="STW", stated_unit="m/s", unit_by_size=None, sketch=SimpleNamespace(y=y)
    )
    speed, words = approach_speed(SimpleNamespace(channels={}), {"u": (log,)}, None)
    assert speed == pytest.approx(5.965, rel=0.008)
    assert words.startswith("what STW seldom exceeds")


@pytest.mark.parametrize(
    ("names", "descriptions"),
    [
        (("rudder_port", "rudder_starboard"), ("", "")),
        (("a", "b"), ("Rudder, instance 0", "Rudder, instance 1")),
    ],
)
def test_two_rudders_by_their_names_or_counted_from_port(
    names: tuple[str, str], descriptions: tuple[str, str]
) -> None:
    """As NMEA 2000 counts them, and engines."""
    port, starboard = (
        SimpleNamespace(name=name, description=words, constant=False, mostly_there=True)
        for name, words in zip(names, descriptions, strict=True)
    )
    found: Any = (starboard, port)
    survey = SimpleNamespace(sources=lambda quantity: found if quantity == "delta" else ())
    trial: Any = SimpleNamespace(survey=survey, quantities={"delta"})
    assert sides_of(trial) == {"n_p": port, "n_s": starboard}
