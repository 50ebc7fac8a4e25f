"""The limit that C sets: the same equations written as C, compiled on the spot by gcc.

A real competitor, not a straw man: the layout is the one that was fastest by hand. Per step the
four stages evaluate f and the nonzeros of J, W and G once; then whole blocks of eight columns go
through the RK4 step in vector registers, with runs of alike blocks in one loop, structure of arrays
throughout. Of the ways to compile it, the one that turns out fastest counts.
"""

import ctypes
import shutil
import subprocess
from collections.abc import Callable, Mapping
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from trialid.simulation.graph import CONSTANT, SYMBOL, Node, order
from trialid.simulation.trace import BLOCK, Equations

Vector = NDArray[np.float64]
Run = Callable[[], int]

FLAGS = ("-O3", "-march=native", "-ffast-math")
WAYS: Mapping[str, tuple[str, ...]] = {
    " ".join(FLAGS): FLAGS,
    " ".join(FLAGS) + " -fno-tree-slp-vectorize": (*FLAGS, "-fno-tree-slp-vectorize"),
}
"""gcc 12 packs scalars of the stages into short vectors, which costs a fifth; hence two ways."""

FUNCTIONS = {"abs": "fabs", "arctan": "atan"}
SOURCE = """\
#include <math.h>
#include <string.h>
typedef double V __attribute__((vector_size(64)));
typedef double M __attribute__((vector_size(64), may_alias));
enum {{ n_x = {n_x}, n_u = {n_u}, width = {width}, kept = {kept} }};
#define ROW __attribute__((aligned(64))) static double

long sens(long N, long sub, double h, const double *restrict theta, const double *restrict u,
          const double *restrict limit, double *restrict X, double *restrict S)
{{
    {fixed}
    double x[n_x], k[n_x], t[n_x], j[4][{n_j}];
    ROW s[n_x][width]; ROW g[4][n_x][width];
    memset(s, 0, sizeof s); memset(g, 0, sizeof g);
    for (int i = 0; i < n_x; i++) {{ x[i] = X[i]; s[i][{free} + i] = 1.0; }}
    const double step = h / sub, share = 1.0 / sub, half = step / 2, sixth = step / 6;
    const double reach[4] = {{0, half, half, step}}, ahead[4] = {{0, 0.5, 0.5, 1}};
    const double weight[4] = {{sixth, 2 * sixth, 2 * sixth, sixth}};
    for (long m = 0; m < N; m++) {{
        const double *u0 = u + m * n_u, *u1 = u0 + n_u;
        for (long b = 0; b < sub; b++) {{
            for (int i = 0; i < n_x; i++) k[i] = t[i] = 0;
            for (int q = 0; q < 4; q++) {{
                const double along = (b + ahead[q]) * share;
                {stage}
            }}
            for (int i = 0; i < n_x; i++) x[i] += t[i];
            {columns}
        }}
        double *to = X + (m + 1) * n_x;
        int inside = 1;
        for (int i = 0; i < n_x; i++) {{ to[i] = x[i]; inside &= fabs(x[i]) < limit[i]; }}
        {copies}
        if (!inside) return m + 1;
    }}
    return 0;
}}
"""


def available() -> bool:
    """Whether there is a gcc."""
    return shutil.which("gcc") is not None


def source(eq: Equations) -> str:
    """The kernel as C."""
    moving_W = [k for k, w in sorted(eq.W.items()) if w.moving]
    copies = (
        f"memcpy(S + ((m + 1) * kept + {n}) * width, s[{i}], sizeof s[{i}]);"
        for n, i in enumerate(eq.kept)
    )
    return SOURCE.format(
        n_x=len(eq.states), n_u=len(eq.inputs), width=eq.columns, kept=len(eq.kept),
        free=len(eq.free), n_j=max(len(eq.J) + len(moving_W), 1),
        fixed="\n    ".join(_fixed(eq)), stage="\n                ".join(_stage(eq)),
        columns="\n            ".join(_columns(eq)), copies="\n        ".join(copies),
    )  # fmt: skip


def _nodes(eq: Equations) -> list[Node]:
    return order([*eq.f, *eq.J.values(), *eq.W.values(), *(g for d in eq.G for g in d.values())])


def _name(node: Node) -> str:
    return f"({node.value!r})" if node.op == CONSTANT else f"a{node.index}"


def _expression(node: Node) -> str:
    args = [_name(a) for a in node.args]
    if node.op in "+-*/":
        return f"{args[0]} {node.op} {args[1]}"
    match node.op:
        case "clip":
            return f"fmin(fmax({args[0]}, -{args[1]}), {args[1]})"
        case "inside":
            return f"fabs({args[0]}) < {args[1]} ? 1.0 : 0.0"
        case "sign":
            return f"copysign(1.0, {args[0]})"
    return f"{FUNCTIONS.get(node.op, node.op)}({args[0]})"


