"""Words that people write for what a trial is used for."""

from pathlib import Path

import pytest

from trialid import pipeline_file
from trialid.errors import PipelineError

WHOLE = Path(__file__).parents[2] / "pipelines" / "hidden_effect.toml"


@pytest.mark.parametrize(
    ("written", "place"),
    [
        ("hold_out = true", "trial[0].hold_out: unknown key"),
        ('use = "held_out"', "trial[0].use: 'held_out' is not allowed"),
    ],
)
def test_a_trial_that_is_held_out_in_other_words(written: str, place: str) -> None:
    text = WHOLE.read_text(encoding="utf-8").replace("[[trial]]", f"[[trial]]\n{written}", 1)
    with pytest.raises(PipelineError) as caught:
        pipeline_file.read(text.encode(), WHOLE)
    assert place in str(caught.value)
    assert 'use = "check" holds a trial out' in str(caught.value)
