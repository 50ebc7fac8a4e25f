"""A ready-to-edit effect file for a force that the catalogue does not hold."""

from collections.abc import Sequence
from typing import Final

import numpy as np

from trialid.diagnosis.force.force_shape import ShapeTerm
from trialid.diagnosis.force.missing_force import WORDS, Equation, MissingForce
from trialid.names import units
from trialid.names.quantities import SIGNALS

NAMES: Final = {"X": "surge", "Y": "sway", "K": "roll", "N": "yaw"}


def draft(found: MissingForce, pipeline: str) -> str | None:
    """The text of an effect file, None where nothing is missing that follows a signal.

    One function for each equation that the record cannot tell apart.
    """
    shaped = [found.equation(r) for r in found.possible if found.equation(r).shape.terms]
    if not shaped:
        return None
    functions = [_function(found, e) for e in shaped]
    return "\n\n".join([_head(found, shaped, pipeline), *functions])


def why_none(found: MissingForce) -> str:
    """Why there is nothing to draft, in one line."""
    if not found.possible:
        return f"nothing to draft: {found.sentence}"
    names = " or ".join(f"{WORDS[r]} {r}" for r in found.possible)
    return (
        f"nothing to draft: a {names} is missing, but it follows no signal of the record "
        "(wind, waves, a tug, a sensor)"
    )


def _head(found: MissingForce, shaped: Sequence[Equation], pipeline: str) -> str:
    imports = ["from trialid.ship.effect import Force, Parameter, effect"]
    functions = sorted(
        {f for e in shaped for t in e.shape.terms for f in ("sin", "cos") if f"{f}(" in t.term.text}
    )
    if functions:
        imports.insert(0, f"from trialid.maths import {', '.join(functions)}")
    names = [_name(found, e) for e in shaped]
    parameters = [_parameter(found, t) for e in shaped for t in e.shape.terms]
    apart = "" if len(shaped) == 1 else (
        "\nThis record cannot tell the equations below apart: try one at a time.\n"
    )  # fmt: skip
    return "\n".join([
        '"""A force that no known effect makes, drafted by `trialid run --draft`.',
        "",
        f"From the pipeline {_plain(pipeline)!r}.",
        "To try it, name this file in the pipeline and free what it brings with it:",
        "",
        "    [model]",
        f"    effects      = [..., {', '.join(_quoted(n) for n in names)}]",
        '    effects_from = ["this_file.py"]',
        "    [identify]",
        f"    free         = [..., {', '.join(_quoted(p) for p in parameters)}]",
        apart,
        "The terms are what fits, not what is: replace them by the physics that you think of.",
        '"""',
        "",
        *imports,
    ])  # fmt: skip


def _function(found: MissingForce, e: Equation) -> str:
    terms = e.shape.terms
    reads = [s for s in (*SIGNALS, "U0") if any(s in t.term.signals for t in terms)]
    names = [_parameter(found, t) for t in terms]
    formula = " + ".join(f"{n} {t.term.words}" for n, t in zip(names, terms, strict=True))
    product = " + ".join(
        n if not t.term.factors else f"{n} * {t.term.text}"
        for n, t in zip(names, terms, strict=True)
    )
    values = [f"    {n}={_typical(t)}," for n, t in zip(names, terms, strict=True)]
    return "\n".join([
        *_comments(found, e),
        '@effect(source="drafted from a sea trial; no theory behind it yet")',
        f"def {_name(found, e)}(",
        *([f"    {', '.join(reads)},"] if reads else []),
        "    *,",
        *values,
        "):",
        f'    """{e.row} = {formula}: drafted.',
        "",
        "    Primed: forces over 1/2 rho L^2 U^2, moments over 1/2 rho L^3 U^2,",
        "    speeds over U, rates over U/L.",
        *[f"    {line}" for line in _ranges(e, reads)],
        '    """',
        f"    return Force({e.row}={product})",
        "",
    ])  # fmt: skip


def _comments(found: MissingForce, e: Equation) -> list[str]:
    """What is known and what is not."""
    lines = [
        f"Known: a {WORDS[e.row]} takes up {e.explains:.1%} of the squared error (p = "
        f"{e.p_value:.2g}); the terms below take up {e.shape.explains:.1%}.",
    ]
    for t in e.shape.terms:
        lines.append(
            f"  {t.term.words}: {t.coefficient:.3g} +- {t.error:.2g}, {t.term.mirror} in the mirror"
            f", {t.share:.1%} of the squared error (p = {t.p_value:.2g})."
        )
        if t.rivals:
            rivals = ", ".join(r.words for r in t.rivals)
            lines.append(f"  Not known: nearly as good in its place would be {rivals}.")
    others = [x for x in found.possible if x != e.row]
    if others:
        lines.append(f"Not known: a force in {' or '.join(others)} would do as well.")
    if found.free:
        lines.append(
            f"Not seen: what the free parameters {', '.join(found.free)} can take by changing."
        )
    return [piece for line in lines for piece in _wrapped(line)]


def _wrapped(line: str, width: int = 96) -> list[str]:
    """A comment of several lines, each ending at a space."""
    import textwrap

    indent = "    " if line.startswith("  ") else "  "
    return textwrap.wrap(
        line, width, initial_indent="# " + line[: len(line) - len(line.lstrip())],
        subsequent_indent="# " + indent, break_long_words=False, break_on_hyphens=False,
    )  # fmt: skip


def _ranges(e: Equation, reads: Sequence[str]) -> list[str]:
    """How far the record went: beyond it the terms are a guess."""
    said = []
    for s in reads:
        if s in SIGNALS:
            factor, unit = units.shown_factor(SIGNALS[s]), SIGNALS[s].shown
            every = np.concatenate([c.signals[s] for c in e.courses]) * factor
            said.append(f"{s} {every.min():.3g} to {every.max():.3g} {unit}")
    return [f"Seen for {', '.join(said)}; a guess beyond."] if said else []


def _typical(t: ShapeTerm) -> str:
    """A start with a range of five standard errors, or of its own size, either way."""
    reach = max(5.0 * t.error, abs(t.coefficient))
    low, high = t.coefficient - reach, t.coefficient + reach
    return f"Parameter({t.coefficient:.4g}, low={low:.2g}, high={high:.2g})"


def _name(found: MissingForce, e: Equation) -> str:
    """A name that the model does not have yet."""
    return _fresh(f"missing_{NAMES[e.row]}", found.effects)


def _parameter(found: MissingForce, t: ShapeTerm) -> str:
    return _fresh(t.name, found.parameters)


def _fresh(name: str, taken: Sequence[str]) -> str:
    made, count = name, 2
    while made in taken:
        made, count = f"{name}_{count}", count + 1
    return made


def _quoted(name: str) -> str:
    return f'"{name}"'


def _plain(text: str) -> str:
    """Text that may stand in a docstring."""
    return " ".join(text.replace("\\", "/").replace('"', "'").split())
