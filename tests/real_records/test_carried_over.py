"""What is named on real records, over choices that must not matter.

Esso Osaka: zig-zags of a 3 m model on a pond, in wind that was measured. KVLCC2: zig-zags of a 7 m
model in a basin, and a roll decay of one of 4.7 m. All of it is a study: hours, not minutes.
"""

import shutil
from itertools import combinations

import numpy as np
import pytest
from real_record import DATA, HERE, added, stages
from test_kvlcc2_zigzag import RECORDS as ZIGZAGS
from test_kvlcc2_zigzag import columns, in_ship
from turns import TURNS

from trialid import pipeline_file
from trialid.diagnosis.search.backward import worth_naming
from trialid.diagnosis.search.refit import of_the_ship
from trialid.effects import CATALOGUE
from trialid.workflow import run

ESSO = DATA / "esso_osaka"
DECAY = DATA / "kvlcc2_roll_decay" / "model_test_21337.csv"
pytestmark = [
    pytest.mark.study, pytest.mark.real_data,
    pytest.mark.skipif(not ESSO.is_dir(), reason=f"no real records {ESSO}"),
]  # fmt: skip
WIND = {"apparent_wind", "apparent_wind_yaw", "steady_wind"}


def of_a_clock(name):
    return name.startswith(("lag_", "delay_", "clock_", "bias_", "scale_"))


def moves_the_ship(name):
    """Whether an effect is of the ship; a coefficient that is held fixed, and freed, is."""
    return name not in CATALOGUE or of_the_ship(CATALOGUE[name])


def held_out(done):
    return [s.run.result.fit.eps_rmsn_check for s in done if s.kept]


def tell(what, done):
    """One row of a table; printed."""
    steps = " ".join(("+" if s.added else "-") + str(s.added or s.dropped)
                     for s in done[1:] if s.kept)  # fmt: skip
    held = " ".join(f"{100.0 * x:.1f}" for x in held_out(done))
    worth = ", ".join(f"{w.effect} x {w.costs:.2f}" for w in done[-1].worths)
    print(f"| {what} | {steps} | {worth} | {held} | {done[-1].end} |")


def names_said(done):
    """Every effect that a verdict named on the way, and what is named in the end."""
    verdicts = [s.run.result.verdict.effect for s in done]
    return {*filter(None, verdicts), *worth_naming(done[-1].worths)}


# --- Esso Osaka ---------------------------------------------------------------------------------

SHIP = """\
name = "Esso Osaka, model of 3 m"
source = "FRT-DS-ESSO, its README; added masses and first values those of a tanker"
system = "prime"
rudder_positive = "starboard"
[particulars]
L = 3.0
B = 0.489
T = 0.201
nabla = 0.2446
rho = 1000.0
g = 9.81
U0 = 0.4
[mass]
m = 0.018119
x_G = 0.03133
I_zz = 0.00115
Xudot = -0.0013
Yvdot = -0.0145
Nrdot = -0.0007
[coefficients]
Yv = -0.0205
Yr = 0.004
Nv = -0.0089
Nr = -0.0032
Kv = 0.0
Kr = 0.0
Kdelta = 0.0
Ydelta = -0.003
Ndelta = 0.0015
"""
PIPELINE = """
[signals]
delta = { channel = "delta_rudder", unit = "rad", positive = "starboard" }
r = { channel = "r_angvelo", unit = "rad/s" }
v = { channel = "vm_velo", unit = "m/s" }
u = { channel = "u_velo", unit = "m/s" }
n = { channel = "n_prop", unit = "rps" }
psi = { channel = "psi_hat", unit = "rad" }
V_aw = { channel = "wind_velo_relative_mid", unit = "m/s" }
gamma_aw = { channel = "wind_dir_relative_mid", unit = "rad" }
[align]
period = 0.2
[model]
states = ["v", "r"]
effects = ["linear_hull", "linear_rudder"]
[identify]
free = ["Yv", "Yr", "Nv", "Nr", "Ndelta"]
outputs = ["r", "v"]
nuisance = ["initial_state", "bias", "rudder_offset", "delay"]
max_iterations = 100
"""


