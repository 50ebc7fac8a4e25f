"""The rows of the hidden-effects benchmark, their tables, and the thresholds they are held to."""

import csv
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass, field, fields, replace
from itertools import groupby
from pathlib import Path
from typing import Any, Final

import numpy as np

DETECTABLE: Final = 30.0
"""Likelihood ratio of what is hidden from which on it has to be named."""

NOTICED: Final = 0.03
"""Share of the squared error that what is hidden is the cause of: a twice that of what is worth a
name, for it is known to the diagnosis within a half only. Less is significant and small."""

NEAR: Final = 0.2
"""Relative difference up to which a predicted and an achieved fall of the error agree."""

IN_CATALOGUE: Final = ("physics", "sensor", "gear")
STAGES: Final = ("simulate", "fit", "rank", "split", "refit", "decide", "truth")


@dataclass(frozen=True)
class Row:
    """One run: what was hidden, what was said, and whether that is right.

    `plain` says how plainly what is hidden stands in the record and `fall` which share of the
    squared error goes with it (`hidden_score`); `score`, `p`,
    `rank` and `visibility` are the diagnosis's own figures of it.
    eps_RMSn: `eps` of the fit, `eps_true` as predicted with what is hidden, `eps_predicted` as
    predicted with what is named, `eps_after` as the refit with that came out; `eps_check` of the
    held-out trial. `tried` is the refit that came out best, named or not.
    """

    scenario: str
    group: str
    noise: str
    trials: str
    seed: int
    kind: str = ""
    name: str = ""
    family: tuple[str, ...] = ()
    exact: bool = False
    right: bool = False
    physical: bool = False
    plain: float | None = None
    fall: float | None = None
    score: float | None = None
    p: float | None = None
    rank: int | None = None
    visibility: float | None = None
    eps_true: float | None = None
    eps: float | None = None
    eps_predicted: float | None = None
    eps_after: float | None = None
    eps_check: float | None = None
    tried: str = ""
    eps_tried: float | None = None
    eps_check_tried: float | None = None
    seconds: Mapping[str, float] = field(default_factory=dict)

    def also(self, **values: Any) -> "Row":
        """The row with more of it known."""
        return replace(self, **values)

    @property
    def detectable(self) -> bool:
        """Whether what is hidden stands out of the noise and would be noticed, by the truth."""
        return self.plain is not None and self.plain > DETECTABLE and self.noticed

    @property
    def noticed(self) -> bool:
        """Whether the error falls by what is worth a name when what is hidden is put back."""
        return self.fall is None or self.fall >= NOTICED

    @property
    def named(self) -> bool:
        """Whether an effect was named."""
        return self.kind == "missing"

    @property
    def wrong(self) -> bool:
        """Whether what was named is something else."""
        return self.named and not self.right

    @property
    def ratio(self) -> float | None:
        """Predicted over achieved fall of the error with the named effect."""
        if self.eps is None or self.eps_predicted is None or self.eps_after is None:
            return None
        achieved = self.eps - self.eps_after
        return (self.eps - self.eps_predicted) / achieved if achieved > 0.0 else float("inf")


@dataclass(frozen=True)
class Threshold:
    """A share that must not fall short of (`least`) or exceed a limit."""

    words: str
    count: int
    of: int
    limit: float
    least: bool = False

    @property
    def share(self) -> float:
        """What was measured."""
        return self.count / self.of if self.of else float("nan")

    @property
    def kept(self) -> bool:
        """Whether it holds; what was not run is not held."""
        if not self.of:
            return True
        return self.share >= self.limit if self.least else self.share <= self.limit

    def __str__(self) -> str:
        sign, result = (">=" if self.least else "<="), ("ok" if self.kept else "MISSED")
        if not self.of:
            return f"{self.words} {sign} {self.limit:.0%}: no such run"
        share = f"{self.share:.1%} ({self.count} of {self.of})"
        return f"{self.words} {sign} {self.limit:.0%}: {share} {result}"


