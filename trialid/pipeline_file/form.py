"""What a pipeline file may hold: frozen sections, every key and value checked where it stands."""

from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Literal

from pydantic import AfterValidator, BeforeValidator, Field, PlainValidator, PrivateAttr

from trialid.pipeline_file.allowed_values import (
    Bounds,
    Curve,
    Delay,
    Factor,
    Fault,
    Instant,
    Names,
    NotEmpty,
    Nuisance,
    Period,
    Rounds,
    Seconds,
    SomeNames,
    Unit,
    Whole,
    Window,
    Zone,
    candidate_names,
    not_zero,
    with_path,
    with_value,
)
from trialid.pipeline_file.named_file import Origin, PythonFile, ReadFile, ReadLog
from trialid.pipeline_file.prior_section import OR_SHIP, SHIP, Prior, Word
from trialid.pipeline_file.section import NotNegative, Number, Positive, Section


class SignalSource(Section):
    """Which channel of the logs is a quantity.

    The signal is `gain` times the logged number, plus `offset`, in the channel's unit: a servo's
    share of full deflection, a rudder indicator that reads two degrees at midships. Where that is
    no unit of the quantity (percent of full) a gain other than 1 makes it `unit`.
    """

    channel: str | None = None
    """The channel's name, as `trialid inspect` lists it."""
    channels: tuple[str, ...] = ()
    """In place of `channel`: several that measure the same, like two rudders on one order or two
    gyros; read alike, and combined."""
    combine: Literal["mean"] | None = None
    """With `channels`: how; the mean is known where all of them are."""
    unit: Unit | None = None
    """Unit of the logged numbers, like `deg/s`; left out: the one the log states."""
    gain: Annotated[Factor, AfterValidator(not_zero)] = 1.0
    """What the logged number is multiplied by, in the channel's unit."""
    offset: Factor = 0.0
    """What is added after that, in the channel's unit."""
    curve: Curve | None = None
    """In place of `gain` and `offset`: points `[logged number, signal]`, straight lines between
    them, in `unit`, as of a motor's thrust over its pulse width; beyond its ends nothing is known.
    """
    positive: Literal["starboard", "port"] | None = None
    """The side the channel counts positive; left out: as the guide's nomenclature; a rudder's is
    never left out."""
    angle: Literal["roll", "pitch", "yaw", "speed", "course"] | None = Field(
        default=None, alias="as"
    )
    """The angle to take out of an orientation quaternion, or the speed or the course of a velocity
    in x and y; the course is counted like yaw, from x to y."""
    delay: Delay = 0.0
    """How much later than the ship the channel shows it [s]."""
    keep: tuple[Fault, ...] = ()
    """Kinds of values that are not masked though they look like no measurement."""

    @property
    def names(self) -> tuple[str, ...]:
        """The channels that make up the signal, one or several."""
        return self.channels if self.channel is None else (self.channel,)


class ClockSection(Section):
    """How a log's clock lies to the trial's; the logs without this table keep the trial's clock.

    One of `offset`, `events` and `match`.
    """

    offset: Seconds | None = None
    """How far the clock is ahead at the log's first stamp [s]."""
    drift: Annotated[Number, Field(gt=-1e6, le=1e6)] | None = None
    """With `offset`: how much too fast it runs [ppm]."""
    events: tuple[tuple[Instant, Instant], ...] | None = None
    """Pairs of instants of one event, here and on the trial's clock: seconds from the log's first
    stamp or dates (UTC unless they say); two or more give the drift."""
    match: tuple[str, str] | None = None
    """A channel of this log and one of another that hold the same motion, or one its rate; the
    shift is measured with its interval, or refused."""
    within: Annotated[Positive, Field(le=1e10)] | None = None
    """With `match`: how far apart the clocks can be [s]; 60 unless given."""


class LogSection(Section):
    """A log file, or a folder of them that is read as one; a bare path is short for `path`."""

    path: ReadLog
    """The file or folder, from the pipeline's own folder."""
    template: ReadFile | None = None
    """File that lays out a table which does not say it itself."""
    dbc: ReadFile | None = None
    """File that says what the frames of a CAN bus mean that is not NMEA 2000."""
    zone: Zone | None = None
    """Time zone of stamps that state none, an IANA name like `Europe/Oslo`."""
    clock: ClockSection | None = None
    """How the log's clock lies to that of the other logs."""


Log = Annotated[LogSection, BeforeValidator(with_path)]


class TrialSection(Section):
    """One manoeuvre: its logs, what it is for, and its signals with the shared ones filled in."""

    name: NotEmpty
    """What the trial is called; each name once."""
    logs: Annotated[tuple[Log, ...], Field(min_length=1)]
    """Its log files or folders; several are merged on time."""
    use: Literal["fit", "check"] = "fit"
    """Whether the model is fitted to it, or it is held out: simulated and scored, never fitted."""
    window: Window | None = None
    """What is cut out of the logs, `[from, to]` [s]; left out: all of it."""
    speed: NotNegative | None = None
    """Approach speed where no log has `u` [m/s]."""
    over_ground: bool = False
    """Whether `u` and `v` are made of what is recorded over the ground, turned by `psi`: of `sog`
    and `cog`, or else of positions. A current is in them."""
    signals: Mapping[str, SignalSource] = {}
    """Which channel is which quantity."""


