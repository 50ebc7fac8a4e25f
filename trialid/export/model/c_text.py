"""A fitted model as one C99 file with its header: double precision, no dependencies."""

import textwrap
from collections.abc import Iterator, Mapping, Sequence
from math import isfinite
from typing import Any, Final

from trialid.export.model.equation_steps import Program, Writer, own_name, program
from trialid.export.model.fitted_model import FittedModel
from trialid.simulation.integrate import domain

WIDE: Final = 98
ENDLESS: Final = 1e300
"""Stands for infinity, which C need not know."""
WRAP: Final[Mapping[str, Any]] = {
    "width": WIDE,
    "break_long_words": False,
    "break_on_hyphens": False,
}
FUNCTIONS: Final = {"abs": "fabs", "arctan": "atan"}

HEADER: Final = """\
#ifndef {UP}_H
#define {UP}_H

/* Everything is SI; axes forward, to starboard, down; primed numbers over 1/2 rho L^2 U^2. */

enum {{ {UP}_STATES = {nx}, {UP}_INPUTS = {nu}, {UP}_OUTPUTS = {ny}, {UP}_PARAMETERS = {np} }};

/* What a step tells; several may be true at once. */
enum {{
  {UP}_OK = 0,
  {UP}_UNSEEN = 1,    /* beyond what the trials held: there the model is a guess */
  {UP}_DIVERGED = 2,  /* beyond what the equations are for; the state is as before the step */
  {UP}_WRONG = 4      /* an input or the period is no number to go on; nothing was done */
}};

{lists}
extern const char *const {low}_state_names[];
extern const char *const {low}_input_names[];
extern const char *const {low}_output_names[];
extern const char *const {low}_parameter_names[];
extern const double {low}_parameters[];  /* as the run fitted them */
extern const double {low}_seen[][2];     /* smallest and largest of each state, then input */

/* Time derivative of every state. */
void {low}_derivatives(const double state[], const double inputs[], const double parameters[],
                       double rates[]);

/* What the sensors would show of a state. */
void {low}_outputs(const double state[], const double inputs[], const double parameters[],
                   double outputs[]);

/* Whether a state and inputs lie beyond what the trials held: {UP}_OK or {UP}_UNSEEN. */
int {low}_unseen(const double state[], const double inputs[]);

/* The state a period [s] later, in place, by Runge-Kutta of order 4 in so many substeps; inputs go
   straight from before to after. In the run a step was {period} s or less. */
int {low}_step(double state[], const double before[], const double after[],
               const double parameters[], double period, int substeps);

#endif
"""

STEPPING: Final = """\
int {low}_unseen(const double state[], const double inputs[]) {{
  for (int i = 0; i < {UP}_STATES + {UP}_INPUTS; i++) {{
    double value = i < {UP}_STATES ? state[i] : inputs[i - {UP}_STATES];
    if (!({low}_seen[i][0] <= value && value <= {low}_seen[i][1])) return {UP}_UNSEEN;
  }}
  return {UP}_OK;
}}

static void between(const double before[], const double after[], double part, double inputs[]) {{
  for (int i = 0; i < {UP}_INPUTS; i++) inputs[i] = before[i] + (after[i] - before[i]) * part;
}}

static void ahead(const double state[], double h, const double rates[], double moved[]) {{
  for (int i = 0; i < {UP}_STATES; i++) moved[i] = state[i] + h * rates[i];
}}

int {low}_step(double state[], const double before[], const double after[],
               const double parameters[], double period, int substeps) {{
  double x[{UP}_STATES], moved[{UP}_STATES], k[4][{UP}_STATES], u[{UP}_INPUTS + 1];
  if (!(period > 0.0) || substeps < 1) return {UP}_WRONG;
  for (int i = 0; i < {UP}_INPUTS; i++)
    if (!isfinite(before[i]) || !isfinite(after[i])) return {UP}_WRONG;
  for (int i = 0; i < {UP}_STATES; i++) x[i] = state[i];
  double h = period / substeps;
  for (int s = 0; s < substeps; s++) {{
    between(before, after, (double)s / substeps, u);
    {low}_derivatives(x, u, parameters, k[0]);
    ahead(x, 0.5 * h, k[0], moved);
    between(before, after, (s + 0.5) / substeps, u);
    {low}_derivatives(moved, u, parameters, k[1]);
    ahead(x, 0.5 * h, k[1], moved);
    {low}_derivatives(moved, u, parameters, k[2]);
    ahead(x, h, k[2], moved);
    between(before, after, (s + 1.0) / substeps, u);
    {low}_derivatives(moved, u, parameters, k[3]);
    for (int i = 0; i < {UP}_STATES; i++)
      x[i] += h * (k[0][i] / 6.0 + k[1][i] / 3.0 + k[2][i] / 3.0 + k[3][i] / 6.0);
  }}
  for (int i = 0; i < {UP}_STATES; i++)
    if (!(fabs(x[i]) < limits[i])) return {UP}_DIVERGED;
  for (int i = 0; i < {UP}_STATES; i++) state[i] = x[i];
  return {low}_unseen(state, after);
}}
"""