@dataclass(frozen=True)
class Limits:
    """The shares that are asked for."""

    right: float = 0.95
    wrong: float = 0.02
    alarms: float = 0.05
    outside_wrong: float = 0.05
    outside_seen: float = 0.90
    sensor_physical: float = 0.02
    control: float = 0.0
    near: float = 0.90


FULL: Final = Limits()
SHORT: Final = Limits(0.80, 0.10, 0.25, 0.25, 0.50, 0.0, 0.0, 0.75)
"""A handful of runs: one that goes wrong may not stop the line, three may."""


def thresholds(rows: Sequence[Row], limits: Limits) -> list[Threshold]:
    """What the mixed trials are held to; to name a coefficient that is held off is never wrong."""
    mixed = [r for r in rows if r.trials == "mixed"]
    seen = [r for r in mixed if r.group in IN_CATALOGUE and r.detectable]
    odd = [r for r in mixed if r.group == "outside" and r.detectable]
    sensors = [r for r in mixed if r.group == "sensor"]
    controls = [r for r in mixed if r.group == "control"]
    drops = [r for r in seen if r.right and r.ratio is not None]
    made = [
        _held("right family, of detectable", seen, lambda r: r.right, limits.right, True),
        _held("wrong name, of detectable", seen, lambda r: r.wrong, limits.wrong),
        _held("predicted fall of the error within 20 % of the achieved", drops, _near,
              limits.near, True),
        _held("outside the catalogue: named", odd, lambda r: r.wrong, limits.outside_wrong),
        _held("outside the catalogue: said to be", [r for r in odd if not r.right], _gap,
              limits.outside_seen, True),
        _held("sensor fault named a physical effect", sensors, lambda r: r.physical and r.wrong,
              limits.sensor_physical),
        _held("control named", controls, lambda r: r.wrong, limits.control),
    ]  # fmt: skip
    for noise in dict.fromkeys(r.noise for r in mixed):
        quiet = [r for r in mixed if r.group == "nothing" and r.noise == noise]
        made.append(_held(f"false alarms, {noise}", quiet, lambda r: r.wrong, limits.alarms))
        made.append(_held(f"gaps claimed, {noise}", quiet, _gap, limits.alarms))
    return [*made, _held("runs that broke off", rows, lambda r: r.kind == "error", 0.0)]


def _held(
    words: str,
    rows: Sequence[Row],
    counts: Callable[[Row], bool],
    limit: float,
    least: bool = False,
) -> Threshold:
    return Threshold(words, sum(map(counts, rows)), len(rows), limit, least)


def _gap(row: Row) -> bool:
    return row.kind == "not in catalogue"


def _near(row: Row) -> bool:
    return row.ratio is not None and abs(row.ratio - 1.0) <= NEAR


HEAD: Final = (
    "scenario", "group", "runs", "median plain", "median score", "median rank", "detectable",
    "right", "exact",
    "wrong", "not in catalogue", "nothing", "cannot tell", "weak: right", "weak: wrong",
    "family size", "fall ratio", "within 20 %",
)  # fmt: skip


def scenario_line(rows: Sequence[Row]) -> list[str]:
    """One scenario under one noise; verdicts of detectable runs, of all where plainness is none."""
    scored = any(r.plain is not None for r in rows)
    strong = [r for r in rows if r.detectable] if scored else list(rows)
    weak = [r for r in rows if not r.detectable] if scored else []
    ratios = [r.ratio for r in rows if r.ratio is not None]
    kinds = [r.kind for r in strong]
    return [
        rows[0].scenario, rows[0].group, str(len(rows)),
        _median([r.plain for r in rows], ".0f"),
        _median([r.score for r in rows], ".0f"), _median([r.rank for r in rows], ".0f"),
        str(len(strong)) if scored else "-",
        str(sum(r.right for r in strong)), str(sum(r.exact for r in strong)),
        str(sum(r.wrong for r in strong)),
        *(str(kinds.count(k)) for k in ("not in catalogue", "nothing missing", "cannot tell")),
        str(sum(r.right for r in weak)), str(sum(r.wrong for r in weak)),
        _median([len(r.family) for r in rows if r.named], ".0f"),
        _median(ratios, ".2f"),
        f"{sum(_near(r) for r in rows)}/{len(ratios)}" if ratios else "-",
    ]  # fmt: skip


