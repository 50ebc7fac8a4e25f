"""A fitted model as one Python file that needs NumPy alone and reads like its equations."""

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from math import isfinite
from typing import Any, Final

from trialid.export.model.equation_steps import Program, Writer, own_name, program
from trialid.export.model.fitted_model import FittedModel

WIDE: Final = 96
DEEP: Final = " " * 8
WRAP: Final[Mapping[str, Any]] = {
    "width": WIDE,
    "break_long_words": False,
    "break_on_hyphens": False,
}
TAIL: Final = '''
def step(state, before, after, period, substeps=1, parameters=PARAMETERS):
    """The state a period [s] later: Runge-Kutta of order 4, inputs straight in between."""
    state, before, after = (np.asarray(x, dtype=float) for x in (state, before, after))
    if not (np.isfinite([*before, *after]).all() and period > 0 and substeps >= 1):
        raise ValueError(f"expected finite {', '.join(INPUTS)}, a period > 0 and substeps >= 1")
    h = period / substeps
    for k in range(substeps):
        u = [before + (after - before) * ((k + part) / substeps) for part in (0.0, 0.5, 1.0)]
        k1 = derivatives(state, u[0], parameters)
        k2 = derivatives(state + 0.5 * h * k1, u[1], parameters)
        k3 = derivatives(state + 0.5 * h * k2, u[1], parameters)
        k4 = derivatives(state + h * k3, u[2], parameters)
        state = state + h * (k1 / 6 + k2 / 3 + k3 / 3 + k4 / 6)
    return state


def simulate(state, inputs, period, substeps=1, parameters=PARAMETERS):
    """States at every sample of the inputs; (N, states) from (N, inputs)."""
    found = [np.asarray(state, dtype=float)]
    for before, after in zip(inputs[:-1], inputs[1:]):
        found.append(step(found[-1], before, after, period, substeps, parameters))
    return np.array(found)


def unseen(state, inputs):
    """Names of what lies outside the ranges of the trials: there the model is a guess."""
    values = dict(zip((*STATES, *INPUTS), (*state, *inputs)))
    return [n for n, (low, high) in SEEN.items()
            if not np.all((low <= values[n]) & (values[n] <= high))]
'''


def numpy_text(made: FittedModel) -> str:
    """The file."""
    equations = made.equations
    rates = program(equations, made.model, equations.f)
    sensed = program(equations, made.model, [*equations.outputs.values()])
    lines = [
        f'"""{_prose(made.name)}: the ship model that a run of trialid fitted.',
        "",
        *_facts(made),
        '"""',
        "",
        "import numpy as np",
        "",
        f"STATES = {_names(equations.states)}",
        f"INPUTS = {_names(made.inputs)}",
        f"OUTPUTS = {_names(tuple(equations.outputs))}",
        "",
        *_tables(made),
        "",
        *_function(made, rates, "derivatives", "Time derivative of every state [SI]."),
        "",
        *_function(made, sensed, "outputs", "What the sensors would show of a state [SI]."),
        TAIL,
    ]
    return "\n".join(line.rstrip() for line in lines)


def _facts(made: FittedModel) -> Iterator[str]:
    """Where it comes from, what to know, letters and units."""
    for key, words in made.origin.items():
        yield from _wrapped(f"{key.replace('_', ' ')}: {words}")
    for words in made.words:
        yield from _wrapped(f"NOTE {words}")
    yield ""
    for name in (*made.equations.states, *made.inputs):
        known = made.quantity(name)
        yield from _wrapped(f"{name} [{known.unit}]: {known.meaning}")
    yield ""
    yield from _wrapped(
        "Everything is SI; axes forward, to starboard, down; primed numbers are over 1/2 rho L^2 "
        f"U^2 (SNAME). Integrated with steps of {made.period:g} s or less in the run."
    )


def _wrapped(words: str) -> list[str]:
    return textwrap.wrap(_prose(words), WIDE, subsequent_indent="    ") or [""]


def _prose(words: str) -> str:
    """Words that end no string, whatever a file's name holds."""
    return words.replace("\\", "/").replace('"', "'")


def _names(names: Sequence[str]) -> str:
    return "(" + "".join(f"{name!r}, " for name in names).rstrip() + ")"


def _tables(made: FittedModel) -> Iterator[str]:
    yield "PARAMETERS = {"
    for p in made.parameters:
        likely = "held fixed"
        if p.fitted:
            likely = "fitted, nobody knows how sure"
            if p.likely is not None:
                likely = f"fitted, likely {p.likely[0]:.4g} to {p.likely[1]:.4g}"
        yield f"    {p.name!r}: {p.value!r},  # [{p.unit}] {likely}"
    yield "}"
    yield f"FITTED = {_names([p.name for p in made.fitted])}"
    yield "COVARIANCE = (  # of FITTED, as wide as the likely ranges"
    for row in made.covariance.tolist():
        yield "    (" + " ".join(f"{x!r}," if isfinite(x) else "None," for x in row) + "),"
    yield ")"
    yield "SEEN = {  # smallest and largest of the trials [SI]"
    for name, seen in made.seen.items():
        if name in (*made.equations.states, *made.inputs):
            yield f"    {name!r}: ({seen.low!r}, {seen.high!r}),"
    yield "}"
    yield ""


def _function(made: FittedModel, what: Program, name: str, words: str) -> Iterator[str]:
    """One function of state, inputs and parameters, a line a step."""
    write = Writer(what, _call)
    yield ""
    yield f"def {name}(state, inputs, parameters=PARAMETERS):"
    yield f'    """{words}"""'
    yield from _unpacked(made.equations.states, "state", what)
    yield from _unpacked(made.inputs, "inputs", what)
    for p in (p.name for p in made.parameters if p.name in what.used):
        yield f"    {own_name(p)} = parameters[{p!r}]"
    for one in what.steps:
        if one.remark:
            yield from (f"    # {line}" for line in _wrapped(one.remark))
        yield from _assignment(one.name, write.step(one))
    found = ", ".join(write.result(node) for node in what.results)
    yield from _assignment("found", f"[{found}]")
    yield "    return np.array(np.broadcast_arrays(*found))"


def _unpacked(names: Sequence[str], source: str, what: Program) -> Iterator[str]:
    for place, name in enumerate(names):
        if name in what.used:
            yield f"    {own_name(name)} = {source}[{place}]"


def _assignment(name: str, text: str) -> Iterator[str]:
    line = f"    {name} = {text}"
    if len(line) <= WIDE:
        yield line
        return
    yield f"    {name} = ("
    yield from textwrap.wrap(text, initial_indent=DEEP, subsequent_indent=DEEP, **WRAP)
    yield "    )"


def _call(op: str, args: Sequence[str]) -> str:
    match op:
        case "clip":
            return f"np.minimum(np.maximum({args[0]}, -({args[1]})), {args[1]})"
        case "inside":
            return f"np.where(np.abs({args[0]}) < {args[1]}, 1.0, 0.0)"
        case "sign":
            return f"np.copysign(1.0, {args[0]})"
    return f"np.{op}({', '.join(args)})"
