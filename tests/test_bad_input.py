"""Wrong input through the real command line: one line that says what, where, and what to do.

A short trial is written into an empty folder and spoilt in one way at a time. Either the command
refuses it with one line and status 2, the folder as it was, or it finishes and says in the report
what it could not know.
"""

import errno
import json
import math
import os
import re
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
import s175q
from click.testing import CliRunner, Result
from valid_result import assert_valid

from trialid.cli import main
from trialid.effects import CATALOGUE
from trialid.own_files import LIST
from trialid.sample import log_writers
from trialid.ship.model import ShipModel

EFFECTS = ("linear_hull", "linear_rudder", "linear_roll")
STATES = ("v", "p", "r", "phi")
SIGNALS = """
[trial.signals]
delta = { channel = "rudder", unit = "deg", positive = "starboard" }
r = { channel = "rot", unit = "deg/s" }
phi = { channel = "heel", unit = "deg" }
u = { channel = "stw", unit = "m/s" }
"""
PIPELINE = f"""
ship = "ship.toml"

[[trial]]
name = "zigzag"
logs = ["log.csv"]
{SIGNALS}
[align]
period = 0.5
[model]
states = ["v", "p", "r", "phi"]
effects = ["linear_hull", "linear_rudder", "linear_roll"]
[identify]
free = ["Nr", "Ndelta"]
outputs = ["r"]
[diagnose]
candidates = "none"
"""
CHECK = f"""
[[trial]]
name = "held-out"
use = "check"
logs = ["check.csv"]
{SIGNALS}
"""
RUN = "pipeline.toml predicted.mcap report.html result.json run.json series.csv standing.npz"
WRITTEN = {LIST, *RUN.split()}
LONGEST = 400
"""Characters a person reads as one line."""

EFFECT = """\
from trialid.ship.effect import Force, Measured, Parameter, effect

@effect(source="the mate")
def mine(v, r, *, Nx=-0.001):
    "N = Nx v|v|: what the mate thinks."
    return Force(N=Nx * v * abs(v))
"""
COPY = EFFECT.replace("Nx * v * abs(v)", "Nx * r")

Change = tuple[str, str, str]
Table = pd.DataFrame


@pytest.fixture(scope="module")
def record() -> Table:
    """Ten minutes of a zig-zag that the model of the pipeline fits, but for the sensors' noise."""
    model = ShipModel(s175q.SHIP, STATES, tuple(CATALOGUE[name] for name in EFFECTS))
    trial = s175q.zigzag(20, model)
    trial = s175q.with_noise(trial, *s175q.white(np.random.default_rng(1), trial.samples))
    columns = {
        "t[s]": trial.t,
        "rudder[deg]": np.rad2deg(trial.signals["delta"]),
        "rot[deg/s]": np.rad2deg(trial.signals["r"]),
        "heel[deg]": np.rad2deg(trial.signals["phi"]),
        "stw[m/s]": np.full(trial.samples, 7.33),
    }
    return pd.DataFrame(columns)[:1200]


@pytest.fixture(autouse=True)
def _folder(record: Table, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Give a pipeline, its ship and its log in the current folder, all of them right."""
    ship = s175q.ROOT / "sample_data" / "ships" / "s175q.toml"
    (tmp_path / "ship.toml").write_bytes(ship.read_bytes())
    (tmp_path / "short.toml").write_text(PIPELINE, encoding="utf-8")
    record.to_csv(tmp_path / "log.csv", index=False)
    monkeypatch.chdir(tmp_path)


def change(file: str, old: str, new: str) -> None:
    text = Path(file).read_text(encoding="utf-8")
    assert old in text
    Path(file).write_text(text.replace(old, new), encoding="utf-8")


def relog(alter: Callable[[Table], Table | None], file: str = "log.csv") -> None:
    """Write the log again with something done to its table."""
    table = pd.read_csv("log.csv")
    table = table if (altered := alter(table)) is None else altered
    table.to_csv(file, index=False)


def with_effect(source: str) -> None:
    """Put the user's own effect `mine` into the model, its Nx free."""
    Path("mine.py").write_text(source, encoding="utf-8")
    change("short.toml", '"linear_roll"]', '"linear_roll", "mine"]\neffects_from = ["mine.py"]')
    change("short.toml", '"Ndelta"]', '"Ndelta", "Nx"]')


def with_check(alter: Callable[[Table], Table | None]) -> None:
    """Add a trial that is held out, of a log of its own."""
    relog(lambda table: table[:-1] if (new := alter(table)) is None else new[:-1], "check.csv")
    change("short.toml", "[align]", f"{CHECK}[align]")


def listing() -> dict[str, bytes | None]:
    """Every file and folder below the current one, with what it holds."""
    here = Path()
    return {str(p): p.read_bytes() if p.is_file() else None for p in sorted(here.rglob("*"))}


def trialid_(*arguments: str) -> Result:
    return CliRunner().invoke(main.commands, [*arguments], prog_name="trialid")


def refused(*words: str, out: str = "out", pipeline: str = "short.toml") -> str:
    """Run, expect the one line with these words and nothing left behind; give the line."""
    before = listing()
    outcome = trialid_("run", pipeline, "--out", out)
    assert isinstance(outcome.exception, SystemExit), repr(outcome.exception)
    assert (outcome.exit_code, outcome.stdout) == (2, "")
    line = outcome.stderr
    assert line.startswith("trialid: ")
    assert line.endswith("\n")
    assert line.count("\n") == 1
    assert len(line) < LONGEST, f"{len(line)} characters: {line}"
    assert [word for word in words if word not in line] == [], line
    assert listing() == before
    return line


def finished(out: str = "out") -> dict[str, Any]:
    """Run, expect a whole and quiet run and nothing beside its folder; give the result."""
    before = set(listing())
    outcome = trialid_("run", "short.toml", "--out", out)
    assert outcome.exception is None, repr(outcome.exception)
    assert (outcome.exit_code, outcome.stderr) == (0, "")
    assert {p.name for p in Path(out).iterdir()} | {"standing.npz"} == WRITTEN  # not of own effects
    assert {name for name in listing() if not name.startswith(out)} == before
    text = Path(out, "result.json").read_text(encoding="utf-8")
    result: dict[str, Any] = json.loads(text, parse_constant=_not_json)
    assert_valid(result)
    return result


def _not_json(constant: str) -> None:
    raise AssertionError(f"{constant} in result.json")


def remarks(result: dict[str, Any], trial: int = 0) -> str:
    return "\n".join(result["trials"][trial]["remarks"])


def compared(column: str = "r_measured_radps", trial: str = "zigzag") -> int:
    series = pd.read_csv("out/series.csv")
    return int(series[series["trial"] == trial][column].notna().sum())


def spawn(*arguments: str) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "trialid", *arguments]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=60)


