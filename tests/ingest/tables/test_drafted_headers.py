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
