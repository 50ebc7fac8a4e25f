"""Drafts of templates for tables whose header has not a name for every field of a row."""

import numpy as np

from trialid.ingest import Aids, draft_template, read


def test_rows_that_end_with_a_separator_have_the_header_above_them(tmp_path):
    rows = [f"08/07/17\t12:39:0{i}\t{y}\t\n" for i, y in enumerate((5.1, 4.7, 4.9))]
    log, aid = tmp_path / "log", tmp_path / "template.toml"
    log.write_text("---- log ----\nDate\tTime\tBoatspeed\n" + "".join(rows))
    drafted = draft_template(log)
    aid.write_text(drafted.replace("reviewed = false", "reviewed = true"))
    speed = read(log, None, Aids(template=aid)).channels["Boatspeed"]
    assert np.diff(speed.t).tolist() == [10**9, 10**9]
    assert speed.y.tolist() == [5.1, 4.7, 4.9]


def test_seconds_that_a_template_states_are_seconds_however_far_apart(tmp_path):
    """Without it whole numbers that step by ten are asked for."""
    log, aid = tmp_path / "log.csv", tmp_path / "template.toml"
    log.write_text("when,heave\n0,1.0\n10,2.0\n20,3.0\n30,1.0\n")
    drafted = draft_template(log).replace("reviewed = false", "reviewed = true")
    aid.write_text(drafted)
    assert 'kind = "seconds"' in drafted
    assert "# QUESTION: its numbers step by 10: seconds, or is a unit to be stated" in drafted
    heave = read(log, None, Aids(template=aid)).channels["heave"]
    assert np.diff(heave.t).tolist() == [10 * 10**9] * 3


def test_dates_with_a_half_of_the_day_and_letters_between_numbers_are_drafted(tmp_path):
    """Split at its blanks it had no header, and 09:12 PM was no %H:%M."""
    log, aid = tmp_path / "log.csv", tmp_path / "template.toml"
    rows = [f"04/05/2026 09:55:0{i} PM,5700.0004,N,00329.9994,W,{y}\n" for i, y in enumerate("579")]
    log.write_text("UTC,Latitude,N/S,Longitude,E/W,Rudder\n" + "".join(rows))
    drafted = draft_template(log).replace("reviewed = false", "reviewed = true")
    aid.write_text(drafted)
    rudder = read(log, None, Aids(template=aid)).channels["delta"]
    assert rudder.y.tolist() == [5.0, 7.0, 9.0]
    assert str(rudder.t.astype("datetime64[ns]")[0]) == "2026-05-04T21:55:00.000000000"
