"""Signals of one's own: a tow line's pull, logged in kN, in an effect of five lines."""

from pathlib import Path

import numpy as np
import pytest

from trialid import pipeline_file
from trialid.errors import EffectError, TrialidError
from trialid.ship.effect import Force, Parameter, Signal, effect
from trialid.trial import Trial
from trialid.workflow.run import run

OWN = '''
from trialid.ship.effect import Force, Parameter, Signal, effect


@effect(source="load cell of the tow line", system="SI")
def tow_line(tow=Signal("N"), *, k_tow=Parameter(0.5, low=-5.0, high=5.0)):
    """X = k_tow tow: the pull of a tow line ahead."""
    return Force(X=k_tow * tow)
'''
SHIP = """
name = "barge"
source = "made up"
system = "dimensional"
rudder_positive = "starboard"
particulars = { L = 20.0, nabla = 100.0, rho = 1000.0, g = 9.81, U0 = 2.0 }
mass = { m = 1.0e5, Xudot = -5.0e3 }
"""
PIPELINE = """
ship = "barge.toml"
[[trial]]
name = "towed"
logs = ["towed.csv"]
[trial.signals]
u = { channel = "u", unit = "m/s" }
tow = { channel = "tow", unit = "kN" }
[align]
period = 1.0
[model]
states = ["u"]
effects = ["surge_resistance", "tow_line"]
effects_from = ["own.py"]
[identify]
free = ["Xuu", "k_tow"]
outputs = ["u"]
"""
TRUE_GAIN, DRAG = 0.8, 900.0


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A barge under tow by Newton's law, 105 t against 900 u|u|, 0.8 of the logged pull ahead."""
    t = np.arange(0.0, 600.0, 1.0)
    pull = 4e3 + 3e3 * np.sign(np.sin(2.0 * np.pi * t / 140.0))
    u, fine = [1.5], 20
    for k in range(len(t) - 1):
        speed = u[-1]
        for i in range(fine):
            now = pull[k] + (pull[k + 1] - pull[k]) * (i + 0.5) / fine
            speed += (TRUE_GAIN * now - DRAG * speed * abs(speed)) / 1.05e5 / fine
        u.append(speed)
    noisy = np.array(u) + 0.01 * np.random.default_rng(7).standard_normal(len(t))
    rows = [f"{a:.1f},{b:.5f},{c / 1e3:.4f}" for a, b, c in zip(t, noisy, pull, strict=True)]
    files = {"own.py": OWN, "barge.toml": SHIP, "p.toml": PIPELINE}
    files["towed.csv"] = "\n".join(["time_s,u,tow", *rows]) + "\n"
    for name, text in files.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def changed(folder: Path, name: str, old: str, new: str) -> Path:
    path = folder / name
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new), encoding="utf-8")
    return folder / "p.toml"


def test_an_effect_reads_a_signal_that_only_the_pipeline_names(folder: Path) -> None:
    """Logged in kN, wanted in N; both numbers of the truth come back."""
    done = run(pipeline_file.load(folder / "p.toml"))
    found = {row.name: row for row in done.findings.before.accuracy.physical}
    scale = 0.5 * 1000.0 * 20.0**2
    assert abs(found["k_tow"].value - TRUE_GAIN) < 3.0 * found["k_tow"].standard_error < 0.05
    drag = -found["Xuu"].value * scale
    assert abs(drag - DRAG) < 3.0 * found["Xuu"].standard_error * scale < 60.0


OUTPUT = "'tow' is a signal of your own, and no equation of the ship gives it; take it out, or choo"
WRONG = [
    ("p.toml", "tow = {", "tau = {", r"trial\[0\].signals.tau: unknown quantity, and no effect"),
    ("p.toml", '"kN"', '"m/s"', r"signals.tow.unit: unit 'm/s' cannot become 'N'"),
    ("p.toml", 'outputs = ["u"]', 'outputs = ["u", "tow"]', OUTPUT),
    ("p.toml", 'effects_from = ["own.py"]\n', "", "signals.tow: unknown quantity; "),
    ("own.py", 'Signal("N")', 'Signal("newtn")', "signal tow: unit 'newtn' is not known"),
    ("own.py", ', system="SI"', "", "tow', a signal of one's own, which has no primed form"),
    ("own.py", 'tow=Signal("N")', 'u=Signal("N")', "signal 'u' is a quantity already"),
    ("own.py", 'tow=Signal("N")', "tow", r'a signal of your own is tow=Signal\("N"\)'),
]


@pytest.mark.parametrize(("name", "old", "new", "says"), WRONG)
def test_what_is_wrong_is_one_line(folder: Path, name: str, old: str, new: str, says: str) -> None:
    path = changed(folder, name, old, new)
    with pytest.raises(TrialidError, match=says) as caught:
        run(pipeline_file.load(path))
    assert "\n" not in str(caught.value)


def test_a_trial_in_memory_takes_signals_of_ones_own() -> None:
    t = np.arange(5.0)
    made = Trial.from_arrays("a", t, {"tow": t}, units={"tow": "kN"}, own={"tow": "N"})
    assert list(made.signals["tow"]) == [0.0, 1e3, 2e3, 3e3, 4e3]
    with pytest.raises(TrialidError, match="there is no signal 'tow'"):
        Trial.from_arrays("a", t, {"tow": t}, units={"tow": "kN"})


def test_two_effects_may_not_disagree_about_a_unit(folder: Path) -> None:
    other = (
        OWN.replace("tow_line", "tow_again").replace('"N"', '"pound_force"').replace("k_tow", "k_2")
    )
    (folder / "other.py").write_text(other, encoding="utf-8")
    path = changed(folder, "p.toml", '["own.py"]', '["own.py", "other.py"]')
    with pytest.raises(
        EffectError, match=r"reads tow in 'pound_force', and it is known in 'N'; write"
    ):
        run(pipeline_file.load(path))


def test_the_declaration_says_what_it_reads() -> None:
    @effect(source="test", system="SI")
    def pull(u, tow=Signal("N"), *, k_pull=Parameter(1.0)):
        """X = k_pull tow u: nothing in particular."""
        return Force(X=k_pull * tow * u)

    assert pull.signals == ("u", "tow")
    assert pull.own == {"tow": Signal("N")}
