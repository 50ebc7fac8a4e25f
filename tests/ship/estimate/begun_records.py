"""Real records begun as `inspect --init` begins them, with three kinds of ship file."""

import math
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Final

TESTS: Final = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(TESTS), str(TESTS / "real_records"), str(TESTS / "benchmarks")]

from pond import ESSO  # noqa: E402
from search_ships import placeholder  # noqa: E402
from test_newcomer import CASES as NEWCOMER  # noqa: E402
from test_newcomer import COASTER, FERRY, LOGS  # noqa: E402

from trialid.ingest import Aids  # noqa: E402
from trialid.inspection import inspect_log  # noqa: E402
from trialid.ship.estimate import Given  # noqa: E402
from trialid.workflow.first_pipeline import starter  # noqa: E402

KNOT: Final = 1852.0 / 3600.0
S175: Final = "S-175 scaled"
LENGTH: Final = "length alone"
PARTICULARS: Final = "particulars"


@dataclass(frozen=True)
class Case:
    """Logs of one ship: what they are called, which, what is known of her."""

    name: str
    logs: tuple[Path, ...]
    given: Given
    ships: tuple[str, ...]
    template: str = ""


def _newcomer(name: str) -> Case:
    kind, logs = NEWCOMER[name]
    known = Given(length=96.0) if kind == "ferry" else Given(length=62.0, speed=11.0 * KNOT)
    paths = tuple(LOGS / f"{log}.csv" for log in logs)
    return Case(name, paths, known, (S175, LENGTH), FERRY if kind == "ferry" else COASTER)


def _osaka(count: int) -> Case:
    known = Given(
        length=3.0,
        beam=0.489,
        draught=0.201,
        displacement=244.6,
        speed=0.4,
        rudder_area=0.0106,
        propeller_diameter=0.084,
        x_G=0.094,
        rho=1000.0,
    )
    logs = tuple(sorted(ESSO.glob("zigzag*.csv"))[:count])
    return Case(f"Esso Osaka, {count} zig-zags", logs, known, (S175, LENGTH, PARTICULARS))


CASES: Final = (*(_newcomer(name) for name in NEWCOMER), _osaka(3), _osaka(7))


def begun(folder: Path, case: Case, ship: str) -> Path | None:
    """The pipeline, None where the records are not here."""
    if not case.logs or not all(log.is_file() for log in case.logs):
        return None
    template = None
    if case.template:
        template = folder / "template.toml"
        template.write_text(case.template, encoding="utf-8")
    logs = [_tidy(folder, log) for log in case.logs]
    surveys = [inspect_log(log, Aids(template=template)) for log in logs]
    given, own = case.given, None
    if ship == S175:
        own = folder / "ship.toml"
        own.write_text(placeholder(given.length or math.nan, given.speed or 8.0), encoding="utf-8")
    elif ship == LENGTH:
        given = Given(length=given.length)
    made = starter(surveys, folder / "p.toml", own, Given() if own else given, case.given.speed)
    for path, text in made.files.items():
        path.write_text(text, encoding="utf-8")
    return folder / "p.toml"


def _tidy(folder: Path, log: Path) -> Path:
    """The log without the rows of commas that one of them ends in; another encoding as it is."""
    if log.parent != ESSO:
        return log
    lines = [x for x in log.read_text(encoding="utf-8").splitlines() if x.strip(",")]
    path = folder / f"{log.stem.split('_', 2)[-1]}.csv"
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path
