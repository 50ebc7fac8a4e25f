"""What a pipeline file may hold: frozen sections, every key and value checked where it stands."""

from collections.abc import Mapping
from datetime import datetime
from pathlib import Path
from typing import Annotated, Any, Final, Literal, NamedTuple, cast

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
    ValidationInfo,
)

from trialid import units
from trialid.errors import nearest
from trialid.ingest.local_time import known_zone

LISTED_AT_MOST: Final = 8
"""How many file names an error lists before it only counts them."""


class Origin(NamedTuple):
    """The file a pipeline stands in, and all that it holds."""

    path: Path
    content: bytes


def _existing(path: Path, info: ValidationInfo) -> Path:
    found = cast(Origin, info.context).path.parent / path
    if found.is_file():
        return found
    if found.is_dir():
        raise ValueError(f"{str(path)!r} is a folder; name the file in it")
    raise ValueError(f"no file {str(path)!r} (looked for {found}; {neighbours(found)})")


def _existing_log(path: Path, info: ValidationInfo) -> Path:
    found = cast(Origin, info.context).path.parent / path
    return found if found.is_dir() else _existing(path, info)


def neighbours(path: Path) -> str:
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
    if unit == "?":
        raise ValueError("is still open; write the unit, like deg/s, m/s or kn")
    if units.TEXT.fullmatch(unit) is None:
        raise ValueError(f"{unit!r} is not a unit; write it like deg/s, m/s or kg*m^2")
    return unit


def with_value(given: Any) -> Any:
    """A bare number as a value without a unit."""
    return given if isinstance(given, dict) else {"value": given}


def _with_path(given: Any) -> Any:
    return {"path": given} if isinstance(given, str) else given


def _not_zero(number: float) -> float:
    if number == 0.0:
        raise ValueError("a gain of zero leaves nothing of the signal")
    return number


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
ReadLog = Annotated[Path, AfterValidator(_existing_log)]
Zone = Annotated[str, AfterValidator(known_zone)]
PythonFile = Annotated[ReadFile, AfterValidator(_python)]
Instant = Number | datetime
NotEmpty = Annotated[str, Field(min_length=1)]
Window = Annotated[tuple[Number, Number], AfterValidator(_rising)]
Limit = Annotated[Number, AllowInfNan(True)]
Bounds = Annotated[tuple[Limit, Limit], AfterValidator(_rising)]
Fault = Literal["range", "dropouts", "spikes", "saturation", "stuck"]
Nuisance = Literal["initial_state", "bias", "rudder_offset", "delay"]


