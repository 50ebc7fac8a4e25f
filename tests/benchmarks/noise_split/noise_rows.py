"""What was stated of noise and model part beside what is so, counted."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from hidden_tables import table

from trialid.diagnosis.noise.error_parts import Split


@dataclass(frozen=True, kw_only=True)
class Row:
    """One record: what is so, and what was said; errors as eps_RMSn.

    `half_wrong`, `twice_wrong`: with half and twice of what parameters may have taken up.
    """

    case: str
    hidden: str
    seed: int
    method: str = ""
    why: str = ""
    eps: float = np.nan
    true_noise: float = np.nan
    true_model: float = np.nan
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


def with_said(row: Row, said: Split) -> Row:
    """With what was stated, if anything was."""
    row = replace(row, method=said.method, why=said.why)
    if said.noise is None or said.noise_interval is None or said.undermodelling_interval is None:
        return row
    (low, high), (floor, top) = said.noise_interval, said.undermodelling_interval
    parts = replace(row, noise=said.noise, noise_low=low, noise_high=high)
    return replace(parts, model=said.undermodelling, model_low=floor, model_high=top)


def page(rows: Sequence[Row]) -> str:
    """Counts by case and by case and method, and every record that is wrong."""
    head = (
        "case",
        "records",
        "both held",
        "refused",
        "noise wrong",
        "model wrong",
        "not wrong",
        "at half",
        "at twice",
    )
    by = [(n, [r for r in rows if r.case == n]) for n in dict.fromkeys(r.case for r in rows)]
    lines = [_line(n, mine) for n, mine in by]
    methods = [
        _line(f"{n}: {m}", [r for r in mine if r.method == m])
        for n, mine in by
        for m in sorted({r.method for r in mine})
        if m != "not separable"
    ]
    wrong = [_said(r) for r in rows if r.wrong]
    return (
        "\n\n".join(
            (
                table(head, lines),
                "## By route",
                table(head, methods),
                "## Wrong",
                "\n".join(wrong) or "none",
            )
        )
        + "\n"
    )


def _line(name: str, rows: Sequence[Row]) -> Sequence[str]:
    stated = [r for r in rows if not r.refused]
    counts = (
        len(rows),
        sum(not r.wrong for r in stated),
        len(rows) - len(stated),
        sum(not r.noise_held for r in stated),
        sum(not r.model_held for r in stated),
    )
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
