"""Rules about the shape of packages, classes, calls and results."""

import ast
from collections.abc import Iterator
from typing import Final

from house.sources import Breach, House, Source

POSITIONAL: Final = 6
"""Arguments of a call that a reader can tell apart by their order."""

FIELDS: Final = 5
"""Fields of a dataclass that may be given by their order."""


def package_fronts(house: House) -> Iterator[Breach]:
    """Find packages that do not say what they are and what they give."""
    for source in house.package:
        if source.name != "__init__.py":
            continue
        missing = [] if ast.get_docstring(source.tree) else ["docstring"]
        if "__all__" not in _assigned(source.tree):
            missing.append("__all__")
        for part in missing:
            yield Breach(
                path=source.path,
                line=1,
                what=f"a package without {part}",
                todo="say in a sentence what it is, and list in __all__ what it gives",
                key=f"{source.path} {part}",
            )


def _assigned(tree: ast.Module) -> set[str]:
    """Names given a value at the top of a module."""
    targets = [t for node in tree.body if isinstance(node, ast.Assign) for t in node.targets]
    targets += [node.target for node in tree.body if isinstance(node, ast.AnnAssign)]
    return {each.id for each in targets if isinstance(each, ast.Name)}


def dataclass_keywords(house: House) -> Iterator[Breach]:
    """Find dataclasses of many fields that may still be made by the order of them."""
    for source in house.python:
        for node in source.nodes:
            if not isinstance(node, ast.ClassDef):
                continue
            made = _dataclass(node)
            if made is not None and not _keywords_only(made) and _fields(node) > FIELDS:
                yield Breach(
                    path=source.path,
                    line=node.lineno,
                    what=f"dataclass {node.name} has {_fields(node)} fields, given by their order",
                    todo="make it kw_only=True and name them where it is made",
                    key=f"{source.path} {node.name}",
                )


def _dataclass(node: ast.ClassDef) -> ast.expr | None:
    """The decorator that makes a class a dataclass."""
    for each in node.decorator_list:
        called = each.func if isinstance(each, ast.Call) else each
        if ast.unparse(called) in ("dataclass", "dataclasses.dataclass"):
            return each
    return None


def _keywords_only(made: ast.expr) -> bool:
    given = made.keywords if isinstance(made, ast.Call) else []
    return any(each.arg == "kw_only" and ast.unparse(each.value) == "True" for each in given)


def _fields(node: ast.ClassDef) -> int:
    """Fields given by their order: those before a KW_ONLY mark, no class variables."""
    count = 0
    for each in node.body:
        if isinstance(each, ast.AnnAssign):
            kind = ast.unparse(each.annotation)
            if kind.endswith("KW_ONLY"):
                break
            count += not kind.startswith(("ClassVar", "typing.ClassVar"))
    return count


def positional_arguments(house: House) -> Iterator[Breach]:
    """Find calls whose arguments can only be told apart by counting."""
    for source in house.python:
        for node in source.nodes:
            if isinstance(node, ast.Call) and len(node.args) > POSITIONAL:
                yield Breach(
                    path=source.path,
                    line=node.lineno,
                    what=f"{len(node.args)} positional arguments, at most {POSITIONAL}",
                    todo="give them by name",
                    key=source.path,
                )


def string_subscripts(house: House) -> Iterator[Breach]:
    """Find results read by the words of a key, where mypy is blind, in the rooms that read them."""
    rooms = tuple(house.listed("results", "rooms"))
    for source in house.package:
        if source.path.startswith(rooms):
            for node in _read_by_key(source, house.listed("results", "no_results")):
                yield Breach(
                    path=source.path,
                    line=node.lineno,
                    what=f"{ast.unparse(node)} reads by a string",
                    todo="read an attribute of the typed result",
                    key=source.path,
                )


def _read_by_key(source: Source, others: list[str]) -> Iterator[ast.Subscript]:
    """Subscripts by a constant string of what may be a part of a result."""
    for node in source.nodes:
        if (
            isinstance(node, ast.Subscript)
            and isinstance(node.slice, ast.Constant)
            and isinstance(node.slice.value, str)
            and _root(node) not in others
        ):
            yield node


def _root(node: ast.expr) -> str:
    """The name that a chain of attributes, calls and subscripts begins with."""
    while not isinstance(node, ast.Name):
        if isinstance(node, ast.Subscript | ast.Attribute):
            node = node.value
        elif isinstance(node, ast.Call):
            node = node.func
        else:
            return ""
    return node.id


def error_returns(house: House) -> Iterator[Breach]:
    """Find functions that give a text instead of what they are for, where it went wrong."""
    for source in house.package:
        for node in source.nodes:
            if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) or not node.returns:
                continue
            kinds = _alternatives(node.returns)
            if "str" in kinds and len(kinds - {"str", "None", "int", "float", "bool"}) > 0:
                yield Breach(
                    path=source.path,
                    line=node.lineno,
                    what=f"{node.name}() -> {ast.unparse(node.returns)}",
                    todo="raise the error, or give a dataclass that holds either",
                    key=source.path,
                )


def _alternatives(annotation: ast.expr) -> set[str]:
    """The kinds that a union at the top of an annotation names."""
    if isinstance(annotation, ast.BinOp) and isinstance(annotation.op, ast.BitOr):
        return _alternatives(annotation.left) | _alternatives(annotation.right)
    return {ast.unparse(annotation)}
