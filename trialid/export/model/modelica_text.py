"""A fitted model as one Modelica model: equations that read like the physics, and what is known.

Names and steps are those of the C and NumPy files (`equation_steps`), so all three say the same.
"""

import textwrap
from collections.abc import Iterator, Sequence
from math import isfinite
from typing import Final

from trialid.export.model.c_text import WRAP
from trialid.export.model.equation_steps import Program, Writer, own_name, program
from trialid.export.model.fitted_model import FittedModel, FittedParameter

FUNCTIONS: Final = {"arctan": "atan"}
UNSEEN: Final = "unseen"
BEYOND: Final = "beyond what the trials held: here the model is a guess"


def modelica_text(made: FittedModel, name: str) -> str:
    """The file; the model is called as the file is."""
    eq, model = made.equations, own_name(name)
    what = program(eq, made.model, [*eq.f, *eq.outputs.values()])
    lines = [
        f'model {model} "{_text(made.name)}: the ship model that a run of trialid fitted"',
        *_facts(made),
        *(_parameter(p) for p in made.parameters),
        *_signals(made),
        "protected",
        *_long(f"Real {', '.join(step.name for step in what.steps)};", "  "),
        "equation",
        *_equations(made, what),
        *_watch(made),
        *_annotation(made),
        f"end {model};",
    ]
    return "\n".join(line.rstrip() for line in lines) + "\n"


def _facts(made: FittedModel) -> Iterator[str]:
    """Where it comes from, and what to know of it."""
    words = [f"{key.replace('_', ' ')}: {said}" for key, said in made.origin.items()]
    words += [f"NOTE {said}" for said in made.words]
    words.append(
        "Everything is SI; axes forward, to starboard, down; primed numbers over 1/2 rho L^2 U^2. "
        f"The run integrated with steps of {made.period:g} s or less."
    )
    for said in words:
        yield from _remark(said)


def _remark(words: str) -> Iterator[str]:
    plain = " ".join(words.split())
    yield from textwrap.wrap(plain, initial_indent="  // ", subsequent_indent="  //   ", **WRAP)


def _text(words: str) -> str:
    """Words inside a string of Modelica, on one line."""
    return " ".join(words.split()).replace("\\", "\\\\").replace('"', '\\"')


def _unit(unit: str) -> str:
    """A unit as Modelica writes it.

    >>> _unit("N m"), _unit("kg/m^3")
    ('N.m', 'kg/m3')
    """
    return unit.replace("^", "").replace(" ", ".")


def _parameter(p: FittedParameter) -> str:
    return (
        f'  parameter Real {own_name(p.name)}(unit="{_unit(p.unit)}") = {p.value!r} "{_sure(p)}";'
    )


def _sure(p: FittedParameter) -> str:
    if not p.fitted:
        return "held fixed"
    if p.likely is None or p.deviation is None:
        return "fitted, nobody knows how sure"
    ends = f"{p.likely[0]:.4g} to {p.likely[1]:.4g}"
    return f"fitted, likely {ends}, standard error {p.deviation:.3g}"


def _signals(made: FittedModel) -> Iterator[str]:
    """Inputs, states and what the sensors show, with units, beginnings and meanings."""
    for name in made.inputs:
        yield _signal(made, "input", name, f"start={made.starts[name]!r}")
    for name in made.equations.states:
        yield _signal(made, "output", name, f"start={made.starts[name]!r}, fixed=true")
    for name in made.equations.outputs:
        yield _signal(made, "output", name, "", "_sensor", ", as its sensor shows it")
    if _ends(made):
        yield f'  output Boolean {UNSEEN} "{BEYOND}";'


def _signal(
    made: FittedModel, kind: str, name: str, more: str, end: str = "", words: str = ""
) -> str:
    known = made.quantity(name)
    told = ", ".join(filter(None, [f'unit="{_unit(known.unit)}"', more]))
    return f'  {kind} Real {own_name(name)}{end}({told}) "{_text(known.meaning + words)}";'


def _equations(made: FittedModel, what: Program) -> Iterator[str]:
    write, eq = Writer(what, _call), made.equations
    for step in what.steps:
        if step.remark:
            yield from _remark(step.remark)
        yield from _long(f"{step.name} = {write.step(step)};", "  ")
    names = [f"der({own_name(n)})" for n in eq.states] + [
        f"{own_name(n)}_sensor" for n in eq.outputs
    ]
    for name, node in zip(names, what.results, strict=True):
        yield from _long(f"{name} = {write.result(node)};", "  ")


def _ends(made: FittedModel) -> list[tuple[str, float, float]]:
    """What the trials held of states and inputs, where they hold anything."""
    names = [n for n in (*made.equations.states, *made.inputs) if n in made.seen]
    return [(n, made.seen[n].low, made.seen[n].high) for n in names]


def _watch(made: FittedModel) -> Iterator[str]:
    """What tells that it goes beyond what was seen."""
    if not _ends(made):
        return
    words = [f"{own_name(n)} < {low!r} or {own_name(n)} > {high!r}" for n, low, high in _ends(made)]
    yield from _long(f"{UNSEEN} = {' or '.join(words)};", "  ")
    yield f'  assert(not {UNSEEN}, "{BEYOND}",'
    yield "      AssertionLevel.warning);"


def _annotation(made: FittedModel) -> Iterator[str]:
    """What was seen, how sure the numbers are, where they are from, for programs."""
    sure = [(p, p.likely, p.deviation) for p in made.fitted]
    groups = {
        "seen": [f"{own_name(n)}={_array(ends)}" for n, *ends in _ends(made)],
        "likely": [f"{own_name(p.name)}={_array(ends)}" for p, ends, _ in sure if ends],
        "standardError": [f"{own_name(p.name)}={x!r}" for p, _, x in sure if x is not None],
    }
    parts = [f'verdict="{_text(made.verdict)}"', f"longestStep={made.period!r}"]
    parts += [f'origin_{key}="{_text(words)}"' for key, words in made.origin.items()]
    parts += [f"{word}({', '.join(rows)})" for word, rows in groups.items() if rows]
    rows = made.covariance.tolist()
    if rows and all(isfinite(x) for row in rows for x in row):
        listed = ", ".join(f'"{p.name}"' for p in made.fitted)
        parts += [f"covarianceOf={{{listed}}}", f"covariance={{{', '.join(map(_array, rows))}}}"]
    yield "  annotation("
    yield f"    experiment(StartTime=0, StopTime=600, Interval={made.period!r}),"
    yield "    __trialid("
    yield from (f"      {part}," for part in parts[:-1])
    yield f"      {parts[-1]}));"


def _array(numbers: Sequence[float]) -> str:
    return f"{{{', '.join(map(repr, numbers))}}}"


def _long(line: str, indent: str) -> list[str]:
    return textwrap.wrap(line, initial_indent=indent, subsequent_indent=f"{indent}    ", **WRAP)


def _call(op: str, args: Sequence[str]) -> str:
    match op:
        case "clip":
            return f"min(max({args[0]}, -({args[1]})), {args[1]})"
        case "inside":
            return f"(if noEvent(abs({args[0]}) < {args[1]}) then 1.0 else 0.0)"
        case "sign":
            return f"(if noEvent({args[0]} >= 0.0) then 1.0 else -1.0)"
    return f"{FUNCTIONS.get(op, op)}({', '.join(args)})"
