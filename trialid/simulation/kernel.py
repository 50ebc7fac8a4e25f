"""Compiled kernels: LLVM IR to machine code by llvmlite, kept on disk by structure."""

import contextlib
import ctypes
import functools
import hashlib
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from trialid.cache import cache_folder, is_ours_alone
from trialid.simulation.emit import module_text
from trialid.simulation.ship_numbers import nodes_of, ship_numbers
from trialid.simulation.trace import Equations

Vector = NDArray[np.float64]
CHECKSUM: Final = 32
LOADED: Final = 256
"""Kernels that stay loaded; their code is 20 kB each on average, at most 80 of 30 looked at."""
LOOPS: Final[list[Any]] = [ctypes.c_int64, ctypes.c_int64, ctypes.c_double]


@functools.cache
def _machine() -> Any:
    import llvmlite.binding as llvm

    llvm.initialize_native_target()
    llvm.initialize_native_asmprinter()
    return llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=2,
        jit=True,
    )


def _key(text: str) -> str:
    import llvmlite
    import llvmlite.binding as llvm

    parts = (
        "sroa reassociate",
        text,
        llvm.get_host_cpu_name(),
        llvm.get_host_cpu_features().flatten(),
        llvmlite.__version__,
    )
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def _compile(text: str) -> bytes:
    """Machine code; two passes are what matters.

    `sroa` turns the places in memory into registers, `reassociate` makes long sums and products
    short chains: a tenth less time with sensitivities, a fifth without. `reassociate` keeps 0.4 MB
    of each kernel for as long as the process lives, whoever lets go of it (llvmlite 0.50).
    """
    import llvmlite.binding as llvm

    machine = _machine()
    module = llvm.parse_assembly(text)
    module.triple = machine.triple
    module.data_layout = str(machine.target_data)
    passes = llvm.create_new_module_pass_manager()
    passes.add_sroa_pass()
    passes.add_reassociate_pass()
    passes.run(module, llvm.create_pass_builder(machine, llvm.create_pipeline_tuning_options()))
    return bytes(machine.emit_object(module))


def _object(text: str) -> bytes:
    """Machine code from the cache, or compiled and put there.

    The file appears whole or not at all (written beside, then renamed), so that two processes
    that compile the same kernel at once both find a good one; it begins with its own checksum,
    because damaged machine code would crash the process. Where nothing can be written, as on a
    read-only disk, the kernel is compiled each time.
    """
    path = cache_folder() / f"{_key(text)}.kernel"
    known = _kept(path)
    if known is not None:
        return known
    code = _compile(text)
    with contextlib.suppress(OSError):
        _keep(path, hashlib.sha256(code).digest() + code)
    return code


def _keep(path: Path, content: bytes) -> None:
    path.parent.mkdir(parents=True, exist_ok=True, mode=0o700)
    with tempfile.NamedTemporaryFile(dir=path.parent, delete=False) as file:
        beside = Path(file.name)
        try:
            file.write(content)
            file.close()
            beside.replace(path)
        finally:
            beside.unlink(missing_ok=True)


def _kept(path: Path) -> bytes | None:
    """Machine code from a file of the cache, None where there is none or it is damaged.

    What somebody else may have written is not run: its checksum says nothing of who made it.
    """
    try:
        if not (is_ours_alone(path) and is_ours_alone(path.parent)):
            return None
        content = path.read_bytes()
    except OSError:
        return None
    checksum, code = content[:CHECKSUM], content[CHECKSUM:]
    return code if code and hashlib.sha256(code).digest() == checksum else None


@functools.lru_cache(maxsize=LOADED)
def _function(text: str, name: str, pointers: int) -> Callable[..., int]:
    """The machine code of a text, loaded; kernels of one structure share it."""
    import llvmlite.binding as llvm

    _machine()  # initialises the compiler once
    engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine_for_engine())
    engine.add_object_file(llvm.ObjectFileRef.from_data(_object(text)))
    engine.finalize_object()
    kind = ctypes.CFUNCTYPE(ctypes.c_int64, *LOOPS, *[ctypes.c_void_p] * pointers)
    call = kind(engine.get_function_address(name))
    call.engine = engine  # type: ignore[attr-defined]  # the code lives as long as its engine
    return call