# --- what all cases begin from ------------------------------------------------------------------


def test_the_trial_that_is_spoilt_below_is_a_good_one() -> None:
    result = finished()
    assert result["fit"]["converged"]
    assert result["fit"]["eps_rmsn"] < 0.1
    assert result["accuracy"]["weak"] == []
    assert compared() == 1200


# --- files and keys -----------------------------------------------------------------------------


def test_a_pipeline_that_is_not_there_leads_to_the_one_that_is() -> None:
    refused("shrt.toml", "no such pipeline", "did you mean 'short.toml'", pipeline="shrt.toml")


@pytest.mark.parametrize(("content", "words"), [
    pytest.param(b"", ("trial", "missing"), id="empty"),
    pytest.param(b"ship: x\n", ("not TOML", "line 1"), id="not TOML"),
    pytest.param(bytes(range(256)), ("not UTF-8",), id="binary"),
])  # fmt: skip
def test_a_pipeline_that_is_none(content: bytes, words: tuple[str, ...]) -> None:
    Path("short.toml").write_bytes(content)
    refused("short.toml", *words)


@pytest.mark.parametrize(("old", "new", "words"), [
    pytest.param("outputs =", "outptus =",
                 ("identify.outptus", "unknown key", "'outputs'"), id="unknown key"),
    pytest.param('"deg/s"', '"degg/s"',
                 ("trial[0].signals.r.unit", "'degg/s'", "not known", "'deg/s'"),
                 id="unknown unit"),
    pytest.param('"deg/s"', '"m/s"',
                 ("trial[0].signals.r.unit", "'m/s'", "cannot become", "write deg, rad"),
                 id="unit of something else"),
    pytest.param(', positive = "starboard"', "",
                 ("trial[0].signals.delta.positive", "missing", "the ship turns",
                  '"starboard" or "port"'), id="rudder without a side"),
    pytest.param("r = {", "yawrate = {",
                 ("trial[0].signals.yawrate", "unknown quantity"), id="unknown quantity"),
    pytest.param('name = "zigzag"', 'name = "zigzag"\nuse = "check"',
                 ("trial", "no trial to fit", 'use = "fit"'), id="all trials are to check"),
    pytest.param('["log.csv"]', '["log.csv"]\nwindow = [60.0, 50.0]',
                 ("trial[0].window", "backwards", "[low, high]"), id="window backwards"),
    pytest.param("period = 0.5", "period = 0",
                 ("align.period", "greater than 0"), id="no period"),
    pytest.param('"linear_rudder"', '"linear_ruder"',
                 ("model.effects[1]", "no effect 'linear_ruder'", "'linear_rudder'"),
                 id="unknown effect"),
    pytest.param('"linear_roll"]', '"linear_roll"]\nvalues = { Nrr = 1.0 }',
                 ("model.values.Nrr", "no effect of the model", "'Nr'"), id="unknown value"),
    pytest.param('"none"', '["linear_hul"]',
                 ("diagnose.candidates[0]", "no effect 'linear_hul'", "'linear_hull'"),
                 id="unknown candidate"),
    pytest.param("[diagnose]", "[identify.priors]\nNv = { mean = 1.0, std = 1.0 }\n[diagnose]",
                 ("identify.priors.Nv", "not free", "Ndelta, Nr"), id="prior of what is not free"),
    pytest.param('"Ndelta"]', '"Ndelt"]',
                 ("identify.free[1]", "'Ndelt'", "'Ndelta'"), id="unknown free parameter"),
    pytest.param('"Ndelta"]', '"Nrar"]',
                 ("identify.free[1]", "'Nrar'", "no effect of the model"),
                 id="free parameter of no effect"),
    pytest.param('["v",', '["w",',
                 ("model.states", "'w'", "phi, psi, r, u, v"), id="unknown state"),
    pytest.param('"linear_roll"]',
                 '"linear_roll"]\nvalues = { GM = { value = 1.0, unit = "kn" } }',
                 ("model.values.GM", "'kn'", "cannot become 'm'"), id="unit of a value"),
])  # fmt: skip
def test_a_wrong_key_or_value_is_named_with_its_place(
    old: str, new: str, words: tuple[str, ...]
) -> None:
    change("short.toml", old, new)
    refused("short.toml: ", *words)


