r"""How often the noise and the model part of an error lie in their stated intervals.

    PYTHONPATH=. python tests/benchmarks/noise_parts.py --records 24 --first 13000 --jobs 2 --write

Two true ships, each fitted by a model that lacks something or, in one record of four of the first,
nothing: the benchmark's own S175Q with an effect hidden, and the cubic S-175, on a second-order
model. What was put on the outputs is known, and what the fitted model misses of the output without
it: both in the norm of eps_RMSn, over the samples that were compared. A part is right inside its
interval of 95 %, wrong outside, or the split is refused. Every record depends on its case and seed
alone. Exit status 1 where fewer than 90 % of a case are right or refused.

In gusts noise is whatever the recorded output has beyond that of the same ship under the same
rudder in a calm: no model driven by the rudder can know of it.
"""

import argparse
import csv
import sys
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import astuple, dataclass, fields, replace
from itertools import product
from pathlib import Path
from typing import Final, Literal
from unittest import mock

import numpy as np
from numpy.typing import NDArray

HERE: Final = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE / "growth"), str(HERE.parents[1] / ".ci")]
import other_base  # noqa: E402
from at_commit import commit_of  # noqa: E402
from hidden_effects import settings_of  # noqa: E402
from hidden_scenarios import SCENARIOS, guessed  # noqa: E402
from hidden_tables import table  # noqa: E402
from hidden_truth import (  # noqa: E402
    APPROACH,
    COMPASS,
    DEG,
    GYRO,
    INCLINOMETER,
    LOG,
    OUTPUTS,
    PERIOD,
    SHAFT,
    STEP,
    TRIAL_SETS,
    Manoeuvre,
    Passage,
    Scenario,
    binary,
    clock,
    coloured,
    disturbance,
    generator,
    ramped,
    sailor,
    truth,
    zigzag,
)

from trialid.diagnosis.diagnose import DiagnoseSettings, examine_fit, refits_of  # noqa: E402
from trialid.diagnosis.noise import error_parts  # noqa: E402
from trialid.diagnosis.noise.error_parts import Split  # noqa: E402
from trialid.diagnosis.noise.noise_bound import held_against  # noqa: E402
from trialid.diagnosis.noise.split import split  # noqa: E402
from trialid.diagnosis.search.completeness import completeness  # noqa: E402
from trialid.errors import TrialidError  # noqa: E402
from trialid.identification.fit import Fit  # noqa: E402
from trialid.identification.problem import Settings  # noqa: E402
from trialid.progress import silent  # noqa: E402
from trialid.threads import one_thread  # noqa: E402
from trialid.trial import Trial  # noqa: E402
from trialid.workflow.fit_model import fit_with_progress  # noqa: E402

Vector = NDArray[np.float64]
RESULTS: Final = HERE / "results" / "noise_parts.md"
ASKED: Final = 0.90
HIDDEN: Final = (
    "righting_arm_cubic", "yaw_drag_rar", "quadratic_roll_damping", "sway_drag_vav", "heel_drift",
    "rudder_slipstream", "odd_heel", "odd_rudder", "delay_r", "static_list",
)  # fmt: skip
SENSORS: Final = np.array([GYRO, INCLINOMETER])
SWELL: Final = np.array([0.03, 0.3]) * DEG
ARM: Final = Scenario(
    "righting_arm", "physics", SCENARIOS["righting_arm_cubic"].effects, {"GM3": 8.0}
)
"""A righting arm that stiffens nearly three times as much as that of the benchmark."""

CUBIC: Final = Scenario("cubic", "outside", ship=other_base.TRUTH)


def square(manoeuvre: Manoeuvre, growth: float) -> Vector:
    """A rudder over to alternate sides every minute, each time so much of the first angle more."""
    t = clock(manoeuvre)
    times = np.arange(APPROACH, manoeuvre.duration, 60.0)
    angles = manoeuvre.angle * DEG * (1.0 + growth * np.arange(len(times)))
    signs = (-1.0) ** np.arange(len(times))
    return ramped([(float(s), float(a)) for s, a in zip(times, signs * angles, strict=True)], t)


def _zigzags(*angles: tuple[float, float]) -> tuple[Manoeuvre, ...]:
    return tuple(Manoeuvre(f"zigzag-{a:g}-{h:g}", a, h, 0.5 + a) for a, h in angles)