def total_line(rows: Sequence[Row]) -> list[str]:
    """All scenarios of one group under one noise."""
    return ["(all)", *scenario_line(rows)[1:]]


def _median(values: Sequence[float | None], form: str) -> str:
    known = [x for x in values if x is not None]
    return format(float(np.median(known)), form) if known else "-"


def wrong_names(rows: Sequence[Row]) -> list[str]:
    """What was named in place of what, most often first."""
    pairs = [(r.scenario, r.name, r.trials, r.noise) for r in rows if r.wrong]
    found = {pair: pairs.count(pair) for pair in pairs}
    return [
        f"{scenario} -> {name}: {count} ({trials}, {noise})"
        for (scenario, name, trials, noise), count in sorted(
            found.items(), key=lambda item: (-item[1], item[0])
        )
    ]


def table(head: Sequence[str], lines: Sequence[Sequence[str]]) -> str:
    """A Markdown table that can be read as it is."""
    widths = [max(len(x[i]) for x in (head, *lines)) for i in range(len(head))]
    rule = ["-" * w for w in widths]
    return "\n".join(
        "| " + " | ".join(x.ljust(w) for x, w in zip(line, widths, strict=True)) + " |"
        for line in (head, rule, *lines)
    )


def report(rows: Sequence[Row], limits: Limits) -> str:
    """Thresholds, tables and times, as Markdown."""
    parts = [f"{len(rows)} runs, seeds {_seeds(rows)}", "## Thresholds (mixed trials)"]
    parts.append("\n".join(f"* {t}" for t in thresholds(rows, limits)))
    for (trials, noise), some in _grouped(rows, lambda r: (r.trials, r.noise)):
        lines = [scenario_line(mine) for _, mine in _grouped(some, lambda r: r.scenario)]
        lines += [total_line(mine) for _, mine in _grouped(some, lambda r: r.group)]
        parts += [f"## {trials}, {noise}", table(HEAD, lines)]
    parts += ["## Wrong names", "\n".join(f"* {x}" for x in wrong_names(rows)) or "none"]
    parts += ["## Processor time a run", times(rows)]
    return "\n\n".join(parts) + "\n"


def times(rows: Sequence[Row]) -> str:
    """Mean processor seconds by stage."""
    each = {
        s: float(np.mean([r.seconds.get(s, 0.0) for r in rows])) if rows else 0.0 for s in STAGES
    }
    words = ", ".join(f"{s} {x:.3f} s" for s, x in each.items())
    return f"{sum(each.values()):.2f} s: {words}"


def _seeds(rows: Sequence[Row]) -> str:
    seeds = sorted({r.seed for r in rows})
    return f"{seeds[0]} to {seeds[-1]}" if seeds else "none"


def _grouped(rows: Sequence[Row], key: Callable[[Row], Any]) -> Iterator[tuple[Any, list[Row]]]:
    """Rows by a key, in the order in which the keys first appear."""
    order = list(dict.fromkeys(map(key, rows)))
    for value, some in groupby(sorted(rows, key=lambda r: order.index(key(r))), key):
        yield value, list(some)


def write(path: Path, rows: Sequence[Row]) -> None:
    """One line a run."""
    names = [f.name for f in fields(Row) if f.name != "seconds"]
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([*names, *(f"seconds_{s}" for s in STAGES)])
        for row in rows:
            values = {n: _text(x) for n, x in asdict(row).items() if n != "seconds"}
            times_ = [f"{row.seconds.get(s, 0.0):.3f}" for s in STAGES]
            writer.writerow([*(values[n] for n in names), *times_])


def _text(value: Any) -> str:
    if isinstance(value, tuple):
        return " ".join(value)
    if isinstance(value, float):
        return f"{value:.6g}"
    return "" if value is None else str(value)