@pytest.mark.parametrize("option", ["--json", "--quiet"])
def test_the_line_is_the_same_whatever_is_to_be_printed(option: str) -> None:
    Path("log.csv").unlink()
    outcome = trialid_("run", "short.toml", option)
    assert (outcome.exit_code, outcome.stdout) == (2, "")
    assert outcome.stderr.count("\n") == 1
    assert not Path("runs").exists()


# --- logs ---------------------------------------------------------------------------------------


def test_a_log_that_is_not_there() -> None:
    Path("log.csv").rename("lag.csv")
    refused("short.toml: trial[0].logs[0]", "no file 'log.csv'", "did you mean 'lag.csv'")


@pytest.mark.parametrize(("content", "words"), [
    pytest.param(b"", ("empty", "0 bytes", "copy it again"), id="empty"),
    pytest.param(b"t[s],rudder[deg]\n", ("header but no rows", "exported"), id="no rows"),
    pytest.param(b"\x89PNG\r\n\x1a\n" + bytes(50), ("none of the formats", "MCAP, MAV", "PNG",
                 "as CSV", "--template FILE"), id="a picture"),
    pytest.param(b"a,b\n1,2\n", ("no time column", "a, b", "'time'"), id="no time"),
    pytest.param(b"t,rudder\n0,1\n1,x\n2,1\n", ("line 3", "'rudder'", "'x'", "number"),
                 id="a word for a number"),
])  # fmt: skip
def test_a_log_that_is_none(content: bytes, words: tuple[str, ...]) -> None:
    Path("log.csv").write_bytes(content)
    refused("log.csv", *words)


def as_mcap(monkeypatch: pytest.MonkeyPatch, share: float) -> None:
    """Turn the log into MCAP and keep this share of its bytes."""
    monkeypatch.setattr(log_writers, "CHUNK_SIZE", 8192)
    table = pd.read_csv("log.csv")
    stamps = np.rint(table["t[s]"].to_numpy() * 1e9).astype(np.int64) + 1_700_000_000_000_000_000
    names = [head.partition("[")[0] for head in table.columns]
    samples = {f"/{n}": (stamps, table.iloc[:, i].to_numpy()) for i, n in enumerate(names) if i}
    log_writers.write_json_mcap(Path("log.mcap"), samples)
    whole = Path("log.mcap").read_bytes()
    Path("log.mcap").write_bytes(whole[: round(share * len(whole))])
    change("short.toml", "log.csv", "log.mcap")
    for name in names[1:]:
        change("short.toml", f'"{name}"', f'"/{name}:value"')


def test_a_torn_mcap_runs_on_what_is_left_of_it(monkeypatch: pytest.MonkeyPatch) -> None:
    as_mcap(monkeypatch, 0.6)
    result = finished()
    said = remarks(result)
    assert re.search(r"log\.mcap: recovered \d+ messages", said)
    assert "damaged at byte" in said
    assert "cut short" in said
    assert 300 < compared() < 1000
    assert "cut short" in Path("out/report.html").read_text(encoding="utf-8")


def test_an_mcap_of_which_nothing_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    as_mcap(monkeypatch, 0.004)
    refused("log.mcap", "no readable message", "damaged at byte", "take another copy")


# --- channels -----------------------------------------------------------------------------------


def test_a_channel_that_is_not_in_the_log_leads_to_its_neighbours() -> None:
    change("short.toml", '"rot"', '"rott"')
    refused("trial 'zigzag'", "signal 'r'", "no channel 'rott'", "log.csv", "did you mean 'rot'")


def test_of_a_hundred_channels_only_the_nearest_are_offered() -> None:
    spares = [f"spare {i}[V]" for i in range(100)]
    relog(lambda table: table.join(pd.DataFrame(0.0, table.index, spares)))
    change("short.toml", '"rot"', '"rate"')
    line = refused("no channel 'rate'", "rot")
    assert line.count("spare") < 10


