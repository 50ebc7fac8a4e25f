"""LLVM IR of a simulation, written from the graph.

Per RK4 step the four stages evaluate f, the nonzeros of J and W and the entries of G; then the
whole RK4 step runs for eight sensitivity columns at a time in vector registers. That is the exact
derivative of the RK4 map.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from itertools import groupby
from typing import Final

from trialid.simulation.graph import SYMBOL
from trialid.simulation.ir_text import DECLARATIONS, VECTOR, IrText, evaluate, literal
from trialid.simulation.ship_numbers import is_written, nodes_of, ship_numbers
from trialid.simulation.trace import BLOCK, Equations

ARGUMENTS: Final = (
    "i64 %N, i64 %sub, double %h, ptr noalias %numbers, ptr noalias %theta, ptr noalias %u, "
    "ptr noalias %limit, ptr noalias %X"
)
WORK: Final = ", ptr noalias %S, ptr noalias %s, ptr noalias %g, ptr noalias %j"


@dataclass(frozen=True)
class _Frame:
    """Names of the run-time values that the loops share."""

    state: list[str]
    slope: list[str]
    total: list[str]
    half: str
    sixth: str
    third: str
    step: str


class _Writer:
    """Writes one kernel: the loops over samples, sub-steps and stages."""

    def __init__(self, equations: Equations, sensitivities: bool) -> None:
        self.eq = equations
        self.sens = sensitivities
        self.text = IrText()
        self.known: dict[int, str] = {}
        self.n_x = len(equations.states)
        self.J = list(equations.J.items())
        self.W = [(k, w) for k, w in sorted(equations.W.items()) if not is_written(w)]
        self.G = [(c, row, g) for c, drive in enumerate(equations.G) for row, g in drive.items()]
        self.nodes = nodes_of(equations, sensitivities)

    def write(self) -> str:
        """The function's text."""
        t = self.text
        name = "sens" if self.sens else "sim"
        t.raw(f"define i64 @{name}({ARGUMENTS}{WORK * self.sens}) {{", "entry:")
        frame = self._prologue()
        self._samples(frame)
        t.raw("}")
        return "\n".join(t.lines)

    def _prologue(self) -> _Frame:
        """Everything that depends on the parameters alone is computed once."""
        t = self.text
        for node in self.nodes:
            if node.op == SYMBOL and not node.moving:
                self.known[node.index] = t.load("%theta", self.eq.parameters.index(node.value))
        for at, node in enumerate(ship_numbers(self.nodes)):
            self.known[node.index] = t.load("%numbers", at)
        evaluate(t, [n for n in self.nodes if not n.moving], self.known)
        self.moving = [n for n in self.nodes if n.moving]
        count = t.new("uitofp i64 %sub to double")
        step = t.new(f"fdiv double %h, {count}")
        zero = literal(0.0)
        state = [t.variable("double", t.load("%X", i)) for i in range(self.n_x)]
        slope = [t.variable("double", zero) for _ in range(self.n_x)]
        total = [t.variable("double", zero) for _ in range(self.n_x)]
        half, sixth, third = (
            t.new(f"fmul double {step}, {literal(x)}") for x in (1 / 2, 1 / 6, 1 / 3)
        )
        self.share = t.new(f"fdiv double {literal(1.0)}, {count}")
        self.vectors = (
            {n: t.splat(x) for n, x in (("half", half), ("sixth", sixth), ("step", step))}
            if self.sens
            else {}
        )
        self.fixed_W = (
            {k: t.splat(self.known[w.index]) for k, w in self.W if not w.moving}
            if self.sens
            else {}
        )
        return _Frame(
            state=state, slope=slope, total=total, half=half, sixth=sixth, third=third, step=step
        )

    def _samples(self, frame: _Frame) -> None:
        t = self.text
        k, j, s = (t.variable("i64", "0") for _ in range(3))
        t.raw("  br label %SAMPLE", "SAMPLE:")
        sample = t.get(k, "i64")
        n_u = len(self.eq.inputs)
        here = t.integer("mul", sample, n_u)
        u0 = [t.load("%u", t.integer("add", here, i)) for i in range(n_u)]
        u1 = [t.load("%u", t.integer("add", here, n_u + i)) for i in range(n_u)]
        du = [t.binary("fsub", b, a) for a, b in zip(u0, u1, strict=True)]
        t.put("0", j, "i64")
        t.raw("  br label %SUBSTEP", "SUBSTEP:")
        substep = t.get(j, "i64")
        done = t.new(f"uitofp i64 {substep} to double")
        t.put("0", s, "i64")
        t.raw("  br label %STAGE", "STAGE:")
        self._stage(frame, s, done, u0, du)
        self._advance(frame)
        if self.sens:
            self._columns()
        following = t.integer("add", substep, 1)
        t.put(following, j, "i64")
        more = t.new(f"icmp slt i64 {following}, %sub")
        t.raw(f"  br i1 {more}, label %SUBSTEP, label %KEEP", "KEEP:")
        self._keep(frame, k, sample)

    def _stage(self, frame: _Frame, s: str, done: str, u0: list[str], du: list[str]) -> None:
        """One of the four evaluations, rolled into a loop so that its code stands once."""
        t = self.text
        stage = t.get(s, "i64")
        first, last = (t.new(f"icmp eq i64 {stage}, {i}") for i in (0, 3))
        one, middle, zero = literal(1.0), literal(0.5), literal(0.0)
        ahead = t.new(f"select i1 {last}, double {one}, double {middle}")
        ahead = t.new(f"select i1 {first}, double {zero}, double {ahead}")
        reach = t.binary("fmul", ahead, frame.step)
        along = t.binary("fmul", t.binary("fadd", done, ahead), self.share)
        ends = t.new(f"or i1 {first}, {last}")
        weight = t.new(f"select i1 {ends}, double {frame.sixth}, double {frame.third}")
        known = self.known | self._symbols(frame, reach, along, u0, du)
        evaluate(t, self.moving, known)
        if self.sens:
            self._store_stage(known, stage)
        for i, f in enumerate(self.eq.f):
            t.put(known[f.index], frame.slope[i])
            before = t.get(frame.total[i])
            start = t.new(f"select i1 {first}, double {zero}, double {before}")
            t.put(t.binary("fadd", start, t.binary("fmul", weight, known[f.index])), frame.total[i])
        following = t.integer("add", stage, 1)
        t.put(following, s, "i64")
        more = t.new(f"icmp slt i64 {following}, 4")
        t.raw(f"  br i1 {more}, label %STAGE, label %ADVANCE", "ADVANCE:")

    def _symbols(
        self, frame: _Frame, reach: str, along: str, u0: list[str], du: list[str]
    ) -> dict[int, str]:
        t = self.text
        values: dict[int, str] = {}
        for node in self.moving:
            if node.op != SYMBOL:
                continue
            if node.value in self.eq.states:
                i = self.eq.states.index(node.value)
                moved = t.binary("fmul", reach, t.get(frame.slope[i]))
                values[node.index] = t.binary("fadd", t.get(frame.state[i]), moved)
            else:
                i = self.eq.inputs.index(node.value)
                moved = t.binary("fmul", du[i], along)
                values[node.index] = t.binary("fadd", u0[i], moved)
        return values

    def _store_stage(self, known: Mapping[int, str], stage: str) -> None:
        """Put J, W and G of this stage where the column loops read them."""
        t = self.text
        numbers = [n for _, n in self.J] + [w for _, w in self.W if w.moving]
        at = t.address("%j", t.integer("mul", stage, max(len(numbers), 1)))
        for i, node in enumerate(numbers):
            t.store(known[node.index], at, i)
        width = self.eq.columns
        at = t.address("%g", t.integer("mul", stage, self.n_x * width))
        for column, row, node in self.G:
            t.store(known[node.index], at, row * width + column)

    def _advance(self, frame: _Frame) -> None:
        t = self.text
        for state, total in zip(frame.state, frame.total, strict=True):
            t.put(t.binary("fadd", t.get(state), t.get(total)), state)

    def _columns(self) -> None:
        """The RK4 step of every block of columns; one loop per run of alike blocks."""
        t = self.text
        blocks = [self._rows(b) for b in range(self.eq.columns // BLOCK)]
        start = 0
        for number, (rows, run) in enumerate(groupby(blocks)):
            stop = start + len(list(run))
            t.raw(f"  br label %FROM{number}", f"FROM{number}:", f"  br label %COLUMN{number}")
            t.raw(f"COLUMN{number}:")
            column = f"%c{number}"
            t.raw(
                f"  {column} = phi i64 [ {start * BLOCK}, %FROM{number} ], "
                f"[ %next{number}, %COLUMN{number} ]"
            )
            self._column_block(column, rows)
            t.raw(f"  %next{number} = add i64 {column}, {BLOCK}")
            more = t.new(f"icmp slt i64 %next{number}, {stop * BLOCK}")
            t.raw(f"  br i1 {more}, label %COLUMN{number}, label %DONE{number}", f"DONE{number}:")
            start = stop

    def _rows(self, block: int) -> tuple[int, ...]:
        """Rows of G that have an entry in this block."""
        columns = range(block * BLOCK, (block + 1) * BLOCK)
        return tuple(sorted({row for c, row, _ in self.G if c in columns}))

    def _column_block(self, column: str, rows: tuple[int, ...]) -> None:
        t = self.text
        width = self.eq.columns
        start = [t.load("%s", t.integer("add", column, i * width), VECTOR) for i in range(self.n_x)]
        now, total = start, [""] * self.n_x
        for stage in range(4):
            slope = self._column_slope(column, rows, stage, now)
            total = [
                k if stage == 0 else self._sum(a, k if stage == 3 else self._sum(k, k))
                for a, k in zip(total, slope, strict=True)
            ]
            if stage < 3:
                reach = self.vectors["half" if stage < 2 else "step"]
                now = [self._fused(reach, k, x) for k, x in zip(slope, start, strict=True)]
        for i, (x, a) in enumerate(zip(start, total, strict=True)):
            moved = self._fused(self.vectors["sixth"], a, x)
            t.store(moved, "%s", t.integer("add", column, i * width), VECTOR)

    def _column_slope(
        self, column: str, rows: tuple[int, ...], stage: int, now: list[str]
    ) -> list[str]:
        """J s + W G for eight columns at one stage."""
        t = self.text
        width = self.eq.columns
        base = stage * self.n_x * width
        g = {r: t.load("%g", t.integer("add", column, base + r * width), VECTOR) for r in rows}
        moving_W = [k for k, w in self.W if w.moving]
        count = max(len(self.J) + len(moving_W), 1)
        slope: list[str | None] = [None] * self.n_x
        for at, ((i, j), _) in enumerate(self.J):
            entry = t.splat(t.load("%j", stage * count + at))
            slope[i] = self._fused(entry, now[j], slope[i])
        for (i, row), w in sorted(self.eq.W.items()):
            if row not in g:
                continue
            if is_written(w):
                factor = t.splat(literal(w.value))
            elif w.moving:
                at = len(self.J) + moving_W.index((i, row))
                factor = t.splat(t.load("%j", stage * count + at))
            else:
                factor = self.fixed_W[i, row]
            slope[i] = self._fused(factor, g[row], slope[i])
        return [k if k is not None else t.splat(literal(0.0)) for k in slope]

    def _sum(self, a: str, b: str) -> str:
        return self.text.binary("fadd", a, b, VECTOR)

    def _fused(self, a: str, b: str, c: str | None) -> str:
        product = self.text.binary("fmul", a, b, VECTOR)
        return product if c is None else self._sum(product, c)

    def _keep(self, frame: _Frame, k: str, sample: str) -> None:
        """Write the sample out; stop where a state leaves its domain (NaN never stays inside)."""
        t = self.text
        following = t.integer("add", sample, 1)
        at = t.integer("mul", following, self.n_x)
        inside = "true"
        for i, place in enumerate(frame.state):
            value = t.get(place)
            t.store(value, "%X", t.integer("add", at, i))
            size = t.call("llvm.fabs.f64", value)
            test = t.new(f"fcmp olt double {size}, {t.load('%limit', i)}")
            inside = t.new(f"and i1 {inside}, {test}")
        if self.sens:
            self._keep_columns(following)
        t.put(following, k, "i64")
        t.raw(f"  br i1 {inside}, label %NEXT, label %LEFT", "LEFT:", f"  ret i64 {following}")
        t.raw("NEXT:")
        more = t.new(f"icmp slt i64 {following}, %N")
        t.raw(f"  br i1 {more}, label %SAMPLE, label %END", "END:", "  ret i64 0")

    def _keep_columns(self, sample: str) -> None:
        """Copy the sensitivities of the states that outputs need."""
        t, width, kept = self.text, self.eq.columns, self.eq.kept
        here = t.integer("mul", sample, len(kept) * width)
        for n, i in enumerate(kept):
            to, of = t.address("%S", t.integer("add", here, n * width)), t.address("%s", i * width)
            t.raw(
                f"  call void @llvm.memcpy.p0.p0.i64(ptr align 8 {to}, ptr align 8 {of}, "
                f"i64 {width * 8}, i1 false)"
            )


def module_text(equations: Equations, sensitivities: bool) -> str:
    """The LLVM IR of one kernel; the same text for the same structure on every run."""
    return _Writer(equations, sensitivities).write() + "\n" + DECLARATIONS