SQUARE: Final = "square"
GROWING: Final = (
    _zigzags((5.0, 5.0), (10.0, 10.0), (20.0, 20.0), (30.0, 30.0)),
    (Manoeuvre(SQUARE, 8.0, None, 0.5), TRIAL_SETS["mixed"][3]),
    _zigzags((15.0, 15.0), (16.0, 15.0), (25.0, 20.0)),
)
"""An error of the model that grows with the angle: from trial to trial, from period to period, and
between two runs that are nearly the same."""

Put = Callable[[np.random.Generator, Vector, Vector], Vector]
"""What sensors put on the outputs, (N, 2): from random numbers, times (N,) and the outputs."""


def white(rng: np.random.Generator, t: Vector, y: Vector) -> Vector:
    """What each sensor has for itself."""
    return SENSORS * rng.standard_normal(y.shape)


def swell(rng: np.random.Generator, t: Vector) -> Vector:
    """What sensors see of a sea and the rudder does not; (N, 2)."""
    return SWELL * np.column_stack([coloured(rng, len(t), 0.6, PERIOD) for _ in OUTPUTS])


def waves(rng: np.random.Generator, t: Vector, y: Vector) -> Vector:
    """The same sea throughout."""
    return white(rng, t, y) + swell(rng, t)


def rising(rng: np.random.Generator, t: Vector, y: Vector) -> Vector:
    """A sea that is a fifth during the approach, and all there two minutes after it."""
    share = np.interp(t, [APPROACH, APPROACH + 120.0], [0.2, 1.0])[:, None]
    return white(rng, t, y) + share * swell(rng, t)


def counts(rng: np.random.Generator, t: Vector, y: Vector) -> Vector:
    """Sensors that count: in steps of 0.3 to 1 of their noise, or 0.1 to 1 of the motion."""
    coarse = rng.random() < 0.5
    noise = white(rng, t, y) * (0.2 if coarse else 1.0)
    step = y.std(axis=0) * rng.uniform(0.1, 1.0) if coarse else SENSORS * rng.uniform(0.3, 1.0)
    return np.asarray(np.round((y + noise) / step) * step - y)


def outliers(rng: np.random.Generator, t: Vector, y: Vector) -> Vector:
    """One sample in a hundred 10 to 30 times the noise away."""
    far = rng.uniform(10.0, 30.0, y.shape) * rng.choice([-1.0, 1.0], y.shape)
    return white(rng, t, y) + SENSORS * far * (rng.random(y.shape) < 0.01)


@dataclass(frozen=True)
class Case:
    """One way in which an assumption of a route may fail."""

    put: Put
    grows: bool = False
    weather: str = "none"
    loss: Literal["squares", "huber"] = "squares"


CASES: Final[Mapping[str, Case]] = {
    "white": Case(white),
    "waves": Case(waves),
    "grows": Case(white, grows=True),
    "grows, waves": Case(waves, grows=True),
    "rising sea": Case(rising),
    "counts": Case(counts),
    "outliers": Case(outliers),
    "outliers, huber": Case(outliers, loss="huber"),
    "gusts": Case(waves, weather="process"),
}


@dataclass(frozen=True)
class Row:
    """One record: what is so, and what was said; errors as eps_RMSn.

    `half_wrong`, `twice_wrong`: with half and twice of what parameters may have taken up.
    """

    case: str
    hidden: str
    seed: int
    method: str
    why: str
    eps: float
    true_noise: float
    true_model: float
    noise: float | None = None
    noise_low: float = np.nan
    noise_high: float = np.nan
    model: float | None = None
    model_low: float = np.nan
    model_high: float = np.nan
    half_wrong: bool = False
    twice_wrong: bool = False

    @property
    def refused(self) -> bool:
        """Whether nothing was stated."""
        return self.noise is None

    @property
    def noise_held(self) -> bool:
        """Whether the noise part is inside."""
        return self.noise_low <= self.true_noise <= self.noise_high

    @property
    def model_held(self) -> bool:
        """Whether the model part is inside."""
        return self.model_low <= self.true_model <= self.model_high

    @property
    def wrong(self) -> bool:
        """Whether a part that was stated is outside."""
        return not self.refused and not (self.noise_held and self.model_held)


def scenario_of(case: Case, seed: int) -> Scenario:
    """What is hidden: in one record of four nothing, in one of four the ship is another."""
    rng = generator(seed, "what")
    if seed % 4 == 3:
        return CUBIC
    if case.grows:
        return ARM
    return SCENARIOS["nothing" if seed % 4 == 0 else str(rng.choice(HIDDEN))]