def test_a_channel_of_nan() -> None:
    relog(lambda table: table.assign(**{"rot[deg/s]": math.nan}))
    refused("trial 'zigzag'", "signal 'r'", "all are NaN", "take another channel")


@pytest.mark.parametrize("channel", ["rot[deg/s]", "rudder[deg]", "stw[m/s]"])
def test_half_a_channel_of_nan_is_masked(channel: str) -> None:
    def lose(table: Table) -> None:
        table.loc[600:, channel] = math.nan

    relog(lose)
    result = finished()
    name = {"rot[deg/s]": "r", "rudder[deg]": "delta", "stw[m/s]": "u"}[channel]
    assert f"{name}: 600 of 1200 values not available" in remarks(result)
    assert f"{name}: 1 gap, 300.0 s in all, at 299.5-599.5 s; masked" in remarks(result)
    assert compared() == 600


def test_signals_that_are_never_there_together() -> None:
    def lose(table: Table) -> None:
        table.loc[:600, "heel[deg]"] = math.nan
        table.loc[600:, "stw[m/s]"] = math.nan

    relog(lose)
    change("short.toml", 'outputs = ["r"]', 'outputs = ["r", "phi"]')
    refused("output 'phi'", "no sample", "every input", "check gaps")


def test_a_rudder_and_a_rate_that_are_never_there_together() -> None:
    def lose(table: Table) -> None:
        table.loc[:600, "rot[deg/s]"] = math.nan
        table.loc[600:, "rudder[deg]"] = math.nan

    relog(lose)
    refused("output 'r'", "no sample", "every input", "check gaps")


def test_a_marker_for_not_available_is_no_measurement() -> None:
    def mark(table: Table) -> None:
        table.loc[50:60, "rot[deg/s]"] = sys.float_info.max

    relog(mark)
    result = finished()
    assert "r: 11 of 1200 values not available" in remarks(result)
    assert result["fit"]["eps_rmsn"] < 0.1


def test_a_log_that_states_another_unit_than_the_pipeline() -> None:
    change("short.toml", '"deg/s"', '"deg/min"')
    refused("trial 'zigzag'", "signal 'r'", "states 'deg/s'", "'deg/min'", "remove unit")


def test_a_rudder_of_the_wrong_side() -> None:
    change("short.toml", 'positive = "starboard"', 'positive = "port"')
    refused("trial 'zigzag'", "delta looks inverted", "-0.9", 'write positive = "starboard"')


# --- what a record can carry --------------------------------------------------------------------


def test_a_ship_that_lies_still() -> None:
    """Unless nothing is fitted that a rudder must move: a roll decay needs no speed."""
    relog(lambda table: table.assign(**{"stw[m/s]": 0.04 + 1e-3 * np.cos(table["t[s]"])}))
    refused("trial 'zigzag'", "lies still", "0.04 m/s", "U0 is 7.33 m/s", "steers r")
    change("short.toml", 'outputs = ["r"]', 'outputs = ["phi"]')
    change("short.toml", '["Nr", "Ndelta"]', '["Kp0"]')
    assert "lies still" not in trialid_("run", "short.toml", "--out", "out").stderr


def test_a_rate_of_turn_in_another_unit_than_stated() -> None:
    """The line that the error gives mends it."""
    heading = 'psi = { channel = "heading", unit = "deg" }\nphi ='

    def spoil(table: Table) -> Table:
        table = table.rename(columns={"rot[deg/s]": "rot"})
        turned = np.cumsum(table["rot"]) * 0.5
        return table.assign(heading=np.mod(turned, 360.0), rot=60.0 * table["rot"])

    relog(spoil)
    change("short.toml", "phi =", heading)
    line = refused("trial 'zigzag'", "r is 59.9", "the slope of psi", 'unit = "deg/min" for r')
    assert "correlation 1.00" in line
    assert "for psi" not in line  # 57.3 is near 60, but not as near
    change("short.toml", 'unit = "deg/s"', 'unit = "deg/min"')
    finished()


def test_values_that_are_kept_although_they_look_wrong() -> None:
    def spoil(table: Table) -> None:
        table.loc[600, "rot[deg/s]"] = 30.0

    relog(spoil)
    remarks = " ".join(finished()["trials"][0]["remarks"])
    assert "r: 1 value out of line, at 300.0 s; masked" in remarks
    change("short.toml", 'unit = "deg/s" }', 'unit = "deg/s", keep = ["spikes"] }')
    remarks = " ".join(finished("again")["trials"][0]["remarks"])
    assert "at 300.0 s; left as it is" in remarks
    change("short.toml", 'keep = ["spikes"]', 'keep = ["spike"]')
    refused("keep", "'spikes'")


def test_a_rudder_that_never_moves() -> None:
    relog(lambda table: table.assign(**{"rudder[deg]": 5.0}))
    refused("rudder (delta)", "'zigzag'", "nothing excites", "use a trial with a manoeuvre")


