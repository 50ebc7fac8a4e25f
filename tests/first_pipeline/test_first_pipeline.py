"""A starter pipeline runs, says why it takes what it takes, and leaves open what it cannot know."""

import dataclasses
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest
from geared_rudder import geared

from trialid import pipeline_file
from trialid.errors import LogError, PipelineError
from trialid.inspection import inspect_log
from trialid.pipeline_file.prior_section import OfTheShip
from trialid.ship.estimate import Given
from trialid.ship.particulars import read_ship
from trialid.workflow.first_pipeline import starter
from trialid.workflow.first_pipeline.chosen import OPEN
from trialid.workflow.run import run as run_pipeline

SAMPLES = Path(__file__).parents[2] / "sample_data"
LOGS = [
    SAMPLES / "hidden_effect" / name
    for name in ("zigzag-10.mcap", "zigzag-20.mcap", "binary-15.mcap", "zigzag-15.csv")
]
L, U = 100.0, 6.0
RADIUS = 15.0  # s, time constant of the yaw rate of the made trials


def begun(folder, logs, ship=None, length=L, speed=None, **particulars):
    """The pipeline written, as `inspect --init` writes it."""
    given = Given(length=length, **particulars)
    made = starter([inspect_log(log) for log in logs], folder / "p.toml", ship, given, speed)
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    return made


def trial(seconds=600.0, gain=-0.05, seed=0):
    """Times [s], rudder [deg], yaw rate [deg/s], heading [deg], speed [m/s] of a made trial."""
    rng = np.random.default_rng(seed)
    t = np.arange(0, seconds, 0.5)
    delta = geared(10 * np.sign(np.sin(0.05 * t) + 0.3 * np.sin(0.013 * t)))
    r = np.zeros(len(t))
    for k in range(len(t) - 1):
        r[k + 1] = r[k] + 0.5 * (gain * delta[k] - r[k]) / RADIUS
    noise, other = rng.normal(size=(2, len(t)))
    return t, delta, r + 0.002 * noise, np.cumsum(r) * 0.5 + 40, U + 0.1 * other


def written(path, **columns):
    rows = np.column_stack(list(columns.values()))
    heads = [head.replace("_in_", "[").replace("_per_", "/") for head in columns]
    heads = [f"{head}]" if "[" in head else head for head in heads]
    np.savetxt(path, rows, delimiter=",", header=",".join(heads), comments="", fmt="%.9g")
    return path


def signals(folder, place=0):
    return tomllib.loads((folder / "p.toml").read_text())["trial"][place]["signals"]


@pytest.mark.study(turn=7)
def test_the_sample_logs_give_a_pipeline_that_runs_at_once(tmp_path):
    assert begun(tmp_path, LOGS, length=175.0).to_fill == ()
    done = run_pipeline(pipeline_file.load(tmp_path / "p.toml"))
    assert [t.use for t in done.result.trials] == ["fit", "fit", "check", "fit"]
    assert done.result.fit.converged
    assert done.result.fit.eps_rmsn < 0.2
    assert done.result.verdict.kind == "missing"


def test_it_maps_the_sample_logs_as_their_own_pipeline_does(tmp_path):
    begun(tmp_path, LOGS, length=175.0)
    own = pipeline_file.load(SAMPLES.parent / "pipelines" / "hidden_effect.toml")
    for ours, theirs in zip(
        pipeline_file.load(tmp_path / "p.toml").trials, own.trials, strict=True
    ):
        for quantity, source in theirs.signals.items():
            found = ours.signals[quantity]
            assert found.channel == source.channel
            assert found.angle == source.angle
            assert (found.unit or "rad") == (source.unit or "rad")
            assert (found.positive or "starboard") == (source.positive or "starboard")


@pytest.mark.parametrize(("gain", "side"), [(-0.05, "port"), (0.05, "starboard")])
def test_the_side_of_the_rudder_is_measured_with_its_figure(tmp_path, gain, side):
    t, delta, r, _, u = trial(gain=gain)
    log = written(
        tmp_path / "a.csv", t=t, rudder_in_deg=delta, rot_in_deg_per_s=r, stw_in_m_per_s=u
    )
    begun(tmp_path, [log])
    assert signals(tmp_path)["delta"]["positive"] == side
    text = (tmp_path / "p.toml").read_text()
    figure = re.search(r"correlation with .*rot, ([+-][01]\.\d\d)", text)
    assert float(figure[1]) * np.sign(gain) > 0.9
    done = run_pipeline(pipeline_file.load(tmp_path / "p.toml"))
    assert done.result.fit.eps_rmsn < 0.05


def test_a_side_nobody_can_know_is_left_open_and_the_run_says_so(tmp_path):
    t, _, r, _, u = trial()
    noise = np.random.default_rng(3).normal(size=len(t))
    log = written(
        tmp_path / "a.csv", t=t, rudder_in_deg=noise, rot_in_deg_per_s=r, stw_in_m_per_s=u
    )
    made = begun(tmp_path, [log])
    assert signals(tmp_path)["delta"]["positive"] == OPEN
    assert made.to_fill
    with pytest.raises(PipelineError, match=r"trial\[0\].signals.delta.positive.*starboard"):
        pipeline_file.load(tmp_path / "p.toml")


