"""The equations of a model as a list of named steps, for texts in any language.

The names are those of the physics: the force of each effect, the totals, the mass matrix. They are
found by evaluating the model's parts once more on the same graph, where what is equal is one node.
"""

import keyword
import re
from collections import Counter
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final

from trialid.names.quantities import SIGNALS
from trialid.ship.effect import Force
from trialid.ship.model import ShipModel, late, slope
from trialid.ship.motion import acting_signals, effect_parts, motion
from trialid.ship.prime import prime_signal
from trialid.ship.rigid_body import ROWS
from trialid.simulation.graph import CONSTANT, SYMBOL, Node, order
from trialid.simulation.trace import Equations

LEVELS: Final = {"+": 1, "-": 1, "*": 2, "/": 2}
ATOM: Final = 9
SHORT: Final = 3
"""Operations up to which something used twice is written twice."""
C_WORDS: Final = (
    "auto break case char const continue default do double else enum extern float for goto if "
    "inline int long register restrict return short signed sizeof static struct switch typedef "
    "union unsigned void volatile while"
)
C_FUNCTIONS: Final = (
    "fabs sqrt sin cos exp tanh atan fmin fmax copysign y0 y1 yn j0 j1 jn gamma NAN INFINITY"
)
MODELICA_WORDS: Final = (
    "algorithm and annotation block class connect connector constant constrainedby der discrete "
    "each elseif elsewhen encapsulated end enumeration equation expandable external false final "
    "flow function impure initial inner input loop model not operator or outer output package "
    "parameter partial protected public pure record redeclare replaceable stream then true type "
    "when within"
)
MODELICA_FUNCTIONS: Final = (
    "abs acos asin assert atan2 cardinality ceil change cosh cross delay diagonal div edge fill "
    "floor homotopy identity inStream integer linspace log log10 matrix max min mod ndims noEvent "
    "ones outerProduct pre product reinit rem sample scalar semiLinear sign sinh size skew smooth "
    "spatialDistribution sum symmetric tan terminal terminate time transpose vector zeros Boolean "
    "Integer Real String"
)
OURS: Final = "np state inputs parameters rates outputs found unseen"
RESERVED: Final = frozenset(
    f"{C_WORDS} {C_FUNCTIONS} {MODELICA_WORDS} {MODELICA_FUNCTIONS} {OURS}".split()
)
"""What no step may be called in any of the languages."""


@dataclass(frozen=True)
class Step:
    """One named number: how it follows from those before, and what it is, where that is new."""

    name: str
    node: Node
    remark: str = ""


@dataclass(frozen=True)
class Program:
    """Steps in their order, and how each result is called or written."""

    steps: tuple[Step, ...]
    names: Mapping[int, str]
    results: tuple[Node, ...]
    used: frozenset[str]


def program(equations: Equations, model: ShipModel, results: Sequence[Node]) -> Program:
    """The steps to these results; `used` are the symbols that they need."""
    needed = order(results)
    symbols = {n.value: n for n in needed if n.op == SYMBOL}
    names = {n.index: own_name(n.value) for n in symbols.values()}
    names |= {symbols[s].index: "0.0" for s in _shifts(model) if s in symbols}
    taken = {*names.values()}
    remarks = dict[int, str]()
    for node, name, remark in _physics(equations, model):
        if node.op not in (CONSTANT, SYMBOL) and node.index not in names:
            names[node.index] = _free_name(name, taken)
            remarks[node.index] = remark
    shared = _shared(needed, names)
    steps, last = [], ""
    for node in needed:
        if node.index in shared:
            names[node.index] = _free_name("w", taken)
        if node.index in names and node.op != SYMBOL:
            remark = remarks.get(node.index, "")
            steps.append(Step(names[node.index], node, remark if remark != last else ""))
            last = remark or last
    return Program(tuple(steps), names, tuple(results), frozenset(symbols))


def _shared(needed: Sequence[Node], names: Mapping[int, str]) -> set[int]:
    """Nodes without a name that are used more than once and are too long to be written twice."""
    uses = Counter(argument.index for node in needed for argument in node.args)
    sizes, found = dict[int, int](), set[int]()
    for node in needed:
        own = 0 if node.op in (CONSTANT, SYMBOL) else 1
        sizes[node.index] = own + sum(sizes[a.index] for a in node.args)
        if node.index not in names and uses[node.index] > 1 and sizes[node.index] > SHORT:
            found.add(node.index)
        if node.index in names or node.index in found:
            sizes[node.index] = 0
    return found


