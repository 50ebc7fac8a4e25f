"""Instructions of LLVM IR: one by one, and those that work out the nodes of a graph.

`reassoc nsz arcp contract` buys the speed of -ffast-math and still keeps NaN and infinity, by which
a diverging simulation is found.
"""

import struct
from collections.abc import Iterable, Mapping
from typing import Final

from trialid.simulation.graph import CONSTANT, SYMBOL, Node
from trialid.simulation.trace import BLOCK

FAST: Final = "reassoc nsz arcp contract"
VECTOR: Final = f"<{BLOCK} x double>"
ARITHMETIC: Final = {"+": "fadd", "-": "fsub", "*": "fmul", "/": "fdiv"}
FUNCTIONS: Final = {
    "abs": "llvm.fabs.f64", "sqrt": "llvm.sqrt.f64", "sin": "llvm.sin.f64", "cos": "llvm.cos.f64",
    "exp": "exp", "tanh": "tanh", "arctan": "atan",
}  # fmt: skip
DECLARATIONS: Final = (
    "declare double @llvm.fabs.f64(double)\ndeclare double @llvm.sqrt.f64(double)\n"
    "declare double @llvm.sin.f64(double)\ndeclare double @llvm.cos.f64(double)\n"
    "declare double @llvm.copysign.f64(double, double)\n"
    "declare double @exp(double)\ndeclare double @tanh(double)\ndeclare double @atan(double)\n"
    "declare void @llvm.memcpy.p0.p0.i64(ptr, ptr, i64, i1)\n"
)


def literal(value: float) -> str:
    """A number as IR writes it, every bit of it."""
    return "0x" + struct.pack(">d", value).hex().upper()


class IrText:
    """IR text in the making; every method appends an instruction and returns its name."""

    def __init__(self) -> None:
        self.lines: list[str] = []
        self._count = 0

    def new(self, expression: str) -> str:
        """A new value."""
        self._count += 1
        self.lines.append(f"  %v{self._count} = {expression}")
        return f"%v{self._count}"

    def raw(self, *lines: str) -> None:
        """Lines as they are."""
        self.lines.extend(lines)

    def binary(self, op: str, a: str, b: str, kind: str = "double") -> str:
        """Arithmetic of two numbers, or of two vectors of them."""
        return self.new(f"{op} {FAST} {kind} {a}, {b}")

    def integer(self, op: str, a: str, b: str | int) -> str:
        """Arithmetic of whole numbers."""
        return self.new(f"{op} i64 {a}, {b}")

    def address(self, base: str, index: str | int) -> str:
        """The place of an element of an array."""
        return self.new(f"getelementptr inbounds double, ptr {base}, i64 {index}")

    def load(self, base: str, index: str | int, kind: str = "double") -> str:
        """An element of an array, or the vector that begins there."""
        return self.new(f"load {kind}, ptr {self.address(base, index)}, align 8")

    def store(self, value: str, base: str, index: str | int, kind: str = "double") -> None:
        """Put a value, or a vector, into an array."""
        self.raw(f"  store {kind} {value}, ptr {self.address(base, index)}, align 8")

    def splat(self, value: str) -> str:
        """A vector of one number."""
        lone = self.new(f"insertelement {VECTOR} poison, double {value}, i32 0")
        zeros = f"<{BLOCK} x i32> zeroinitializer"
        return self.new(f"shufflevector {VECTOR} {lone}, {VECTOR} poison, {zeros}")

    def call(self, function: str, *args: str) -> str:
        """What a function gives."""
        listed = ", ".join(f"double {a}" for a in args)
        return self.new(f"call {FAST} double @{function}({listed})")

    def variable(self, kind: str, start: str) -> str:
        """A place in memory that the optimiser turns into a register."""
        place = self.new(f"alloca {kind}, align 64")
        self.raw(f"  store {kind} {start}, ptr {place}")
        return place

    def get(self, place: str, kind: str = "double") -> str:
        """What is in a place."""
        return self.new(f"load {kind}, ptr {place}, align 8")

    def put(self, value: str, place: str, kind: str = "double") -> None:
        """Put a value into a place."""
        self.raw(f"  store {kind} {value}, ptr {place}, align 8")


def evaluate(text: IrText, nodes: Iterable[Node], known: dict[int, str]) -> None:
    """Write the instructions of nodes that are not known yet."""
    for node in nodes:
        if node.index not in known and node.op != SYMBOL:
            known[node.index] = (
                literal(node.value) if node.op == CONSTANT else _instruction(text, node, known)
            )


def _instruction(text: IrText, node: Node, known: Mapping[int, str]) -> str:
    args = [known[a.index] for a in node.args]
    if node.op in ARITHMETIC:
        return text.binary(ARITHMETIC[node.op], *args)
    match node.op:
        case "clip":
            low = text.new(f"fneg double {args[1]}")
            return _nearer(text, "ogt", _nearer(text, "olt", args[0], low), args[1])
        case "inside":
            size = text.call("llvm.fabs.f64", args[0])
            test = text.new(f"fcmp olt double {size}, {args[1]}")
            return text.new(f"select i1 {test}, double {literal(1.0)}, double {literal(0.0)}")
        case "sign":
            return text.call("llvm.copysign.f64", literal(1.0), *args)
    return text.call(FUNCTIONS[node.op], *args)


def _nearer(text: IrText, beyond: str, value: str, bound: str) -> str:
    """The bound where the value is beyond it; NaN is beyond nothing and stays."""
    test = text.new(f"fcmp {beyond} double {value}, {bound}")
    return text.new(f"select i1 {test}, double {bound}, double {value}")