def c_texts(made: FittedModel, name: str) -> dict[str, str]:
    """The source and its header by their suffixes; functions begin with the name of the file."""
    low = own_name(name).lower()
    names = {"low": low, "UP": low.upper()}
    header = HEADER.format(
        **names,
        nx=len(made.equations.states),
        nu=len(made.inputs),
        ny=len(made.equations.outputs),
        np=len(made.parameters),
        period=f"{made.period:g}",
        lists=_lists(made),
    )
    eq = made.equations
    rates, sensed = (program(eq, made.model, list(x)) for x in (eq.f, eq.outputs.values()))
    lines = [
        *_head(made),
        "",
        "#include <math.h>",
        "",
        f'#include "{name}.h"',
        "",
        *_tables(made, low),
        "",
        *_function(made, rates, f"{low}_derivatives", "rates"),
        "",
        *_function(made, sensed, f"{low}_outputs", "outputs"),
        "",
        STEPPING.format(**names),
    ]
    return {".c": "\n".join(lines), ".h": header}


def _head(made: FittedModel) -> Iterator[str]:
    """Where it comes from and what to know of it, as a comment."""
    words = [f"{made.name}: the ship model that a run of trialid fitted."]
    words += [f"{key.replace('_', ' ')}: {said}" for key, said in made.origin.items()]
    words += [f"NOTE {said}" for said in made.words]
    for place, said in enumerate(words):
        yield from _comment(said, "/* " if place == 0 else "   ")
    yield "*/"


def _comment(words: str, first: str) -> list[str]:
    """Lines of a comment that nothing in a name can end."""
    safe = words.replace("*/", "* /").replace("/*", "/ *").replace("\\", "/").replace("??", "? ?")
    return textwrap.wrap(safe, initial_indent=first, subsequent_indent="     ", **WRAP)


def _lists(made: FittedModel) -> str:
    """States, inputs and outputs with their units, in the order of the arrays."""
    lines = []
    groups = {
        "states": made.equations.states,
        "inputs": made.inputs,
        "outputs": tuple(made.equations.outputs),
    }
    for group, names in groups.items():
        each = [f"{n} [{made.quantity(n).unit}]" for n in names]
        lines += [*_comment(f"{group}: {', '.join(each)}", "/* ")]
        lines[-1] += " */"
    return "\n".join(lines)


def _tables(made: FittedModel, low: str) -> Iterator[str]:
    eq = made.equations
    tables = {
        "state": eq.states,
        "input": made.inputs,
        "output": tuple(eq.outputs),
        "parameter": [p.name for p in made.parameters],
    }
    for what, names in tables.items():
        listed = ", ".join(f'"{n}"' for n in names) or "0"
        yield from _long(f"const char *const {low}_{what}_names[] = {{{listed}}};")
    yield f"const double {low}_parameters[] = {{"
    for p in made.parameters:
        yield f"  {p.value!r},  /* {p.name} [{p.unit}] {_sure(p.likely, fitted=p.fitted)} */"
    yield "};"
    yield f"const double {low}_seen[][2] = {{"
    for name in (*eq.states, *made.inputs):
        seen = made.seen.get(name)
        ends = (-ENDLESS, ENDLESS) if seen is None else (seen.low, seen.high)
        yield f"  {{{ends[0]!r}, {ends[1]!r}}},  /* {name} */"
    yield "};"
    bounds = [x if isfinite(x) else ENDLESS for x in domain(made.model).tolist()]
    yield from _long(f"static const double limits[] = {{{', '.join(map(repr, bounds))}}};")


def _sure(likely: tuple[float, float] | None, *, fitted: bool) -> str:
    if likely is None:
        return "fitted, nobody knows how sure" if fitted else "held fixed"
    return f"fitted, likely {likely[0]:.4g} to {likely[1]:.4g}"


def _long(line: str) -> list[str]:
    return textwrap.wrap(line, subsequent_indent="    ", **WRAP)


def _function(made: FittedModel, what: Program, name: str, result: str) -> Iterator[str]:
    """One function of state, inputs and parameters, a line a step."""
    write = Writer(what, _call)
    yield f"void {name}(const double state[], const double inputs[], const double parameters[],"
    yield f"    double {result}[]) {{"
    yield from (f"  (void){array};" for array in ("state", "inputs", "parameters"))
    arrays = {
        "state": made.equations.states,
        "inputs": made.inputs,
        "parameters": tuple(p.name for p in made.parameters),
    }
    for array, names in arrays.items():
        for place, one in enumerate(names):
            if one in what.used:
                yield f"  const double {own_name(one)} = {array}[{place}];"
    for step in what.steps:
        if step.remark:
            lines = _comment(step.remark, "  /* ")
            yield from (*lines[:-1], f"{lines[-1]} */")
        yield from _assignment(f"const double {step.name}", write.step(step))
    for place, node in enumerate(what.results):
        yield from _assignment(f"{result}[{place}]", write.result(node))
    yield "}"


def _assignment(name: str, text: str) -> list[str]:
    line = f"{name} = {text};"
    return textwrap.wrap(line, initial_indent="  ", subsequent_indent="      ", **WRAP)


def _call(op: str, args: Sequence[str]) -> str:
    match op:
        case "clip":
            return f"fmin(fmax({args[0]}, -({args[1]})), {args[1]})"
        case "inside":
            return f"(fabs({args[0]}) < {args[1]} ? 1.0 : 0.0)"
        case "sign":
            return f"copysign(1.0, {args[0]})"
    return f"{FUNCTIONS.get(op, op)}({', '.join(args)})"
