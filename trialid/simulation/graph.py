"""Expressions as a graph: traced from plain functions, differentiated symbolically.

Equal expressions are one node (hash-consing), so that common parts are computed once and the text
generated from a graph is the same on every run.
"""

import math
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Final

from trialid.errors import EffectError

SYMBOL: Final = "symbol"
CONSTANT: Final = "constant"
UNARY: Final = ("abs", "sign", "sqrt", "sin", "cos", "exp", "tanh", "arctan")
SWITCHES: Final = ("sign", "inside")  # derivative zero wherever there is one


class Graph:
    """A table of nodes; make symbols here, and operators do the rest."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self._table: dict[tuple[Any, ...], Node] = {}

    def symbol(self, name: str, moving: bool) -> "Node":
        """A named leaf; `moving` says that it changes during a simulation."""
        return self.node(SYMBOL, (), name, moving)

    def constant(self, value: float) -> "Node":
        """A number."""
        return self.node(CONSTANT, (), float(value), False)

    def node(self, op: str, args: tuple["Node", ...], value: Any, moving: bool) -> "Node":
        """The one node of this operation on these arguments."""
        key = (op, value, *(a.index for a in args))
        known = self._table.get(key)
        if known is None:
            known = Node(self, op, args, value, moving, len(self.nodes))
            self.nodes.append(known)
            self._table[key] = known
        return known

    def operation(self, op: str, *args: "Node") -> "Node":
        """The node of an operation; it moves when an argument does."""
        return self.node(op, args, None, any(a.moving for a in args))


class Node:
    """One expression; behaves as a number in `+ - * / ** abs` and in `trialid.maths`."""

    __slots__ = ("args", "graph", "index", "moving", "op", "value")
    __array_ufunc__ = None  # NumPy scalars give way to our operators

    def __init__(
        self,
        graph: Graph,
        op: str,
        args: tuple["Node", ...],
        value: Any,
        moving: bool,
        index: int,
    ) -> None:
        self.graph = graph
        self.op = op
        self.args = args
        self.value = value
        self.moving = moving
        self.index = index

    def is_constant(self, value: float | None = None) -> bool:
        """Whether this is a number, or that number."""
        return self.op == CONSTANT and (value is None or self.value == value)

    def __add__(self, other: Any) -> "Node":
        return add(self, lift(self.graph, other))

    __radd__ = __add__

    def __sub__(self, other: Any) -> "Node":
        return subtract(self, lift(self.graph, other))

    def __rsub__(self, other: Any) -> "Node":
        return subtract(lift(self.graph, other), self)

    def __mul__(self, other: Any) -> "Node":
        return multiply(self, lift(self.graph, other))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "Node":
        return divide(self, lift(self.graph, other))

    def __rtruediv__(self, other: Any) -> "Node":
        return divide(lift(self.graph, other), self)

    def __neg__(self) -> "Node":
        return multiply(self.graph.constant(-1.0), self)

    def __pos__(self) -> "Node":
        return self

    def __pow__(self, power: Any) -> "Node":
        if not isinstance(power, int) or power < 1:
            raise EffectError(f"power {power!r}: only whole powers from 1 up; write sqrt or 1/x")
        return self if power == 1 else self * self ** (power - 1)

    def __abs__(self) -> "Node":
        return unary("abs", self)

    def __bool__(self) -> bool:
        raise EffectError(
            "an effect may not branch on a signal (`if v > 0`): its derivative would be unknown; "
            "use abs, maths.tanh or maths.clip"
        )

    def __lt__(self, other: object) -> bool:
        return bool(self)

    __le__ = __gt__ = __ge__ = __lt__

    def __float__(self) -> float:
        raise EffectError(
            "an effect called a function that is not in trialid.maths on a signal; "
            "use trialid.maths (sin, cos, sqrt, exp, tanh, arctan, clip)"
        )

    def sin(self) -> "Node":
        """Sine."""
        return unary("sin", self)

    def cos(self) -> "Node":
        """Cosine."""
        return unary("cos", self)

    def sqrt(self) -> "Node":
        """Square root."""
        return unary("sqrt", self)

    def exp(self) -> "Node":
        """Exponential."""
        return unary("exp", self)

    def tanh(self) -> "Node":
        """Hyperbolic tangent."""
        return unary("tanh", self)

    def arctan(self) -> "Node":
        """Inverse tangent."""
        return unary("arctan", self)

    def clip_to(self, limit: Any) -> "Node":
        """The value held between -limit and limit."""
        return self.graph.operation("clip", self, lift(self.graph, limit))


def lift(graph: Graph, value: Any) -> Node:
    """A node of this graph for a node or a number.

    Raises
    ------
    EffectError
        It is nan or inf.
    """
    if isinstance(value, Node):
        return value
    if not math.isfinite(value):
        raise EffectError(
            f"{value} came up in it; look for a division by zero or a root of a negative number"
        )
    return graph.constant(value)


def add(a: Node, b: Node) -> Node:
    """The sum, with numbers folded and the order of arguments fixed."""
    if a.is_constant() and b.is_constant():
        return a.graph.constant(a.value + b.value)
    if a.is_constant(0.0):
        return b
    if b.is_constant(0.0):
        return a
    first, second = (a, b) if a.index <= b.index else (b, a)
    return a.graph.operation("+", first, second)


def subtract(a: Node, b: Node) -> Node:
    """The difference, with numbers folded."""
    if a.is_constant() and b.is_constant():
        return a.graph.constant(a.value - b.value)
    if b.is_constant(0.0):
        return a
    if a is b:
        return a.graph.constant(0.0)
    return a.graph.operation("-", a, b)


def multiply(a: Node, b: Node) -> Node:
    """The product, with numbers folded and the order of arguments fixed."""
    if a.is_constant() and b.is_constant():
        return a.graph.constant(a.value * b.value)
    if a.is_constant(0.0) or b.is_constant(0.0):
        return a.graph.constant(0.0)
    if a.is_constant(1.0):
        return b
    if b.is_constant(1.0):
        return a
    first, second = (a, b) if a.index <= b.index else (b, a)
    return a.graph.operation("*", first, second)


def divide(a: Node, b: Node) -> Node:
    """The quotient, with numbers folded."""
    if a.is_constant() and b.is_constant() and b.value != 0.0:
        return a.graph.constant(a.value / b.value)
    if a.is_constant(0.0) or b.is_constant(1.0):
        return a
    return a.graph.operation("/", a, b)


def unary(op: str, a: Node) -> Node:
    """A function of one argument, computed at once when that is a number."""
    if not a.is_constant():
        return a.graph.operation(op, a)
    return a.graph.constant(_plain(op)(a.value))


def _plain(op: str) -> Any:
    special = {"abs": abs, "sign": lambda x: math.copysign(1.0, x), "arctan": math.atan}
    return special.get(op) or getattr(math, op)


def _partials(node: Node) -> tuple[Node, ...]:
    """Derivative of a node by each of its arguments."""
    one = node.graph.constant(1.0)
    a = node.args[0]
    match node.op:
        case "+":
            return one, one
        case "-":
            return one, -one
        case "*":
            return node.args[1], a
        case "/":
            inverse = one / node.args[1]
            return inverse, -(node * inverse)
        case "clip":
            inside = node.graph.operation("inside", a, node.args[1])
            return inside, (one - inside) * unary("sign", a)
    return (_UNARY_PARTIALS[node.op](node, a),)


_UNARY_PARTIALS: Final[dict[str, Callable[[Node, Node], Node]]] = {
    "abs": lambda node, a: unary("sign", a),
    "sqrt": lambda node, a: 0.5 / node,
    "sin": lambda node, a: a.cos(),
    "cos": lambda node, a: -a.sin(),
    "exp": lambda node, a: node,
    "tanh": lambda node, a: 1.0 - node * node,
    "arctan": lambda node, a: 1.0 / (1.0 + a * a),
}


def gradient(output: Node, wanted: Sequence[Node]) -> list[Node]:
    """Derivatives of one output by each wanted symbol, by symbolic reverse mode."""
    graph = output.graph
    zero = graph.constant(0.0)
    adjoint: dict[int, Node] = {output.index: graph.constant(1.0)}
    for node in reversed(order([output])):
        if not node.args or node.index not in adjoint or node.op in SWITCHES:
            continue
        for argument, partial in zip(node.args, _partials(node), strict=True):
            part = adjoint[node.index] * partial
            if not (argument.is_constant() or part.is_constant(0.0)):
                known = adjoint.get(argument.index)
                adjoint[argument.index] = part if known is None else known + part
    return [adjoint.get(symbol.index, zero) for symbol in wanted]


def order(outputs: Iterable[Node]) -> list[Node]:
    """Every node the outputs need, arguments before users."""
    needed: dict[int, Node] = {}
    waiting = list(outputs)
    while waiting:
        node = waiting.pop()
        if node.index not in needed:
            needed[node.index] = node
            waiting.extend(node.args)
    return [needed[index] for index in sorted(needed)]
