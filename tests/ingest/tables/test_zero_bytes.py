"""Bytes of zero where a recorder lost its power cost the lines that they stand in, and no more."""

import numpy as np

from trialid import ingest


def test_a_hole_of_zeros_in_a_table_leaves_the_rest(tmp_path):
    """4 kB of them took all 1800 rows of an outsider's log; its end may be of nothing else."""
    rows = [f"{0.5 * k:.1f},{np.sin(0.1 * k):.4f}\n" for k in range(1000)]
    rows[700] = rows[700].strip() + "\0" * 4096 + "0.25\n"
    path = tmp_path / "a.csv"
    path.write_text("t [s],rudder [deg]\n" + "".join(rows) + "\0" * 512, encoding="utf-8")
    found = ingest.read(path)
    assert found.remarks == (
        "line 1002, the last, is cut short and left out",
        "line 702 holds bytes of zero, left out",
    )
    [channel] = found.channels.values()
    assert len(channel.y) == 999
    assert channel.y[699:701].tolist() == [float(rows[k].split(",")[1]) for k in (699, 701)]
