"""How large a change must be to be told, held against changes that are sought."""

from dataclasses import replace

import numpy as np
import pytest
from records_of_ships import rows_of

from trialid.fleet.changes import changes, told_from
from trialid.result.fleet_rows import Remark


def share_told(seed: int, voyages: int) -> float:
    """From which share of the level on a step is told, by the line of a record without any."""
    runs, fitted = rows_of(np.full(voyages, 0.8), None, seed)
    assert not [*changes(runs, fitted)]
    return share_of(*told_from(runs, fitted, ()))


def share_of(line: Remark) -> float:
    """Of the one parameter that a line is of."""
    words = line.words.replace("\N{NARROW NO-BREAK SPACE}", " ")
    assert words.endswith("of GM; less may have passed")
    return float(words.partition("as likely told as not at ")[2].split(" %")[0]) / 100.0


@pytest.mark.parametrize("voyages", [8, 16])
def test_a_step_is_told_from_about_there_on(voyages: int) -> None:
    """Of 20 records, half as large a step in two at most, as large in some, twice in nearly all."""
    half = np.arange(voyages) >= voyages // 2
    told = {0.5: 0, 1.0: 0, 2.0: 0}
    for seed in range(400, 420):
        least = 0.8 * share_told(seed, voyages)
        for times in told:
            runs, fitted = rows_of(0.8 - times * least * half, None, seed)
            told[times] += any(row.form == "step" for row in changes(runs, fitted))
    assert told[0.5] <= 2
    assert 4 <= told[1.0] <= 16
    assert told[2.0] >= 18


@pytest.mark.parametrize("seed", range(420, 424))
def test_what_passed_unseen_does_not_count_as_scatter(seed: int) -> None:
    least = 0.8 * share_told(seed, 8)
    x = np.where(np.arange(8) < 4, 0.8, 0.8 - 0.6 * least)
    runs, fitted = rows_of(x, None, seed)
    assert not [*changes(runs, fitted)]
    assert share_of(*told_from(runs, fitted, ())) < 1.5 * least / 0.8


def test_what_has_changed_is_not_told_of_again() -> None:
    runs, fitted = rows_of(np.where(np.arange(16) < 8, 0.8, 0.5), None)
    found = list(changes(runs, fitted))
    assert found
    assert told_from(runs, fitted, found) == ()


def test_a_sensors_own_number_and_too_short_a_record_are_not_told_of() -> None:
    runs, fitted = rows_of(np.full(16, 0.8), None)
    assert told_from(runs, [replace(row, kind="nuisance") for row in fitted], ()) == ()
    assert told_from(runs[:5], fitted[:5], ()) == ()