def own_name(name: str) -> str:
    """A name that is one in Python and in C.

    >>> own_name("Yv"), own_name("lambda"), own_name("a b")
    ('Yv', 'lambda_', 'a_b')
    """
    word = re.sub(r"\W", "_", name, flags=re.ASCII)
    if keyword.iskeyword(word) or word in RESERVED or not word[:1].isalpha():
        word = f"{word}_" if word[:1].isalpha() else f"s{word}"
    return word


def _shifts(model: ShipModel) -> Iterator[str]:
    for signal in model.late_inputs:
        yield from (late(signal), slope(signal))


def _free_name(name: str, taken: set[str]) -> str:
    word, count = own_name(name), 1
    while word in taken or (name == "w" and count == 1):
        word, count = f"{own_name(name)}{'' if name == 'w' else '_'}{count}", count + 1
    taken.add(word)
    return word


def _physics(equations: Equations, model: ShipModel) -> Iterator[tuple[Node, str, str]]:
    """Nodes that have a name in the physics, with the name and what it is."""
    graph = equations.graph
    x = {s: graph.symbol(s, True) for s in equations.states}
    inputs = {s: graph.symbol(s, True) for s in equations.inputs}
    theta = {n: 0.0 for n in model.parameters} | {
        n: graph.symbol(n, False) for n in equations.parameters
    }
    acting = acting_signals(model, x, inputs, theta)
    yield from _nodes([(acting["U"], "U", "speed through the water")])
    p, U = model.ship.particulars, acting["U"]
    for name in (n for n in acting if n in SIGNALS and n != "U"):
        node = prime_signal(name, acting[name], p["L"], U)
        yield from _nodes([(node, f"{name}_prime", "primed: over U, or U / L")])
    scale = 0.5 * p["rho"] * p["L"] * p["L"] * (U * U)
    yield from _nodes([(scale, "q", "1/2 rho L^2 U^2, what primed forces are multiplied by")])
    for effect, part in effect_parts(model, x, inputs, theta):
        what = f"{effect.name}: {effect.equation}"
        if isinstance(part, Force):
            named = [(n, f"{row}_{effect.name}", what) for row, n in part._asdict().items()]
        else:
            named = [(n, f"d_{state}", what) for state, n in part.items()]
        yield from _nodes(named)
    whole = motion(model, x, inputs, theta)
    matrix, right = whole.balance
    balance = "rigid body: mass matrix M, right-hand sides R"
    yield from _nodes((n, f"M_{a}{b}", balance) for (a, b), n in matrix.items())
    yield from _nodes((n, f"R_{ROWS[a]}", balance) for a, n in right.items())
    solved = "solved for the accelerations: W = M^-1"
    for (i, j), n in equations.W.items():
        rows = equations.states[i], equations.states[j]
        yield from _nodes([(n, f"W_{rows[0]}{rows[1]}", solved)])
    rates = zip(equations.f, equations.states, strict=True)
    yield from _nodes((n, f"d_{s}", solved) for n, s in rates)


def _nodes(named: Iterable[tuple[object, str, str]]) -> Iterator[tuple[Node, str, str]]:
    for node, name, remark in named:
        if isinstance(node, Node):
            yield node, name, remark


Call = Callable[[str, Sequence[str]], str]
"""How a language writes a function of these arguments."""


@dataclass(frozen=True)
class Writer:
    """Expressions of a program in one language; operations keep their order, digit for digit."""

    program: Program
    call: Call

    def step(self, step: Step) -> str:
        """The right-hand side of a step."""
        return self._expression(step.node)[0]

    def result(self, node: Node) -> str:
        """A result by its name, or written out."""
        return self._operand(node)[0]

    def _operand(self, node: Node) -> tuple[str, int]:
        if node.index in self.program.names:
            return self.program.names[node.index], ATOM
        return self._expression(node)

    def _expression(self, node: Node) -> tuple[str, int]:
        if node.op == CONSTANT:
            text = repr(float(node.value))
            return (text, ATOM) if node.value >= 0.0 else (f"({text})", ATOM)
        if node.op not in LEVELS:
            return self.call(node.op, [self._operand(a)[0] for a in node.args]), ATOM
        level = LEVELS[node.op]
        (left, l_level), (right, r_level) = (self._operand(a) for a in node.args)
        left = f"({left})" if l_level < level else left
        right = f"({right})" if r_level <= level else right
        return f"{left} {node.op} {right}", level
