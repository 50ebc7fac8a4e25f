"""The pipeline file: TOML in, frozen plain data out, every mistake named by file and key.

Checked here: form, files, quantities, units, contradictions. Names of effects and parameters are
checked by the model, which knows them; it says where with `where(recipe, key)`.
"""

import json
import re
import reprlib
import tomllib
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from itertools import chain
from pathlib import Path
from typing import Annotated, Any, Final, Literal, cast

from pydantic import (
    AfterValidator,
    AllowInfNan,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PlainValidator,
    PrivateAttr,
    Strict,
    ValidationError,
    ValidationInfo,
)
from pydantic_core import ErrorDetails

from trialid import units
from trialid.errors import RecipeError, UnitError, nearest
from trialid.quantities import SIGNALS, Quantity

UNIT_TEXT: Final = re.compile(r"(1|[^\W\d_]+|[°%])((\s*[*/]\s*|\s+)[^\W\d_]+|(\^|\*\*)-?\d+)*")
"""`deg/s`, `1/s`, `kg*m^2`: what may be handed to the unit library, which chokes on less."""

RUDDERS: Final = frozenset({"delta", "delta_order"})
"""Signals whose sign no convention settles: indicators and SNAME have it opposite."""

LISTED_AT_MOST: Final = 8
"""How many file names an error lists before it only counts them."""

Problem = tuple[str, str]
"""The key's full path, and a sentence that says what is wrong there."""


def _existing(path: Path, info: ValidationInfo) -> Path:
    found = cast(Path, info.context).parent / path
    if found.is_file():
        return found
    if found.is_dir():
        raise ValueError(f"{str(path)!r} is a folder; name the file in it")
    raise ValueError(f"no file {str(path)!r} (looked for {found}; {_neighbours(found)})")


def _neighbours(path: Path) -> str:
    """Words about the files of the same kind beside a missing one."""
    if not path.parent.is_dir():
        return f"there is no folder {path.parent}"
    names = [other.name for other in path.parent.iterdir() if other.suffix == path.suffix]
    hint = nearest(path.name, names)
    if not names:
        return f"no {path.suffix or 'such'} file there"
    if len(names) > LISTED_AT_MOST and not hint.startswith("did you mean"):
        return f"{len(names)} {path.suffix} files there, none of a similar name"
    return hint


def _python(path: Path) -> Path:
    if path.suffix != ".py":
        raise ValueError(f"{str(path)!r} is not a .py file; effects are written in Python")
    return path


def _rising(interval: tuple[float, float]) -> tuple[float, float]:
    low, high = interval
    if not low < high:
        raise ValueError(f"[{low:g}, {high:g}] runs backwards; write [low, high]")
    return interval


def _unit_text(unit: str) -> str:
    if UNIT_TEXT.fullmatch(unit) is None:
        raise ValueError(f"{unit!r} is not a unit; write it like deg/s, m/s or kg*m^2")
    return unit


def _with_value(given: Any) -> Any:
    return given if isinstance(given, dict) else {"value": given}


def _candidates(given: Any) -> Literal["all", "none"] | tuple[str, ...]:
    if given in ("all", "none"):
        return given
    if isinstance(given, list) and all(isinstance(name, str) for name in given):
        return tuple(given)
    hint = nearest(str(given), ("all", "none"))
    raise ValueError(f'must be "all", "none" or a list of effects, got {given!r} ({hint})')


# Strict, because a pipeline that writes "0.5" or true for a number has a slip worth showing.
Number = Annotated[float, Strict()]
Positive = Annotated[Number, Field(gt=0)]
NotNegative = Annotated[Number, Field(ge=0)]
Count = Annotated[int, Strict(), Field(ge=1)]
Whole = Annotated[int, Strict(), Field(ge=0)]
Unit = Annotated[str, AfterValidator(_unit_text)]
Names = tuple[str, ...]
SomeNames = Annotated[Names, Field(min_length=1)]
ReadFile = Annotated[Path, AfterValidator(_existing)]
PythonFile = Annotated[ReadFile, AfterValidator(_python)]
Window = Annotated[tuple[Number, Number], AfterValidator(_rising)]
Limit = Annotated[Number, AllowInfNan(True)]
Bounds = Annotated[tuple[Limit, Limit], AfterValidator(_rising)]
Nuisance = Literal["initial_state", "bias", "rudder_offset", "delay"]


