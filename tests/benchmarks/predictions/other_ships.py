"""How often the ranges that a newcomer is given hold what a ship of another structure is and does.

    PYTHONPATH=. python tests/benchmarks/predictions/other_ships.py --first-seed 900 --ships 12

Ships are drawn and logged as in `growth/mmg_ships.py` (the MMG method, which no model here has),
with a gyro and a sway, and with a compass and a speed log alone; begun as `trialid start` does, and
grown by `--auto`. Counted are the linear coefficients about the straight course, and the numbers of
a turning circle of 35 deg and zig-zags 10/10 and 20/20, against the drawn ship's own; `alone` are
the ranges without what other models say. A coefficient is believed where the report does not warn
of it. Results stand in `results/other_ships.md` with `--write`. Exit status 1 where fewer than nine
of ten ranges hold, or a believed coefficient is not in its own.
"""

import argparse
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

ROOT: Final = Path(__file__).resolve().parents[3]
sys.path[:0] = [
    str(ROOT / "tests" / "grow"),
    str(ROOT / ".ci"),
    str(ROOT / "tests/benchmarks/fleets"),
]
import mmg  # noqa: E402
from at_commit import commit_of  # noqa: E402
from begun import begun  # noqa: E402
from spread import add_options, spread  # noqa: E402

from trialid.accuracy.parameter_table import ParameterAccuracy  # noqa: E402
from trialid.arrays import Vector  # noqa: E402
from trialid.design.helm import Passage  # noqa: E402
from trialid.design.imo import measures  # noqa: E402
from trialid.design.prediction.seen_range import seen_ranges  # noqa: E402
from trialid.errors import TrialidError  # noqa: E402
from trialid.progress import silent  # noqa: E402
from trialid.report.words.doubt import HALF  # noqa: E402
from trialid.threads import one_thread  # noqa: E402
from trialid.trial import Trial  # noqa: E402
from trialid.workflow import grow  # noqa: E402
from trialid.workflow.outcome import Run  # noqa: E402
from trialid.workflow.use.finished_model import NO_FIT, FinishedModel  # noqa: E402
from trialid.workflow.use.kept_models import KeptAccuracy, KeptFit, Unknown  # noqa: E402
from trialid.workflow.use.orders import named_manoeuvre  # noqa: E402
from trialid.workflow.use.predict import predict_manoeuvre  # noqa: E402

RESULTS: Final = ROOT / "tests/benchmarks/results"
TRIALS: Final[Mapping[str, tuple[float, ...]]] = {
    "zz10": (10.0, 10.0),
    "zz20": (20.0, 20.0),
    "zz15": (15.0, 15.0),
    "turn20": (20.0,),
}
WANTED: Final = 0.9
Range = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class Said:
    """One number that is said of a ship: its true value, its range, and the range alone.

    `stage` is how the model came about; `believed` is a coefficient of which nothing warns.
    """

    stage: str
    kind: str
    true: float
    likely: Range
    alone: Range
    believed: bool = False

    @property
    def held(self) -> bool:
        """Whether the range holds the truth."""
        return self.likely[0] <= self.true <= self.likely[1]

    @property
    def held_alone(self) -> bool:
        """Whether the range of the model alone does."""
        return self.alone[0] <= self.true <= self.alone[1]

    @property
    def half_width(self) -> float:
        """Of the range, as a share of the truth."""
        return 0.5 * (self.likely[1] - self.likely[0]) / abs(self.true)


@one_thread
def said_of(item: tuple[int, bool]) -> list[Said]:
    """All that is said of one drawn ship, by one of the two recorders."""
    seed, heading = item
    rng, ship = np.random.default_rng([seed, 11]), mmg.drawn(seed)
    with tempfile.TemporaryDirectory() as place:
        try:
            pipeline = begun(Path(place), ship, rng, TRIALS, heading)
            done = [stage.run for stage in grow.stages(pipeline, silent) if stage.kept]
        except TrialidError as error:
            print(f"{seed}: {str(error).rpartition('/')[2]}", flush=True)
            return []
    stages = {"begun": done[0], "grown": done[-1]}
    said = [one for name, run in stages.items() for one in _of_run(name, run, ship)]
    off = [f"{one.stage} {one.kind}" for one in said if not one.held]
    print(f"{seed} {'compass' if heading else 'gyro'}: {len(said)}, off {off}", flush=True)
    return said


def _of_run(stage: str, run: Run, ship: mmg.Ship) -> Iterator[Said]:
    if run.result.verdict.kind != NO_FIT:
        yield from _coefficients(stage, run, ship)
        yield from _numbers(stage, run, ship)


def _coefficients(stage: str, run: Run, ship: mmg.Ship) -> Iterator[Said]:
    done, truth = run.findings.before, mmg.slopes(ship)
    pairs = zip(done.accuracy.physical, done.own_accuracy.physical, strict=True)
    for row, own in pairs:
        if row.name in truth and row.likely is not None and own.likely is not None:
            yield Said(
                stage=stage,
                kind="coefficients",
                true=truth[row.name],
                likely=row.likely,
                alone=own.likely,
                believed=_believed(row),
            )