class Section(BaseModel):
    """A table of the pipeline file: frozen, finite numbers, no key it does not know."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class SignalSource(Section):
    """Which channel of the logs is a quantity.

    `unit` None: the unit the log states. The signal is `gain` times the logged number, plus
    `offset`, in that unit: a servo's share of full deflection, a rudder indicator that reads two
    degrees at midships. `positive` is the side the channel counts as positive; None follows the
    dictionary of quantities, which a rudder may not leave open. `angle` (key `as`) is the angle to
    take out of an orientation quaternion, `delay` how much later than the ship the channel shows
    it [s]. `keep` names the kinds of values that are not masked though they look like no
    measurement.
    """

    channel: str
    unit: Unit | None = None
    gain: Annotated[Number, AfterValidator(_not_zero)] = 1.0
    offset: Number = 0.0
    positive: Literal["starboard", "port"] | None = None
    angle: Literal["roll", "pitch", "yaw"] | None = Field(default=None, alias="as")
    delay: Number = 0.0
    keep: tuple[Fault, ...] = ()


class ClockRecipe(Section):
    """How a log's clock lies to the trial's; the logs without this table keep the trial's clock.

    One of: `offset`, how far it is ahead [s] at its first stamp, with the `drift` it runs too fast
    [ppm]; `events`, pairs of instants of the same event on this clock and on the trial's, seconds
    from the log's first stamp or dates (UTC unless they say), of which two or more give the drift;
    `match`, a channel of this log and one of another that hold the same motion, or one of them its
    rate, at most `within` [s] apart (60 unless given), measured with its interval or refused.
    """

    offset: Number | None = None
    drift: Number | None = None
    events: tuple[tuple[Instant, Instant], ...] | None = None
    match: tuple[str, str] | None = None
    within: Positive | None = None


class LogRecipe(Section):
    """A log file, or a folder of them that is read as one; a bare path is short for `path`.

    What the log does not say itself: `template` lays out a table, `dbc` the frames of a CAN bus
    that is not NMEA 2000, `zone` is the time zone of stamps that state none, `clock` how its clock
    lies to the other logs'.
    """

    path: ReadLog
    template: ReadFile | None = None
    dbc: ReadFile | None = None
    zone: Zone | None = None
    clock: ClockRecipe | None = None


Log = Annotated[LogRecipe, BeforeValidator(_with_path)]


class TrialRecipe(Section):
    """One manoeuvre: its logs, what it is for, and its signals with the shared ones filled in.

    `window` is cut out of the logs [s]; `speed` is the approach speed [m/s] where no log has `u`.
    """

    name: NotEmpty
    logs: Annotated[tuple[Log, ...], Field(min_length=1)]
    use: Literal["fit", "check"] = "fit"
    window: Window | None = None
    speed: NotNegative | None = None
    signals: Mapping[str, SignalSource] = {}


class AlignRecipe(Section):
    """The common clock; `period` between samples [s].

    `clocks = "repair"` puts the stamps of evenly paced sensors on a line through their count of
    samples, so that latency, bundles and whole seconds do not shake them; `"as logged"` takes every
    stamp as it is.
    """

    period: Positive = 0.5
    clocks: Literal["repair", "as logged"] = "repair"


class GivenValue(Section):
    """A number in place of the ship file's or the effect's own; `unit` None: the same unit."""

    value: Number
    unit: Unit | None = None


class ModelRecipe(Section):
    """What is simulated, by which effects, with which values given by hand."""

    states: Names
    effects: Names
    effects_from: tuple[PythonFile, ...] = ()
    values: Mapping[str, Annotated[GivenValue, BeforeValidator(with_value)]] = {}


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
    refit: Whole = 4
    family_cos: Annotated[Number, Field(gt=0, le=1)] = 0.9
    level: Annotated[Number, Field(gt=0, lt=1)] = 0.05
    quiet: tuple[QuietStretch, ...] = ()


class Written(Section):
    """What a file of the user's describes, and the file itself."""

    _origin: Origin = PrivateAttr()

    def model_post_init(self, context: Origin) -> None:
        """Keep where it was read from, which `where` needs and no key may set."""
        self._origin = context

    @property
    def path(self) -> Path:
        """The file, as the caller named it."""
        return self._origin.path

    @property
    def content(self) -> bytes:
        """What was read; the file may hold something else by now."""
        return self._origin.content

    @property
    def text(self) -> str:
        """What was read, as text with its own line ends."""
        return self.content.decode("utf-8")


class Described(Written):
    """A ship, her model and what is to be estimated: what every file asks for.

    `ship` None: sensors only, with no motion simulated between them.
    """

    name: str
    ship: ReadFile | None = None
    model: ModelRecipe
    identify: IdentifyRecipe


class Recipe(Described):
    """A pipeline file, complete: defaults filled in, paths resolved from the file's folder.

    `imo` asks for the standard measures of MSC.137(76).
    """

    trials: Annotated[tuple[TrialRecipe, ...], Field(alias="trial", min_length=1)]
    signals: Mapping[str, SignalSource] = {}
    align: AlignRecipe = AlignRecipe()
    diagnose: DiagnoseRecipe = DiagnoseRecipe()
    imo: bool = False
