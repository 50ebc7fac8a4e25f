"""The C source of an FMU compiled: for this Linux by its compiler, for others by that of a wheel.

`ziglang` brings Clang with the headers of Windows and macOS; without it there is Linux alone.
"""

import importlib.util
import platform
import shutil
import struct
import subprocess
import sys
import tempfile
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from trialid.errors import TrialidError

OPTIONS: Final = ("-O2", "-shared", "-fPIC", "-fvisibility=hidden")
SAME: Final = ("-s", "-ffp-contract=off")
"""Of the wheel's compiler: no debugger's files; products and sums rounded as on any other."""
FAT: Final = 0xCAFEBABE
PAGE: Final = 1 << 14
"""Where parts of a binary for two processors begin; that of Apple's ARM is the larger page."""
EXTRA: Final = "platforms"
"""The extra of this package that brings the compiler."""


@dataclass(frozen=True)
class Target:
    """A system and processor: how the compiler calls it, and how the two standards do."""

    name: str
    fmi2: str
    fmi3: str
    suffix: str


TARGETS: Final = (
    Target("x86_64-windows-gnu", "win64", "x86_64-windows", ".dll"),
    Target("x86_64-macos", "darwin64", "x86_64-darwin", ".dylib"),
    Target("aarch64-macos", "darwin64", "aarch64-darwin", ".dylib"),
)
LINUX: Final = Target("x86_64-linux-gnu.2.17", "linux64", "x86_64-linux", ".so")
"""With the oldest glibc that is still about, where the wheel's compiler makes it."""


def has_cross_compiler() -> bool:
    """Whether the wheel that compiles for other systems is installed."""
    return importlib.util.find_spec("ziglang") is not None


def binaries(source: str, low: str, version: str, *, everywhere: bool) -> dict[str, bytes]:
    """Binaries by their paths in the FMU; those for two processors of one folder as one.

    Parameters
    ----------
    version
        Of FMI: `2.0` or `3.0`, whose folders have other names.
    everywhere
        For other systems too, where the compiler for them is installed.

    Raises
    ------
    TrialidError
        There is a compiler, and it fails.
    """
    found = dict[str, list[bytes]]()
    own = _own_compiler()
    commands: list[tuple[Target, Sequence[str]]] = [(LINUX, [own])] if own else []
    if everywhere and has_cross_compiler():
        zig = [sys.executable, "-m", "ziglang", "cc", *SAME]
        others = TARGETS if own else (LINUX, *TARGETS)
        commands += [(target, [*zig, "-target", target.name]) for target in others]
    for target, command in commands:
        folder = target.fmi2 if version == "2.0" else target.fmi3
        made = _compiled(source, target, command)
        found.setdefault(f"binaries/{folder}/{low}{target.suffix}", []).append(made)
    return {path: parts[0] if len(parts) == 1 else _fat(parts) for path, parts in found.items()}


def _own_compiler() -> str | None:
    """That of this system, None where this is no Linux on a PC."""
    if sys.platform != "linux" or platform.machine() != "x86_64":
        return None
    return shutil.which("gcc") or shutil.which("cc")


def _compiled(source: str, target: Target, command: Sequence[str]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "model.c").write_text(source, encoding="utf-8")
        out = f"model{target.suffix}"
        line = [*command, *OPTIONS, "-o", out, "model.c", "-lm"]
        told = subprocess.run(line, cwd=folder, capture_output=True, text=True, check=False)
        if told.returncode:
            raise TrialidError(
                f"{command[0]} cannot compile the FMU for {target.name}: {told.stderr.strip()}"
            )
        return Path(folder, out).read_bytes()


def _fat(parts: Sequence[bytes]) -> bytes:
    """Binaries of one system for several processors in one file, as macOS has them.

    Big-endian: a word that says so, how many, then of each processor, its kind, offset, size and
    the power of two it is aligned to (`mach-o/fat.h`).
    """
    head, body, place = struct.pack(">II", FAT, len(parts)), b"", PAGE
    for part in parts:
        kind, subkind = struct.unpack_from("<ii", part, 4)
        head += struct.pack(">iiIII", kind, subkind, place, len(part), PAGE.bit_length() - 1)
        padded = part + bytes(-len(part) % PAGE)
        body, place = body + padded, place + len(padded)
    return head + bytes(PAGE - len(head)) + body


def platform_words(paths: Iterable[str]) -> str:
    """For which systems an FMU holds binaries, and what would add the others."""
    folders = sorted({path.split("/")[1] for path in paths if path.startswith("binaries/")})
    if not folders:
        return "No C compiler at hand: the FMU holds its source alone."
    said = f"Binaries for {', '.join(folders)}"
    if has_cross_compiler():
        return f"{said}."
    return f"{said}; for Windows and macOS too with pip install 'trialid[{EXTRA}]'."
