"""Two rate-of-turn sensors and no ship: what lies between them, made here, is named.

The same on a real boat is in `real_records/test_two_rate_sensors.py`.
"""

from pathlib import Path

import numpy as np
import pytest
from scipy.signal import lfilter
from test_bad_input import trialid_

from trialid import pipeline_file
from trialid.workflow import grow

PIPELINE = Path(__file__).parent / "two_rates.toml"
FINE = 0.01  # s
HELD = 30.0  # s, an order of the helmsman
DEG = np.deg2rad(1.0)
DELAY, BIAS, NOISE = 0.6, 0.04 * DEG, 0.01 * DEG


def turning(duration, seed):
    """A boat's rate of turn: a helmsman's orders and a sea of three waves; [rad/s]."""
    rng = np.random.default_rng(seed)
    t = FINE * np.arange(round(duration / FINE) + 1)
    orders = rng.uniform(-6.0, 6.0, round(duration / HELD) + 1) * DEG
    turn = low_pass(low_pass(orders[(t / HELD).astype(int)], 2.0), 1.0)
    phases = rng.uniform(0.0, 2.0 * np.pi, 3)
    sea = sum(np.sin(w * t + a) for w, a in zip((1.1, 1.5, 2.3), phases, strict=True))
    return turn + 0.2 * DEG * sea


def low_pass(x, T):
    """T dz/dt = x - z, from rest."""
    keep = np.exp(-FINE / T)
    return lfilter([1.0 - keep], [1.0, -keep], x)


def write_logs(folder, poles, delay=DELAY, bias=BIAS):
    """The first sensor at 20 Hz, the second, behind the poles, at 10 Hz; each on its own clock."""
    for k, (name, duration) in enumerate((("8", 240.0), ("wide", 200.0))):
        rng = np.random.default_rng(100 + k)
        first = turning(duration, k)
        second = first
        for T in poles:
            second = low_pass(second, T)
        fine = FINE * np.arange(len(first))
        for sensor, rate, values, late in (
            ("first", 20, first, 0.0),
            ("second", 10, second, delay),
        ):
            t = 0.003 * rate + np.arange(0.0, duration - 0.2, 1.0 / rate)
            seen = np.interp(t - late, fine, values) + (bias if sensor == "second" else 0.0)
            seen = seen + NOISE * rng.standard_normal(len(t))
            table = np.column_stack([t, seen])
            np.savetxt(
                folder / f"{sensor}-{name}.csv", table, "%.9g", ",",
                header=f"t,{sensor}", comments="",
            )  # fmt: skip


def pipeline(folder, **changes):
    """The pipeline beside its logs, with other states or effects."""
    text = PIPELINE.read_text(encoding="utf-8")
    for key, new in changes.items():
        old = {"states": "states = []", "effects": '["reference_rate"]'}[key]
        assert old in text
        text = text.replace(old, new)
    path = folder / "two_rates.toml"
    path.write_text(text, encoding="utf-8")
    return path


def found(path):
    """Every stage of the loop, with its history printed."""
    done = list(grow.stages(pipeline_file.load(path), lambda words, share: None))
    for stage in done:
        fit, named = stage.run.result.fit, stage.run.result.verdict
        print(
            f"{stage.added}: {fit.eps_rmsn:.2%}, held out {fit.eps_rmsn_check:.2%}, "
            f"then {named.kind} {named.effect} {named.family}"
        )
    return done


def values(stage):
    return {p.name: p.value for p in stage.run.result.accuracy.parameters}


def refitted(stage, effect):
    row = next(m for m in stage.run.result.missing if m.effect == effect)
    return row.eps_rmsn_refitted


@pytest.mark.study(turn="each")
def test_two_poles_are_named_and_preferred_to_one(tmp_path):
    write_logs(tmp_path, poles=(4.5, 5.0))
    done = found(pipeline(tmp_path))
    first, last = done[0], done[-1]
    assert first.run.result.verdict.kind == "missing"
    assert first.run.result.verdict.effect == "lag_twice_r"
    assert refitted(first, "lag_twice_r") < 0.5 * refitted(first, "lag_r")
    assert [s.added for s in done[1:] if s.kept] == ["lag_twice_r", "delay_r"]
    assert last.run.result.verdict.kind == "nothing missing"
    value = values(last)
    print(value)
    assert value["T_rr"] == pytest.approx(4.75, abs=0.05)
    assert value["tau_r"] == pytest.approx(DELAY, abs=0.1)
    assert value["b_r [figure of eight]"] == pytest.approx(BIAS, rel=0.2)
    assert value["k_ref"] == pytest.approx(1.0, abs=0.01)


def test_one_pole_is_named_where_there_is_one(tmp_path):
    write_logs(tmp_path, poles=(5.0,), delay=0.0)
    first, *_, last = found(pipeline(tmp_path))
    assert first.run.result.verdict.effect == "lag_r"
    assert refitted(first, "lag_r") < 0.5 * refitted(first, "lag_twice_r")
    assert values(last)["T_r"] == pytest.approx(5.0, abs=0.1)


def test_nothing_is_named_where_the_sensors_agree(tmp_path):
    """What resampling two clocks leaves, 0.2 % of the signal, may be called more than noise."""
    write_logs(tmp_path, poles=(), delay=0.0, bias=0.0)
    (only,) = found(pipeline(tmp_path))
    assert only.run.result.verdict.kind != "missing"
    assert only.run.result.fit.eps_rmsn < 0.005


def test_it_runs_by_the_command_too(tmp_path, monkeypatch):
    write_logs(tmp_path, poles=(4.5, 5.0))
    pipeline(tmp_path)
    monkeypatch.chdir(tmp_path)
    outcome = trialid_("run", "two_rates.toml")
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    assert "lag_twice_r is missing" in outcome.stdout
    assert (tmp_path / "runs" / "two_rates" / "report.html").is_file()
    outcome = trialid_("run", "two_rates.toml", "--draft", "mine.py")
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    assert "No draft: nothing is simulated" in outcome.stdout
    assert not (tmp_path / "mine.py").exists()


@pytest.mark.parametrize(("changes", "words"), [
    ({"states": 'states = ["v", "r"]'},
     "ship: missing; v, r can be simulated for a ship only: name her file, or write states = []"),
    ({"effects": '["reference_rate", "linear_hull"]'},
     "model.effects[1]: linear_hull is about a ship, and the pipeline names none; "
     "write ship = ..., or leave it out"),
    ({"effects": '["reference_rate", "inclinometer_lever"]'},
     "model.effects[1]: inclinometer_lever is about a ship"),
    ({"effects": '["reference_rate", "scale_r"]'},
     "model.effects[1]: scale_r reads r, an output that is not simulated: it would explain itself"),
    ({"effects": "[]"}, "r"),
])  # fmt: skip
def test_what_has_no_place_without_a_ship_is_one_line(tmp_path, monkeypatch, changes, words):
    write_logs(tmp_path, poles=())
    pipeline(tmp_path, **changes)
    monkeypatch.chdir(tmp_path)
    outcome = trialid_("run", "two_rates.toml")
    print(outcome.stderr)
    assert outcome.exit_code == 2
    assert len(outcome.stderr.splitlines()) == 1
    assert words in outcome.stderr
    assert not (tmp_path / "runs").exists()
