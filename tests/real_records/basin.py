"""Zig-zags of a 7 m model of a tanker in a basin, any of them held out, from several bases.

The release labels the columns wrongly. Column 7 is the rate of turn in deg/s (it is d psi/dt), and
columns 5 and 6 are not u and v of the ship but the speed along and across the tank (they are
dx0/dt and dy0/dt): the converter turns them by the heading.
"""

import re
import shutil
from itertools import combinations
from pathlib import Path

import numpy as np
from real_record import DATA, HERE

from trialid import ingest
from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import starter

RECORDS = DATA / "kvlcc2_hsva_zigzag"
PIPELINE = "kvlcc2_zigzag.toml"
BEGUN = "begun.toml"
TEMPLATE = HERE / "kvlcc2_hsva.template.toml"

BASES = {
    "linear": ((), ()),
    "second-order": (("yaw_drag_rar", "sway_drag_vav"), ("Nrar", "Yvav")),
    "cubic": (("yaw_cubic_rrr", "sway_cubic_vvv"), ("Nrrr", "Yvvv")),
}


def columns(record):
    """A record's columns by name, as it has them; t in seconds."""
    channels = ingest.read(record, None, ingest.Aids(template=TEMPLATE)).channels
    seconds = next(iter(channels.values())).t / 1e9
    return {"t": seconds} | {name: channel.y for name, channel in channels.items()}


def in_ship(c):
    """Speed ahead and to starboard [m/s] from speed along and across the tank."""
    psi = np.deg2rad(c["psi"])
    u = c["along"] * np.cos(psi) + c["across"] * np.sin(psi)
    v = c["across"] * np.cos(psi) - c["along"] * np.sin(psi)
    return u, v


def _pairs_of_logs(folder: Path, heads: str) -> list[tuple[str, ...]]:
    """Write each record as CSV under these heads; every choice of two of them."""
    for record in RECORDS.glob("*.dat"):
        c = columns(record)
        table = np.column_stack([c["t"], *in_ship(c), c["r"], c["delta"]])
        name = record.stem.removeprefix("HSVA_CPMC_KVLCC2_")
        np.savetxt(folder / f"{name}.csv", table, "%.9g", ",", header=heads, comments="")
    return list(combinations(sorted(p.stem for p in folder.glob("Z_*.csv")), 2))


def in_basin(folder: Path) -> list[tuple[str, ...]]:
    """Write the pipeline of four and three trials, its ship and the records as CSV; the choices."""
    for name in (PIPELINE, "kvlcc2_hsva.toml"):
        shutil.copy(HERE / name, folder)
    return _pairs_of_logs(folder, "t,u,v,r,delta")


def held_in_basin(
    basin: Path, held: tuple[str, ...], effects: tuple[str, ...] = (), free: tuple[str, ...] = ()
) -> Path:
    """The pipeline with two trials held out, and with more in its base."""
    text = (basin / PIPELINE).read_text(encoding="utf-8").replace('use = "check"\n', "")
    for log in held:
        text = text.replace(f'logs = ["{log}.csv"]', f'use = "check"\nlogs = ["{log}.csv"]')
    text = text.replace('candidates = "none"', 'candidates = "all"')
    for old, more in (('"rudder_offset"]', effects), ('"delta_0"]', free)):
        assert old in text
        text = text.replace(old, old[:-1] + "".join(f', "{n}"' for n in more) + "]")
    path = basin / f"{'-'.join(held)}-{len(effects)}-{len(text)}.toml"
    path.write_text(text, encoding="utf-8")
    return path


def begun_in_basin(folder: Path) -> list[tuple[str, ...]]:
    """Write the same records with their units, and the pipeline that a newcomer begins with."""
    ship = Path(shutil.copy(HERE / "kvlcc2_hsva.toml", folder))
    heads = "t [s],u [m/s],v [m/s],yaw rate [deg/s],rudder angle [deg]"
    choices, logs = _pairs_of_logs(folder, heads), sorted(folder.glob("Z_*.csv"))
    made = starter([inspect_log(log) for log in logs], folder / BEGUN, ship, Given())
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    return choices


def held_as_begun(folder: Path, held: tuple[str, ...]) -> Path:
    """That pipeline with two trials held out."""
    text = re.sub(r'use = "check".*\n', "", (folder / BEGUN).read_text(encoding="utf-8"))
    for log in held:
        assert f'logs = ["{log}.csv"]' in text
        text = text.replace(f'logs = ["{log}.csv"]', f'use = "check"\nlogs = ["{log}.csv"]')
    path = folder / f"{'-'.join(held)}.toml"
    path.write_text(text, encoding="utf-8")
    return path
