"""A fault that is nothing but another value of a free gain is not missing."""

from dataclasses import replace
from pathlib import Path

import pytest
from made_boat import begun, log, pushes

from trialid import pipeline_file
from trialid.diagnosis.search.gross_fault import gross_faults
from trialid.effects.actuators import actuator_effects
from trialid.identification.fit import identify
from trialid.progress import silent
from trialid.workflow.build_model import available, build_model, settings_of
from trialid.workflow.read_trials import align_trials


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("own", [True, pytest.param(False, marks=pytest.mark.study(turn="each"))])
def test_a_thruster_of_its_own_free_gain_is_not_weak(tmp_path: Path, own: bool) -> None:
    """With a gain in common it is: from it no free parameter could take a half of one thruster."""
    logs = []
    for i in range(2):
        p = pushes(i)
        acts = p * (0.5, 1.0)
        made = log(tmp_path / f"r{i * 'u'}.csv", acts, 100.0 * p, ("a_left_pct", "a_right_pct"))
        logs.append(made)
        text = made.read_text(encoding="utf-8")
        made.write_text(text.replace("a_left", "motor_left").replace("a_right", "motor_right"))
    begun(tmp_path, *logs)
    ship = tmp_path / "p_ship.toml"
    path = tmp_path / "p.toml"
    if own:
        ship.write_text(ship.read_text("utf-8").replace("own = false", "own = true"), "utf-8")
        names = '"k_ahead_thruster_port", "k_ahead_thruster_starboard"'
        text = path.read_text("utf-8").replace('"k_ahead"', names)
        held = "values = { k_astern_thruster_port = 1.0, k_astern_thruster_starboard = 1.0 } #"
        text = text.replace("values = {", held)
        path.write_text(text, "utf-8")
    asked = pipeline_file.load(path)
    model = build_model(asked, available(asked))
    fit = identify(align_trials(asked, silent), model, settings_of(asked, model))
    worse = tuple(replace(s, eps_rmsn={c: 20.0 for c in s.eps_rmsn}) for s in fit.scores)
    failed = replace(fit, converged=False, scores=worse)
    known = actuator_effects(model.ship, ("thruster_port", "thruster_starboard"))
    found = gross_faults(failed, known, silent, lambda _: True)
    assert ("thruster_port_weak" in {r.candidate.effect.name for r in found}) is not own
