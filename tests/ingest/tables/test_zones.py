"""Stamps of a local clock: their zone, and hours that a change of the clocks doubles or omits."""

import numpy as np
import pytest

from trialid.errors import LogError
from trialid.ingest import Aids, read

START = 1_699_192_800  # 2023-11-05 14:00:00 UTC
PLAIN = """
reviewed = true
header = ["t", "roll"]
time = { columns = ["t"], kind = "seconds" }
"""


def refused(path, aids):
    """What is said of a log that is not read."""
    with pytest.raises(LogError) as caught:
        read(path, None, aids)
    return str(caught.value)


def given(tmp_path, content, told):
    """A log and its template."""
    path, aid = tmp_path / "log", tmp_path / "template.toml"
    path.write_text(content)
    aid.write_text(told, encoding="utf-8")
    return path, Aids(template=aid)


@pytest.mark.parametrize("local", ["2023-10-29 02:30:00", "2023-03-26 02:30:00"])
def test_hours_that_a_change_of_the_clocks_doubles_or_leaves_out(tmp_path, local):
    path = tmp_path / "log"
    path.write_text(f"t,roll\n{local},1\n")
    message = refused(path, Aids(zone="Europe/Oslo"))
    assert f"line 2, column 't': {local} is no one instant in Europe/Oslo" in message


def test_of_a_log_through_the_end_of_summer_time_the_order_of_its_rows_tells_the_hour(tmp_path):
    """From 02:59 to 02:01 is two minutes later; two rows that changed places tell nothing."""
    text = "t,roll\n2026-10-25 02:{},1\n2026-10-25 02:{},2\n2026-10-25 03:00:00,3\n"
    path = tmp_path / "log"
    path.write_text(text.format("59:00", "01:00"))
    berlin = Aids(zone="Europe/Berlin")
    found = read(path, None, berlin).channels["roll"].t // 10**9
    assert np.diff(found).tolist() == [120, 59 * 60]
    path.write_text(text.format("30:01", "30:00"))
    assert "2026-10-25 02:30:01 is no one instant" in refused(path, berlin)
    joined = ("02:35", "02:59", "03:05", "03:30", "01:30", "01:55", "02:00", "02:25")
    rows = [f"2026-10-25 {at}:00,{i}" for i, at in enumerate(joined)]  # the later file first
    path.write_text("\n".join(("t,roll", *rows)))
    assert "2026-10-25 02:35:00 is no one instant" in refused(path, berlin)


def test_the_zone_may_come_with_the_log_and_must_not_contradict(tmp_path):
    path, aids = given(tmp_path, "t,roll\n2023-11-05 15:00:00,1\n", PLAIN)
    assert read(path, None, Aids(zone="Europe/Oslo")).channels["roll"].t[0] == START * 10**9
    assert read(path).channels["roll"].t[0] == (START + 3600) * 10**9
    told = PLAIN.replace('kind = "seconds"', 'zone = "Europe/Berlin"')
    path, aids = given(tmp_path, "t,roll\n2023-11-05 15:00:00,1\n", told)
    both = Aids(template=aids.template, zone="Europe/Oslo")
    assert "zone 'Europe/Oslo' and its template says 'Europe/Berlin'; leave one" in refused(
        path, both
    )
    path.write_text("t,roll\n0,1\n")
    assert "its time is no date, so that zone 'Europe/Oslo' says nothing" in refused(
        path, Aids(zone="Europe/Oslo")
    )


@pytest.mark.parametrize("zoned", [0, 1, 2])
def test_stamps_of_which_some_state_a_zone_are_of_no_one_clock(tmp_path, zoned):
    """Those without it were read as of UTC, two hours off the others."""
    stamps = [f"2026-07-01T12:00:0{i}" + ("+02:00" if i == zoned else "") for i in range(3)]
    path = tmp_path / "log"
    path.write_text("\n".join(("t,roll", *(f"{at},{i}" for i, at in enumerate(stamps)))))
    bare = 1 if zoned == 0 else 0
    message = refused(path, Aids())
    assert f"line {bare + 2}, column 't': '{stamps[bare]}' states no zone, where other" in message
    whole = "\n".join(("t,roll", *(f"{at[:19]}+02:00,{i}" for i, at in enumerate(stamps))))
    path.write_text(whole)
    assert read(path).channels["roll"].t[0] == 1_782_900_000 * 10**9
