"""A current is no candidate in a speed that says itself that it is through the water."""

from pathlib import Path

import pytest
import s175q

from trialid import pipeline_file
from trialid.effects import CATALOGUE
from trialid.workflow.findings import OVER_GROUND, diagnose_settings

TRIAL = """\
[[trial]]
name = "{name}"
logs = ["{name}.csv"]
[trial.signals]
delta = {{ channel = "rudder", unit = "deg", positive = "starboard" }}
r = {{ channel = "rot", unit = "deg/s" }}
u = {{ channel = "{channel}", unit = "kn" }}
"""
REST = """\
[model]
states = ["v", "r"]
effects = ["linear_hull", "linear_rudder"]
[identify]
free = ["Nr"]
outputs = ["r"]
{more}
"""
LISTED = '[diagnose]\ncandidates = ["current_in_speed_record"]'


@pytest.mark.parametrize(
    ("channels", "more", "tried"),
    [
        (("stw", "VHW/II:speed"), "", False),
        (("stw", "speed"), "", True),
        (("sog", "sog"), "", True),
        (("sog_open_water", "sog_open_water"), "", True),
        (("stw", "stw"), LISTED, True),
    ],
)
def test_unless_it_is_asked_for(tmp_path: Path, channels, more: str, tried: bool) -> None:
    """A ship of 6 m/s was in a current of 2.5 by her `stw`, and a deviation was called one."""
    for k in range(len(channels)):
        (tmp_path / f"t{k}.csv").write_text("t\n", encoding="utf-8")
    trials = "".join(TRIAL.format(name=f"t{k}", channel=c) for k, c in enumerate(channels))
    path = tmp_path / "p.toml"
    path.write_text(
        f'ship = "{s175q.ROOT}/sample_data/ships/s175q.toml"\n{trials}{REST.format(more=more)}',
        encoding="utf-8",
    )
    asked = pipeline_file.load(path)
    settings = diagnose_settings(asked, CATALOGUE)
    assert ("current_in_speed_record" in settings.candidates) == tried
    assert bool({*OVER_GROUND} & {*settings.candidates}) == tried
