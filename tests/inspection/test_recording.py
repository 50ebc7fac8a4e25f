"""What a log holds stays what it was, and says nothing to a terminal."""

from pathlib import Path

import numpy as np
import pytest

from trialid.ingest import ADAPTERS
from trialid.inspection.channels import TABLES
from trialid.recording import Channel, Recording

T = np.arange(5, dtype=np.int64)


def test_numbers_of_a_log_cannot_be_overwritten():
    one = Channel("r", T.copy(), np.zeros(5), received=T.copy())
    for array in (one.t, one.y, one.received):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_remarks_quote_a_log_without_what_could_steer_a_terminal():
    made = Recording(Path("a.log"), "csv", "0" * 64, {}, ("bell \x07, colour \x1b[31m",))
    (remark,) = made.remarks
    assert "\x07" not in remark
    assert "\x1b" not in remark
    assert "colour" in remark


def test_formats_that_a_template_can_lay_out_define_no_quantity():
    assert {one.name for one in ADAPTERS if "template" in one.aids} == TABLES