@pytest.fixture(scope="module")
def pond(tmp_path_factory):
    """The ship's file and the zig-zags, without the rows of commas at the end of one of them."""
    folder = tmp_path_factory.mktemp("pond")
    (folder / "ship.toml").write_text(SHIP, encoding="utf-8")
    for record in sorted(ESSO.glob("zigzag*.csv")):
        lines = [x for x in record.read_text(encoding="utf-8").splitlines() if x.strip(",")]
        name = record.stem.split("_", 2)[-1]
        (folder / f"{name}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return folder


def on_the_pond(folder, held):
    """A pipeline with these trials held out."""
    trials = [
        f'[[trial]]\nname = "{p.stem}"\nlogs = ["{p.name}"]\n'
        + ('use = "check"\n' if p.stem in held else "")
        for p in sorted(folder.glob("*.csv"))
    ]
    path = folder / f"{'-'.join(held)}.toml"
    path.write_text(f'name = "pond"\nship = "ship.toml"\n{"".join(trials)}{PIPELINE}',
                    encoding="utf-8")  # fmt: skip
    return path


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("part", range(TURNS))
@pytest.mark.xfail(strict=False, reason="a goal: not met yet on every split and base")
def test_the_wind_is_named_whatever_is_held_out(pond, part):
    """A wind effect first, no clock named, the error never rises, and ends at 35 of 43 %.

    Every fifth of the 21 choices of the two.
    """
    logs = sorted(p.stem for p in pond.glob("*.csv"))
    first, errors, clocks = [], [], []
    for held in list(combinations(logs, 2))[part::TURNS]:
        done = stages(on_the_pond(pond, held), {})
        tell(" ".join(held), done)
        first.append(done[0].run.result.verdict.effect)
        errors.append(held_out(done))
        clocks += [n for n in names_said(done) if of_a_clock(n)]
    begun, ended = np.mean([e[0] for e in errors]), np.mean([e[-1] for e in errors])
    print(f"held out {begun:.1%} to {ended:.1%}; first: {first}; of a clock: {clocks}")
    assert all(e == sorted(e, reverse=True) for e in errors)
    assert all(n in WIND for n in first)
    assert ended <= 0.35 / 0.43 * begun
    assert clocks == []


# --- KVLCC2, zig-zags ---------------------------------------------------------------------------

BASES = {
    "linear": ((), ()),
    "second-order": (("yaw_drag_rar", "sway_drag_vav"), ("Nrar", "Yvav")),
    "cubic": (("yaw_cubic_rrr", "sway_cubic_vvv"), ("Nrrr", "Yvvv")),
}


@pytest.fixture(scope="module")
def basin(tmp_path_factory):
    """The pipeline of four and three trials, its ship and the records as CSV."""
    made = tmp_path_factory.mktemp("basin")
    for name in ("kvlcc2_zigzag.toml", "kvlcc2_hsva.toml"):
        shutil.copy(HERE / name, made)
    for record in ZIGZAGS.glob("*.dat"):
        c = columns(record)
        table = np.column_stack([c["t"], *in_ship(c), c["r"], c["delta"]])
        name = record.stem.removeprefix("HSVA_CPMC_KVLCC2_")
        np.savetxt(made / f"{name}.csv", table, "%.9g", ",", header="t,u,v,r,delta", comments="")
    return made


def held_in_the_basin(basin, held, effects=(), free=()):
    """The pipeline with two trials held out, and with more in its base."""
    text = (basin / "kvlcc2_zigzag.toml").read_text(encoding="utf-8").replace('use = "check"\n', "")
    for log in held:
        text = text.replace(f'logs = ["{log}.csv"]', f'use = "check"\nlogs = ["{log}.csv"]')
    text = text.replace('candidates = "none"', 'candidates = "all"')
    for key, old, more in (
        ("effects", '"rudder_offset"]', effects), ("free", '"delta_0"]', free),
    ):  # fmt: skip
        assert old in text, key
        text = text.replace(old, old[:-1] + "".join(f', "{n}"' for n in more) + "]")
    path = basin / f"{'-'.join(held)}-{len(effects)}-{len(text)}.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.study(turn="each")
@pytest.mark.parametrize("part", range(TURNS))
@pytest.mark.xfail(strict=False, reason="a goal: not met yet on every split and base")
def test_a_force_is_named_whatever_is_held_out(basin, part):
    """Every fifth of 21 choices of the two, from the linear model: 12.2 of 28.3 % was reached."""
    logs = sorted(p.stem for p in basin.glob("Z_*.csv"))
    ended = []
    for held in list(combinations(logs, 2))[part::TURNS]:
        done = stages(held_in_the_basin(basin, held), {})
        tell(" ".join(held), done)
        errors = held_out(done)
        ended.append(errors[-1] / errors[0])
        assert errors == sorted(errors, reverse=True)
        assert moves_the_ship(done[0].run.result.verdict.effect)
        assert not any(map(of_a_clock, names_said(done)))
    print(f"held-out error at the end over that at the beginning: {np.round(ended, 2)}")
    assert np.median(ended) <= 12.2 / 28.3


@pytest.mark.study(turn=2)
@pytest.mark.xfail(strict=False, reason="a goal: not met yet on every split and base")
@pytest.mark.parametrize("base", BASES)
def test_from_another_base_the_first_name_is_a_force(basin, base):
    done = stages(held_in_the_basin(basin, ("Z_10_10_S", "Z_20_10_S"), *BASES[base]), {})
    tell(base, done)
    first = done[0].run.result.verdict.effect
    assert first is None or moves_the_ship(first)
    assert not any(map(of_a_clock, names_said(done)))


# --- KVLCC2, roll decay -------------------------------------------------------------------------

PERIODS = (0.01, 0.015, 0.02, 0.03, 0.05, 0.1)
LATER = (0.0, 0.3, 0.6, 0.9)
"""[s] later than the second trough."""


@pytest.mark.parametrize("period", PERIODS)
def test_the_arm_and_then_the_damping_at_every_period_and_start(tmp_path, period):
    """Ours: 3.0 to 0.3 % in every cell."""
    shutil.copy(HERE / "kvlcc2_roll.toml", tmp_path)
    text = (HERE / "kvlcc2_roll_decay.toml").read_text(encoding="utf-8")
    text = text.replace("../../../shared/data/kvlcc2_roll_decay/model_test_21337.csv",
                        DECAY.as_posix())  # fmt: skip
    text = text.replace("period = 0.01", f"period = {period}")
    text = text.replace('candidates = "none"', 'candidates = "all"')
    for later in LATER:
        begun = 27.45 + later
        path = tmp_path / f"from_{later}.toml"
        path.write_text(text.replace("[27.45, 77.45]", f"[{begun}, {begun + 50.0}]"))
        done = stages(path, {})
        errors = [s.run.result.fit.eps_rmsn for s in done if s.kept]
        print(f"| {period} | {later} | {' '.join(added(done))} | "
              f"{' '.join(f'{x:.2%}' for x in errors)} | {done[-1].end} |")  # fmt: skip
        arm, damping = added(done)[:2]
        assert arm == "righting_arm_cubic"
        assert damping in {"quadratic_roll_damping", "cubic_roll_damping"}
        assert errors[2] < 0.006
        for stage in done:  # nothing missing is not said above twice the reachable error
            if stage.run.result.verdict.kind == "nothing missing":
                assert stage.run.result.fit.eps_rmsn < 2.0 * 0.0031


def test_no_noise_part_is_above_what_any_model_leaves(basin):
    """The same rows by the linear model and by what the loop makes of it."""
    done = stages(held_in_the_basin(basin, ("Z_10_10_S", "Z_20_10_S")), {})
    least = min(s.run.result.fit.eps_rmsn for s in done)
    rows = run.run(pipeline_file.load(held_in_the_basin(basin, ("Z_10_10_S", "Z_20_10_S")))).result
    for result in (rows, *(s.run.result for s in done)):
        tried = [m.eps_rmsn_refitted for m in result.missing if m.eps_rmsn_refitted]
        print(result.split.noise, result.split.method, least)
        assert (result.split.noise or 0.0) <= min([result.fit.eps_rmsn, *tried]) + 1e-12
