"""Zig-zags of a 3 m model of a tanker on a pond in wind that was measured; any held out."""

from itertools import combinations
from pathlib import Path

from real_record import DATA

ESSO = DATA / "esso_osaka"
WIND = {"apparent_wind", "apparent_wind_yaw", "steady_wind"}

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


def on_pond(folder: Path) -> list[tuple[str, ...]]:
    """Write the ship's file and the zig-zags there; the choices of two of them.

    Without the rows of commas at the end of one of them.
    """
    (folder / "ship.toml").write_text(SHIP, encoding="utf-8")
    for record in sorted(ESSO.glob("zigzag*.csv")):
        lines = [x for x in record.read_text(encoding="utf-8").splitlines() if x.strip(",")]
        name = record.stem.split("_", 2)[-1]
        (folder / f"{name}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return list(combinations(sorted(p.stem for p in folder.glob("*.csv")), 2))


def held_on_pond(folder: Path, held: tuple[str, ...]) -> Path:
    """A pipeline with these trials held out."""
    trials = [
        f'[[trial]]\nname = "{p.stem}"\nlogs = ["{p.name}"]\n'
        + ('use = "check"\n' if p.stem in held else "")
        for p in sorted(folder.glob("*.csv"))
    ]
    path = folder / f"{'-'.join(held)}.toml"
    text = f'name = "pond"\nship = "ship.toml"\n{"".join(trials)}{PIPELINE}'
    path.write_text(text, encoding="utf-8")
    return path
