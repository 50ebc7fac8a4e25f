r"""What half and twice of each threshold of `diagnosis.search.carried` does to the names.

    PYTHONPATH=. python tests/benchmarks/carry_over.py --out tests/benchmarks/results/carry_over.md

Records of the hidden-effects benchmark, of seeds that no threshold was chosen on. The first of the
ranking is counted, before any refit: right, wrong, or no name; where nothing is hidden any name is
wrong. Gaps in the catalogue are counted by the same records.
"""

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from itertools import product
from pathlib import Path
from typing import Final
from unittest import mock

from hidden_effects import DEFAULTS, EVERY, settings_of
from hidden_scenarios import guessed
from hidden_tables import table
from hidden_truth import Scenario, record

from trialid.diagnosis.search import carried, carry_over
from trialid.diagnosis.search.completeness import WORTH, Completeness, completeness
from trialid.diagnosis.search.score import Candidate, rank
from trialid.effects import CATALOGUE
from trialid.threads import one_thread
from trialid.workflow.fit_model import fit_with_progress

HIDDEN: Final = (
    "yaw_drag_rar", "quadratic_roll_damping", "righting_arm_cubic", "delay_r", "gyro_cross_axis",
    "sway_drag_vav", "rudder_slipstream", "static_list",
)  # fmt: skip
NOTHING: Final = ("nothing", "x_G + 1 % of L")
OUTSIDE: Final = ("odd_switch", "odd_heel", "odd_rudder", "odd_course")
NOISES: Final = ("white", "waves", "process")
FIRST_SEED: Final = 7000
FIELDS: Final = ("FALL", "LARGE", "ALIKE", "FAINT", "EACH")


@dataclass(frozen=True)
class Seen:
    """One record, ranked with blocks of three counts, and whether the catalogue has a gap."""

    scenario: Scenario
    noise: str
    ranking: dict[int, tuple[Candidate, ...]]
    whole: Completeness


@one_thread
def look(name: str, noise: str, seed: int) -> Seen:
    """Fit what lacks the hidden effect and rank, with half and twice the blocks too."""
    scenario = EVERY[name]
    model = guessed(scenario, seed)
    trials = record(scenario, noise, "mixed", seed)
    fit = fit_with_progress(trials, model, settings_of(model), lambda words, share: None)
    found = {}
    for blocks in (3, 6, 12):
        with mock.patch.object(carry_over, "BLOCKS", blocks):
            found[blocks], augmented = rank(fit, CATALOGUE, DEFAULTS.family_cos)
    whole = completeness(augmented)
    assert whole is not None
    return Seen(scenario, noise, found, whole)


def said(seen: Seen, blocks: int) -> str:
    """Right, wrong or nothing, by the first of the ranking under the thresholds as they stand."""
    worth = [c for c in seen.ranking[blocks] if c.worth_a_name(DEFAULTS.level)]
    if not worth:
        return "none"
    first = min(worth, key=lambda c: c.price)
    return "right" if {first.effect.name, *first.family} & seen.scenario.right else "wrong"


def variants() -> Iterator[tuple[str, str, dict[str, float], int]]:
    """Threshold, words, what it is then, and how many blocks."""
    yield "as they are", "", {}, 6
    for name in FIELDS:
        value = getattr(carried, name)
        fall = name in ("FALL", "LARGE")
        for words, factor in (("half", 0.5), ("twice", 2.0)):
            new = 1.0 - factor * (1.0 - value) if fall else factor * value
            yield name, f"{words}: {new:.4g}", {name: new}, 6
    yield "BLOCKS", "half: 3 whole trials", {}, 3
    yield "BLOCKS", "twice: 12", {}, 12


def counted(records: Sequence[Seen], blocks: int, among: Callable[[Seen], bool]) -> str:
    """Right / wrong / no name."""
    words = [said(r, blocks) for r in records if among(r)]
    return "/".join(str(words.count(w)) for w in ("right", "wrong", "none"))


def names(records: Sequence[Seen]) -> str:
    """The table of names."""
    lines = []
    for name, words, values, blocks in variants():
        with changed(values):
            groups = [
                counted(records, blocks, lambda r, n=noise: r.noise == n and r.scenario.group in
                        ("physics", "sensor", "gear"))
                for noise in NOISES
            ]  # fmt: skip
            groups += [
                counted(records, blocks, lambda r, n=noise: r.noise == n and r.scenario.group in
                        ("nothing", "control"))
                for noise in NOISES
            ]  # fmt: skip
            groups.append(counted(records, blocks, lambda r: r.scenario.group == "outside"))
        lines.append([name, words, *groups])
    head = ["threshold", "", *(f"hidden, {n}" for n in NOISES), *(f"nothing, {n}" for n in NOISES),
            "outside"]  # fmt: skip
    return table(head, lines)


@contextmanager
def changed(values: dict[str, float]) -> Iterator[None]:
    """Thresholds at other values."""
    with ExitStack() as stack:
        for name, value in values.items():
            stack.enter_context(mock.patch.object(carried, name, value))
        yield


def gaps(records: Sequence[Seen]) -> str:
    """How often a gap in the catalogue is claimed, at half and twice of what it must be worth."""
    lines = []
    for words, factor in (("half", 0.5), ("as it is", 1.0), ("twice", 2.0)):
        limit = factor * WORTH
        row = [f"{words}: {limit:g}"]
        for groups in (("nothing", "control"), ("physics", "sensor", "gear"), ("outside",)):
            for noise in NOISES:
                mine = [r.whole for r in records
                        if r.scenario.group in groups and r.noise == noise]  # fmt: skip
                missed = [w.any_shape - w.catalogue for w in mine]
                claimed = sum(m > max(limit, 0.25 * w.any_shape)
                              for m, w in zip(missed, mine, strict=True))  # fmt: skip
                row.append(f"{claimed}/{len(mine)}")
        lines.append(row)
    head = ["a gap is worth", *(f"{g}, {n}" for g, n in product(
        ("nothing", "hidden", "outside"), NOISES))]  # fmt: skip
    return table(head, lines)


def main() -> int:
    """Look at all records, print and write the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=2, help="records of each scenario and noise")
    parser.add_argument("--out", type=Path, help="FILE.md")
    asked = parser.parse_args()
    todo = list(product((*HIDDEN, *NOTHING, *OUTSIDE), NOISES,
                        range(FIRST_SEED, FIRST_SEED + asked.seeds)))  # fmt: skip
    records = []
    for i, task in enumerate(todo, 1):
        records.append(look(*task))
        print(f"{i}/{len(todo)} {task}", file=sys.stderr)
    text = (
        f"# What carries over: half and twice of each threshold\n\n{len(records)} records, seeds "
        f"{FIRST_SEED} to {FIRST_SEED + asked.seeds - 1}, mixed trials; right / wrong / no name, "
        f"first of the ranking, before any refit.\n\n{names(records)}\n\n"
        f"A gap in the catalogue claimed, of records:\n\n{gaps(records)}\n"
    )
    print(text)
    if asked.out is not None:
        asked.out.write_text(text, encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
