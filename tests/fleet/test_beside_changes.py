"""What is told beside changes: the order of voyages, copies, models, effects missing since."""

from dataclasses import replace
from datetime import date

import numpy as np
import pytest
from records_of_ships import rows_of

from trialid.fleet.changes import remarks
from trialid.result.fleet_rows import RunRow

DAYS = range(0, 480, 30)


def voyages(many: int = 16, days: range | None = DAYS) -> list[RunRow]:
    return rows_of(np.ones(many), days)[0]


def words(runs: list[RunRow]) -> list[str]:
    assert {each.ship for each in remarks(runs)} <= {"ann"}
    told = [each.words for each in remarks(runs)]
    return [line for line in told if not line.startswith("no changes are sought")]


def test_of_voyages_with_dates_and_one_model_nothing_is_told() -> None:
    assert words(voyages()) == []


def test_voyages_without_dates_are_told_to_be_in_the_order_of_names() -> None:
    told = "no voyage has a date: they are in the order of their names, trip 0 to trip 15"
    assert words(voyages(days=None)) == [told]
    assert words(voyages(5, None)) == []  # too few for a change


def test_ships_with_too_few_voyages_for_changes_are_told_in_one_line() -> None:
    """`changes found: 0` of five voyages said that none had been; nobody had looked."""
    five = voyages(5, DAYS[:5])
    runs = [replace(row, ship=ship) for ship in ("ann", "bea") for row in five]
    (told,) = remarks([*runs, *(replace(row, ship="cid") for row in voyages())])
    assert told.ship == "ann and bea"
    assert told.words.startswith("no changes are sought: it takes 6 voyages with a fit")
    assert remarks(voyages(6, DAYS[:6])) == ()
    undated = [replace(row, date=None) if k else row for k, row in enumerate(voyages())]
    assert remarks(undated)[-1].words == told.words
    assert remarks(voyages(1, DAYS[:1])) == ()  # of one voyage nobody expects it


def test_some_without_a_date_are_named() -> None:
    runs = [replace(row, date=None) if k in (3, 7) else row for k, row in enumerate(voyages())]
    assert words(runs) == [
        "2 of 16 voyages have no date, and no say in her changes: trip 3 and trip 7"
    ]


def test_a_day_that_no_calendar_has_is_told() -> None:
    names = ["2024-02-30 trip", "2024-02-29 trip"]
    runs = [replace(voyages()[k], voyage=name, date=None) for k, name in enumerate(names)]
    told = "2024-02-30 trip begins with no day of the calendar; write when it was into dates"
    assert words(runs) == [told]


def test_copied_voyages_are_told_in_one_line() -> None:
    logs = {k: f"{k}:700" for k in range(16)} | {5: "2:700", 9: "7:700, 8:700"}
    runs = [replace(row, logs=logs[k]) for k, row in enumerate(voyages())]
    told = "trip 2 = trip 5, trip 7 = trip 9 and trip 8 = trip 9"
    assert words(runs) == [
        f"voyages hold the same log, and count as if they were independent: {told}"
    ]
    twice = [row for row in runs[:3] for row in (row, replace(row, run=row.run + "x", seed=4))]
    assert words(twice) == []  # a voyage done in two ways is one


def test_models_that_differ_are_told_with_what_differs() -> None:
    first = {"effects": "hull, drag", "free": "GM, Nr"}
    other = {"effects": "hull, memory", "free": "GM"}
    runs = [replace(row, **(first if k < 10 else other)) for k, row in enumerate(voyages())]
    (told,) = words(runs)
    assert told.endswith(
        "10 voyages have that of trip 0; 6 that of trip 10, with memory, without drag, Nr not free"
    )


def missing(row: RunRow, *family: str) -> RunRow:
    return replace(row, verdict="missing", effect=family[0], family=", ".join(family))


def test_that_runs_have_no_fit_from_a_voyage_on_is_told() -> None:
    """Of an outsider's ship every sensor was another from the seventh voyage on: no change."""
    runs = [replace(row, verdict="no fit") if k >= 6 else row for k, row in enumerate(voyages(12))]
    (told,) = words(runs)
    assert told.startswith("from trip 6 on 6 of 6 runs have no fit, before 0 of 6: something is")
    here_and_there = [
        replace(row, verdict="no fit") if k in (1, 4, 9) else row
        for k, row in enumerate(voyages(12))
    ]
    assert words(here_and_there) == []


def test_an_effect_missing_from_a_voyage_on_is_told() -> None:
    runs = [
        missing(row, "rudder_scale", "Kdelta", *(["roll_cubic"] if k % 3 else []))
        if k >= 8
        else row
        for k, row in enumerate(voyages())
    ]
    told = (
        "from trip 8 on rudder_scale or Kdelta is missing in 8 of 8, before in 0 of 8: a change of "
        "that may stand in the changes told"
    )
    assert words(runs) == [told]
    (back,) = words(list(reversed(runs)))
    assert "is missing in 0 of 8, before in 8 of 8" in back


@pytest.mark.study(turn="each")
def test_effects_missing_here_and_there_are_missing_since_no_voyage() -> None:
    """Each second voyage or by chance: one ship of twenty at most."""
    runs = voyages()
    assert words([missing(row, "a") if k % 2 else row for k, row in enumerate(runs)]) == []
    assert words([missing(row, "a") for row in runs]) == []
    alarms = 0
    for seed in range(100):
        rng = np.random.default_rng(seed)
        drawn = [rng.choice(list("abcdefgh"), rng.integers(0, 4), replace=False) for _ in runs]
        told = [missing(r, *map(str, d)) if len(d) else r for r, d in zip(runs, drawn, strict=True)]
        alarms += bool(words(told))
    assert alarms <= 5


def test_runs_without_a_fit_are_missing_nothing() -> None:
    runs = [replace(row, date=date(2024, 1, 1), failure="empty") for row in voyages()]
    assert words(runs) == []


@pytest.mark.parametrize(("samples", "told"), [(19, True), (81, True), (160, False), (1000, False)])
def test_a_log_that_is_cut_off_is_told(samples: int, told: bool) -> None:
    """An outsider's voyage lost a zig-zag but for 19 s, and was fitted as if it were whole."""
    logs = [f"{k:064x}:300, {k + 1000:064x}:{320 + k}" for k in range(16)]
    logs[5] = f"{5:064x}:301, {1005:064x}:{samples}"
    runs = [replace(row, logs=each) for row, each in zip(voyages(), logs, strict=True)]
    said = f"trip 5: log 2 of 2 has {samples} samples, in her other voyages 328: was it cut off?"
    assert words(runs) == [said] * told
    two = [
        replace(row, logs=each) for row, each in zip(voyages()[:2], (logs[4], logs[5]), strict=True)
    ]
    said = f"trip 1: log 2 of 2 has {samples} samples, in her other voyages 324: was it cut off?"
    runs = [replace(row, voyage=f"trip {k}") for k, row in enumerate(two)]
    assert (said in words([*runs, runs[1]])) is told
    assert words([*runs, runs[1]]).count(said) == told
