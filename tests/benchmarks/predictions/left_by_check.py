"""How often trials held out speak against a model in which nothing is missing, and one that lacks.

    PYTHONPATH=. python tests/benchmarks/predictions/left_by_check.py

The true ship and her trials are those of the hidden-effects benchmark; which of them are fitted and
which are held out goes round, so that manoeuvres are predicted unlike those that were fitted. With
something hidden the model is fitted without it, whatever a diagnosis of the fitted trials says.
`--seeds`, `--first-seed` and `--jobs` say how many; results stand in `results/left_by_check.md`
with `--write`. Exit status 1 where more of what lacks nothing is called than the level and
two standard errors of so many records.
"""

import argparse
import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

sys.path += [str(Path(__file__).parents[1] / part) for part in ("", "fleets", "../../.ci")]

from at_commit import commit_of
from hidden_effects import settings_of
from hidden_scenarios import SCENARIOS, guessed
from hidden_truth import NOISES, record
from spread import add_options, spread

from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.examine import examine_fit
from trialid.diagnosis.left_by_check import left_by_check
from trialid.identification.fit import identify
from trialid.progress import silent
from trialid.threads import one_thread

RESULTS: Final = Path(__file__).parents[1] / "results" / "left_by_check.md"
ASKED: Final = DiagnoseSettings(candidates={}, coefficients=False)
"""The covariance by noise is the same whatever may be missing."""
LEVEL: Final = ASKED.level
SPLITS: Final = (
    (("zigzag-10", "zigzag-20", "binary"), ("zigzag-15",)),
    (("zigzag-10", "binary", "zigzag-15"), ("zigzag-20",)),
    (("zigzag-10", "zigzag-20", "zigzag-15"), ("binary",)),
    (("zigzag-10",), ("zigzag-20",)),
    (("zigzag-20",), ("binary",)),
    (("zigzag-10", "zigzag-20"), ("zigzag-15", "binary")),
)
"""Fitted, and held out."""
HIDDEN: Final = ("nothing", "yaw_drag_rar", "yaw_cubic_rrr")

CALLED: Final = """\
Called: trials held out leave more than noise of the fitted ones and what parameters uncertain by it
move them by, at the level of the diagnosis. With something hidden the model lacks it, whatever a
diagnosis of the fitted trials says: how often that is seen here is its power.
"""


@dataclass(frozen=True, kw_only=True)
class Held:
    """One fit: the chance that noise leaves as much in what was held out, over all outputs."""

    hidden: str
    noise: str
    split: int
    chance: float


@one_thread
def held(asked: tuple[str, str, int, int]) -> Held:
    """One record made and fitted without what is hidden."""
    hidden, noise, split, seed = asked
    scenario, (fitted, out) = SCENARIOS[hidden], SPLITS[split]
    trials = [
        replace(t, use="check" if t.name in out else "fit")
        for t in record(scenario, noise, "mixed", seed)
        if t.name in (*fitted, *out)
    ]
    model = guessed(scenario, seed, 0.0)
    fit = identify(trials, model, settings_of(model))
    diagnosed, _ = examine_fit(fit, ASKED, silent)
    found = left_by_check(fit, diagnosed.accuracy.covariance)
    chance = min((one.p_value * len(found) for one in found), default=1.0)
    return Held(hidden=hidden, noise=noise, split=split, chance=chance)


def table(found: Sequence[Held]) -> str:
    """Shares by what is hidden and the noise; the last columns at half and twice the level."""
    lines = [
        f"| hidden | noise | records | called at {LEVEL:g} | at half | at twice |",
        "|---|---|---|---|---|---|",
    ]
    for hidden in dict.fromkeys(x.hidden for x in found):
        for noise in (*NOISES, "all"):
            of = [x.chance for x in found if x.hidden == hidden and noise in (x.noise, "all")]
            levels = (LEVEL, LEVEL / 2.0, LEVEL * 2.0)
            shares = (f"{sum(c < level for c in of) / len(of):.1%}" for level in levels)
            lines.append(f"| {hidden} | {noise} | {len(of)} | {' | '.join(shares)} |")
    return "\n".join(lines) + "\n"


def main() -> int:
    """Run, print, and write the table where asked."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--seeds", type=int, default=80)
    asked.add_argument("--first-seed", type=int, default=200)
    add_options(asked, jobs=2)
    asked.add_argument("--write", action="store_true")
    o = asked.parse_args()
    seeds = range(o.first_seed, o.first_seed + o.seeds)
    every = range(len(SPLITS))
    todo = [(h, n, k, s) for h in HIDDEN for n in NOISES for k in every for s in seeds]
    found = list(spread(held, todo, o.jobs, o.on, together=6))
    print(text := table(found))
    if o.write:
        head = (
            "# Trials held out against `nothing missing`\n\n"
            f"`python tests/benchmarks/predictions/left_by_check.py --seeds {o.seeds} "
            f"--first-seed {o.first_seed}` at {commit_of(RESULTS.parent)}\n\n{CALLED}\n"
        )
        RESULTS.write_text(head + text, encoding="utf-8")
    plain = [x.chance < LEVEL for x in found if x.hidden == "nothing"]
    return int(np.mean(plain) > LEVEL + 2.0 * np.sqrt(LEVEL * (1.0 - LEVEL) / len(plain)))


if __name__ == "__main__":
    sys.exit(main())
