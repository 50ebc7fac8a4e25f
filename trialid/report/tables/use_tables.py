"""The model in use, for a page: its equations with numbers, and what it can be handed over as."""

from collections.abc import Iterator
from dataclasses import dataclass

from trialid.effects import CATALOGUE
from trialid.names.model_kinds import KINDS, Kind
from trialid.result.fit_rows import ModelPart, ParameterRow
from trialid.result.schema import Result


@dataclass(frozen=True)
class EquationRow:
    """An effect of the model, its equation where the catalogue has it, and its fitted numbers."""

    effect: str
    equation: str
    parameters: tuple[ParameterRow, ...]


@dataclass(frozen=True)
class CommandRow:
    """A command, and what it gives."""

    command: str
    words: str


def equations(run: Result) -> Iterator[EquationRow]:
    """A row an effect, in the order of the model."""
    rows = {row.name: row for row in run.physical}
    for name in run.model.effects:
        known = CATALOGUE.get(name)
        own = () if known is None else tuple(rows[n] for n in known.parameters if n in rows)
        yield EquationRow(name, "" if known is None else known.equation, own)


def commands(run: Result) -> Iterator[CommandRow]:
    """What can be done with the run, from its own folder; nothing that its model would refuse."""
    model, marked = run.model, " --anyway" if run.verdict.kind == "no fit" else ""
    by_angle = model.by_rudder or model.by_rudders
    if by_angle or model.by_thrusters:
        manoeuvre = "zigzag 20 20" if by_angle else "stop"
        yield CommandRow(
            f"trialid simulate . {manoeuvre}{marked}", "a manoeuvre with likely ranges"
        )
    if model.turns:
        yield CommandRow(f"trialid simulate . orders.csv{marked}", "orders of your own")
    for name, kind in kinds_of(model).items():
        needs = kind.needs_by_thrusters if model.by_thrusters else kind.needs
        said = f" {needs}" if needs else ""
        yield CommandRow(f"trialid export . --as {name}{said}{marked}", kind.words)


def kinds_of(model: ModelPart) -> dict[str, Kind]:
    """What a model can be written as: one that nothing known steers has no K, T and gains."""
    steered = model.by_rudder or model.by_thrusters
    return {name: kind for name, kind in KINDS.items() if steered or not kind.steered}
