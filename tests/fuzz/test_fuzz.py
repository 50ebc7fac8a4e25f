"""Damaged logs of every format: the short form; the long one is run by `fuzz.py` itself."""

import pytest
from fuzz import fuzz, table

EACH_TIME = 160
STUDY = 2200


def check(tmp_path, count, seed):
    """Nothing offends, every format was damaged, and some of all were still read."""
    rows = fuzz(count, 2, seed, tmp_path / "offending")
    print(table(rows))
    assert [one for row in rows for one in row.offending] == []
    assert sum(sum(row.count.values()) for row in rows) == count
    assert min(sum(row.count.values()) for row in rows) >= count // len(rows)
    assert sum(row.samples for row in rows if row.seed.covered != "nothing") > 100 * count
    return rows


@pytest.mark.study(turn=2)
def test_some_damaged_logs_of_every_format(tmp_path):
    check(tmp_path, EACH_TIME, 7)


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("seed", range(8, 13))
def test_two_thousand_damaged_logs_in_turns(tmp_path, seed):
    rows = check(tmp_path, STUDY // 5, seed)
    kinds = {name: sum(row.count[name] for row in rows) for name in rows[0].count}
    assert min(kinds.values()) > 0