def sailed(case: Case, scenario: Scenario, m: Manoeuvre, seed: int) -> tuple[Passage, Vector]:
    """The manoeuvre in its weather, and the outputs (N, 2) of the same rudder in a calm."""
    rng = generator(seed, m.name, "sea")
    forces = disturbance(case.weather, m, rng)
    sail = sailor(truth(scenario), scenario, m, forces)
    if m.heading is not None:
        passage = zigzag(m, sail)
    else:
        passage = sail(square(m, 0.03) if m.name == SQUARE else binary(m, rng))
    if case.weather == "none":
        return passage, passage.y
    return passage, sailor(truth(scenario), scenario, m, disturbance("none", m, rng))(
        passage.delta
    ).y


def recorded(
    case: Case, scenario: Scenario, seed: int
) -> tuple[tuple[Trial, ...], dict[str, Vector]]:
    """Trials as logged, and the outputs without noise by trial; (N, 2)."""
    size = float(np.exp(generator(seed, "size").uniform(np.log(0.3), 0.0)))
    chosen = GROWING[seed % 3] if case.grows else TRIAL_SETS["mixed"]
    made, clean, each = [], {}, round(PERIOD / STEP)
    for m in chosen:
        passage, calm = sailed(case, scenario, m, seed)
        y, clean[m.name] = passage.y[::each], calm[::each]
        rng, n, t = generator(seed, m.name, "sensors"), len(y), np.arange(len(y)) * PERIOD
        # the noise is smaller where its size is, and so is the motion that a count is a share of
        seen = y + size * case.put(rng, t, y / size)
        signals = {
            "delta": passage.delta[::each].copy(), "n": np.full(n, SHAFT),
            "u": passage.states["u"][::each] + LOG * rng.standard_normal(n),
            "psi": passage.states["psi"][::each] + COMPASS * rng.standard_normal(n),
            **{c: seen[:, i].copy() for i, c in enumerate(OUTPUTS)},
        }  # fmt: skip
        valid = {c: np.ones(n, dtype=bool) for c in signals}
        made.append(Trial(m.name, m.use, PERIOD, signals, valid))
    return tuple(made), clean


def fitted(case: Case, scenario: Scenario, seed: int, trials: tuple[Trial, ...]) -> Fit:
    """The model that lacks what is hidden."""
    if scenario is CUBIC:
        model = other_base.BASE
        settings = Settings(other_base.FREE, OUTPUTS, nuisance=("initial_state",))
    else:
        model = guessed(scenario, seed)
        settings = settings_of(model)
    settings = replace(settings, loss=case.loss)
    return fit_with_progress(trials, model, settings, lambda words, share: None)


def parts_of(fit: Fit, clean: Mapping[str, Vector]) -> tuple[float, float]:
    """The noise that was put in, and what the model misses of the output without it."""
    squares = np.zeros((2, len(OUTPUTS)))
    count = np.zeros(len(OUTPUTS))
    for score in (s for s in fit.scores if s.trial.use == "fit"):
        y = np.column_stack([score.trial.signals[c] for c in OUTPUTS])
        true, mask = clean[score.trial.name], score.compared
        for k, apart in enumerate((y - true, true - score.response.y)):
            squares[k] += np.sum(np.where(mask, apart, 0.0) ** 2, axis=0)
        count += mask.sum(axis=0)
    noise, model = np.sqrt(np.mean(squares / count / fit.problem.y_rms**2, axis=1))
    return float(noise), float(model)


def said_of(fit: Fit, shares: Sequence[float]) -> list[Split]:
    """The split as the diagnosis states it, with `TAKEN` at these shares of what it is."""
    asked = DiagnoseSettings()
    _, ranking, augmented = examine_fit(fit, asked, silent)
    whole = completeness(augmented)
    fits = [r.fit for r in refits_of(fit, ranking, asked, lambda words: None)]
    said = []
    for share in shares:
        with mock.patch.object(error_parts, "TAKEN", share * error_parts.TAKEN):
            chosen, routes = split(fit, augmented, {})
            said.append(held_against(chosen, routes, fit, fits, whole))
    return said


