"""The design file: TOML that says what the next trial is for, what is allowed, what may be run."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from pydantic import BeforeValidator, Field

from trialid.design.kinds import KINDS
from trialid.errors import UnitError, nearest
from trialid.names import units
from trialid.names.quantities import SIGNALS
from trialid.pipeline_file import check_form, content_of, load, table_of
from trialid.pipeline_file.allowed_values import Count, Names, NotEmpty, Whole, Window, with_value
from trialid.pipeline_file.complaints import Problem, dotted_key, refusal
from trialid.pipeline_file.form import Described, GivenValue
from trialid.pipeline_file.named_file import Origin, ReadFile
from trialid.pipeline_file.own_quantities import ship_quantities
from trialid.pipeline_file.section import NotNegative, Number, Positive, Section

MOST: Final = 200_000
"""Samples of a test: a day and more at the usual period."""

Given = Annotated[GivenValue, BeforeValidator(with_value)]
Numbers = Number | tuple[Number, ...]


def _with_sigma(given: Any) -> Any:
    return given if isinstance(given, dict) else {"sigma": given}


class NoiseSection(Section):
    """Noise of a sensor; a bare number is its `sigma`."""

    sigma: Positive
    """Standard deviation, in the unit of reports (deg/s, deg)."""
    memory: NotNegative = 0.0
    """How long the noise remembers itself [s]; 0 is white."""


class AtSea(Section):
    """How the tests are sailed."""

    period: Positive = 0.5
    """Time between samples of the log to come [s]."""
    approach: NotNegative = 30.0
    """Straight run before each test [s]."""
    rudder_rate: Positive | None = None
    """Speed of the steering gear [deg/s], where no effect of the model is one; left out: as in the
    trials of `run`, or 2.5."""
    constant: Mapping[str, Given] = {}
    """Recorded signals that do not change, as the shaft speed, by name: a number in the unit of
    reports, or with a `unit` of its own; what is left out is as in the trials of `run`."""


class LimitsSection(Section):
    """What may not be passed; left out: no limit."""

    rudder: Positive | None = None
    """Rudder angle [deg]."""
    rudder_rate: Positive | None = None
    """Rudder speed [deg/s], of the gear and of the orders: those that come too quickly for it
    break the limit. Left out: the rudder merely comes late."""
    heel: Positive | None = None
    """Heel [deg]."""
    speed_loss: Annotated[Number, Field(gt=0, le=1)] | None = None
    """Share of the approach speed that may be lost."""
    room: tuple[Positive, Positive, Positive] | None = None
    """Room ahead, to each side and astern of where the ship begins [m]."""
    duration: Positive | None = None
    """How long a test may last [s]."""


class TestSection(Section):
    """A test: its kind, and its numbers in deg and s."""

    __test__ = False

    name: NotEmpty
    """What the test is called; each name once."""
    kind: NotEmpty
    """Which manoeuvre it is, as listed below."""
    duration: Positive | None = None
    """How long it lasts, the straight run before it included [s]."""
    set: Mapping[str, Numbers] = {}
    """Numbers of the manoeuvre that are given."""
    open: Mapping[str, Window] = {}
    """Numbers that the search chooses, `[low, high]` each; `duration` may be one."""
    steps: Count = 8
    """How many numbers an open list has."""


class SearchSection(Section):
    """How open numbers are chosen."""

    criterion: Literal["error", "S_imin", "R", "D", "A"] = "error"
    """What counts: the largest error of Eq. 14, the least S_imin, R, the volume of the errors'
    ellipsoid (D) or their root mean square (A)."""
    candidates: Count = 1500
    """How many tests are sailed to find the best."""
    seed: Whole = 0
    """Seed of the search."""


class PlausibleShips(Section):
    """Ships the test must serve: parameters drawn about their values."""

    count: Count = 1
    """How many ships; 1 is the stated one alone."""
    spread: NotNegative = 0.2
    """How far the parameters are drawn, as a share of their values."""
    seed: Whole = 0
    """Seed of the draw."""
    over: Literal["mean", "worst"] = "mean"
    """Whether the ships' mean counts, or the worst of them."""


class FullModelSection(Section):
    """What the ship has beyond the model to be fitted."""

    effects: Names = ()
    """Effects she has and the model lacks."""
    values: Mapping[str, Given] = {}
    """Their values, given by hand."""


class SeparateSection(Section):
    """Two effects that are to be told apart, by the tests that have something open.

    The other tests are what these are compared with: those that were run already.
    """

    effects: tuple[str, str]
    """Their names."""


class DesignFile(Described):
    """A design file, complete."""

    pipeline: ReadFile | None = None
    """A pipeline that lends ship, model and identify where they are not given."""
    run: Path | None = None
    """Folder of a finished run, whose fitted values are the ship's."""
    full: FullModelSection = FullModelSection()
    """What the ship has beyond the model to be fitted."""
    noise: Mapping[str, Annotated[NoiseSection, BeforeValidator(_with_sigma)]]
    """Noise of each output's sensor, by name."""
    wanted: Names = ()
    """Free parameters that count; left out: all of them."""
    scale: Mapping[str, Positive] = {}
    """What a parameter is multiplied with before R and S_min are taken, by name; 1 if not given."""
    at_sea: AtSea = AtSea()
    """How the tests are sailed."""
    limits: LimitsSection = LimitsSection()
    """What may not be passed."""
    tests: Annotated[tuple[TestSection, ...], Field(alias="test", min_length=1)]
    """The tests, a table `[[test]]` each."""
    together: bool = False
    """Whether all tests are fitted as one programme, or each is rated alone."""
    search: SearchSection = SearchSection()
    """How open numbers are chosen."""
    ships: PlausibleShips = PlausibleShips()
    """Ships the test must serve."""
    separate: SeparateSection | None = None
    """Two effects that are to be told apart."""
    imo: bool = False
    """Whether the standard measures of MSC.137(76) are predicted too."""


