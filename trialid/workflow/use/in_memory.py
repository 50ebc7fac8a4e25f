"""A run in memory under orders, as a table, once or for thousands of ships that may be hers."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Protocol

import numpy as np

from trialid.arrays import Vector
from trialid.design.following import sailed_ship
from trialid.design.prediction.drawn_ships import draw_ships, sail_draws, simulate_draws
from trialid.design.prediction.predicted_motion import motions
from trialid.design.prediction.seen_range import seen_ranges
from trialid.errors import TrialidError, nearest
from trialid.export.predicted_file import predicted_columns
from trialid.result.build import Findings
from trialid.result.schema import Result
from trialid.signal_arrays import HALF_ROUND, numbers
from trialid.workflow.use.export_model import export_model, export_places
from trialid.workflow.use.finished_model import FinishedModel, check_verdict
from trialid.workflow.use.orders import OrderTable, named_manoeuvre, stop_order
from trialid.workflow.use.predict import (
    predict_manoeuvre,
    predict_orders,
    ready_orders,
    spread_of,
)

if TYPE_CHECKING:
    import pandas as pd

from trialid.workflow.use.steering import Wishes
from trialid.workflow.use.stop import predict_stop
from trialid.workflow.use.what_if import WhatIf


class Found(Protocol):
    """A run as it lies in memory."""

    findings: Findings
    result: Result


def simulated_frame(
    run: Found,
    words: Sequence[str],
    period: float | None,
    inputs: Mapping[str, Sequence[float]],
    *,
    what_if: WhatIf,
    anyway: bool,
) -> "pd.DataFrame":
    """A manoeuvre by its words, or orders on a clock; see `RunView.simulate`."""
    import pandas as pd

    model = _model(run, anyway=anyway)
    stop = stop_order(words) if words else None
    if stop is not None:
        made = predict_stop(model, stop, what_if)
    elif words:
        made = predict_manoeuvre(model, named_manoeuvre(words), what_if)
    else:
        made = predict_orders(model, _table(model, period, inputs), "orders", what_if)
    columns = {n: x for n, _, x in predicted_columns(made.motion)}
    frame = pd.DataFrame(columns, index=pd.Index(made.motion.t, name="t"))
    frame.attrs |= {"numbers": dict(made.motion.numbers), "words": made.words}
    return frame


@dataclass(frozen=True)
class Draws:
    """What ships do that the record leaves open, a row a ship.

    Attributes
    ----------
    parameters
        Fitted and held numbers of each, and the effect that is missing from the model but there in
        the ship, or nothing.
    numbers
        Standard numbers of a manoeuvre by name; NaN where a ship has none.
    t, motion
        Times [s] (N,), and of orders on a clock every motion by name [SI]; (n, N).
    words
        What to know of them.
    """

    parameters: "pd.DataFrame"
    numbers: "pd.DataFrame"
    t: Vector
    motion: Mapping[str, Vector]
    words: tuple[str, ...]


def drawn_ships(
    run: Found,
    words: Sequence[str],
    period: float | None,
    inputs: Mapping[str, Sequence[float]],
    *,
    number: int,
    seed: int,
    anyway: bool,
) -> Draws:
    """A manoeuvre or orders for ships that are drawn; see `RunView.draw`."""
    import pandas as pd

    if number < 1:
        raise TrialidError(f"number={number}: expected how many ships to draw, at least 1")
    model = _model(run, anyway=anyway)
    spread = spread_of(model)
    if words:
        asked = named_manoeuvre(words)
        ship = sailed_ship(model.fit)
        ships = draw_ships(ship, spread, number, seed)
        numbers, t, motion = sail_draws(ship, asked, spread, ships), np.zeros(0), {}
    else:
        ship, orders, _ = ready_orders(model, _table(model, period, inputs), "orders")
        ships = draw_ships(ship, spread, number, seed)
        numbers, t = {}, orders.t
        motion = simulate_draws(ship, orders, spread, ships, motions(ship))
    missing = [m.effect.name for m in spread.missing]
    about = {**ships.known, "missing": [missing[i] if i >= 0 else "" for i in ships.rivals]}
    return Draws(pd.DataFrame(about), pd.DataFrame(numbers), t, motion, model.doubts)


def exported_model(
    run: Found, kind: str, out: Path | None, wishes: Wishes, *, force: bool, anyway: bool
) -> Path:
    """The first of the files that a model is written to; see `RunView.export`."""
    places = export_places(run.findings.name, kind, out, force=force)
    export_model(_model(run, anyway=anyway), kind, places, wishes)
    return places[0]


def _model(run: Found, *, anyway: bool) -> FinishedModel:
    """The model of a run in memory, as of one whose folder is read."""
    check_verdict(run.result, run.findings.name, anyway=anyway)
    done = run.findings.before
    return FinishedModel(run.findings.name, run.result, done, seen_ranges(done.fit))


def _table(
    model: FinishedModel, period: float | None, inputs: Mapping[str, Sequence[float]]
) -> OrderTable:
    """Orders of one length on an even clock.

    Raises
    ------
    TrialidError
        One is not known, not as long as the others, or not finite; or there is no clock.
    """
    known = model.quantities
    for name in inputs:
        if name not in known:
            raise TrialidError(f"there is no signal {name!r}; {nearest(name, known)}")
    values = {n: numbers(n, x) for n, x in inputs.items()}
    for name, one in values.items():
        if one.ndim != 1 or len(one) < 2 or not np.isfinite(one).all():
            raise TrialidError(f"{name}: expected a row of at least two finite numbers, in SI")
        if name in HALF_ROUND and float(np.abs(one).max()) > np.pi:
            raise TrialidError(
                f"{name}: reaches {np.abs(one).max():.4g} rad; no {HALF_ROUND[name]} is turned "
                "half round: give radians, as np.deg2rad(20)"
            )
    lengths = {len(one) for one in values.values()}
    timed = isinstance(period, float | int) and 0.0 < period < np.inf
    if len(lengths) != 1 or period is None or not timed:
        raise TrialidError(
            "expected a manoeuvre as 'zigzag', 20, 20, or inputs of one length and their period "
            "[s]: delta=[...], period=0.5"
        )
    return OrderTable(np.asarray(np.arange(lengths.pop()) * period), values)