def test_a_rate_of_turn_counted_to_port_is_told_by_the_heading(tmp_path):
    t, delta, r, psi, u = trial()
    log = written(
        tmp_path / "a.csv",
        t=t,
        rudder_in_deg=delta,
        rot=-60 * r,
        heading_in_deg=psi % 360,
        stw_in_m_per_s=u,
    )
    begun(tmp_path, [log])
    found = signals(tmp_path)
    assert found["r"] == {"channel": "rot", "unit": "deg/min", "positive": "port"}
    assert found["delta"]["positive"] == "port"
    assert "unit by the slope of heading" in (tmp_path / "p.toml").read_text()


def test_a_rate_of_turn_without_a_unit_is_sized_by_the_ship(tmp_path):
    t, delta, r, _, u = trial()
    log = written(tmp_path / "a.csv", t=t, rudder_in_deg=delta, rot=60 * r, stw_in_m_per_s=u)
    begun(tmp_path, [log])
    assert signals(tmp_path)["r"]["unit"] == "deg/min"
    assert "r L / U would be" in (tmp_path / "p.toml").read_text()


def test_with_a_heading_alone_the_heading_is_the_output(tmp_path):
    t, delta, _, psi, u = trial()
    log = written(
        tmp_path / "a.csv",
        t=t,
        rudder_in_deg=delta,
        heading_in_deg=psi % 360,
        stw_in_m_per_s=u,
    )
    begun(tmp_path, [log])
    made = pipeline_file.load(tmp_path / "p.toml")
    assert made.identify.outputs == ("psi",)
    assert run_pipeline(made).result.fit.converged


def test_with_an_order_alone_the_rudder_follows_it(tmp_path):
    t, delta, r, _, u = trial()
    log = written(
        tmp_path / "a.csv",
        t=t,
        rudder_order_in_deg=delta,
        rot_in_deg_per_s=r,
        stw_in_m_per_s=u,
    )
    begun(tmp_path, [log])
    made = pipeline_file.load(tmp_path / "p.toml")
    assert "rudder_servo" in made.model.effects
    assert run_pipeline(made).result.fit.eps_rmsn < 0.1


def test_a_speed_over_ground_is_the_speed_where_no_log_is(tmp_path):
    t, delta, r, _, u = trial()
    log = written(
        tmp_path / "a.csv", t=t, rudder_in_deg=delta, rot_in_deg_per_s=r, sog_in_m_per_s=u
    )
    begun(tmp_path, [log])
    made = pipeline_file.load(tmp_path / "p.toml")
    assert made.trials[0].speed is None
    assert signals(tmp_path)["u"]["channel"] == "sog"
    assert "over ground" in made.text
    assert run_pipeline(made).result.fit.converged


def test_the_stated_speed_settles_the_unit_of_the_log(tmp_path):
    t, delta, r, _, u = trial()
    log = written(tmp_path / "a.csv", t=t, rudder_in_deg=delta, stw=u / 0.5144, rot_in_deg_per_s=r)
    with pytest.raises(LogError, match="add --speed KNOTS"):
        begun(tmp_path, [log])
    begun(tmp_path, [log], speed=U)
    assert signals(tmp_path)["u"]["unit"] == "kn"


def test_the_placeholder_says_that_it_is_one_and_keeps_the_length(tmp_path):
    begun(tmp_path, LOGS[:1], length=42.5)
    ship = read_ship(tmp_path / "p_ship.toml")
    assert ship.particulars["L"] == 42.5
    assert ship.source.startswith("PLACEHOLDER")
    mass = ship.mass["m"] * 0.5 * 42.5**3
    assert ship.particulars["nabla"] == pytest.approx(mass, rel=1e-3)


def test_what_is_known_of_the_ship_goes_into_her_file(tmp_path):
    """Length, beam, draught and displacement; the speed from the log, with the words for it."""
    begun(tmp_path, LOGS[:1], length=42.5, beam=9.0, draught=3.1, displacement=700e3, GM=0.8)
    ship = read_ship(tmp_path / "p_ship.toml")
    known = {n: ship.particulars[n] for n in ("L", "B", "T")}
    assert known == {"L": 42.5, "B": 9.0, "T": 3.1}
    assert ship.particulars["nabla"] == pytest.approx(700.0 / 1.025, rel=1e-4)
    assert ship.coefficients["GM"] == 0.8
    assert ship.source.startswith("Estimated from her particulars")
    text = (tmp_path / "p_ship.toml").read_text(encoding="utf-8")
    assert re.search(r"^U0 = [67][.\d]*  # m/s, what .* seldom exceeds, speed thr", text, re.M)
    made = pipeline_file.load(tmp_path / "p.toml")
    assert isinstance(made.identify.priors, OfTheShip)