def load_design(path: Path) -> DesignFile:
    """Give the design in a TOML file.

    Raises
    ------
    PipelineError
        In one line: the file, the key's full path, what is wrong, the nearest valid names.
    """
    content = content_of(path, "design")
    table = table_of(content, path, "design")
    pipeline = check_form(DesignFile, {**_lent(table, path), **table}, Origin(path, content))
    if problems := [*_of_tests(pipeline), *_of_signals(pipeline), *_of_gear(pipeline)]:
        raise refusal(path, problems)
    return pipeline


def _lent(table: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """Ship, model and identify of the pipeline the design builds on."""
    if not isinstance(table.get("pipeline"), str):
        return {}
    base = load(path.parent / table["pipeline"])
    lent: dict[str, Any] = {"identify": base.identify.model_dump()}
    model = base.model.model_dump(exclude={"effects_from"})
    model["effects_from"] = [f.resolve() for f in base.model.effects_from]
    lent["model"] = model
    if base.ship is not None:
        lent["ship"] = base.ship.resolve()
    return lent


def _of_tests(pipeline: DesignFile) -> list[Problem]:
    found: list[Problem] = []
    names = [test.name for test in pipeline.tests]
    for i, test in enumerate(pipeline.tests):
        at = ("test", i)
        if names.index(test.name) != i:
            found.append((dotted_key(*at, "name"), f"{test.name!r} is already the name of a test"))
        if test.kind not in KINDS:
            words = f"there is no manoeuvre {test.kind!r}; {nearest(test.kind, KINDS)}"
            found.append((dotted_key(*at, "kind"), words))
            continue
        found += [*_of_numbers(test, at), *_of_duration(pipeline, test, at)]
    return found


def _of_duration(pipeline: DesignFile, test: TestSection, at: Sequence[str | int]) -> list[Problem]:
    """A test must outlast its approach, and fit into the memory of a computer."""
    low, high = test.open.get("duration", (test.duration, test.duration))
    if low is None or high is None:
        return []  # missing, and said so
    key = dotted_key(*at, "open" if "duration" in test.open else "duration")
    approach, period = pipeline.at_sea.approach, pipeline.at_sea.period
    if low <= approach:
        return [(key, f"{low:g} s are over with the straight run before (at_sea.approach = "
                 f"{approach:g}); give the test more time")]  # fmt: skip
    if high / period > MOST:
        return [(key, f"{high:g} s are more than {MOST} samples of {period:g} s; make it shorter")]
    return []


def _of_numbers(test: TestSection, at: Sequence[str | int]) -> list[Problem]:
    variables = KINDS[test.kind].variables
    words = KINDS[test.kind].words
    found: list[Problem] = []
    for key, numbers, known in (
        ("set", test.set, {*variables}),
        ("open", test.open, {*variables, "duration"}),
    ):
        found += [
            (dotted_key(*at, key, n), f"a {words} has no such number; {nearest(n, known)}")
            for n in numbers
            if n not in known
        ]
    for name, value in test.set.items():
        if isinstance(value, tuple) and name in variables and not variables[name].many:
            found.append((dotted_key(*at, "set", name), "is one number, not a list"))
    found += [
        (dotted_key(*at, key, n), variables[n].wrong(x))
        for key, numbers in (("set", test.set), ("open", test.open))
        for n, value in numbers.items()
        for x in (value if isinstance(value, tuple) else (value,))[: None if key == "set" else 1]
        if n in variables and variables[n].wrong(x)
    ]
    found += [(dotted_key(*at, "set", n), "is empty") for n, x in test.set.items() if x == ()]
    twice = [n for n in test.open if n in test.set]
    found += [(dotted_key(*at, "open", n), "is set as well; keep one of the two") for n in twice]
    return found + _missing(test, at)


def _missing(test: TestSection, at: Sequence[str | int]) -> list[Problem]:
    given = {*test.set, *test.open}
    variables = KINDS[test.kind].variables
    needed = [n for n, v in variables.items() if v.default is None and n not in given]
    found = [
        (dotted_key(*at, "set", n), f"missing; give {n} here, or leave it open") for n in needed
    ]
    if test.duration is None and "duration" not in test.open:
        found.append((dotted_key(*at, "duration"), "missing; give it in s, or leave it open"))
    return found


def _of_gear(pipeline: DesignFile) -> list[Problem]:
    """A gear that is to run faster than it can."""
    able, asked = pipeline.limits.rudder_rate, pipeline.at_sea.rudder_rate
    if able is None or asked is None or asked <= able:
        return []
    words = (
        f"{asked:g} deg/s are more than limits.rudder_rate allows, {able:g}; give the gear's own"
    )
    return [(dotted_key("at_sea", "rudder_rate"), words)]


def _of_signals(pipeline: DesignFile) -> list[Problem]:
    found: list[Problem] = []
    known = ship_quantities(pipeline)
    for name, given in pipeline.at_sea.constant.items():
        key = dotted_key("at_sea", "constant", name)
        if name not in known:
            found.append((key, f"unknown quantity; {nearest(name, known)}"))
        elif given.unit is not None:
            try:
                units.factor(given.unit, known[name].unit)
            except UnitError as error:
                found.append((dotted_key("at_sea", "constant", name, "unit"), str(error)))
    for name in pipeline.noise:
        if name not in SIGNALS:
            found.append((dotted_key("noise", name), f"unknown quantity; {nearest(name, SIGNALS)}"))
    return found