def test_a_rudder_that_only_its_sensor_moves() -> None:
    rng = np.random.default_rng(2)

    def still(table: Table) -> None:
        for head, sigma in (("rudder[deg]", 0.02), ("rot[deg/s]", 0.05), ("heel[deg]", 0.1)):
            table[head] = sigma * rng.standard_normal(len(table))

    relog(still)
    refused("rudder (delta)", "'zigzag'", "nothing excites", "use a trial with a manoeuvre")


def test_an_output_that_never_moves() -> None:
    relog(lambda table: table.assign(**{"rot[deg/s]": 0.0}))
    refused("output 'r'", "does not move", "check the channel")


def test_fewer_samples_than_unknowns() -> None:
    relog(lambda table: table[:6])
    change("short.toml", '["Nr", "Ndelta"]', '["Nr", "Ndelta", "Nv", "Yv", "Yr", "Ydelta"]')
    refused("6 compared values for 10 unknowns", "free fewer", "longer record")


def test_one_sample() -> None:
    relog(lambda table: table[:1])
    refused("trial 'zigzag'", "1 values", "at least 4", "another channel")


def test_a_record_of_five_seconds_does_not_pretend() -> None:
    relog(lambda table: table[:10])
    result = finished()
    assert result["verdict"]["kind"] == "no fit"
    assert result["missing"] == []


@pytest.mark.parametrize("window", ["[5000.0, 6000.0]", "[-50.0, 60.0]"])
def test_a_window_outside_of_the_record(window: str) -> None:
    change("short.toml", '["log.csv"]', f'["log.csv"]\nwindow = {window}')
    refused("trial 'zigzag'", "window = [", "599.5 s that all channels cover")


def test_a_window_that_reaches_past_the_end_is_cut() -> None:
    change("short.toml", '["log.csv"]', '["log.csv"]\nwindow = [100.0, 5000.0]')
    assert "before the window does" in remarks(finished())


def test_a_period_longer_than_the_record() -> None:
    change("short.toml", "period = 0.5", "period = 5000.0")
    refused("trial 'zigzag'", "599.5 s hold 1 samples 5000 s apart", "a shorter period")


def test_a_period_too_long_to_integrate() -> None:
    change("short.toml", "period = 0.5", "period = 30.0")
    refused("period", "30 s", "shorter")


def test_a_period_of_a_nanosecond() -> None:
    change("short.toml", "period = 0.5", "period = 1e-9")
    refused("trial 'zigzag'", "period = 1e-09 s", "a longer period")


# --- the model ----------------------------------------------------------------------------------


@pytest.mark.parametrize("free", ['["Nr", "Ndelta"]', '["Ndelta"]'])
def test_a_start_that_diverges(free: str) -> None:
    change("short.toml", '"linear_roll"]', '"linear_roll"]\nvalues = { Nr = 5.0 }')
    change("short.toml", '["Nr", "Ndelta"]', free)
    refused("cannot be simulated at its start values", "at t = 0.5 s", "nearer values",
            "[model.values]")  # fmt: skip


def test_bounds_that_leave_out_the_start() -> None:
    change("short.toml", "[diagnose]", "[identify.bounds]\nNr = [1.0, 2.0]\n[diagnose]")
    refused("short.toml: identify.bounds.Nr", "[1, 2]", "-0.00247579")


@pytest.mark.parametrize("output", ["u", "delta"])
def test_an_output_that_is_an_input(output: str) -> None:
    change("short.toml", 'outputs = ["r"]', f'outputs = ["{output}"]')
    refused(f"output '{output}' is not simulated", "v, p, r, phi")


def test_an_output_that_no_channel_measures() -> None:
    change("short.toml", 'outputs = ["r"]', 'outputs = ["v"]')
    refused("trial 'zigzag'", "no signal 'v'", "map it in [trial.signals]", "delta, phi, r, u")


def test_a_signal_that_an_effect_needs_and_no_channel_gives() -> None:
    change("short.toml", '"linear_roll"]', '"linear_roll", "propeller_thrust"]')
    refused("trial 'zigzag'", "no signal 'n'", "'propeller_thrust' needs", "leave the effect out")


def test_a_rudder_that_no_channel_gives() -> None:
    change("short.toml", SIGNALS.strip().splitlines()[1] + "\n", "")
    refused("trial 'zigzag'", "no signal 'delta'", "'linear_rudder' needs", "[trial.signals]")


def test_a_parameter_that_leaves_no_trace_is_named_and_not_known() -> None:
    change("short.toml", '"linear_roll"]', '"linear_roll", "surge_resistance"]')
    change("short.toml", '"Ndelta"]', '"Ndelta", "Xuu"]')
    result = finished()
    assert [w["parameters"] for w in result["accuracy"]["weak"]] == [["Xuu"]]
    assert "Xuu leaves no trace" in Path("out/report.html").read_text(encoding="utf-8")
    rows = {row["name"]: row for row in result["accuracy"]["parameters"]}
    assert rows["Xuu"]["standard_error"] is None
    assert rows["Xuu"]["relative_error"] is None
    assert rows["Nr"]["standard_error"] > 0.0