def _machine_for_engine() -> Any:
    """A target machine of its own: an engine takes possession of it."""
    import llvmlite.binding as llvm

    return llvm.Target.from_default_triple().create_target_machine(
        cpu=llvm.get_host_cpu_name(), features=llvm.get_host_cpu_features().flatten(), jit=True
    )


class Kernel:
    """The compiled equations of one model structure; safe to call from several threads."""

    def __init__(self, equations: Equations) -> None:
        self.equations = equations

    @functools.cached_property
    def _sim(self) -> tuple[Callable[..., int], Vector]:
        return self._code(False, 5)

    @functools.cached_property
    def _sens(self) -> tuple[Callable[..., int], Vector]:
        return self._code(True, 9)

    def _code(self, sensitivities: bool, pointers: int) -> tuple[Callable[..., int], Vector]:
        """The machine code of this structure, and this ship's numbers for it."""
        name = "sens" if sensitivities else "sim"
        code = _function(module_text(self.equations, sensitivities), name, pointers)
        numbers = ship_numbers(nodes_of(self.equations, sensitivities))
        return code, np.array([n.value for n in numbers])

    def simulate(
        self, theta: Vector, x0: Vector, u: Vector, limit: Vector, h: float, substeps: int
    ) -> tuple[Vector, int]:
        """States at every sample, and the sample at which they left the domain (0: never).

        Parameters
        ----------
        theta, x0, limit
            Parameters (n_p,), initial states (n_x,) and bounds on |x| (n_x,).
        u
            Inputs at the samples, linear between them; (N, n_u).
        h, substeps
            Sample period [s] and RK4 steps in it.
        """
        X = _room(x0, len(u))
        if len(u) < 2:
            return X, 0
        run, numbers = self._sim
        arrays = (numbers, theta, _rows(u), limit, X)  # named: a copied u must outlive the call
        left = run(len(u) - 1, substeps, h, *map(_at, arrays))
        return X, left

    def sensitivities(
        self,
        theta: Vector,
        x0: Vector,
        u: Vector,
        limit: Vector,
        h: float,
        substeps: int,
        s: Vector | None = None,
    ) -> tuple[Vector, Vector, int]:
        """States, and d(kept states)/d(free parameters, initial states); (N, n_kept, columns).

        `s` are those of all states at the first sample, and then at the last: a run goes on.
        """
        eq = self.equations
        n_x, width = len(eq.states), eq.columns
        X = _room(x0, len(u))
        s = first_slopes(eq) if s is None else s
        S = np.empty((len(u), len(eq.kept), width))
        S[0] = s[list(eq.kept)]
        if len(u) < 2:
            return X, S, 0
        g = np.zeros((4, n_x, width))
        j = np.zeros((4, max(len(eq.J) + len(eq.W), 1)))
        run, numbers = self._sens
        arrays = (numbers, theta, _rows(u), limit, X, S, s, g, j)
        left = run(len(u) - 1, substeps, h, *map(_at, arrays))
        if left:
            S[left + 1 :] = np.nan  # what the kernel did not write is not a number
        return X, S, left


def first_slopes(equations: Equations) -> Vector:
    """Sensitivities of all states at the first sample: to their own start; (n_x, columns)."""
    n_x = len(equations.states)
    s = np.zeros((n_x, equations.columns))
    s[np.arange(n_x), len(equations.free) + np.arange(n_x)] = 1.0
    return s


def _room(x0: Vector, samples: int) -> Vector:
    X = np.full((samples, len(x0)), np.nan)
    X[0] = x0
    return X


def _rows(u: Vector) -> Vector:
    return np.ascontiguousarray(u, dtype=np.float64)


def _at(array: Vector) -> int:
    return int(array.ctypes.data)


def available() -> bool:
    """Whether a compiler is installed (llvmlite); without it the NumPy reference runs."""
    if "llvmlite" in sys.modules:
        return True
    try:
        import llvmlite.binding  # noqa: F401
    except ImportError:
        return False
    return True