class Section(BaseModel):
    """A table of the pipeline file: frozen, finite numbers, no key it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class SignalSource(Section):
    """Which channel of the logs is a quantity.

    `unit` None: the unit the log states. `positive` is the side the channel counts as positive;
    None follows the dictionary of quantities, which a rudder may not leave open. `angle` (key `as`)
    is the angle to take out of an orientation quaternion, `delay` how much later than the ship the
    channel shows it [s].
    """

    channel: str
    unit: Unit | None = None
    positive: Literal["starboard", "port"] | None = None
    angle: Literal["roll", "pitch", "yaw"] | None = Field(default=None, alias="as")
    delay: Number = 0.0


class TrialRecipe(Section):
    """One manoeuvre: its logs, what it is for, and its signals with the shared ones filled in.

    `window` is cut out of the logs [s]; `speed` is the approach speed [m/s] where no log has `u`.
    """

    name: Annotated[str, Field(min_length=1)]
    logs: Annotated[tuple[ReadFile, ...], Field(min_length=1)]
    use: Literal["fit", "check"] = "fit"
    window: Window | None = None
    speed: NotNegative | None = None
    signals: Mapping[str, SignalSource] = {}


class AlignRecipe(Section):
    """The common clock; `period` between samples [s]."""

    period: Positive = 0.5


class GivenValue(Section):
    """A number in place of the ship file's or the effect's own; `unit` None: the same unit."""

    value: Number
    unit: Unit | None = None


class ModelRecipe(Section):
    """What is simulated, by which effects, with which values given by hand."""

    states: SomeNames
    effects: Names
    effects_from: tuple[PythonFile, ...] = ()
    values: Mapping[str, Annotated[GivenValue, BeforeValidator(_with_value)]] = {}


class Prior(Section):
    """What is known of a parameter beforehand, in the parameter's own unit."""

    mean: Number
    std: Positive


class IdentifyRecipe(Section):
    """What is estimated, against which outputs, and how the search goes.

    `starts` searches begin within the relative `spread` of the first values, drawn from `seed`.
    `norm` says whether y_RMS of Eq. 8 is about the channel's own mean or about zero.
    `bounds` and `priors` are in each parameter's own unit.
    """

    free: SomeNames
    outputs: SomeNames
    nuisance: tuple[Nuisance, ...] = ("initial_state",)
    weights: Mapping[str, Positive] = {}
    loss: Literal["squares", "huber"] = "squares"
    priors: Mapping[str, Prior] = {}
    bounds: Mapping[str, Bounds] = {}
    starts: Count = 1
    spread: Positive = 0.3
    seed: Whole = 0
    max_iterations: Count = 50
    norm: Literal["mean", "zero"] = "mean"
    substeps: Count = 1
    engine: Literal["compiled", "numpy"] = "compiled"


class QuietStretch(Section):
    """A stretch of a trial declared to be without excitation [s]."""

    trial: str
    window: Window


class DiagnoseRecipe(Section):
    """The search for the missing effect.

    `noise` is a stated sensor figure by output, in the unit reports show (deg/s, deg);
    `refit` how many of the best candidates are fitted again; `family_cos` from which cosine on two
    effects count as one family; `level` the significance level.
    """

    candidates: Annotated[Literal["all", "none"] | Names, PlainValidator(_candidates)] = "all"
    noise: Mapping[str, Positive] = {}
    refit: Whole = 3
    family_cos: Annotated[Number, Field(gt=0, le=1)] = 0.9
    level: Annotated[Number, Field(gt=0, lt=1)] = 0.05
    quiet: tuple[QuietStretch, ...] = ()


class Recipe(Section):
    """A pipeline file, complete: defaults filled in, paths resolved from the file's folder."""

    name: str
    ship: ReadFile
    trials: Annotated[tuple[TrialRecipe, ...], Field(alias="trial", min_length=1)]
    model: ModelRecipe
    identify: IdentifyRecipe
    signals: Mapping[str, SignalSource] = {}
    align: AlignRecipe = AlignRecipe()
    diagnose: DiagnoseRecipe = DiagnoseRecipe()
    _path: Path = PrivateAttr()

    def model_post_init(self, context: Path) -> None:
        """Keep the file's own path, which `where` needs and no key may set."""
        self._path = context

    @property
    def path(self) -> Path:
        """The pipeline file, as the caller named it."""
        return self._path


def load(path: Path) -> Recipe:
    """Give the pipeline in a TOML file.

    Raises
    ------
    RecipeError
        In one line: the file, the key's full path, what is wrong, the nearest valid names.
    """
    table = _table(path)
    try:
        recipe = Recipe.model_validate({"name": path.stem, **table}, context=path)
    except ValidationError as error:
        raise _refusal(path, [_problem(one) for one in _own_mistakes(error)]) from error
    if problems := list(_contradictions(recipe)):
        raise _refusal(path, problems)
    return _with_shared_signals(recipe)


def where(recipe: Recipe, key: str) -> str:
    """Words that begin an error about a key: `pipelines/zigzag.toml: model.effects`."""
    return f"{recipe.path}: {key}"


