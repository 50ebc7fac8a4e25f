"""The design file: TOML that says what the next trial is for, what is allowed, what may be run."""

import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Final, Literal

from pydantic import BeforeValidator, Field

from trialid import units
from trialid.design.kinds import KINDS
from trialid.errors import RecipeError, UnitError, nearest
from trialid.quantities import SIGNALS
from trialid.recipe import content_of, formed, load, table_of
from trialid.recipe.complaints import Problem, dotted, refusal
from trialid.recipe.form import (
    Count,
    Described,
    GivenValue,
    Names,
    NotEmpty,
    NotNegative,
    Number,
    Origin,
    Positive,
    ReadFile,
    Section,
    Whole,
    Window,
    with_value,
)

MOST: Final = 200_000
"""Samples of a test: a day and more at the usual period."""

Given = Annotated[GivenValue, BeforeValidator(with_value)]
Numbers = Number | tuple[Number, ...]


def _with_sigma(given: Any) -> Any:
    return given if isinstance(given, dict) else {"sigma": given}


class NoiseRecipe(Section):
    """Noise of a sensor: standard deviation in the unit of reports, and its memory [s]."""

    sigma: Positive
    memory: NotNegative = 0.0


class AtSea(Section):
    """How the tests are sailed: clock, straight run before each, gear, and what stays constant.

    `period`, `approach` [s], `rudder_rate` [deg/s] of the steering gear, where no effect of the
    model is one; `constant` holds recorded signals that do not change, as the shaft speed: a number
    in the unit of reports, or with a unit of its own.
    """

    period: Positive = 0.5
    approach: NotNegative = 30.0
    rudder_rate: Positive = 2.5
    constant: Mapping[str, Given] = {}


class LimitsRecipe(Section):
    """What may not be passed: deg, deg/s, share of the speed, m ahead, aside and astern, s.

    `rudder_rate` holds for the rudder and for the orders: those that come so quickly that it would
    have to run faster to reach each of them break it. Without it the rudder merely comes late.
    """

    rudder: Positive | None = None
    rudder_rate: Positive | None = None
    heel: Positive | None = None
    speed_loss: Annotated[Number, Field(gt=0, le=1)] | None = None
    room: tuple[Positive, Positive, Positive] | None = None
    duration: Positive | None = None


class TestRecipe(Section):
    """A test: its kind, numbers in deg and s, and those left open between two limits.

    `steps` says how many numbers an open list has.
    """

    __test__ = False

    name: NotEmpty
    kind: NotEmpty
    duration: Positive | None = None
    set: Mapping[str, Numbers] = {}
    open: Mapping[str, Window] = {}
    steps: Count = 8


class SearchRecipe(Section):
    """How open numbers are chosen: what counts, how many candidates, and the seed."""

    criterion: Literal["error", "S_imin", "R", "D", "A"] = "error"
    candidates: Count = 1500
    seed: Whole = 0


class PlausibleShips(Section):
    """Ships the test must serve: parameters drawn about their values, `spread` a share of them."""

    count: Count = 1
    spread: NotNegative = 0.2
    seed: Whole = 0
    over: Literal["mean", "worst"] = "mean"


class FullRecipe(Section):
    """What the ship has beyond the model to be fitted: effects, and values given by hand."""

    effects: Names = ()
    values: Mapping[str, Given] = {}


class SeparateRecipe(Section):
    """Two effects that are to be told apart, by the tests that have something open.

    The other tests are what these are compared with: those that were run already.
    """

    effects: tuple[str, str]


class DesignRecipe(Described):
    """A design file, complete.

    `pipeline` lends ship, model and identify where they are not given; `run` is a folder of a
    finished run, whose fitted values are the ship's.
    """

    pipeline: ReadFile | None = None
    run: Path | None = None
    full: FullRecipe = FullRecipe()
    noise: Mapping[str, Annotated[NoiseRecipe, BeforeValidator(_with_sigma)]]
    wanted: Names = ()
    scale: Mapping[str, Positive] = {}
    at_sea: AtSea = AtSea()
    limits: LimitsRecipe = LimitsRecipe()
    tests: Annotated[tuple[TestRecipe, ...], Field(alias="test", min_length=1)]
    together: bool = False
    search: SearchRecipe = SearchRecipe()
    ships: PlausibleShips = PlausibleShips()
    separate: SeparateRecipe | None = None
    imo: bool = False


def load_design(path: Path) -> DesignRecipe:
    """Give the design in a TOML file.

    Raises
    ------
    RecipeError
        In one line: the file, the key's full path, what is wrong, the nearest valid names.
    """
    content = content_of(path)
    table = table_of(content, path)
    recipe = formed(DesignRecipe, {**_lent(table, path), **table}, Origin(path, content))
    if problems := [*_of_tests(recipe), *_of_signals(recipe), *_of_gear(recipe)]:
        raise refusal(path, problems)
    return recipe


def _lent(table: Mapping[str, Any], path: Path) -> dict[str, Any]:
    """Ship, model and identify of the pipeline the design builds on."""
    if not isinstance(table.get("pipeline"), str):
        return {}
    base = load(path.parent / table["pipeline"])
    lent: dict[str, Any] = {"identify": base.identify.model_dump()}
    model = base.model.model_dump(exclude={"effects_from"})
    model["effects_from"] = [base.path.parent.resolve() / f for f in base.model.effects_from]
    lent["model"] = model
    if base.ship is not None:
        lent["ship"] = base.ship.resolve()
    return lent


