"""Rules about what comes in one order in every process."""

import ast
from collections.abc import Iterator
from typing import Final

from house.sources import Breach, House, Source

MIXES: Final = (ast.BitOr, ast.BitAnd, ast.Sub, ast.BitXor)
"""What makes a set of two."""

NO_ORDER: Final = frozenset(
    {"sorted", "set", "frozenset", "any", "all", "min", "max", "len", "Counter"}
)
"""Functions that give the same whatever order they are given."""

ORDERED: Final = frozenset({"list", "tuple", "enumerate", "zip", "chain", "join", "fromkeys"})
"""Functions that keep the order they are given."""


def set_orders(house: House) -> Iterator[Breach]:
    """Find what goes through a set in its own order, which is another in each process."""
    for source in house.package:
        told = _told_to_be_sets(source)
        for node, gone in _gone_through(source):
            if _is_set(gone, told):
                yield Breach(
                    path=source.path,
                    line=node.lineno,
                    what=f"{ast.unparse(gone)[:60]} in a set's order",
                    todo="go through sorted(...), or through what it was made of",
                    key=source.path,
                )


def _told_to_be_sets(source: Source) -> frozenset[str]:
    """Names that are sets wherever a file gives them a value or a kind."""
    sets, others = set[str](), set[str]()
    for node in source.nodes:
        for name, is_set in _kind_of_names(node):
            (sets if is_set else others).add(name)
    return frozenset(sets - others)


def _kind_of_names(node: ast.AST) -> Iterator[tuple[str, bool]]:
    """Names that a node gives a value or a kind, each with whether that is a set."""
    if isinstance(node, ast.Assign):
        for target in node.targets:
            if isinstance(target, ast.Name):
                yield target.id, _is_set(node.value, frozenset())
    elif isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
        yield node.target.id, _says_set(node.annotation)
    elif isinstance(node, ast.arg):
        yield node.arg, _says_set(node.annotation)
    elif isinstance(node, ast.For | ast.comprehension) and isinstance(node.target, ast.Name):
        yield node.target.id, False


def _says_set(kind: ast.expr | None) -> bool:
    outer = kind.value if isinstance(kind, ast.Subscript) else kind
    return outer is not None and ast.unparse(outer) in ("set", "frozenset", "Set", "AbstractSet")


def _gone_through(source: Source) -> Iterator[tuple[ast.expr | ast.stmt, ast.expr]]:
    """What is gone through in order, and where."""
    free = {id(node) for call in source.nodes for node in _without_order(call)}
    for node in source.nodes:
        if isinstance(node, ast.For):
            yield node, node.iter
        elif isinstance(node, ast.ListComp | ast.GeneratorExp | ast.DictComp):
            if id(node) not in free:
                yield from ((node, part.iter) for part in node.generators)
        elif isinstance(node, ast.Call) and _called(node) in ORDERED and id(node) not in free:
            yield from ((node, given) for given in node.args)
        elif isinstance(node, ast.List | ast.Tuple) and id(node) not in free:
            starred = (each for each in node.elts if isinstance(each, ast.Starred))
            yield from ((node, each.value) for each in starred)


def _without_order(node: ast.AST) -> Iterator[ast.expr]:
    """Parts of a node whose order is nothing to it."""
    if isinstance(node, ast.Call) and _called(node) in NO_ORDER:
        yield from node.args
    elif isinstance(node, ast.Set):
        yield from (each.value for each in node.elts if isinstance(each, ast.Starred))


def _called(node: ast.Call) -> str:
    return node.func.attr if isinstance(node.func, ast.Attribute) else ast.unparse(node.func)


def _is_set(node: ast.expr, told: frozenset[str]) -> bool:
    """Whether an expression is a set by the look of it."""
    if isinstance(node, ast.Name):
        return node.id in told
    if isinstance(node, ast.Call):
        made = node.func.value if isinstance(node.func, ast.Subscript) else node.func
        return ast.unparse(made) in ("set", "frozenset")
    if isinstance(node, ast.BinOp) and isinstance(node.op, MIXES):
        return any(_is_set(x, told) or _is_keys(x) for x in (node.left, node.right))
    return isinstance(node, ast.Set | ast.SetComp)


def _is_keys(node: ast.expr) -> bool:
    """Whether an expression is the keys of a mapping, of which two make a set."""
    return isinstance(node, ast.Call) and _called(node) == "keys"