def signal_key(recipe: Recipe, trial: TrialRecipe, quantity: str) -> str:
    """Where a trial's signal is written: `trial[0].signals.u`, or `signals.u` when it is shared."""
    if trial.signals.get(quantity) is recipe.signals.get(quantity, trial):
        return _dotted("signals", quantity)
    place = [other.name for other in recipe.trials].index(trial.name)
    return _dotted("trial", place, "signals", quantity)


def sources(recipe: Recipe) -> tuple[Path, ...]:
    """Every file the pipeline reads, itself first."""
    logs = chain.from_iterable(trial.logs for trial in recipe.trials)
    return (recipe.path, recipe.ship, *recipe.model.effects_from, *logs)


# --- reading ------------------------------------------------------------------------------------


def _table(path: Path) -> dict[str, Any]:
    text = _text(path)
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        last = f"at line {text.count(chr(10)) + 1}, the end of the file"
        said = str(error).replace("at end of document", last)
        raise RecipeError(f"{path}: not TOML: {said}") from error


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8-sig")  # some editors write a byte-order mark
    except FileNotFoundError as error:
        raise RecipeError(f"{path}: no such pipeline file ({_neighbours(path)})") from error
    except UnicodeDecodeError as error:
        raise RecipeError(f"{path}: not TOML: not UTF-8 text (byte {error.start})") from error
    except OSError as error:
        raise RecipeError(f"{path}: cannot be read ({error.strerror})") from error


def _with_shared_signals(recipe: Recipe) -> Recipe:
    trials = tuple(
        trial.model_copy(update={"signals": {**recipe.signals, **trial.signals}})
        for trial in recipe.trials
    )
    return recipe.model_copy(update={"trials": trials})


# --- saying what is wrong -----------------------------------------------------------------------


def _refusal(path: Path, problems: Sequence[Problem]) -> RecipeError:
    key, sentence = problems[0]
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return RecipeError(" ".join(f"{path}: {key}: {sentence}{more}".splitlines()))


def _dotted(*steps: str | int) -> str:
    """Give a key's full path as TOML would write it.

    >>> _dotted("trial", 0, "signals", "odd name", "unit")
    'trial[0].signals."odd name".unit'
    """
    text = ""
    for step in steps:
        if isinstance(step, int):
            text += f"[{step}]"
        else:
            bare = re.fullmatch(r"[A-Za-z0-9_-]+", step) is not None
            text += "." + (step if bare else json.dumps(step))
    return text.removeprefix(".")


def _own_mistakes(error: ValidationError) -> list[ErrorDetails]:
    """Give what the user wrote wrong, the telling ones first, without what only follows from it."""
    # A list whose entries are refused counts as empty too.
    own = [one for one in error.errors() if one["type"] != "too_short" or not one["input"]]
    # A misspelt key is a missing one too; the misspelling leads.
    return sorted(own, key=lambda one: one["type"] != "extra_forbidden")


def _problem(detail: ErrorDetails) -> Problem:
    say = _SENTENCES.get(detail["type"], _as_reported)
    return _dotted(*detail["loc"]), say(detail)


def _as_reported(detail: ErrorDetails) -> str:
    wanted = detail["msg"].replace("Input should be", "must be")
    return f"{wanted}, got {reprlib.repr(detail['input'])}"


def _unknown_key(detail: ErrorDetails) -> str:
    *parents, key = detail["loc"]
    keys = _keys(_section(parents))
    return f"unknown key; {nearest(str(key), keys)}"


def _not_listed(detail: ErrorDetails) -> str:
    allowed = re.findall(r"'([^']*)'", detail["ctx"]["expected"])
    given = detail["input"]
    return f"{given!r} is not allowed; {nearest(str(given), allowed)}"


def _not_a_list(detail: ErrorDetails) -> str:
    if isinstance(detail["input"], dict):
        key = detail["loc"][-1]
        return f"must be a list of tables; write [[{key}]] with two brackets"
    return f"must be a list in square brackets, got {reprlib.repr(detail['input'])}"


def _not_a_table(detail: ErrorDetails) -> str:
    keys = ", ".join(_keys(_section(detail["loc"])))
    return f"must be a table (keys: {keys}), got {reprlib.repr(detail['input'])}"


_SENTENCES: Final[Mapping[str, Callable[[ErrorDetails], str]]] = {
    "extra_forbidden": _unknown_key,
    "literal_error": _not_listed,
    "missing": lambda detail: "missing; the pipeline needs it",
    "model_type": _not_a_table,
    "too_long": lambda detail: f"too long, got {reprlib.repr(detail['input'])}",
    "too_short": lambda detail: "must not be empty",
    "tuple_type": _not_a_list,
    "value_error": lambda detail: str(detail["ctx"]["error"]),
}