@one_thread
def one(task: tuple[str, int]) -> Row:
    """One record made, fitted and split."""
    name, seed = task
    case = CASES[name]
    scenario = scenario_of(case, seed)
    trials, clean = recorded(case, scenario, seed)
    try:
        fit = fitted(case, scenario, seed, trials)
    except TrialidError as error:
        return Row(name, scenario.name, seed, "no fit", str(error), np.nan, np.nan, np.nan)
    parts = parts_of(fit, clean)
    rows = [
        _row(Row(name, scenario.name, seed, x.method, x.why, fit.eps_rmsn, *parts), x)
        for x in said_of(fit, (1.0, 0.5, 2.0))
    ]
    return replace(rows[0], half_wrong=rows[1].wrong, twice_wrong=rows[2].wrong)


def _row(row: Row, said: Split) -> Row:
    """With what was stated, if anything was."""
    if said.noise is None or said.noise_interval is None or said.undermodelling_interval is None:
        return row
    return replace(
        row, noise=said.noise, noise_low=said.noise_interval[0],
        noise_high=said.noise_interval[1], model=said.undermodelling,
        model_low=said.undermodelling_interval[0], model_high=said.undermodelling_interval[1],
    )  # fmt: skip


def page(rows: Sequence[Row]) -> str:
    """Counts by case and by case and method, and every record that is wrong."""
    head = ("case", "records", "both held", "refused", "noise wrong", "model wrong", "not wrong",
            "at half", "at twice")  # fmt: skip
    by = [(n, [r for r in rows if r.case == n]) for n in dict.fromkeys(r.case for r in rows)]
    lines = [_line(n, mine) for n, mine in by]
    methods = [
        _line(f"{n}: {m}", [r for r in mine if r.method == m])
        for n, mine in by
        for m in sorted({r.method for r in mine})
        if m != "not separable"
    ]
    wrong = [_said(r) for r in rows if r.wrong]
    return "\n\n".join((
        table(head, lines), "## By route", table(head, methods), "## Wrong",
        "\n".join(wrong) or "none",
    )) + "\n"  # fmt: skip


def _line(name: str, rows: Sequence[Row]) -> Sequence[str]:
    stated = [r for r in rows if not r.refused]
    counts = (
        len(rows), sum(not r.wrong for r in stated), len(rows) - len(stated),
        sum(not r.noise_held for r in stated), sum(not r.model_held for r in stated),
    )  # fmt: skip
    kept = [
        f"{1.0 - np.mean([wrong(r) for r in rows]):.0%}"
        for wrong in (lambda r: r.wrong, lambda r: r.half_wrong, lambda r: r.twice_wrong)
    ]
    return name, *map(str, counts), *kept


def _said(r: Row) -> str:
    return (
        f"* {r.case}, {r.seed}, {r.hidden}, {r.method}: noise {r.true_noise:.2%} "
        f"({r.noise_low:.2%} to {r.noise_high:.2%}), "
        f"model {r.true_model:.2%} ({r.model_low:.2%} to {r.model_high:.2%})"
    )


def main() -> int:
    """Count, and write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--records", type=int, default=24, help="of each case")
    parser.add_argument("--first", type=int, default=13000, help="first seed")
    parser.add_argument("--cases", default=",".join(CASES).replace(", ", " "), help="by commas")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--rows", type=Path, help="FILE.csv of every record")
    parser.add_argument("--write", action="store_true")
    asked = parser.parse_args()
    names = [n for n in CASES if n.replace(", ", " ") in asked.cases.split(",")]
    seeds = range(asked.first, asked.first + asked.records)
    with ProcessPoolExecutor(asked.jobs) as pool:
        rows = list(pool.map(one, product(names, seeds), chunksize=4))
    said = page(rows)
    print(said)
    if asked.rows:
        with asked.rows.open("w", newline="", encoding="utf-8") as file:
            out = csv.writer(file)
            out.writerow(f.name for f in fields(Row))
            out.writerows(map(astuple, rows))
    if asked.write:
        head = (
            "# Noise and model part against the truth\n\n`python tests/benchmarks/noise_parts.py`, "
            f"commit {commit_of(HERE)}, seeds {seeds[0]} to {seeds[-1]}\n\n"
        )
        RESULTS.write_text(head + said, encoding="utf-8")
    kept = [np.mean([not r.wrong for r in rows if r.case == n]) >= ASKED for n in names]
    return 0 if all(kept) else 1


if __name__ == "__main__":
    sys.exit(main())
