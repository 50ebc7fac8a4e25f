"""The model on the screen in use: a manoeuvre tried, a file of it handed out."""

import io
import math
import threading
import zipfile
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Any, Final

from trialid.design.prediction.seen_range import seen_ranges
from trialid.diagnosis.examine import examine_fit
from trialid.errors import PipelineError, nearest
from trialid.names.model_kinds import KINDS
from trialid.progress import silent
from trialid.report.pictures.prediction_picture import prediction_picture
from trialid.threads import one_thread
from trialid.workbench.shown import Shown
from trialid.workflow.build_model import available
from trialid.workflow.findings import diagnose_settings
from trialid.workflow.outcome import Outcome
from trialid.workflow.use.finished_model import FinishedModel, check_verdict, revived_fit
from trialid.workflow.use.hand_over import WRITERS
from trialid.workflow.use.orders import ASTERN, BY_NAME, STOPS, named_manoeuvre, stop_order
from trialid.workflow.use.predict import predict_manoeuvre
from trialid.workflow.use.steering import Wishes
from trialid.workflow.use.stop import predict_stop

STOP: Final = "stop"


@dataclass
class InUse:
    """The last model that was used, made ready once: that takes as long as its diagnosis."""

    _lock: threading.Lock = field(default_factory=threading.Lock)
    _of: Outcome | None = None
    _made: FinishedModel | None = None

    def model(self, shown: Shown) -> FinishedModel:
        """The model on the screen, ready for use.

        Raises
        ------
        PipelineError
            It is not known yet, or carries no verdict.
        """
        run = shown.run
        if run is None:
            raise PipelineError("this model is still being worked out; try again when it is")
        check_verdict(run.result, shown.pipeline.path.name, anyway=False)
        with self._lock:
            if self._made is None or self._of is not run:
                self._made, self._of = _ready(shown, run), run
            return self._made


@one_thread
def _ready(shown: Shown, run: Outcome) -> FinishedModel:
    where = shown.pipeline.path.name
    fit = revived_fit(shown.pipeline, shown.trials, run.result, where)
    how = diagnose_settings(shown.pipeline, available(shown.pipeline))
    done, _ = examine_fit(fit, how, silent)
    return FinishedModel(where, run.result, done, seen_ranges(fit))


def try_orders(model: FinishedModel, orders: str) -> dict[str, Any]:
    """A manoeuvre by its words, as a page shows it: numbers with their ranges, words, pictures.

    Raises
    ------
    TrialidError
        There is no such manoeuvre.
    """
    words = orders.split()
    if not words:
        raise PipelineError("write a manoeuvre, as zigzag 20 20 or circle 35")
    _check_orders(*words)
    stop = stop_order(words)
    made = (
        predict_manoeuvre(model, named_manoeuvre(words))
        if stop is None
        else predict_stop(model, stop)
    )
    rows = [
        [name, f"{value:.4g}", "" if ends is None else f"{ends[0]:.4g} to {ends[1]:.4g}"]
        for name, (value, ends) in made.motion.numbers.items()
    ]
    said = [*made.words, *([f"Not come to: {made.motion.remark}."] if made.motion.remark else ())]
    picture = asdict(prediction_picture(made.motion))
    return {"name": made.name, "rows": rows, "words": said, "picture": picture}


def _check_orders(name: str, *numbers: str) -> None:
    """Refuse what is no manoeuvre: here, no file of orders is read.

    Raises
    ------
    PipelineError
        There is none of this name, or a number is none.
    """
    if name not in (*BY_NAME, STOP):
        known = "; ".join([*(one.usage for one in BY_NAME.values()), STOPS])
        raise PipelineError(
            f"{name!r}: is no manoeuvre; expected {known} ({nearest(name, [*BY_NAME, STOP])})"
        )
    for number in numbers:
        if number != ASTERN and math.isnan(_number(number)):
            raise PipelineError(f"{number!r}: is no number; write it like 20.5")


def _number(text: str) -> float:
    try:
        return float(text)
    except ValueError:
        return math.nan


def hand_out(model: FinishedModel, kind: str, asked: Mapping[str, str]) -> tuple[str, bytes]:
    """The name and the content of a form of the model; where it has more files, they are zipped.

    Raises
    ------
    PipelineError
        There is no such form, or a number that it needs is none.
    """
    if kind not in KINDS:
        raise PipelineError(f"{kind!r}: is no form of a model; {nearest(kind, KINDS)}")
    rudder, command = _positive(asked, "full_rudder"), _positive(asked, "full_command")
    angle = None if rudder is None else math.radians(rudder)
    made = WRITERS[kind](model, "model", Wishes(full_rudder=angle, full_command=command))
    files = {s: c if isinstance(c, bytes) else c.encode() for s, c in made.items()}
    if len(files) == 1:
        [(suffix, content)] = files.items()
        return f"{_stem(kind, suffix)}{suffix}", content
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as packed:
        for suffix, content in files.items():
            packed.writestr(f"model{suffix}", content)
    return f"model-{kind}.zip", stream.getvalue()


def _stem(kind: str, suffix: str) -> str:
    """The name of a file, which says its kind where the ending does not: three end in `.json`."""
    told = suffix == f".{kind}" or sum(suffix in one.suffixes for one in KINDS.values()) == 1
    return "model" if told else f"model-{kind}"


def _positive(asked: Mapping[str, str], name: str) -> float | None:
    """A number of a form, None where it is left empty.

    Raises
    ------
    PipelineError
        It is none above zero.
    """
    given = asked.get(name, "")
    number = _number(given) if given else None
    if number is not None and not 0.0 < number < math.inf:
        raise PipelineError(f"{name.replace('_', ' ')} {given!r}: expected a number above 0")
    return number