def test_two_parameters_that_are_copies_are_named_and_not_known() -> None:
    with_effect(COPY)
    result = finished()
    (weak,) = result["accuracy"]["weak"]
    assert sorted(weak["parameters"]) == ["Nr", "Nx"]
    assert "cannot be told apart" in weak["sentence"]
    rows = {row["name"]: row for row in result["accuracy"]["parameters"]}
    for name in ("Nr", "Nx"):
        error = rows[name]["standard_error"]
        assert error is None or error > abs(rows[name]["value"])
    assert rows["Ndelta"]["standard_error"] > 0.0


def test_a_roll_decay_needs_no_rudder_and_no_yaw() -> None:
    for line in SIGNALS.strip().splitlines()[1:3]:
        change("short.toml", line + "\n", "")
    change("short.toml", '["v", "p", "r", "phi"]', '["p", "phi"]')
    change("short.toml", '"linear_hull", "linear_rudder", ', "")
    change("short.toml", '["Nr", "Ndelta"]', '["GM", "Kp"]')
    change("short.toml", 'outputs = ["r"]', 'outputs = ["phi"]')
    change("short.toml", '"none"', '"all"')
    result = finished()
    assert "r" in result["not_tried"]["gyro_cross_axis"]
    assert "delta" in result["not_tried"]["rudder_offset"]


# --- the user's own effects ---------------------------------------------------------------------


@pytest.mark.parametrize(("old", "new", "words"), [
    pytest.param("Nx=-0.001):", "Nx=-0.001)", ("line 4",), id="syntax"),
    pytest.param("from trialid", "import nowhere\nfrom trialid", ("'nowhere'",), id="import"),
    pytest.param("@effect", "@efect", ("'efect'",), id="misspelt name"),
    pytest.param('@effect(source="the mate")\n', "", ("no effect", "@effect"), id="none"),
    pytest.param('    "N = Nx v|v|: what the mate thinks."\n', "",
                 ("'mine'", "no docstring", "write its equation"), id="no docstring"),
    pytest.param("(v, r,", "(v, rr,", ("'mine'", "'rr'", "did you mean 'r'"), id="unknown signal"),
    pytest.param("Nx=-0.001", "Nx", ("'mine'", "'Nx' has no typical value", "Nx=..."),
                 id="no start"),
    pytest.param("Nx=-0.001", 'Nx="x"', ("'mine'", "'Nx'", "'x'"), id="a word for a start"),
    pytest.param("Nx=-0.001", "Nx=0.0", ("'mine'", "'Nx'", "0"), id="a start without a size"),
    pytest.param("return Force(N=Nx * v * abs(v))", "return Nx * v",
                 ("'mine'", "returns float", "Force"), id="returns a number"),
    pytest.param("return Force(N=Nx * v * abs(v))", "return Force(N='x')",
                 ("'mine'",), id="returns a word"),
    pytest.param("return Force(N=Nx * v * abs(v))", "return ()",
                 ("'mine'", "Force"), id="returns nothing"),
    pytest.param("return Force(N=Nx * v * abs(v))", "return Measured(psi=Nx * v)",
                 ("'mine'", "psi"), id="measures what is neither state nor record"),
    pytest.param("return Force", "if v > 0.0:\n        return Force(N=0.0)\n    return Force",
                 ("'mine'", "branch", "abs"), id="branches on a signal"),
    pytest.param("return Force", "if v:\n        return Force(N=0.0)\n    return Force",
                 ("'mine'", "branch", "abs"), id="branches on a truth"),
    pytest.param("Nx * v * abs(v)", "Nx * max(v, 0.0)", ("'mine'", "branch", "abs"),
                 id="takes the larger"),
    pytest.param("Nx * v * abs(v)", "Nx * __import__('numpy').sin(v)",
                 ("'mine'", "trialid.maths", "sin"), id="numpy"),
    pytest.param("Nx * v * abs(v)", "Nx * __import__('math').sin(v)",
                 ("'mine'", "trialid.maths", "sin"), id="math"),
    pytest.param("Nx * v * abs(v)", "Nx * abs(v) ** 1.5",
                 ("'mine'", "1.5", "whole powers"), id="a broken power"),
    pytest.param("Nx * v * abs(v)", "Nx * v * r / abs(v)", ("'mine'", "at rest"),
                 id="divides by zero at rest"),
    pytest.param("Nx * v * abs(v)", "Nx * v * __import__('trialid.maths').maths.sqrt(v)",
                 ("'mine'", "at rest"), id="a root without a slope at rest"),
    pytest.param("from trialid", "1 / 0\nfrom trialid", ("division by zero",), id="raises"),
    pytest.param("from trialid", "open('table.csv')\nfrom trialid", ("table.csv",),
                 id="reads a file that is not there"),
])  # fmt: skip
def test_a_users_effect_that_cannot_be_used(old: str, new: str, words: tuple[str, ...]) -> None:
    assert old in EFFECT
    with_effect(EFFECT.replace(old, new, 1))
    refused("mine.py", *words)