def _believed(row: ParameterAccuracy) -> bool:
    return row.may_be_off is not None and row.may_be_off <= HALF


def _numbers(stage: str, run: Run, ship: mmg.Ship) -> Iterator[Said]:
    done = run.findings.before
    own = done.own_accuracy
    known = KeptAccuracy(tuple(Unknown(p.name) for p in own.parameters), own.covariance)
    model = FinishedModel("here", run.result, done, seen_ranges(done.fit))
    alone = replace(model, done=KeptFit(done.fit, known, done.doubts))
    for words, truth in sailed(ship).items():
        asked = named_manoeuvre(words.split())
        whole, narrow = (predict_manoeuvre(m, asked).motion.numbers for m in (model, alone))
        for name, (_, likely) in whole.items():
            kind, ends = name.partition(" [")[0], narrow[name][1]
            if kind in truth and likely is not None and ends is not None:
                yield Said(stage=stage, kind=words, true=truth[kind], likely=likely, alone=ends)


def sailed(ship: mmg.Ship) -> dict[str, dict[str, float]]:
    """What she does herself, by the words of a manoeuvre and the name of a number."""
    circle = measures.turning(_passage(ship, 35.0))
    found = {"circle 35": circle}
    for angle in (10, 20):
        over = np.rad2deg(measures.overshoots(_passage(ship, float(angle), float(angle))))
        names = (f"{n} overshoot {angle}/{angle}" for n in ("first", "second"))
        found[f"zigzag {angle} {angle}"] = dict(zip(names, map(float, over), strict=False))
    return found


def _passage(ship: mmg.Ship, angle: float, check: float | None = None) -> Passage:
    t, u, v, r, delta = mmg.sail(ship, angle, check, lengths=60.0)
    dt = float(t[1])
    psi = _integral(r, dt)
    x = _integral(u * np.cos(psi) - v * np.sin(psi), dt)
    y = _integral(u * np.sin(psi) + v * np.cos(psi), dt)
    signals = {"psi": psi, "delta_order": _orders(psi, delta, np.deg2rad(angle), check)}
    return Passage(Trial("hers", "check", dt, signals, {}), x, y, None)


def _integral(x: Vector, dt: float) -> Vector:
    return np.concatenate([[0.0], np.cumsum(0.5 * (x[1:] + x[:-1])) * dt])


def _orders(psi: Vector, delta: Vector, angle: float, check: float | None) -> Vector:
    """What the helmsman of `mmg.sail` ordered."""
    side, orders = 1.0, np.zeros(len(psi))
    begin = int(np.argmax(delta != 0.0))
    for k in range(begin, len(psi)):
        if check is not None and np.rad2deg(psi[k]) * side >= check:
            side = -side
        orders[k] = side * angle
    return orders


def page(found: Sequence[Said]) -> str:
    """The table: each kind of number, begun and grown."""
    heads = "| model | of | numbers | held | alone | half-width | believed | of them held |"
    rows = [heads, "|---" * 8 + "|"]
    for stage in ("begun", "grown"):
        kinds = {x.kind: None for x in found}
        for kind in kinds:
            some = [x for x in found if (x.stage, x.kind) == (stage, kind)]
            if some:
                rows.append(_row(stage, kind, some))
    return "\n".join(rows) + "\n"


def _row(stage: str, kind: str, some: Sequence[Said]) -> str:
    held, alone = sum(x.held for x in some), sum(x.held_alone for x in some)
    believed = [x.held for x in some if x.believed]
    of_them = f"{len(believed)} | {sum(believed)}" if kind == "coefficients" else "| "
    wide = float(np.median([x.half_width for x in some]))
    return f"| {stage} | {kind} | {len(some)} | {held} | {alone} | {wide:.0%} | {of_them} |"


def main() -> int:
    """Draw, begin, grow, count."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--first-seed", type=int, default=900)
    asked.add_argument("--ships", type=int, default=12)
    asked.add_argument("--write", action="store_true")
    add_options(asked, jobs=2)
    options = asked.parse_args()
    seeds = range(options.first_seed, options.first_seed + options.ships)
    items = [(seed, heading) for heading in (False, True) for seed in seeds]
    each = spread(said_of, items, options.jobs, options.on)
    found = [one for said in each for one in said]
    text = page(found)
    print(text)
    if options.write:
        begins = f"`python {Path(__file__).relative_to(ROOT)}`, seeds {seeds[0]} to {seeds[-1]}"
        head = f"# Ranges of ships of another structure\n\n{begins}, commit {commit_of(RESULTS)}"
        (RESULTS / "other_ships.md").write_text(f"{head}\n\n{text}", encoding="utf-8")
    held = sum(x.held for x in found) / len(found)
    return int(held < WANTED or not all(x.held for x in found if x.believed))


if __name__ == "__main__":
    sys.exit(main())
