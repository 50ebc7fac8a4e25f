"""A current that carries a boat is found beside her forces where u and v are over the ground."""

from pathlib import Path

import numpy as np
import pytest
from made_boat import begun
from test_over_ground import CURRENT, logged

from trialid import pipeline_file
from trialid.errors import PipelineError
from trialid.progress import silent
from trialid.workflow.build_model import available
from trialid.workflow.fit_model import check_current, fit_of
from trialid.workflow.read_trials import align_trials


def test_it_comes_back_as_it_was(tmp_path: Path) -> None:
    begun(tmp_path, *(logged(tmp_path / f"{i}.csv", i, "course") for i in (2, 3)))
    pipeline = pipeline_file.load(tmp_path / "p.toml")
    fit = fit_of(pipeline, align_trials(pipeline, silent), available(pipeline), silent)
    for name, true in zip(("V_cn", "V_ce"), CURRENT, strict=True):
        found = [v for n, v in fit.estimates.items() if n.startswith(f"{name} [")]
        assert np.mean(found) == pytest.approx(true, abs=0.05), name


def test_in_a_speed_through_the_water_no_current_is_fitted(tmp_path: Path) -> None:
    begun(
        tmp_path, logged(tmp_path / "a.csv", 2, "course"), logged(tmp_path / "b.csv", 3, "course")
    )
    text = (tmp_path / "p.toml").read_text(encoding="utf-8")
    one, rest = text.split("over_ground = true", 1)
    for changed, said in (
        (f"{one}over_ground = false{rest}", "no current shows, and trial 'a' has no over_ground"),
        (text.replace('outputs = ["u"', 'outputs = ["sog", "u"'), "keep u and v, or the other"),
    ):
        (tmp_path / "q.toml").write_text(changed, encoding="utf-8")
        with pytest.raises(PipelineError, match=said):
            check_current(pipeline_file.load(tmp_path / "q.toml"))