def _fixed(eq: Equations) -> list[str]:
    """What depends on the parameters alone, once for the whole run."""
    lines = []
    for node in _nodes(eq):
        if node.moving or node.op == CONSTANT:
            continue
        at = f"theta[{eq.parameters.index(node.value)}]" if node.op == SYMBOL else _expression(node)
        lines.append(f"const double {_name(node)} = {at};")
    return lines


def _stage(eq: Equations) -> list[str]:
    """f, J, W and G at one stage."""
    lines = []
    for node in _nodes(eq):
        if node.moving:
            at = _moved(eq, node.value) if node.op == SYMBOL else _expression(node)
            lines.append(f"const double {_name(node)} = {at};")
    numbers = [*eq.J.values(), *(w for _, w in sorted(eq.W.items()) if w.moving)]
    lines += [f"j[q][{n}] = {_name(node)};" for n, node in enumerate(numbers)]
    for c, drive in enumerate(eq.G):
        lines += [f"g[q][{row}][{c}] = {_name(node)};" for row, node in drive.items()]
    return lines + [
        f"k[{i}] = {_name(f)}; t[{i}] += weight[q] * k[{i}];" for i, f in enumerate(eq.f)
    ]


def _moved(eq: Equations, name: str) -> str:
    if name in eq.states:
        i = eq.states.index(name)
        return f"x[{i}] + reach[q] * k[{i}]"
    i = eq.inputs.index(name)
    return f"u0[{i}] + along * (u1[{i}] - u0[{i}])"


def _columns(eq: Equations) -> list[str]:
    """The RK4 step of all columns, one loop for each run of blocks that drive the same rows."""
    blocks = [
        {row for drive in eq.G[c : c + BLOCK] for row in drive} for c in range(0, eq.columns, BLOCK)
    ]
    lines, start = [], 0
    for rows, run in groupby(blocks):
        stop = start + BLOCK * len(list(run))
        lines.append(f"for (int c = {start}; c < {stop}; c += {BLOCK}) {{")
        lines += _block(eq, rows)
        lines.append("}")
        start = stop
    return lines


def _block(eq: Equations, rows: set[int]) -> list[str]:
    all_x = range(len(eq.states))
    lines = [f"V s{i} = *(M *)&s[{i}][c], y{i} = s{i}, t{i};" for i in all_x]
    for q in range(4):
        slopes = _slopes(eq, rows, q)
        lines += [f"V k{q}{i} = {slopes[i]};" for i in all_x]
        twice = "" if q in (0, 3) else " * 2.0"
        before = [f"t{i} + " if q else "" for i in all_x]
        lines += [f"t{i} = {before[i]}k{q}{i}{twice};" for i in all_x]
        if q < 3:
            lines += [f"y{i} = s{i} + {'half' if q < 2 else 'step'} * k{q}{i};" for i in all_x]
    return lines + [f"*(M *)&s[{i}][c] = s{i} + sixth * t{i};" for i in all_x]


def _slopes(eq: Equations, rows: set[int], stage: int) -> list[str]:
    """J s + W G of one block at one stage, row by row."""
    terms: list[list[str]] = [[] for _ in eq.states]
    for n, (i, column) in enumerate(eq.J):
        terms[i].append(f"j[{stage}][{n}] * y{column}")
    moving = [k for k, w in sorted(eq.W.items()) if w.moving]
    for (i, row), w in sorted(eq.W.items()):
        if row not in rows:
            continue
        n = len(eq.J) + moving.index((i, row)) if w.moving else 0
        factor = f"j[{stage}][{n}]" if w.moving else _name(w)
        terms[i].append(
            f"{'' if w.is_constant(1.0) else f'{factor} * '}*(M *)&g[{stage}][{row}][c]"
        )
    return [" + ".join(t) or f"s{i} * 0.0" for i, t in enumerate(terms)]


def compile_c(text: str, flags: tuple[str, ...], folder: Path) -> Any:
    """The compiled function `sens`."""
    file = folder / f"limit{len(list(folder.iterdir()))}.c"
    file.write_text(text)
    library = file.with_suffix(".so")
    command = ["gcc", *flags, "-shared", "-fPIC", "-o", library, file, "-lm"]
    subprocess.run(command, check=True)
    function = ctypes.CDLL(str(library)).sens
    function.restype = ctypes.c_long
    function.argtypes = [ctypes.c_long, ctypes.c_long, ctypes.c_double, *[ctypes.c_void_p] * 5]
    return function
