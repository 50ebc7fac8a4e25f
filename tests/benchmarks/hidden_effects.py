r"""Hide one effect after the other in a simulated ship and count how well the diagnosis names them.

    PYTHONPATH=. python tests/benchmarks/hidden_effects.py              # all of it, for the record
    PYTHONPATH=. python tests/benchmarks/hidden_effects.py --short      # what CI runs
    PYTHONPATH=. python tests/benchmarks/hidden_effects.py --short --fixed-off 0.15  # held off
    PYTHONPATH=. python tests/benchmarks/hidden_effects.py --seeds 4 --noise white \
        --scenarios yaw_drag_rar,nothing --jobs 2 --out first.md

Every run makes a record of the true ship (`hidden_truth`), fits the model that lacks what is hidden
(`hidden_scenarios`) and takes the package's own way to a verdict. A run depends on its scenario,
noise, trial set and seed alone, not on `--jobs` or `--on` (`fleets/spread.py`). `--scenarios
typical` hides every other effect at the size its file calls typical. `--out` takes `.csv` (a row a
run) or `.md` (tables, with such a `.csv` beside). Exit status 1 where a threshold is missed.
"""

import argparse
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from itertools import product
from pathlib import Path
from typing import Final

sys.path += [str(Path(__file__).parent / "fleets"), str(Path(__file__).parents[2] / ".ci")]

from at_commit import commit_of
from hidden_scenarios import SCENARIOS, TYPICAL, guessed
from hidden_score import plainness
from hidden_tables import FULL, SHORT, Row, report, thresholds, write
from hidden_truth import (
    FREE,
    NOISES,
    OUTPUTS,
    TRIAL_SETS,
    Scenario,
    record,
    restored,
    without,
)
from spread import add_options, spread

from trialid.diagnosis.diagnose import refits_of
from trialid.diagnosis.diagnosed import DiagnoseSettings
from trialid.diagnosis.examine import gap_beside_best
from trialid.diagnosis.force.missing_force import missing_force
from trialid.diagnosis.gap_untold import without_gap
from trialid.diagnosis.left_by_check import with_held_out
from trialid.diagnosis.may_be_off import may_be_off
from trialid.diagnosis.meant_as_well import beside_others
from trialid.diagnosis.noise.noise_bound import held_against
from trialid.diagnosis.noise.split import split
from trialid.diagnosis.records.contradicting_trial import settle_trials
from trialid.diagnosis.search.completeness import completeness
from trialid.diagnosis.search.freed import candidates_to_free
from trialid.diagnosis.search.refit import Refit
from trialid.diagnosis.search.score import Candidate, rank
from trialid.diagnosis.trust import accuracy_of
from trialid.diagnosis.verdict import Verdict, decide
from trialid.effects import CATALOGUE
from trialid.errors import TrialidError
from trialid.identification.fit import Fit
from trialid.identification.problem import Settings
from trialid.progress import silent
from trialid.ship.effect import Force
from trialid.ship.model import ShipModel
from trialid.threads import one_thread
from trialid.trial import Trial
from trialid.workflow import fit_model

SEEDS: Final = 20
SHORT_SEEDS: Final = 4
SHORT_SCENARIOS: Final = (
    "yaw_drag_rar", "quadratic_roll_damping", "righting_arm_cubic", "delay_r", "gyro_cross_axis",
    "odd_switch", "x_G + 1 % of L", "nothing",
)  # fmt: skip
EVERY: Final = {**SCENARIOS, **TYPICAL}
CORE: Final = (
    "sway_drag_vav", "sway_drag_rar", "yaw_drag_rav", "yaw_drag_rar", "roll_drag_rav",
    "yaw_cubic_cross", "roll_cubic", "centripetal_added_mass", "roll_rate_yaw", "heel_drift",
    "quadratic_roll_damping", "righting_arm_cubic", "static_list", "rudder_cubic",
    "rudder_slipstream", "steady_wind", "rudder_offset", "bias_r", "delay_r", "lag_phi",
    "gyro_cross_axis", "rudder_record_delay", "rudder_servo", "rudder_servo_limited",
    "rudder_backlash", "odd_rudder", "odd_switch", "odd_heel", "odd_course", "x_G + 1 % of L",
    "gyro scale + 3 %", "roll scale + 3 %", "nothing",
)  # fmt: skip
"""Twenty-five effects from every part of the ship, and what must not be named."""

DEFAULTS: Final = DiagnoseSettings()
"""A pipeline that says nothing in [diagnose]."""

SHORT_NOISES: Final = ("white", "process")

