"""Wind and current told apart where the record can, and said where it cannot."""

from dataclasses import replace

import numpy as np
import pytest
from sailed_tracks import SETTINGS, SHIP, accuracy, trials
from sailed_wind import WINDY
from wind_and_current import MODELS, one, record

from trialid.design.wind_and_current import WORDS, cannot_tell
from trialid.identification.fit import identify
from trialid.threads import one_thread

READ = MODELS["read"]


def test_a_full_turn_tells_and_a_small_zigzag_in_little_current_does_not() -> None:
    """The weather of this seed: a current of 0.15 m/s, a wind of 9.3 m/s."""
    seed = 306
    turn, zigzag = (record(name, seed, *READ) for name in ("circle", "small zigzag"))
    assert cannot_tell(turn, accuracy(turn)) == ()
    [said] = cannot_tell(zigzag, accuracy(zigzag))
    assert said.startswith(f"{WORDS} in small zigzag (")
    assert said.endswith("sail a full turn in the same wind and water")


def test_without_a_wind_in_the_model_what_it_drifts_her_is_said_to_count_as_current() -> None:
    fit = identify(trials(0), SHIP, SETTINGS)
    [said] = cannot_tell(fit, accuracy(fit))
    assert said.startswith(WORDS)
    assert "add steady_wind" in said
    blind = replace(SETTINGS, nuisance=("initial_state",))
    fit = identify(trials(0, True), SHIP, blind)
    assert cannot_tell(fit, accuracy(fit)) == ()


def test_a_wind_that_is_held_is_said_to_be() -> None:
    fit = record("circle", 306, WINDY, ())
    [said] = cannot_tell(fit, accuracy(fit))
    assert "the model's wind is held: free it" in said


@pytest.mark.study(turn=1)
@one_thread
def test_a_full_turn_tells_and_what_is_told_is_right() -> None:
    for name, least in (("circle", 0.95), ("zigzag", 0.0)):
        found = [one(name, seed, *READ) for seed in range(40)]
        told = [x for x in found if x.told]
        right = np.mean([h for x in told for h in x.holds])
        print(f"{name}: told {len(told)} of {len(found)}, right {right:.3f}")
        assert len(told) >= least * len(found)
        assert right >= 0.93