class AlignSection(Section):
    """The common clock."""

    period: Period = 0.5
    """Time between samples [s]; of a boat a tenth of what she takes for her length, or less."""
    clocks: Literal["repair", "as logged"] = "repair"
    """`"repair"` puts the stamps of evenly paced sensors on a line through their count of samples,
    so that latency, bundles and whole seconds do not shake them; `"as logged"` takes every stamp
    as it is."""


class GivenValue(Section):
    """A number given by hand, with a unit or in the usual one; a bare number is its `value`."""

    value: Number
    """The number."""
    unit: Unit | None = None
    """Its unit; left out: the parameter's own, or that of reports."""


class ModelSection(Section):
    """What is simulated, by which effects, with which values given by hand."""

    states: Names
    """Motions that are simulated; every other signal an effect needs is read from the record."""
    effects: Names
    """What the model is made of, by the names `trialid effects` lists."""
    effects_from: tuple[PythonFile, ...] = ()
    """Python files with effects of your own."""
    values: Mapping[str, Annotated[GivenValue, BeforeValidator(with_value)]] = {}
    """Parameter values in place of the ship file's or the effect's own: held, or where a free one
    starts."""


class IdentifySection(Section):
    """What is estimated, against which outputs, and how the search goes."""

    free: SomeNames
    """Parameters that are estimated; all others keep their values."""
    outputs: SomeNames
    """Signals the simulation is held against."""
    nuisance: tuple[Nuisance, ...] = ("initial_state",)
    """What is estimated for each trial apart and is not the ship; the current in a speed over
    ground (with `drift_in_speed_record` in the model) for all trials together."""
    weights: Mapping[str, Positive] = {}
    """Weight of an output in the error, by its name; 1 where not given."""
    loss: Literal["squares", "huber"] = "squares"
    """What is made small: squares, or `"huber"` where the log has outliers."""
    priors: Annotated[Mapping[str, Prior], OR_SHIP, Word(SHIP)] = {}
    """What is known of a parameter beforehand, by its name; `"ship"`: of each that the ship file
    states, its number there, with the standard deviation of its `[uncertainty]`."""
    bounds: Mapping[str, Bounds] = {}
    """`[low, high]` a parameter may not leave, by its name, in its own unit; `inf` is allowed.
    Without it the range of its effect holds, and for a gear's time constant half an integration
    step: what is quicker cannot be simulated."""
    starts: Rounds = 1
    """Searches from different first values; the run says how many agree."""
    spread: Positive = 0.3
    """How far those first values lie about the given ones, as a share of them."""
    seed: Whole = 0
    """Seed of their draw."""
    max_iterations: Rounds = 50
    """Steps after which a search gives up."""
    norm: Literal["mean", "zero"] = "mean"
    """Whether y_RMS of Eq. 8 is taken about each trial's own mean or about zero."""
    substeps: Rounds = 1
    """Simulation steps in one sample to begin with; a run takes more where they are too long."""
    engine: Literal["compiled", "numpy"] = "compiled"
    """What simulates: compiled kernels, or their slow twin in NumPy."""


class QuietStretch(Section):
    """A stretch of a trial declared to be without excitation."""

    trial: str
    """The trial's name."""
    window: Window
    """`[from, to]` in it [s]."""


class DiagnoseSection(Section):
    """The search for the missing effect."""

    candidates: Annotated[Literal["all", "none"] | Names, PlainValidator(candidate_names)] = "all"
    """Effects that may be missing: all of the catalogue and what is held fixed, none, or a list."""
    noise: Mapping[str, Positive] = {}
    """Stated sensor figure by output, standard deviation in the unit reports show (deg/s, deg)."""
    refit: Whole = 4
    """How many of the best candidates are fitted."""
    family_cos: Annotated[Number, Field(gt=0, le=1)] = 0.9
    """Cosine of their traces from which on two effects count as one family."""
    level: Annotated[Number, Field(gt=0, lt=1)] = 0.05
    """Significance level: how often chance may do as well as what is named."""
    quiet: tuple[QuietStretch, ...] = ()
    """Stretches declared to be without excitation: what is left over there is noise."""


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
    """A ship, her model and what is to be estimated: what every file asks for."""

    name: str
    """What reports call it; left out: the file's own name."""
    ship: ReadFile | None = None
    """The ship's file; left out with `states = []`: sensors alone are compared."""
    model: ModelSection
    """What is simulated, and by which effects."""
    identify: IdentifySection
    """What is estimated, and against which outputs."""


class Pipeline(Described):
    """A pipeline file, complete: defaults filled in, paths resolved from the file's folder."""

    trials: Annotated[tuple[TrialSection, ...], Field(alias="trial", min_length=1)]
    """The manoeuvres, a table `[[trial]]` each; at least one is fitted."""
    signals: Mapping[str, SignalSource] = {}
    """Signals that all trials share; a trial's own come first."""
    align: AlignSection = AlignSection()
    """The clock all signals are brought to."""
    diagnose: DiagnoseSection = DiagnoseSection()
    """How the missing effect is sought."""
    imo: bool = False
    """Whether the standard measures of MSC.137(76) are predicted too."""
    structures: Mapping[str, Names] = {}
    """Structures for `trialid structures` to compare, each a list of effects on top of those of
    `model.effects` that no list names; left out: the usual ones."""
