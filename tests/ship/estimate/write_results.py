"""How far ship files made of particulars are from published sets, and what fits begin with them.

    python tests/ship/estimate/write_results.py

Writes `tests/benchmarks/results/ship_estimates.toml`, which the guide's page `own_ship` is made of.
Fits of real records are done where the records lie beside the repository, else what is written
of them stays.
"""

import sys
import tempfile
import tomllib
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Final

import numpy as np

HERE: Final = Path(__file__).resolve().parent
ROOT: Final = HERE.parents[2]
sys.path[:0] = [str(HERE), str(HERE.parents[2] / ".ci")]

from at_commit import commit_of  # noqa: E402
from begun_records import CASES, begun  # noqa: E402
from published import Published, published_ships  # noqa: E402
from sailed_zigzags import fit, sailed  # noqa: E402

from trialid import pipeline_file  # noqa: E402
from trialid.workflow import build_model, run  # noqa: E402

RESULTS: Final = ROOT / "tests" / "benchmarks" / "results" / "ship_estimates.toml"
SHORT: Final = {
    "S-175": "S-175",
    "naval vessel": "naval",
    "Mariner": "Mariner",
    "ONR Tumblehome": "ONRT",
    "KVLCC2": "KVLCC2",
    "Esso Osaka": "Osaka",
    "190 000 t tanker": "tanker",
}
"""Names as columns of a table."""

HEAD: Final = """\
# How far what `trialid ship` estimates lies from published sets: written by
#     python tests/ship/estimate/write_results.py
# `found` holds an estimate, its scatter as a share of it, and what is published, by ship; a number
# whose estimate is a mean over that very ship is `own`. `commit` is the state it was counted at.
"""


def main() -> None:
    """Count, fit and write."""
    warnings.simplefilter("ignore")
    ships = published_ships()
    before = tomllib.loads(RESULTS.read_text(encoding="utf-8")) if RESULTS.is_file() else {}
    parts = [
        f'{HEAD}commit = "{commit_of(ROOT)}"\n',
        *(_ship(s) for s in ships),
        *_numbers(ships),
        _held_out(ships),
        *(_zigzag(s) for s in ships),
        *(_records() or _again(before.get("record", []))),
    ]
    RESULTS.write_text("\n".join(parts), encoding="utf-8")


def _ship(ship: Published) -> str:
    rows = {"short": SHORT[ship.name], "name": ship.name, "source": ship.source}
    lines = [f'{key} = "{text}"' for key, text in rows.items()]
    return "\n".join(["[[ship]]", *lines, f"counted = {str(ship.counted).lower()}", ""])


def _numbers(ships: list[Published]) -> Iterator[str]:
    found: dict[str, list[str]] = {}
    for ship in ships:
        for name, value, share, known in ship.pairs():
            own = "true" if ship.is_own(name) else "false"
            row = (
                f"found.{SHORT[ship.name]} = {{ estimate = {value:.4g}, share = {share:.3g}, "
                f"published = {known:.4g}, own = {own} }}"
            )
            found.setdefault(name, []).append(row)
    for name, rows in found.items():
        yield "\n".join(["[[number]]", f'name = "{name}"', *rows, ""])


def _held_out(ships: list[Published]) -> str:
    off = np.array(
        [
            (known / value - 1.0) / share
            for ship in ships
            if not ship.counted
            for _, value, share, known in ship.pairs()
            if share > 0.0
        ]
    )
    one, two = (int(np.sum(np.abs(off) < k)) for k in (1.0, 2.0))
    return f"[held_out]\nnumbers = {len(off)}\nwithin_one = {one}\nwithin_two = {two}\n"


def _zigzag(ship: Published) -> str:
    made = sailed(ship)
    plain, held = (fit(made, priors) for priors in (False, True))
    return "\n".join(
        [
            "[[zigzag]]",
            f'ship = "{ship.name}"',
            f"converged = {str(plain.converged and held.converged).lower()}",
            f"error = {plain.eps_rmsn:.4f}",
            f"error_with_priors = {held.eps_rmsn:.4f}",
            "",
        ]
    )


def _records() -> list[str]:
    """Fits of real records begun with the scaled S-175, the length alone and the particulars."""
    rows = []
    for case in CASES:
        for ship in case.ships:
            with tempfile.TemporaryDirectory() as folder:
                path = begun(Path(folder), case, ship)
                if path is None:
                    return []
                rows.append(_record(case.name, ship, path))
                sys.stdout.write(f"{rows[-1]}\n")
    return rows


def _record(case: str, ship: str, path: Path) -> str:
    read = pipeline_file.load(path)
    trials = run.align_trials(read, lambda words, share: None)
    found = run.fit_of(read, trials, build_model.available(read), lambda words, share: None)
    row: Mapping[str, Any] = {
        "record": f'"{case}"',
        "ship": f'"{ship}"',
        "error": f"{found.eps_rmsn:.4f}",
        "held_out": "-1.0" if found.eps_check is None else f"{found.eps_check:.4f}",
        "converged": str(found.converged).lower(),
        "GM": f"{found.value('GM'):.3g}" if "GM" in found.estimates else "-1.0",
        "ambiguous": str(bool(found.rivals)).lower(),
    }
    return "\n".join(["[[record]]", *(f"{key} = {text}" for key, text in row.items()), ""])


def _again(rows: list[Mapping[str, Any]]) -> Iterator[str]:
    """What was written before, where the records are not here."""
    for row in rows:
        said = {k: f'"{x}"' if isinstance(x, str) else str(x).lower() for k, x in row.items()}
        yield "\n".join(["[[record]]", *(f"{key} = {text}" for key, text in said.items()), ""])


if __name__ == "__main__":
    main()