def test_a_users_effect_that_can_be_used() -> None:
    with_effect(EFFECT)
    assert "mine" in finished()["model"]["effects"]


def test_a_users_effect_of_another_encoding() -> None:
    with_effect("")
    Path("mine.py").write_bytes(b"# M\xfcller\n" + EFFECT.encode())
    refused("mine.py", "UTF-8")


def test_a_users_effect_with_the_parameter_of_another() -> None:
    with_effect(EFFECT.replace("Nx", "Kp"))
    refused("'mine'", "'linear_roll'", "both have 'Kp'", "rename")


def test_a_users_effect_that_is_not_there() -> None:
    with_effect(EFFECT)
    Path("mine.py").rename("mien.py")
    refused("short.toml: model.effects_from[0]", "no file 'mine.py'", "'mien.py'")


# --- the ship -----------------------------------------------------------------------------------


def test_a_ship_that_is_not_there() -> None:
    Path("ship.toml").rename("shipp.toml")
    refused("short.toml: ship", "no file 'ship.toml'", "did you mean 'shipp.toml'")


@pytest.mark.parametrize(("old", "new", "words"), [
    pytest.param("rudder_positive", "ruder_positive",
                 ("'ruder_positive'", "unknown key", "'rudder_positive'"), id="wrong key"),
    pytest.param('rudder_positive = "starboard"\n', "",
                 ("'rudder_positive' is missing", '"starboard"', '"port"'), id="no side"),
    pytest.param('rudder_positive = "starboard"', 'rudder_positive = "left"',
                 ("rudder_positive = 'left'", "'starboard', 'port'"), id="unknown side"),
    pytest.param("nabla = ", "nbla = ", ("[particulars]", "nabla"), id="wrong particular"),
    pytest.param("L = 175.0", 'L = "175"', ("[particulars] L = '175'", "not a number"),
                 id="a word for a number"),
    pytest.param("[mass]", "[mass", ("not valid TOML", "line"), id="not TOML"),
    pytest.param("I_zz = ", "Izz = ", ("[mass]", "Izz", "'I_zz'"), id="wrong mass"),
    pytest.param("Yvdot = ", "Yv_dot = ", ("[mass]", "Yv_dot", "'Yvdot'"), id="wrong added mass"),
    pytest.param("L = 175.0", "L = 0.0", ("[particulars] L", "0", "positive"), id="no length"),
    pytest.param("L = 175.0", "L = -175.0", ("[particulars] L", "-175", "positive"),
                 id="negative length"),
    pytest.param("U0 = 7.33", "U0 = -1.0", ("[particulars] U0", "-1", "positive"), id="no speed"),
    pytest.param("Yv = -0.01189081", "Yv = nan", ("[coefficients] Yv", "nan"), id="nan"),
    pytest.param("[mass]\nm = 0.00792", "[mass]\nm = nan", ("[mass] m", "nan"), id="nan mass"),
    pytest.param('system = "prime"', 'system = "prime"\ncoefficient_speed = "x"',
                 ("coefficient_speed", "'x'", "not a number"), id="a word for a speed"),
])  # fmt: skip
def test_a_ship_that_is_none(old: str, new: str, words: tuple[str, ...]) -> None:
    change("ship.toml", old, new)
    refused("ship.toml", *words)


def test_a_ship_without_tables() -> None:
    head, _, _ = Path("ship.toml").read_text(encoding="utf-8").partition("[particulars]")
    Path("ship.toml").write_text(f"{head}particulars = 3\nmass = 3\n", encoding="utf-8")
    refused("ship.toml", "particulars = 3", "[particulars]")


def test_a_mass_matrix_that_cannot_be() -> None:
    change("short.toml", '"linear_roll"]', '"linear_roll"]\nvalues = { Yvdot = 5.0 }')
    refused("S175Q", "mass matrix", "not positive", "added masses")


def test_a_ship_of_another_encoding() -> None:
    ship = Path("ship.toml").read_bytes()
    Path("ship.toml").write_bytes(b"# M\xfcller\n" + ship)
    refused("ship.toml", "UTF-8")


# --- trials that are held out -------------------------------------------------------------------


def too_much_rudder(table: Table) -> None:
    table["rudder[deg]"] *= 4.4  # 88 degrees: somebody took a share of the travel for degrees


def test_a_rudder_that_no_gear_can_reach() -> None:
    def radians_for_degrees(table: Table) -> None:
        table["rudder[deg]"] *= 60.0

    relog(radians_for_degrees)
    refused("'delta'", "values are beyond 90 deg", "the unit is wrong", "correct unit")


def test_a_check_run_that_leaves_the_domain_is_said() -> None:
    with_check(too_much_rudder)
    result = finished()
    said = remarks(result, trial=1)
    assert "left the model's domain at t = 162.5 s" in said
    assert "so the trial has no score" in said
    page = Path("out/report.html").read_text(encoding="utf-8")
    assert "domain at t = 162.5 s" in page
    series = pd.read_csv("out/series.csv")
    held_out = series[series["trial"] == "held-out"]
    assert 0 < held_out["r_residual_radps"].count() < 330
    assert result["fit"]["converged"]


