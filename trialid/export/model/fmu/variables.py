"""What an FMU says of a model in either version of FMI: variables, units, what is known of it."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final, Literal
from xml.sax.saxutils import quoteattr

from trialid.export.model.fitted_model import FittedModel

UNSEEN: Final = "unseen"
BASE: Final[Mapping[str, str]] = {
    "1": "",
    "rad": 'rad="1"',
    "m": 'm="1"',
    "s": 's="1"',
    "m/s": 'm="1" s="-1"',
    "rad/s": 'rad="1" s="-1"',
    "1/s": 's="-1"',
    "1/m": 'm="-1"',
    "N": 'kg="1" m="1" s="-2"',
    "N m": 'kg="1" m="2" s="-2"',
    "m/s^2": 'm="1" s="-2"',
    "rad/s^2": 'rad="1" s="-2"',
}
"""Units in those of the standard; others are named and no more."""

HOW: Final = {
    "state": 'causality="output" variability="continuous" initial="exact"',
    "input": 'causality="input" variability="continuous"',
    "output": 'causality="output" variability="continuous" initial="calculated"',
    "parameter": 'causality="parameter" variability="tunable" initial="exact"',
    "flag": 'causality="output" variability="discrete" initial="calculated"',
}


@dataclass(frozen=True)
class Variable:
    """One number of an FMU; its reference is its place. `start` is None where it is calculated."""

    kind: Literal["state", "input", "output", "parameter", "flag"]
    name: str
    words: str
    unit: str = ""
    start: float | None = None

    @property
    def is_output(self) -> bool:
        """Whether others may follow it."""
        return self.kind in ("state", "output", "flag")

    @property
    def how(self) -> str:
        """What it does, in the words of both versions."""
        return HOW[self.kind]

    @property
    def attributes(self) -> str:
        """Unit and start, as both versions write them."""
        unit = f" unit={quoteattr(self.unit)}" if self.unit else ""
        return unit if self.start is None else f'{unit} start="{self.start!r}"'


def variables_of(made: FittedModel) -> list[Variable]:
    """States, inputs, what sensors show, parameters, and the flag, in the order of the C arrays."""
    found = []
    for name, start in made.starts.items():
        known = made.quantity(name)
        kind: Literal["input", "state"] = "input" if name in made.inputs else "state"
        found.append(Variable(kind, name, known.meaning, known.unit, start))
    for name in made.equations.outputs:
        known = made.quantity(name)
        words = f"{known.meaning}, as its sensor shows it"
        found.append(Variable("output", f"{name}_sensor", words, known.unit))
    for p in made.parameters:
        words = "fitted, nobody knows how sure" if p.fitted else "held fixed"
        if p.likely is not None:
            words = f"fitted, likely {p.likely[0]:.4g} to {p.likely[1]:.4g}"
        found.append(Variable("parameter", p.name, words, p.unit, p.value))
    return [*found, Variable("flag", UNSEEN, "whether anything was beyond what the trials held")]


def units_of(variables: list[Variable]) -> Iterator[str]:
    """Their units in those of the standard."""
    yield "<UnitDefinitions>"
    for unit in dict.fromkeys(["s", *(v.unit for v in variables if v.unit)]):
        base = f"<BaseUnit {BASE[unit]}/>" if unit in BASE else ""
        yield f"<Unit name={quoteattr(unit)}>{base}</Unit>"
    yield "</UnitDefinitions>"


def known_of(made: FittedModel) -> Iterator[str]:
    """What was seen, how sure the numbers are, where they come from."""
    yield f'<Model file="resources/model.json" verdict={quoteattr(made.verdict)}>'
    for key, words in made.origin.items():
        yield f"<Origin key={quoteattr(key)} value={quoteattr(words)}/>"
    yield from (f"<Note text={quoteattr(words)}/>" for words in made.words)
    for name, seen in made.seen.items():
        yield f'<Seen name={quoteattr(name)} low="{seen.low!r}" high="{seen.high!r}"/>'
    for p in (p for p in made.fitted if p.likely is not None):
        low, high = p.likely or (0.0, 0.0)
        yield f'<Likely name={quoteattr(p.name)} low="{low!r}" high="{high!r}"/>'
    yield f"<Covariance of={quoteattr(' '.join(p.name for p in made.fitted))}>"
    yield from (f"<Row>{' '.join(map(repr, row))}</Row>" for row in made.covariance.tolist())
    yield "</Covariance></Model>"


def description(made: FittedModel) -> str:
    """The name and all there is to know of it, in one attribute."""
    return quoteattr(f"{made.name}: {' '.join(made.words) or 'fitted by trialid'}")
