"""A ship model as graph expressions: what a kernel or the reference needs, derived once."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Final

from trialid.errors import EffectError
from trialid.ship.mass_matrix import solve
from trialid.ship.model import ShipModel
from trialid.ship.motion import Motion, motion
from trialid.ship.readings import Readings, readings
from trialid.simulation.graph import SYMBOL, Graph, Node, gradient, lift, order

BLOCK: Final = 8
"""Sensitivity columns that move together through one integration step."""


@dataclass(frozen=True)
class Equations:
    """Expressions of one model structure; parameters, inputs and initial states stay symbols.

    With the mass matrix M, the right-hand sides R and W = M^-1, the sensitivity s_c of the states
    to parameter c follows  ds_c/dt = J s_c + W G_c,  where G_c = dR/dc - (dM/dc) dx/dt is sparse.

    Attributes
    ----------
    states, inputs, parameters
        Names in the order of the run-time arrays; `parameters` leaves out those fixed at zero.
    free
        Parameters with a sensitivity, ordered so that neighbours drive the same equations.
    f
        Time derivative of each state; (n_x,).
    J
        Structural nonzeros (i, j) -> df_i/dx_j.
    W
        Nonzeros (i, row) -> how a row of G drives state i.
    G
        Per free parameter the nonzeros row -> expression.
    outputs
        Output name to its measured value, before delay.
    delays, lags
        Output name to its delay [s], and to the time constants of its sensor's low-passes [s].
    """

    graph: Graph
    states: tuple[str, ...]
    inputs: tuple[str, ...]
    parameters: tuple[str, ...]
    free: tuple[str, ...]
    f: tuple[Node, ...]
    J: Mapping[tuple[int, int], Node]
    W: Mapping[tuple[int, int], Node]
    G: tuple[Mapping[int, Node], ...]
    outputs: Mapping[str, Node]
    delays: Mapping[str, Node]
    lags: Mapping[str, tuple[Node, ...]]

    @property
    def kept(self) -> tuple[int, ...]:
        """States that the outputs depend on, in the order in which outputs ask for them."""
        asked = [n.value for c in self.outputs.values() for n in order([c]) if n.op == SYMBOL]
        return tuple(self.states.index(s) for s in dict.fromkeys(asked) if s in self.states)

    @property
    def columns(self) -> int:
        """Sensitivity columns, with those of the initial states, padded to whole blocks."""
        count = len(self.free) + len(self.states)
        return -(-count // BLOCK) * BLOCK


def trace(model: ShipModel, free: Sequence[str], outputs: Sequence[str]) -> Equations:
    """The model's equations with exact sensitivities to `free`.

    Raises
    ------
    EffectError
        A free parameter no effect has; an effect that branches or leaves trialid.maths.
    """
    graph = Graph()
    x = {s: graph.symbol(s, True) for s in model.all_states}
    inputs = {s: graph.symbol(s, True) for s in model.recorded}
    theta = _parameters(graph, model, free)
    now = _traced(model, x, inputs, theta)
    rows = tuple(now.balance.force)
    inverse = {k: lift(graph, w) for k, w in solve(now.balance, rows).items()}
    right = {s: lift(graph, r) for s, r in (*now.balance.force.items(), *now.rates.items())}
    f = _state_rates(graph, model, right, inverse, rows)
    sensed = _sensed(model, x, inputs, theta, f)
    names, given = model.all_states, list(free)
    W = {(names.index(a), names.index(b)): w for (a, b), w in inverse.items() if a in rows}
    W |= {(i, i): graph.constant(1.0) for i, s in enumerate(names) if s not in rows}
    mass = {k: lift(graph, m) for k, m in now.balance.mass.items()}
    symbols = [lift(graph, theta[n]) for n in free] + [x[s] for s in names]
    found = _drives(names, right, mass, f, symbols)
    G, drives = dict(zip(free, found, strict=False)), found[len(free) :]
    ordered = tuple(sorted(free, key=lambda n: (sorted(G[n]), given.index(n))))
    return Equations(
        graph=graph,
        states=names,
        inputs=model.recorded,
        parameters=tuple(n for n, node in theta.items() if isinstance(node, Node)),
        free=ordered,
        f=tuple(f[s] for s in names),
        J=_jacobian(graph, W, drives),
        W=W,
        G=tuple(G[n] for n in ordered),
        outputs={c: _output(graph, model, sensed.measured, c) for c in outputs},
        delays={c: lift(graph, sensed.delay.get(c, 0.0)) for c in outputs},
        lags={c: tuple(lift(graph, x) for x in sensed.lags.get(c, ())) for c in outputs},
    )


@contextmanager
def _differentiable() -> Iterator[None]:
    """Say in words what an effect did that has no derivative."""
    try:
        yield
    except TypeError as error:
        raise EffectError(
            f"an effect does what cannot be differentiated ({error}); without branches, min and "
            "max, use abs and trialid.maths (sin, cos, sqrt, exp, tanh, arctan, clip)"
        ) from error


def _traced(
    model: ShipModel,
    states: Mapping[str, Node],
    inputs: Mapping[str, Node],
    theta: Mapping[str, Node | float],
) -> Motion:
    with _differentiable():
        return motion(model, states, inputs, theta)


def _sensed(
    model: ShipModel,
    states: Mapping[str, Node],
    inputs: Mapping[str, Node],
    theta: Mapping[str, Node | float],
    rates: Mapping[str, Node],
) -> Readings:
    with _differentiable():
        return readings(model, states, inputs, theta, rates)


def _parameters(graph: Graph, model: ShipModel, free: Sequence[str]) -> dict[str, Node | float]:
    """A symbol for each parameter; those fixed at zero vanish from the equations."""
    for name in free:
        if name not in model.parameters:
            raise EffectError(f"free parameter {name!r} is in no effect of the model")
    fixed_zero = {n for n in model.parameters if n not in free and model.value(n) == 0.0}
    return {n: 0.0 if n in fixed_zero else graph.symbol(n, False) for n in model.parameters}


def _state_rates(
    graph: Graph,
    model: ShipModel,
    right: Mapping[str, Node],
    inverse: Mapping[tuple[str, str], Node],
    rows: tuple[str, ...],
) -> dict[str, Node]:
    rates: dict[str, Node] = {}
    for state in model.all_states:
        if state not in rows:
            rates[state] = right[state]
            continue
        total = graph.constant(0.0)
        for row in rows:
            if (state, row) in inverse:
                total = total + inverse[state, row] * right[row]
        rates[state] = total
    return rates


def _drives(
    names: tuple[str, ...],
    right: Mapping[str, Node],
    mass: Mapping[tuple[str, str], Node],
    f: Mapping[str, Node],
    symbols: Sequence[Node],
) -> list[dict[int, Node]]:
    """Nonzeros of dR/ds - (dM/ds) dx/dt by row, for each symbol s; one reverse pass a row."""
    found: list[dict[int, Node]] = [{} for _ in symbols]
    for i, row in enumerate(names):
        totals = gradient(right[row], symbols)
        for (a, b), m in mass.items():
            if a == row:
                slopes = gradient(m, symbols)
                totals = [t - s * f[b] for t, s in zip(totals, slopes, strict=True)]
        for drive, total in zip(found, totals, strict=True):
            if not total.is_constant(0.0):
                drive[i] = total
    return found


def _jacobian(
    graph: Graph, W: Mapping[tuple[int, int], Node], drives: Sequence[Mapping[int, Node]]
) -> dict[tuple[int, int], Node]:
    J: dict[tuple[int, int], Node] = {}
    for (i, row), w in W.items():
        for j, drive in enumerate(drives):
            if row in drive:
                J[i, j] = J.get((i, j), graph.constant(0.0)) + w * drive[row]
    return {k: J[k] for k in sorted(J) if not J[k].is_constant(0.0)}


NEEDS_MOTION: Final = {
    "a_x": "; it needs u simulated, v and r",
    "a_y": "; it needs v simulated, r and phi: an accelerometer feels gravity in a heel",
}


def _output(graph: Graph, model: ShipModel, measured: Mapping[str, object], name: str) -> Node:
    if name not in measured:
        states = ", ".join(model.all_states)
        raise EffectError(
            f"output {name!r} is not simulated; simulated states: {states}"
            f"{NEEDS_MOTION.get(name, '')}"
        )
    return lift(graph, measured[name])