def test_a_check_run_that_leaves_the_domain_is_no_success() -> None:
    """A wild first sample is no place to start: the search starts where the rest of them say."""

    def heel(table: Table) -> None:
        table.loc[0, "heel[deg]"] = 89.0

    with_check(heel)
    result = finished()
    assert 0.0 < result["fit"]["eps_rmsn_check"] < 0.1


def test_a_check_run_without_an_output() -> None:
    with_check(lambda table: None)
    text = Path("short.toml").read_text(encoding="utf-8")
    kept, _, check = text.partition(CHECK)
    bare = CHECK.replace('r = { channel = "rot", unit = "deg/s" }\n', "")
    Path("short.toml").write_text(kept + bare + check, encoding="utf-8")
    refused("trial 'held-out'", "no signal 'r'", "map it in [trial.signals]")


# --- where the results go -----------------------------------------------------------------------


def test_a_folder_that_is_not_of_a_run_is_left_alone() -> None:
    Path("out").mkdir()
    Path("out/letter.txt").write_text("Dear Sir", encoding="utf-8")
    refused("out", "holds other files and no earlier run", "choose another --out")


def test_a_file_is_left_alone() -> None:
    refused("log.csv", "is a file", "--out takes a folder", out="log.csv")


def test_a_folder_that_this_run_reads_from_is_left_alone() -> None:
    refused("short.toml", "which this run reads", "choose another --out", out=".")


def test_an_earlier_run_outlives_a_wrong_one() -> None:
    finished()
    change("short.toml", 'positive = "starboard"', 'positive = "port"')
    refused("looks inverted")


def test_a_place_below_a_file() -> None:
    refused("log.csv/run", "cannot be written", out="log.csv/run")


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="a read-only place of Linux")
def test_a_place_nobody_may_write_to() -> None:
    refused("/proc/run", "cannot be written", out="/proc/run")


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_without_the_right_to_write() -> None:
    Path("locked").mkdir(mode=0o500)
    refused("locked/run", "cannot be written", "permission denied", out="locked/run")


def test_a_name_too_long_for_the_disk() -> None:
    refused("too long", out="x" * 260)


def test_a_place_that_cannot_be_written_leaves_no_folders(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("trialid.workflow.write_run.write_page", full)
    refused("a/b/run", "cannot be written", "no space left", out="a/b/run")


def full(*_: object) -> None:
    raise OSError(errno.ENOSPC, "No space left on device")


def stopped(*_: object) -> None:
    raise KeyboardInterrupt


def test_a_full_disk_leaves_the_earlier_run(monkeypatch: pytest.MonkeyPatch) -> None:
    finished()
    monkeypatch.setattr("trialid.workflow.write_run.write_page", full)
    refused("out", "cannot be written", "no space left on device")


def test_the_keyboard_leaves_the_earlier_run(monkeypatch: pytest.MonkeyPatch) -> None:
    finished()
    before = listing()
    monkeypatch.setattr("trialid.workflow.write_run.write_page", stopped)
    outcome = trialid_("run", "short.toml", "--out", "out")
    assert (outcome.exit_code, outcome.stdout) == (130, "")
    assert outcome.stderr == "trialid: stopped; no half-written results are left\n"
    assert listing() == before


def test_no_place_for_compiled_code_is_no_reason_to_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TRIALID_CACHE", str(Path("log.csv").resolve() / "kernels"))
    assert finished()["fit"]["converged"]


@pytest.mark.study(turn=3)
def test_torn_compiled_code_is_compiled_again(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TRIALID_CACHE", str(Path("kernels").resolve()))
    assert spawn("run", "short.toml", "--out", "first").returncode == 0
    for kernel in Path("kernels").iterdir():
        kernel.write_bytes(kernel.read_bytes()[:100])
    again = spawn("run", "short.toml", "--out", "second")
    assert (again.returncode, again.stderr) == (0, "")


def test_wrong_input_in_a_real_process() -> None:
    change("short.toml", 'positive = "starboard"', 'positive = "port"')
    before = listing()
    outcome = spawn("run", "short.toml")
    assert (outcome.returncode, outcome.stdout) == (2, "")
    assert outcome.stderr.startswith("trialid: trial 'zigzag': delta looks inverted")
    assert outcome.stderr.count("\n") == 1
    assert listing() == before


def test_a_wrong_effect_in_a_real_process() -> None:
    with_effect(EFFECT.replace("return", "if v > 0.0:\n        return Force()\n    return", 1))
    outcome = spawn("run", "short.toml")
    assert (outcome.returncode, outcome.stdout) == (2, "")
    assert outcome.stderr.count("\n") == 1


def test_a_run_in_a_real_process_is_quiet_on_stderr() -> None:
    with_effect(COPY)
    outcome = spawn("run", "short.toml")
    assert (outcome.returncode, outcome.stderr) == (0, "")
    assert "Report: runs/short/report.html" in outcome.stdout