@pytest.mark.parametrize(("known", "held"), [("", False), ("\n[uncertainty]\nNr = 0.3\n", True)])
def test_a_file_that_says_how_it_scatters_holds_by_that(tmp_path, known, held):
    ship = tmp_path / "own.toml"
    text = (SAMPLES / "ships" / "s175q.toml").read_text(encoding="utf-8")
    ship.write_text(text + known, encoding="utf-8")
    begun(tmp_path, LOGS[:1], ship=ship, length=None)
    made = pipeline_file.load(tmp_path / "p.toml")
    assert isinstance(made.identify.priors, OfTheShip) == held


def test_an_own_ship_file_is_taken_and_no_placeholder_made(tmp_path):
    made = begun(tmp_path, LOGS[:1], ship=SAMPLES / "ships" / "s175.toml", length=None)
    assert list(made.files) == [tmp_path / "p.toml"]
    assert pipeline_file.load(tmp_path / "p.toml").ship.name == "s175.toml"


def test_the_period_is_what_logs_and_ship_allow(tmp_path):
    begun(tmp_path, LOGS[:1], length=175.0)
    assert pipeline_file.load(tmp_path / "p.toml").align.period == 0.5
    begun(tmp_path, LOGS[:1], length=20.0)  # 4 Hz logs, and 3 s for her length
    assert pipeline_file.load(tmp_path / "p.toml").align.period == 0.25


def test_other_sources_stand_beside_commented_out(tmp_path):
    t, delta, r, _, u = trial()
    rates = dict.fromkeys(("rot_in_deg_per_s", "yaw_rate_in_deg_per_s"), r)
    log = written(tmp_path / "a.csv", t=t, rudder_in_deg=delta, **rates, stw_in_m_per_s=u)
    begun(tmp_path, [log])
    text = (tmp_path / "p.toml").read_text()
    assert '# or r = { channel = "yaw_rate", unit = "deg/s" }  # 2 Hz' in text
    swapped = text.replace("r     = {", "# r = {").replace(
        "# or r = { channel =", "r = { channel ="
    )
    (tmp_path / "q.toml").write_text(swapped)
    assert pipeline_file.load(tmp_path / "q.toml").trials[0].signals["r"].channel == "yaw_rate"
    mean = text.replace("r     = {", "# r = {").replace("# or r = { channels", "r = { channels")
    (tmp_path / "m.toml").write_text(mean)
    r = pipeline_file.load(tmp_path / "m.toml").trials[0].signals["r"]
    assert r.names == ("rot", "yaw_rate")


def test_no_rudder_no_motion_no_ship_are_one_line_each(tmp_path):
    t, delta, r, _, u = trial()
    own = {"t": t, "rot_in_deg_per_s": r, "stw_in_m_per_s": u}
    still = written(tmp_path / "a.csv", rudder_in_deg=0 * t, **own)
    blind = written(tmp_path / "b.csv", t=t, rudder_in_deg=delta, stw_in_m_per_s=u)
    for log, words in ((still, "no moving rudder"), (blind, "no moving yaw rate or heading")):
        with pytest.raises(LogError, match=words) as caught:
            begun(tmp_path, [log])
        ends = [line.rpartition("; see ")[2] for line in str(caught.value).split("\n")]
        assert ends == [f"`trialid inspect --all {log}`, and map them by hand"]
    with pytest.raises(LogError, match=r"add --ship SHIP.toml, or --length"):
        begun(tmp_path, LOGS[:1], length=None)


def test_logs_that_share_no_motion_are_refused(tmp_path):
    t, delta, r, psi, u = trial()
    one = written(
        tmp_path / "a.csv", t=t, rudder_in_deg=delta, rot_in_deg_per_s=r, stw_in_m_per_s=u
    )
    two = written(
        tmp_path / "b.csv", t=t, rudder_in_deg=delta, heading_in_deg=psi, stw_in_m_per_s=u
    )
    with pytest.raises(LogError, match=r"share no yaw motion \(a.csv: r; b.csv: psi\)"):
        begun(tmp_path, [one, two])


def test_a_channel_s_name_can_neither_break_the_file_nor_the_terminal(tmp_path):
    t, delta, r, _, u = trial()
    log = tmp_path / "a.csv"
    written(log, t=t, rudder_in_deg=delta, rot_in_deg_per_s=r, stw_in_m_per_s=u)
    evil = "yaw rate\"]' = 1 # \\ \x1b[31m \x7f\nx = 1"
    found = inspect_log(log)
    channels = {
        key: dataclasses.replace(one, name=evil if one.name == "rot" else one.name)
        for key, one in found.channels.items()
    }
    made = starter(
        [dataclasses.replace(found, channels=channels)], tmp_path / "p.toml", None, Given(length=L)
    )
    text = made.files[tmp_path / "p.toml"]
    assert tomllib.loads(text)["trial"][0]["signals"]["r"]["channel"] == evil
    assert "\x1b" not in text
    assert "\x7f" not in text
