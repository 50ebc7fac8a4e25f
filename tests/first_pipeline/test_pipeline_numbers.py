"""Numbers of a pipeline on their way to the model: units, priors, noise, and defaults."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import s175q
from test_bad_input import PIPELINE

from trialid.pipeline_file import load
from trialid.workflow import findings
from trialid.workflow.build_model import available, build_model, settings_of, stated_noise

D = float(np.deg2rad(1.0))


def written(folder: Path, *changes: tuple[str, str]):
    """The pipeline with these replacements, beside its ship."""
    text = PIPELINE
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    ship = s175q.ROOT / "sample_data" / "ships" / "s175q.toml"
    (folder / "ship.toml").write_bytes(ship.read_bytes())
    (folder / "log.csv").write_text("t[s]\n", encoding="utf-8")
    path = folder / "short.toml"
    path.write_text(text, encoding="utf-8")
    return load(path)


def test_a_value_with_a_unit_is_taken_in_the_parameters_own(tmp_path):
    values = '[model.values]\nGM = { value = 30.0, unit = "cm" }\nYv = -0.0125\n[identify]'
    asked = written(tmp_path, ("[identify]", values))
    model = build_model(asked, available(asked))
    assert model.value("GM") == pytest.approx(0.3)
    assert model.value("Yv") == -0.0125


def test_stated_noise_is_in_the_units_of_reports(tmp_path):
    """Degrees and degrees a second, as sensors' data sheets have them."""
    asked = written(
        tmp_path,
        ('outputs = ["r"]', 'outputs = ["r", "phi", "u"]'),
        ("[diagnose]", "[diagnose]\nnoise = { r = 0.05, phi = 0.1, u = 0.2 }"),
    )
    assert stated_noise(asked) == pytest.approx({"r": 0.05 * D, "phi": 0.1 * D, "u": 0.2})


def test_a_prior_is_a_mean_and_its_deviation_and_bounds_are_low_and_high(tmp_path):
    said = "priors = { Nr = { mean = -0.002, std = 0.0005 } }\nbounds = { Ndelta = [0.0, 0.01] }"
    asked = written(tmp_path, ('outputs = ["r"]', f'outputs = ["r"]\n{said}'))
    settings = settings_of(asked, build_model(asked, available(asked)))
    assert settings.priors == {"Nr": (-0.002, 0.0005)}
    assert settings.bounds == {"Ndelta": (0.0, 0.01)}


def test_two_samples_a_second_unless_said(tmp_path):
    """What the guide says: enough for a ship, and for her roll."""
    assert written(tmp_path, ("[align]\nperiod = 0.5\n", "")).align.period == 0.5


def test_noise_for_a_proposed_trial_is_in_the_outputs_units(monkeypatch):
    """What the fit leaves of each output, as it was measured."""
    given = []
    monkeypatch.setattr(findings.following, "by_name", lambda catalogue, names: ("a", "b"))
    monkeypatch.setattr(findings.following, "next_trial", lambda *asked: given.append(asked))
    monkeypatch.setattr(findings, "candidates_to_free", lambda fit: {})
    fit = SimpleNamespace(
        problem=SimpleNamespace(outputs=("r", "phi"), y_rms=np.array([0.006, 0.03])),
        eps_by_output={"r": 0.5, "phi": 0.1},
    )
    findings.proposal(fit, SimpleNamespace(family=("a", "b")), {})
    [(_, pair, noise)] = given
    assert pair == ("a", "b")
    assert noise == pytest.approx({"r": 0.003, "phi": 0.003})