Task = tuple[str, str, str, int, float]
"""Scenario, noise, trial set, seed, by which share at most what is held fixed is off."""


@dataclass(frozen=True)
class Diagnosis:
    """The package's way from trials to a verdict, with what is counted here."""

    fit: Fit
    ranking: Sequence[Candidate]
    refits: Sequence[Refit]
    named: Refit | None
    verdict: Verdict


class Stopwatch:
    """Processor seconds by stage."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def __call__(self, stage: str) -> Iterator[None]:
        """Count what runs inside."""
        before = time.process_time()
        yield
        self.seconds[stage] = self.seconds.get(stage, 0.0) + time.process_time() - before


def diagnosed(
    trials: Sequence[Trial], model: ShipModel, settings: Settings, watch: Stopwatch
) -> Diagnosis:
    """From trials to a verdict as `trialid.workflow.run.run` goes, with its own functions."""
    asked = DEFAULTS
    with watch("fit"):
        fit = fit_model.fit_with_progress(tuple(trials), model, settings, silent)
    with watch("rank"):
        candidates = {**CATALOGUE, **candidates_to_free(fit)}
        ranking, augmented = rank(fit, candidates, asked.family_cos, asked.level)
    with watch("split"):
        parts, routes = split(fit, augmented, {})
    with watch("refit"):
        tried = refits_of(fit, ranking, asked, silent)
    with watch("decide"):
        whole = gap_beside_best(completeness(augmented), fit, tried, asked)
        parts = held_against(parts, routes, fit, [r.fit for r in tried.refits], whole)
        verdict = decide(fit, ranking, tried.refits, parts, whole, asked.level)
        sure = partial(accuracy_of, fit, parts, may_be_off(augmented))
        verdict = with_held_out(fit.examined, verdict, lambda: sure().covariance, asked.level)
        named = next((r for r in tried.refits if r.candidate.effect.name == verdict.effect), None)
        known = named.fit if named else None
        verdict = settle_trials(fit, verdict, known, [r.fit for r in tried.refits])
        if not verdict.doubts:
            verdict = beside_others(fit, verdict, named, parts, whole, asked=asked, progress=silent)
        gap = verdict.kind == "not in catalogue"
        force = missing_force(fit.examined, asked.level) if gap else None
        verdict = without_gap(fit, verdict, ranking, parts, force, asked.level)
    return Diagnosis(fit, ranking, tried.refits, named if verdict.effect else None, verdict)


def settings_of(model: ShipModel) -> Settings:
    """What is fitted: the linear parameters that the model has, and where each trial starts."""
    free = tuple(n for n in FREE if n in model.parameters)
    return Settings(free, OUTPUTS, nuisance=("initial_state",))


def true_candidate(
    scenario: Scenario, ranking: Sequence[Candidate]
) -> tuple[int, Candidate] | None:
    """Place in the ranking, from 1, and score of what is hidden; None where it has neither."""
    places = enumerate(ranking, 1)
    return next(((i, c) for i, c in places if c.effect.name in scenario.exact), None)


@one_thread
def run(task: Task) -> Row:
    """One record made, diagnosed and judged."""
    name, noise, trial_set, seed, fixed_off = task
    scenario, watch = EVERY[name], Stopwatch()
    with watch("simulate"):
        trials = record(scenario, noise, trial_set, seed)
    model = guessed(scenario, seed, fixed_off)
    row = Row(name, scenario.group, noise, trial_set, seed)
    try:
        done = diagnosed(trials, model, settings_of(model), watch)
    except TrialidError as error:
        return row.also(kind="error", name=str(error), seconds=watch.seconds)
    if scenario.known:
        with watch("truth"):
            trials = record(scenario, noise, trial_set, seed, rudder=True)
            true = without(scenario)
            values = {n: true.value(n) for n in done.fit.settings.free}
            plain, fall = plainness(done.fit, trials, restored(scenario, true), values)
            row = row.also(plain=plain, fall=fall)
    right = {*scenario.right, *(candidates_to_free(done.fit) if fixed_off else ())}
    return judged(row, scenario, right, done).also(seconds=watch.seconds)


def judged(row: Row, scenario: Scenario, right: set[str], done: Diagnosis) -> Row:
    """What the diagnosis said beside what is true, and what is `right` to name."""
    verdict, named, family = done.verdict, done.named, done.verdict.family
    if (found := true_candidate(scenario, done.ranking)) is not None:
        place, candidate = found
        row = row.also(
            score=candidate.score, p=candidate.p_value, rank=place,
            visibility=candidate.visibility, eps_true=candidate.eps_predicted,
        )  # fmt: skip
    if named is not None:
        row = row.also(eps_predicted=named.candidate.eps_predicted, eps_after=named.fit.eps_rmsn)
    if tried := min(done.refits, key=lambda r: r.fit.eps_rmsn, default=None):
        row = row.also(tried=tried.candidate.effect.name, eps_tried=tried.fit.eps_rmsn,
                       eps_check_tried=tried.fit.eps_check)  # fmt: skip
    effect = named.candidate.effect if named is not None else None
    return row.also(
        kind=verdict.kind, name=verdict.effect or "", family=family,
        exact=verdict.effect in scenario.exact,
        right=bool({verdict.effect, *family, *verdict.held_as_well} & right),
        physical=effect is not None and Force in effect.forms,
        eps=done.fit.eps_rmsn, eps_check=done.fit.eps_check,
    )  # fmt: skip


def tasks(asked: argparse.Namespace) -> list[Task]:
    """Every run that is asked for, in the order of the tables."""
    seeds = range(asked.first_seed, asked.first_seed + asked.seeds)
    return [
        (name, noise, trial_set, seed, asked.fixed_off)
        for trial_set, noise, name, seed in product(
            asked.trials, asked.noise, asked.scenarios, seeds
        )
    ]


def run_all(todo: Sequence[Task], jobs: int, on: str | None = None) -> list[Row]:
    """Rows in the order of the tasks, wherever they are done."""
    # few at a time: neighbours share the compiled truth of their scenario
    rows = spread(run, todo, jobs, on, together=4)
    return [_told(row, i, len(todo)) for i, row in enumerate(rows, 1)]


def _told(row: Row, done: int, of: int) -> Row:
    said = f"{row.kind} {row.name}".strip()
    where = f"{row.scenario}, {row.noise}, {row.trials}, seed {row.seed}"
    print(f"{done}/{of} {where}: {said}", file=sys.stderr)
    return row


def _names(known: Sequence[str]) -> Callable[[str], list[str]]:
    """A list with commas of known names."""

    def parse(text: str) -> list[str]:
        names = [n for word in text.split(",") for n in (TYPICAL if word == "typical" else [word])]
        for name in names:
            if name not in known:
                raise argparse.ArgumentTypeError(f"{name!r} is none of {', '.join(known)}")
        return names

    return parse


def options() -> argparse.Namespace:
    """The command line, with the short form's own defaults."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--short", action="store_true", help="the form that CI runs")
    parser.add_argument("--seeds", type=int, help="records of each scenario and noise")
    parser.add_argument("--first-seed", type=int, default=0)
    parser.add_argument(
        "--scenarios",
        type=_names(tuple(EVERY)),
        help="with commas; `typical` for the rest of the catalogue",
    )
    parser.add_argument("--noise", type=_names(NOISES), help="with commas")
    parser.add_argument("--trials", type=_names(tuple(TRIAL_SETS)), help="with commas")
    off = "share by which what is held fixed is off"
    parser.add_argument("--fixed-off", type=float, default=0.0, help=off)
    add_options(parser)
    parser.add_argument("--out", type=Path, help="FILE.md or FILE.csv")
    asked = parser.parse_args()
    if asked.out is not None and asked.out.suffix not in (".md", ".csv"):
        parser.error(f"--out {asked.out}: a name that ends in .md or .csv is needed")
    full, short = (SEEDS, CORE, NOISES, TRIAL_SETS), (SHORT_SEEDS, SHORT_SCENARIOS, SHORT_NOISES)
    seeds, scenarios, noise, trials = (*short, ["mixed"]) if asked.short else full
    asked.seeds, asked.scenarios = asked.seeds or seeds, asked.scenarios or list(scenarios)
    asked.noise, asked.trials = asked.noise or list(noise), asked.trials or list(trials)
    return asked


def main() -> int:
    """Run, print, write; 1 where a threshold is missed."""
    asked = options()
    began = time.perf_counter()
    rows = run_all(tasks(asked), asked.jobs, asked.on)
    text = report(rows, limits := SHORT if asked.short else FULL)
    print(text)
    print(f"{len(rows)} runs in {time.perf_counter() - began:.0f} s", file=sys.stderr)
    if asked.out is not None:
        write(asked.out.with_suffix(".csv"), rows)
        if asked.out.suffix == ".md":
            head = f"# Hidden effects\n\nMade at commit {commit_of(Path(__file__).parent)}.\n\n"
            asked.out.write_text(head + text, encoding="utf-8")
    return 0 if all(t.kept for t in thresholds(rows, limits)) else 1


if __name__ == "__main__":
    sys.exit(main())
