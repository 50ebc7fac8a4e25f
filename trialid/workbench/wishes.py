"""What a person can ask of a model on the screen, and the edit of the pipeline that does it."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Annotated, Any, Final, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    FiniteFloat,
    TypeAdapter,
    ValidationError,
    field_validator,
)

from trialid.errors import PipelineError, TrialidError, nearest
from trialid.pipeline_file import Pipeline, read
from trialid.pipeline_file.edit import fix_parameter, set_bounds, set_free, set_use, set_value
from trialid.pipeline_file.rewrite import check_is_no_copy
from trialid.ship.model import ShipModel
from trialid.workflow.build_model import available, build_model, check_bounds, settings_of
from trialid.workflow.edit_pipeline import Edit, add_to_pipeline, drop_from_pipeline


class Wish(BaseModel):
    """An edit asked for in view of one content of the file."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True)
    version: str

    @field_validator("*")
    @classmethod
    def _writable(cls, value: Any) -> Any:
        """Half a character, which JSON can hold, no file can."""
        if isinstance(value, str) and value.encode("utf-8", "ignore").decode() != value:
            raise ValueError("not a text that a file can hold")
        return value


class Add(Wish):
    """An effect more."""

    do: Literal["add"]
    effect: str


class Drop(Wish):
    """An effect less."""

    do: Literal["drop"]
    effect: str


class Free(Wish):
    """A parameter estimated, or fixed."""

    do: Literal["free"]
    parameter: str
    free: bool


class Bounds(Wish):
    """Bounds of a free parameter in its own unit; null where there is none on that side."""

    do: Literal["bounds"]
    parameter: str
    low: FiniteFloat | None
    high: FiniteFloat | None


class Value(Wish):
    """A parameter's value or start in its own unit; null for the ship file's or the effect's."""

    do: Literal["value"]
    parameter: str
    value: FiniteFloat | None


class Use(Wish):
    """A trial fitted, or held out."""

    do: Literal["use"]
    trial: str
    use: Literal["fit", "check"]


AnyWish = Annotated[Add | Drop | Free | Bounds | Value | Use, Field(discriminator="do")]
_DONE: Final = {"fit": "fitted", "check": "held out"}
_ADAPTER: Final[TypeAdapter[Any]] = TypeAdapter(AnyWish)


@dataclass(frozen=True)
class Granted:
    """A pipeline as wished for, the wish in words, and the edit where an effect comes or goes."""

    after: Pipeline
    words: str
    edit: Edit | None = None


def read_wish(asked: object) -> Any:
    """The wish in what a page sent.

    Raises
    ------
    PipelineError
        It is none, in one line.
    """
    try:
        return _ADAPTER.validate_python(asked)
    except ValidationError as error:
        first = error.errors()[0]
        place = ".".join(str(step) for step in first["loc"][1:]) or "edit"
        words = f"{place}: {first['msg']}".encode("utf-8", "backslashreplace").decode()
        raise PipelineError(words) from error


def grant(pipeline: Pipeline, wish: Any) -> Granted:
    """The pipeline as wished for, checked as far as can be without fitting it.

    Raises
    ------
    TrialidError
        In one line: what cannot be, and why.
    """
    check_is_no_copy(pipeline.path)
    found = _GRANTS[type(wish)](pipeline, wish)
    if found.after.content == pipeline.content:
        raise PipelineError(f"{found.words}: it is so already")
    model = build_model(found.after, available(found.after))
    if isinstance(wish, Bounds):
        _check_start(wish, model)
    check_bounds(found.after, model, settings_of(found.after, model))
    return found


def _check_start(wish: Bounds, model: ShipModel) -> None:
    """Refuse bounds that leave out the start, and say how to give another on the screen."""
    name, (low, high) = wish.parameter, _ends(wish)
    start = model.stated(name) if name in model.parameters else None
    if start is not None and not low <= start <= high:
        raise PipelineError(
            f"[{low:g}, {high:g}] leaves out the start {start:.6g} of {name}; widen it, or untick "
            f"{name}, give it another value and tick it again"
        )


def find_edit(old: Pipeline, new: Pipeline) -> Edit | None:
    """The edit that one effect came or went by; None where two pipelines differ otherwise."""
    had, has = old.model.effects, new.model.effects
    came = [n for n in has if n not in had]
    went = [n for n in had if n not in has]
    if len(came) + len(went) != 1:
        return None
    try:
        edit = add_to_pipeline(old, came[0]) if came else drop_from_pipeline(old, went[0])
    except TrialidError:  # it was written by hand, or an effect file is broken by now
        return None
    return replace(edit, after=new)


def _add(pipeline: Pipeline, wish: Add) -> Granted:
    edit = add_to_pipeline(pipeline, wish.effect)
    return Granted(edit.after, f"add {wish.effect}", edit)


def _drop(pipeline: Pipeline, wish: Drop) -> Granted:
    edit = drop_from_pipeline(pipeline, wish.effect)
    return Granted(edit.after, f"drop {wish.effect}", edit)


def _free(pipeline: Pipeline, wish: Free) -> Granted:
    name = wish.parameter
    if wish.free == (name in pipeline.identify.free):
        raise PipelineError(f"{name} is {'free' if wish.free else 'fixed'} already")
    if wish.free:
        return _edited(pipeline, f"free {name}", lambda text: set_free(text, name))
    return _edited(pipeline, f"fix {name}", lambda text: fix_parameter(text, name)[0])


def _bounds(pipeline: Pipeline, wish: Bounds) -> Granted:
    name, low, high = wish.parameter, wish.low, wish.high
    if low is None and high is None:
        return _edited(pipeline, f"no bounds of {name}", lambda text: set_bounds(text, name, None))
    between = _ends(wish)
    words = f"bounds of {name} {between[0]:g} to {between[1]:g}"
    return _edited(pipeline, words, lambda text: set_bounds(text, name, between))


def _ends(wish: Bounds) -> tuple[float, float]:
    low, high = wish.low, wish.high
    return (-math.inf if low is None else low, math.inf if high is None else high)


def _value(pipeline: Pipeline, wish: Value) -> Granted:
    name, value = wish.parameter, wish.value
    words = f"no value of {name}" if value is None else f"{name} = {value:g}"
    return _edited(pipeline, words, lambda text: set_value(text, name, value))


def _use(pipeline: Pipeline, wish: Use) -> Granted:
    names = [trial.name for trial in pipeline.trials]
    if wish.trial not in names:
        raise PipelineError(f"there is no trial {wish.trial!r}; {nearest(wish.trial, names)}")
    index = names.index(wish.trial)
    if pipeline.trials[index].use == wish.use:
        raise PipelineError(f"{wish.trial} is {_DONE[wish.use]} already")
    words = f"{wish.trial} {_DONE[wish.use]}"
    return _edited(pipeline, words, lambda text: set_use(text, index, wish.use))


def _edited(pipeline: Pipeline, words: str, change: Callable[[str], str]) -> Granted:
    return Granted(read(change(pipeline.text).encode("utf-8"), pipeline.path), words)


_GRANTS: Final[dict[type, Callable[[Pipeline, Any], Granted]]] = {
    Add: _add, Drop: _drop, Free: _free, Bounds: _bounds, Value: _value, Use: _use,
}  # fmt: skip