def _keys(section: type[Section]) -> list[str]:
    return [field.alias or name for name, field in section.model_fields.items()]


def _section(steps: Iterable[str | int]) -> type[Section]:
    """Give the section that stands at a place in the file.

    >>> _section(("trial", 0, "signals", "delta")).__name__
    'SignalSource'
    """
    section: type[Section] = Recipe
    for step in steps:
        for name, field in section.model_fields.items():
            if (field.alias or name) == step:
                section = next(_sections_in(field.annotation), section)
                break
    return section


def _sections_in(annotation: Any) -> Iterator[type[Section]]:
    if isinstance(annotation, type) and issubclass(annotation, Section):
        yield annotation
    for part in getattr(annotation, "__args__", ()):
        yield from _sections_in(part)


# --- contradictions -----------------------------------------------------------------------------


def _contradictions(recipe: Recipe) -> Iterator[Problem]:
    """Everything wrong that no single key shows."""
    yield from _trial_problems(recipe)
    yield from _signal_problems(recipe.signals, "signals")
    for place, trial in enumerate(recipe.trials):
        yield from _signal_problems(trial.signals, "trial", place, "signals")
    yield from _output_problems(recipe)
    yield from _repetitions(recipe)
    yield from _quiet_problems(recipe)


def _trial_problems(recipe: Recipe) -> Iterator[Problem]:
    first: dict[str, int] = {}
    for place, trial in enumerate(recipe.trials):
        if first.setdefault(trial.name, place) != place:
            at = _dotted("trial", first[trial.name])
            yield _dotted("trial", place, "name"), f"{trial.name!r} is already the name of {at}"
    if all(trial.use == "check" for trial in recipe.trials):
        yield "trial", 'no trial to fit; at least one must have use = "fit"'


def _signal_problems(signals: Mapping[str, SignalSource], *steps: str | int) -> Iterator[Problem]:
    for name, source in signals.items():
        if name not in SIGNALS:
            yield _dotted(*steps, name), f"unknown quantity; {_nearest_signal(name)}"
            continue
        if trouble := _side_trouble(SIGNALS[name], source.positive):
            yield _dotted(*steps, name, "positive"), trouble
        if trouble := _unit_trouble(SIGNALS[name], source.unit):
            yield _dotted(*steps, name, "unit"), trouble


def _nearest_signal(name: str) -> str:
    """Words for an unknown signal; a name that logs use leads to ours.

    >>> _nearest_signal("heading")
    "did you mean 'psi'?"
    """
    for own, signal in SIGNALS.items():
        if name.lower() in signal.aliases:
            return f"did you mean {own!r}?"
    return nearest(name, SIGNALS)


def _side_trouble(quantity: Quantity, positive: str | None) -> str:
    if quantity.mirror == 1 and positive is not None:
        return f"{quantity.name!r} has no port or starboard ({quantity.meaning}); leave it out"
    if quantity.name in RUDDERS and positive is None:
        return (
            'missing; write the side the ship turns to when it is positive: "starboard" or "port"'
        )
    return ""


def _unit_trouble(quantity: Quantity, unit: str | None) -> str:
    try:
        units.factor(unit or quantity.unit, quantity.unit)
    except UnitError as error:
        return str(error)
    return ""


def _output_problems(recipe: Recipe) -> Iterator[Problem]:
    outputs = recipe.identify.outputs
    for place, name in enumerate(outputs):
        if name not in SIGNALS:
            key = _dotted("identify", "outputs", place)
            yield key, f"unknown quantity {name!r}; {_nearest_signal(name)}"
    for section, table in (
        (("identify", "weights"), recipe.identify.weights),
        (("diagnose", "noise"), recipe.diagnose.noise),
    ):
        for name in table:
            if name not in outputs:
                hint = nearest(name, outputs)
                yield _dotted(*section, name), f"not one of identify.outputs; {hint}"


def _repetitions(recipe: Recipe) -> Iterator[Problem]:
    lists: dict[str, Iterable[object]] = {
        "model.states": recipe.model.states,
        "model.effects": recipe.model.effects,
        "identify.free": recipe.identify.free,
        "identify.outputs": recipe.identify.outputs,
        "identify.nuisance": recipe.identify.nuisance,
    }
    for key, entries in lists.items():
        for entry, times in Counter(entries).items():
            if times > 1:
                yield key, f"{str(entry)!r} stands there {times} times; once is enough"


def _quiet_problems(recipe: Recipe) -> Iterator[Problem]:
    names = [trial.name for trial in recipe.trials]
    for place, stretch in enumerate(recipe.diagnose.quiet):
        if stretch.trial not in names:
            key = _dotted("diagnose", "quiet", place, "trial")
            yield key, f"no trial {stretch.trial!r}; {nearest(stretch.trial, names)}"
