"""The ship file with the fitted values, for a next pipeline: their scatter, and where from."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Final

from trialid.errors import printable
from trialid.export.model.fitted_model import deviation_of
from trialid.names.quantities import MASS_PARAMETERS
from trialid.result.fit_rows import ParameterRow
from trialid.result.schema import Result
from trialid.ship.actuators import actuator_tables
from trialid.ship.forms import Force, Mass, Rate
from trialid.ship.model import ShipModel
from trialid.ship.particulars import MOST_UNCERTAIN, Ship
from trialid.ship.prime import mass_scale, primed_coefficient
from trialid.toml_text import quote
from trialid.version import VERSION

HEAD: Final = """\
# Written by `trialid export --as ship`. Numbers with `fitted` are those of a run, with where each
# is likely to lie; [uncertainty] has that as a standard deviation, a share of the number: for what
# a next pipeline holds, and with priors = "ship" for what it estimates. The others are as before.
"""


@dataclass(frozen=True)
class FittedShip:
    """A ship with fitted numbers in the system of her file, and what is said of each."""

    ship: Ship
    words: Mapping[str, str]


def fitted_ship(model: ShipModel, result: Result) -> FittedShip:
    """The ship of a fitted model: its values in the system and the rudder's sign of her file.

    What belongs to sensors stays out; what the pipeline states is put in beside what was fitted.
    """
    rows = {row.name: row for row in result.physical}
    mass, coefficients = dict(model.ship.mass), dict(model.ship.coefficients)
    shares, words = dict(model.ship.uncertainty), dict[str, str]()
    hers = {*rows, *coefficients, *mass, *_of_the_ship(model)}
    for name in (n for n in model.values if n in hers):
        before = (mass if name in MASS_PARAMETERS else coefficients).get(name)
        factor = _file_factor(model, name)
        value = model.value(name) / factor
        (mass if name in MASS_PARAMETERS else coefficients)[name] = value
        row = rows.get(name)
        if row is None:
            words[name] = "as the pipeline states it"
            continue
        words[name] = _words(row, factor, before)
        if value != 0.0:
            shares[name] = _share(row)
    listed = sorted({g.path for t in result.trials if t.use == "fit" for g in t.logs})
    source = f"Fitted by trialid {VERSION} to {', '.join(listed)}; before: {model.ship.source}"
    notes = " ".join(filter(None, [model.ship.notes, f"Verdict: {result.verdict.sentence}"]))
    ship = replace(model.ship, mass=mass, coefficients=coefficients, uncertainty=shares)
    ship = replace(ship, source=source, notes=notes)
    return FittedShip(ship, words)


def _of_the_ship(model: ShipModel) -> set[str]:
    """Parameters of what acts on the ship, not of what only records her."""
    acting = (e for e in model.effects if {Force, Mass, Rate} & {*e.forms})
    return {n for e in acting for n in e.parameters}


def _file_factor(model: ShipModel, name: str) -> float:
    """What a number of the file is multiplied by to be the model's."""
    ship = model.ship
    if name in MASS_PARAMETERS:
        p = ship.particulars
        return 1.0 if ship.system == "prime" else 1.0 / mass_scale(name, p["L"], p["rho"])
    effect = next(e for e in model.effects if name in e.parameters)
    return primed_coefficient(replace(ship, coefficients={name: 1.0}), effect, name)


def _words(row: ParameterRow, factor: float, before: float | None) -> str:
    said = "fitted"
    if row.likely is not None:
        low, high = sorted(end / factor for end in row.likely)
        said += f", likely {low:.6g} to {high:.6g}"
    return said if before is None else f"{said}; was {before:.6g}"


def _share(row: ParameterRow) -> float:
    """Standard deviation as a share of the value; hardly the sign is known where nobody knows."""
    deviation = deviation_of(row)
    if deviation is None or not row.value:
        return MOST_UNCERTAIN
    return min(float(f"{deviation / abs(row.value):.4g}"), MOST_UNCERTAIN)


def fitted_ship_text(made: FittedShip, warnings: tuple[str, ...]) -> str:
    """The ship file; `read_ship` gives the same ship, digit for digit."""
    ship = made.ship
    lines = [
        *HEAD.splitlines(),
        *(f"# {printable(words)}" for words in warnings),
        f"name = {quote(ship.name)}",
        f"source = {quote(ship.source)}",
        f"notes = {quote(ship.notes)}",
        f"system = {quote(ship.system)}",
        f"rudder_positive = {quote(ship.rudder_positive)}",
        f"coefficient_speed = {ship.coefficient_speed!r}",
        "",
        "[particulars]",
        *_rows(ship.particulars, {}),
        "",
        "[mass]",
        *_rows(ship.mass, made.words),
        "",
        "[coefficients]",
        *_rows(ship.coefficients, made.words),
        "",
        "[uncertainty]  # one standard deviation, as a share of the number",
        *_rows(ship.uncertainty, {}),
        *(["", "[antenna]", *_rows(ship.antenna, {})] if ship.antenna else []),
        *(["", *actuator_tables(ship.actuators)] if ship.actuators else []),
    ]
    return "\n".join(lines) + "\n"


def _rows(numbers: Mapping[str, float], words: Mapping[str, str]) -> Iterator[str]:
    for name, value in numbers.items():
        said = f"  # {words[name]}" if name in words else ""
        yield f"{_key(name)} = {float(value)!r}{said}"


def _key(name: str) -> str:
    """A key as TOML takes it."""
    plain = name.isascii() and name.replace("_", "a").replace("-", "a").isalnum()
    return name if plain else quote(name)
