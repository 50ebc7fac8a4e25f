"""Variables of MAT-files before version 7.3, element by element; no type or length is believed.

SciPy's reader looks a damaged type up past the end of its table, which ends Python: one byte is
enough. Format: MathWorks, MAT-File Level 5 File Format.
"""

import math
import struct
from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.generic]

MATRIX = 14
STORED = {
    1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8",
}  # fmt: skip
"""How the numbers of an element lie in it, by the element's type."""
STRUCT, OBJECT, FUNCTION, OPAQUE = 2, 3, 16, 17
NUMERIC = range(6, 16)
"""Classes of arrays of numbers."""
COMPLEX = 0x800
DEEPEST = 12
"""Structs in structs."""
MOST_DIMENSIONS = 32
Body = bytes | memoryview


class Damaged(ValueError):
    """An element that does not hold what it says it holds."""


@dataclass
class Variable:
    """Arrays of two numbers and more by dotted name, and names of what only MATLAB can read."""

    plain: dict[str, Numbers] = field(default_factory=dict)
    opaque: list[str] = field(default_factory=list)


def variable(body: Body, order: str) -> Variable:
    """What lies in a matrix element, tag and all; `order` is `<` or `>`. Damaged where it lies."""
    found = Variable()
    kind, content, _ = _element(memoryview(body), 0, order)
    if kind != MATRIX:
        raise Damaged(f"an element of type {kind} is no variable")
    _matrix(content, order, "", None, found)
    return found


def _element(body: memoryview, at: int, order: str) -> tuple[int, memoryview, int]:
    """Type and content of the element there, and where the next one begins."""
    if at + 8 > len(body):
        raise Damaged("an element is cut short")
    kind, size = struct.unpack_from(f"{order}II", body, at)
    begin, end = at + 8, at + 8 + size
    following = end + -size % 8
    if kind >> 16:  # up to four bytes, in the place of their count
        kind, size = kind & 0xFFFF, kind >> 16
        begin, end, following = at + 4, at + 4 + size, at + 8
        if size > 4:
            raise Damaged("a small element of more than four bytes")
    if end > len(body):
        raise Damaged(f"an element of {size} bytes, where {len(body) - begin} are left")
    return kind, body[begin:end], following


def _elements(body: memoryview, order: str) -> Iterator[tuple[int, memoryview]]:
    at = 0
    while at < len(body):
        kind, content, at = _element(body, at, order)
        yield kind, content


def _matrix(
    body: memoryview, order: str, prefix: str, called: str | None, found: Variable, depth: int = 0
) -> None:
    """Note the arrays in a matrix; a field of a struct is `called` so, a variable names itself."""
    parts = _elements(body, order)
    flags = _single(*_next(parts), order)
    kind = flags & 0xFF
    if kind == OPAQUE:
        found.opaque.append(prefix + (called or _text(_next(parts)[1])))
        return
    shape = _shape(_numbers(*_next(parts), order))
    own = _text(_next(parts)[1])
    name = prefix + (own if called is None else called)
    if kind in (OBJECT, FUNCTION):
        found.opaque.append(name)
    elif kind in NUMERIC and not flags & COMPLEX:
        y = _array(_numbers(*_next(parts), order), shape)
        found.plain |= {name: y} if y.size > 1 else {}
    elif kind == STRUCT and math.prod(shape) == 1 and depth < DEEPEST:
        for one in _fields(_next(parts), _next(parts), order):
            content = _held(_next(parts))
            if len(content):
                _matrix(content, order, f"{name}.", one, found, depth + 1)


def _array(y: Numbers, shape: tuple[int, ...]) -> Numbers:
    if len(y) != math.prod(shape):
        raise Damaged(f"{len(y)} numbers in an array of {math.prod(shape)}")
    return y.reshape(shape, order="F")


def _held(element: tuple[int, memoryview]) -> memoryview:
    kind, content = element
    if kind != MATRIX:
        raise Damaged("the field of a struct is no array")
    return content


def _next(parts: Iterator[tuple[int, memoryview]]) -> tuple[int, memoryview]:
    found = next(parts, None)
    if found is None:
        raise Damaged("an array ends before its content")
    return found


def _numbers(kind: int, content: memoryview, order: str) -> Numbers:
    if kind not in STORED or len(content) % int(STORED[kind][1]):
        raise Damaged(f"{len(content)} bytes of type {kind} are no numbers")
    return np.frombuffer(content, order + STORED[kind])


def _single(kind: int, content: memoryview, order: str) -> int:
    """The first of the whole numbers of an element that has one."""
    found = _numbers(kind, content, order)
    if not len(found) or found.dtype.kind not in "iu":
        raise Damaged("an element without its number")
    return int(found[0])


def _shape(dimensions: Numbers) -> tuple[int, ...]:
    if not 2 <= len(dimensions) <= MOST_DIMENSIONS or dimensions.dtype.kind != "i":
        raise Damaged(f"an array of {len(dimensions)} dimensions")
    shape = tuple(dimensions.astype(int).tolist())
    if min(shape) < 0:
        raise Damaged("an array of fewer than no numbers")
    return shape


def _text(content: memoryview) -> str:
    return bytes(content).partition(b"\0")[0].decode("latin1")


def _fields(
    length: tuple[int, memoryview], names: tuple[int, memoryview], order: str
) -> Iterator[str]:
    """Names of the fields, each in so many bytes."""
    width = _single(*length, order)
    if width <= 0 or len(names[1]) % width:
        raise Damaged("the names of a struct's fields are cut short")
    return (_text(names[1][at : at + width]) for at in range(0, len(names[1]), width))
