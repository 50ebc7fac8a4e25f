"""A run in memory under orders, as a table."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Protocol

import numpy as np

from trialid.design.prediction.seen_range import seen_ranges
from trialid.errors import TrialidError, nearest
from trialid.export.predicted_file import predicted_columns
from trialid.names.quantities import SIGNALS
from trialid.result.build import Findings
from trialid.result.schema import Result
from trialid.workflow.use.finished_model import FinishedModel, check_verdict
from trialid.workflow.use.orders import OrderTable, named_manoeuvre
from trialid.workflow.use.predict import predict_manoeuvre, predict_orders

if TYPE_CHECKING:
    import pandas as pd


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
    anyway: bool,
) -> "pd.DataFrame":
    """A manoeuvre by its words, or orders on a clock; see `RunView.simulate`."""
    import pandas as pd

    name = run.findings.name
    check_verdict(run.result, name, anyway=anyway)
    done = run.findings.before
    model = FinishedModel(name, run.result, done, seen_ranges(done.fit))
    if words:
        made = predict_manoeuvre(model, named_manoeuvre(words))
    else:
        made = predict_orders(model, _table(period, inputs), "orders")
    columns = {n: x for n, _, x in predicted_columns(made.motion)}
    frame = pd.DataFrame(columns, index=pd.Index(made.motion.t, name="t"))
    frame.attrs |= {"numbers": dict(made.motion.numbers), "words": made.words}
    return frame


def _table(period: float | None, inputs: Mapping[str, Sequence[float]]) -> OrderTable:
    """Orders of one length on an even clock.

    Raises
    ------
    TrialidError
        One is not known, not as long as the others, or not finite; or there is no clock.
    """
    values = {n: np.asarray(x, dtype=np.float64) for n, x in inputs.items()}
    for name, one in values.items():
        if name not in SIGNALS:
            raise TrialidError(f"there is no signal {name!r}; {nearest(name, SIGNALS)}")
        if one.ndim != 1 or len(one) < 2 or not np.isfinite(one).all():
            raise TrialidError(f"{name}: expected a row of at least two finite numbers, in SI")
    lengths = {len(one) for one in values.values()}
    if len(lengths) != 1 or period is None or not 0.0 < period < np.inf:
        raise TrialidError(
            "expected a manoeuvre as 'zigzag', 20, 20, or inputs of one length and their period "
            "[s]: delta=[...], period=0.5"
        )
    return OrderTable(np.asarray(np.arange(lengths.pop()) * period), values)
