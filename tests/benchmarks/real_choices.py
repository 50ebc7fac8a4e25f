"""What the loop does on two real sets of zig-zags, whichever two trials are held out.

    python tests/benchmarks/real_choices.py [--only "Esso Osaka"] [--jobs 2] [--write]

Esso Osaka in measured wind and KVLCC2 in a basin, each in all 21 choices of the two, KVLCC2 also
from the pipeline that `trialid start` writes and from other bases: the first name, what stays in
the end, the error of the trials held out from the first stage to the last. Results stand in
`results/real_choices.md` with `--write`, each table with its commit; those not asked for stay. Exit
status 1 where a held-out error rises.
"""

import argparse
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "real_records"))
sys.path.insert(0, str(Path(__file__).parents[2] / ".ci"))
sys.path.insert(0, str(Path(__file__).parent / "fleets"))
from at_commit import commit_of
from basin import BASES, begun_in_basin, held_as_begun, held_in_basin, in_basin
from pond import WIND, held_on_pond, on_pond
from real_record import of_a_clock, stages
from spread import add_options, spread

from trialid.diagnosis.search.backward import worth_naming
from trialid.threads import one_thread

RESULTS: Final = Path(__file__).parent / "results" / "real_choices.md"
POND: Final = "Esso Osaka, two of seven held out"
BASIN: Final = "KVLCC2, two of seven held out"
BEGUN: Final = "KVLCC2 as `trialid start` begins it, two of seven held out"
FROM: Final = "KVLCC2, another base"


@dataclass(frozen=True, kw_only=True)
class Loop:
    """What the loop did with one choice: first name, steps, names in the end, held-out errors."""

    kind: str
    choice: str
    first: str | None
    steps: tuple[str, ...]
    named: tuple[str, ...]
    held_out: tuple[float, ...]
    end: str

    @property
    def rises(self) -> bool:
        """Whether a step that was kept raised the error of the trials held out."""
        return any(b > a for a, b in zip(self.held_out, self.held_out[1:], strict=False))

    def row(self) -> str:
        """One line of the table."""
        errors = " ".join(f"{100.0 * e:.1f}" for e in self.held_out)
        return (
            f"| {self.choice} | {self.first} | {' '.join(self.steps)} | {', '.join(self.named)} "
            f"| {errors} | {self.end} |"
        )


@one_thread
def loop(asked: tuple[str, str, Path]) -> Loop:
    """Fit, diagnose, add and again."""
    kind, choice, pipeline = asked
    done = stages(pipeline, {})
    kept = [s for s in done if s.kept]
    return Loop(
        kind=kind,
        choice=choice,
        first=done[0].run.result.verdict.effect,
        steps=tuple(f"+{s.added}" if s.added else f"-{s.dropped}" for s in kept[1:]),
        named=tuple(worth_naming(done[-1].worths)),
        held_out=tuple(s.run.result.fit.eps_rmsn_check for s in kept),
        end=done[-1].end,
    )


def choices(folder: Path, only: str) -> list[tuple[str, str, Path]]:
    """The pipelines of all kinds whose name begins so, written below the folder."""
    (pond := folder / "pond").mkdir()
    (basin := folder / "basin").mkdir()
    (begun := folder / "begun").mkdir()
    on, at, by = on_pond(pond), in_basin(basin), begun_in_basin(begun)
    held = ("Z_10_10_S", "Z_20_10_S")
    every = [
        *((POND, " ".join(c), held_on_pond(pond, c)) for c in on),
        *((BASIN, " ".join(c), held_in_basin(basin, c)) for c in at),
        *((BEGUN, " ".join(c), held_as_begun(begun, c)) for c in by),
        *((FROM, name, held_in_basin(basin, held, *base)) for name, base in BASES.items()),
    ]
    return [one for one in every if one[0].startswith(only)]


def table(of: Sequence[Loop]) -> str:
    """The table of one kind, a line of counts over it."""
    begun, ended = (float(np.mean([x.held_out[k] for x in of])) for k in (0, -1))
    ratio = np.median([x.held_out[-1] / x.held_out[0] for x in of])
    lines = [
        f"Of {len(of)}: wind first in {sum(x.first in WIND for x in of)}; a sensor or clock "
        f"named in {sum(any(map(of_a_clock, {*x.named, x.first or ''})) for x in of)}; the "
        f"held-out error rises in {sum(x.rises for x in of)}; held out {begun:.1%} to "
        f"{ended:.1%} on average, median of the ratios {ratio:.2f}.\n",
        "| choice | first | steps | named in the end | held out, % | end |",
        "|---|---|---|---|---|---|",
        *(x.row() for x in of),
    ]
    return "\n".join(lines) + "\n"


def kept(page: str) -> dict[str, str]:
    """The tables of a page by their kind."""
    parts = (part.split("\n\n", 1) for part in page.split("## ")[1:])
    return {kind.strip(): text.strip() + "\n" for kind, text in parts}


def main() -> int:
    """Run, print, and write the tables where asked."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--only", default="", help="what the kinds begin with")
    add_options(asked, jobs=2)
    asked.add_argument("--write", action="store_true")
    options = asked.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        asked_for = choices(Path(folder), options.only)
        loops = list(spread(loop, asked_for, options.jobs, options.on))
    found = {x.kind: table([y for y in loops if y.kind == x.kind]) for x in loops}
    print("\n".join(f"## {kind}\n\n{text}" for kind, text in found.items()))
    if options.write:
        at = f"At {commit_of(RESULTS.parent)}. "
        before = kept(RESULTS.read_text(encoding="utf-8")) if RESULTS.exists() else {}
        every = before | {kind: at + text for kind, text in found.items()}
        said = "\n".join(f"## {kind}\n\n{text}" for kind, text in every.items())
        head = "# Real zig-zags\n\n`python tests/benchmarks/real_choices.py`\n\n"
        RESULTS.write_text(head + said, encoding="utf-8")
    return int(any(x.rises for x in loops))


if __name__ == "__main__":
    sys.exit(main())
