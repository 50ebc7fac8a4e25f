"""Trials that are the same stretch of the same log: none can be held out, nor count twice."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from trialid.errors import PipelineError
from trialid.trial import LogSource, Trial
from trialid.workflow.read_trials import check_own_stretches

PIPELINE = SimpleNamespace(path=Path("p.toml"), trials=())


def of_log(name, begin, seconds, sha256="aa", use="fit"):
    r = np.zeros(seconds + 1)
    logs = (LogSource("bridge.mcap", sha256, "mcap"),)
    valid = np.ones(len(r), np.bool_)
    return Trial(name, use, 1.0, {"r": r}, {"r": valid}, logs=logs, start=begin * 10**9)


@pytest.mark.parametrize("use", ["fit", "check"])
def test_the_same_stretch_is_refused(use):
    trials = (of_log("a", 0, 600), of_log("b", 300, 400, use=use))
    with pytest.raises(PipelineError, match=r"'a' and 'b' are the same 300 s of bridge\.mcap"):
        check_own_stretches(PIPELINE, trials)


def test_other_windows_and_other_logs_are_trials_of_their_own():
    ends = of_log("b", 590, 400)
    check_own_stretches(PIPELINE, (of_log("a", 0, 600), ends, of_log("c", 0, 600, "bb")))


def test_logs_that_are_put_on_another_clock_count_as_stated():
    """The same day's log under two offsets is two parts of it."""
    log = SimpleNamespace(clock=SimpleNamespace(offset=600.0))
    stated = [SimpleNamespace(name=name, logs=[log]) for name in ("a", "b")]
    given = SimpleNamespace(path=Path("p.toml"), trials=stated)
    check_own_stretches(given, (of_log("a", 0, 600), of_log("b", 0, 600)))


@pytest.mark.parametrize("use", ["fit", "check"])
def test_a_copy_under_other_stamps_is_refused(use):
    """Held out it had foretold itself: 5.50 % of 5.52."""
    r = np.random.default_rng(3).normal(size=301)
    begun = of_log("a", 0, 300)
    one = replace(begun, signals={"r": r, "u": np.ones(301)})
    copied = replace(of_log("b", 1000, 300, "bb", use), signals={"r": r.copy(), "u": np.ones(301)})
    with pytest.raises(PipelineError, match="'a' and 'b' hold the same samples, whatever"):
        check_own_stretches(PIPELINE, (one, copied))
    again = replace(copied, signals={"r": r + 1e-9, "u": np.ones(301)})
    check_own_stretches(PIPELINE, (one, again))


DATED = 1_780_477_200  # s, in 2026


def of_day(name, begin, seconds, sha256, seed=4, noise=0.0):
    """A part of one day's record, in a file of its own; what moves with its own noise."""
    day = np.cumsum(np.random.default_rng(seed).normal(size=2000))
    blank = of_log(name, DATED + begin, seconds, sha256)
    own = noise * np.random.default_rng(begin).normal(size=seconds + 1)
    moved = day[begin : begin + seconds + 1] + own
    return replace(blank, signals={"r": moved, "delta": -moved, "n": np.ones(seconds + 1)})


def test_two_logs_of_one_day_that_overlap_are_refused():
    """An outsider held out a third of what was fitted, and no word was said."""
    first, later = of_day("a", 0, 900, "aa"), of_day("b", 600, 900, "bb")
    with pytest.raises(PipelineError, match="'a' and 'b' are the same 300 s of one record, in two"):
        check_own_stretches(PIPELINE, (first, later))
    check_own_stretches(PIPELINE, (first, of_day("b", 890, 900, "bb")))


def test_a_recorder_whose_date_is_wrong_holds_another_run():
    """It says the same hour of all of them, and nothing in them is alike."""
    check_own_stretches(PIPELINE, (of_day("a", 0, 900, "aa"), of_day("b", 600, 900, "bb", seed=5)))


def test_logs_without_a_date_may_begin_at_the_same_second():
    """Two runs with the same orders: nobody knows when they were."""
    one, other = of_day("a", 0, 900, "aa"), of_day("b", 0, 900, "bb", noise=0.1)
    undated = [replace(t, start=t.start - DATED * 10**9) for t in (one, other)]
    check_own_stretches(PIPELINE, undated)
