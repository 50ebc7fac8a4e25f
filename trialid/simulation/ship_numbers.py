"""What a kernel works out, and the numbers of a ship that it loads for it.

A ship's numbers are no part of a kernel's text, so that all ships of one structure share it.
"""

from typing import Final

from trialid.simulation.graph import CONSTANT, Node, order
from trialid.simulation.trace import Equations

WRITTEN: Final = frozenset({-1.0, -0.5, 0.0, 0.5, 1.0, 2.0})
"""Numbers that stand in the text: signs, halves and twos of the equations."""


def nodes_of(equations: Equations, sensitivities: bool) -> list[Node]:
    """Every node that a kernel needs, arguments before users."""
    outputs = list(equations.f)
    if sensitivities:
        outputs += equations.J.values()
        outputs += [w for _, w in sorted(equations.W.items())]
        outputs += [g for drive in equations.G for g in drive.values()]
    return order(outputs)


def is_written(node: Node) -> bool:
    """Whether a node is a number of arithmetic, which stands in the text."""
    return node.is_constant() and node.value in WRITTEN


def ship_numbers(nodes: list[Node]) -> list[Node]:
    """The ship's numbers among nodes, in the order in which a kernel loads them."""
    return [n for n in nodes if n.op == CONSTANT and not is_written(n)]