def _of_tests(recipe: DesignRecipe) -> list[Problem]:
    found: list[Problem] = []
    names = [test.name for test in recipe.tests]
    for i, test in enumerate(recipe.tests):
        at = ("test", i)
        if names.index(test.name) != i:
            found.append((dotted(*at, "name"), f"{test.name!r} is already the name of a test"))
        if test.kind not in KINDS:
            words = f"there is no manoeuvre {test.kind!r}; {nearest(test.kind, KINDS)}"
            found.append((dotted(*at, "kind"), words))
            continue
        found += [*_of_numbers(test, at), *_of_duration(recipe, test, at)]
    return found


def _of_duration(recipe: DesignRecipe, test: TestRecipe, at: Sequence[str | int]) -> list[Problem]:
    """A test must outlast its approach, and fit into the memory of a computer."""
    low, high = test.open.get("duration", (test.duration, test.duration))
    if low is None or high is None:
        return []  # missing, and said so
    key = dotted(*at, "open" if "duration" in test.open else "duration")
    approach, period = recipe.at_sea.approach, recipe.at_sea.period
    if low <= approach:
        return [(key, f"{low:g} s are over with the straight run before (at_sea.approach = "
                 f"{approach:g}); give the test more time")]  # fmt: skip
    if high / period > MOST:
        return [(key, f"{high:g} s are more than {MOST} samples of {period:g} s; make it shorter")]
    return []


def _of_numbers(test: TestRecipe, at: Sequence[str | int]) -> list[Problem]:
    variables = KINDS[test.kind].variables
    words = KINDS[test.kind].words
    found: list[Problem] = []
    for key, numbers, known in (
        ("set", test.set, {*variables}),
        ("open", test.open, {*variables, "duration"}),
    ):
        found += [
            (dotted(*at, key, n), f"a {words} has no such number; {nearest(n, known)}")
            for n in numbers
            if n not in known
        ]
    for name, value in test.set.items():
        if isinstance(value, tuple) and name in variables and not variables[name].many:
            found.append((dotted(*at, "set", name), "is one number, not a list"))
    found += [
        (dotted(*at, key, n), variables[n].wrong(x))
        for key, numbers in (("set", test.set), ("open", test.open))
        for n, value in numbers.items()
        for x in (value if isinstance(value, tuple) else (value,))[: None if key == "set" else 1]
        if n in variables and variables[n].wrong(x)
    ]
    found += [(dotted(*at, "set", n), "is empty") for n, x in test.set.items() if x == ()]
    twice = [n for n in test.open if n in test.set]
    found += [(dotted(*at, "open", n), "is set as well; keep one of the two") for n in twice]
    return found + _missing(test, at)


def _missing(test: TestRecipe, at: Sequence[str | int]) -> list[Problem]:
    given = {*test.set, *test.open}
    variables = KINDS[test.kind].variables
    needed = [n for n, v in variables.items() if v.default is None and n not in given]
    found = [(dotted(*at, "set", n), f"missing; give {n} here, or leave it open") for n in needed]
    if test.duration is None and "duration" not in test.open:
        found.append((dotted(*at, "duration"), "missing; give it in s, or leave it open"))
    return found


def _of_gear(recipe: DesignRecipe) -> list[Problem]:
    """A gear that is to run faster than it can."""
    able, asked = recipe.limits.rudder_rate, recipe.at_sea.rudder_rate
    if able is None or asked <= able:
        return []
    words = (
        f"{asked:g} deg/s are more than limits.rudder_rate allows, {able:g}; give the gear's own"
    )
    return [(dotted("at_sea", "rudder_rate"), words)]


def _of_signals(recipe: DesignRecipe) -> list[Problem]:
    found: list[Problem] = []
    for name, given in recipe.at_sea.constant.items():
        key = dotted("at_sea", "constant", name)
        if name not in SIGNALS:
            found.append((key, f"unknown quantity; {nearest(name, SIGNALS)}"))
        elif given.unit is not None:
            try:
                units.factor(given.unit, SIGNALS[name].unit)
            except UnitError as error:
                found.append((dotted("at_sea", "constant", name, "unit"), str(error)))
    for name in recipe.noise:
        if name not in SIGNALS:
            found.append((dotted("noise", name), f"unknown quantity; {nearest(name, SIGNALS)}"))
    return found


def fitted_values(recipe: DesignRecipe) -> dict[str, float]:
    """Parameter values of the finished run the design builds on; empty where there is none.

    Raises
    ------
    RecipeError
        The folder holds no run.
    """
    if recipe.run is None:
        return {}
    file = recipe.path.parent / recipe.run / "result.json"
    try:
        result = json.loads(file.read_text("utf-8"))
        rows = result["accuracy"]["parameters"]
        return {p["name"]: float(p["value"]) for p in rows if p["kind"] == "physical"}
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise RecipeError(
            f"{recipe.path}: run: {file} is no result of a run; give the folder that "
            "`trialid run` wrote"
        ) from error
