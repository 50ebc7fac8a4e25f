"""Binaries of an FMU for other systems, by the compiler of a wheel; without it, said."""

import io
import struct
import zipfile
from pathlib import Path

import pytest
from handed_models import cases, handed

from trialid.export.model.fmu import binaries
from trialid.export.model.fmu.binaries import PAGE, _fat, has_cross_compiler, platform_words
from trialid.export.model.fmu.fmu_file import Fmi, fmu_bytes

X86, ARM = 0x01000007, 0x0100000C
"""How Mach-O calls the processors."""
THIN, WINDOWS = 0xFEEDFACF, 0x8664
CALLS = {
    "2.0": (b"fmi2DoStep", b"fmi2GetReal", b"fmi2Instantiate"),
    "3.0": (b"fmi3DoStep", b"fmi3GetFloat64", b"fmi3InstantiateCoSimulation"),
}
wheel = pytest.mark.skipif(not has_cross_compiler(), reason="no ziglang here")


def parts(fat: bytes) -> dict[int, bytes]:
    """Binaries of a universal one by their processors, as `mach-o/fat.h` has it."""
    magic, count = struct.unpack_from(">II", fat)
    assert magic == 0xCAFEBABE
    rows = [struct.unpack_from(">iiIII", fat, 8 + 20 * i) for i in range(count)]
    assert all(start % (1 << align) == 0 for _, _, start, _, align in rows)
    return {kind: fat[start : start + size] for kind, _, start, size, _ in rows}


def test_two_processors_in_one_file() -> None:
    thin = [
        struct.pack("<Iii", THIN, kind, 3) + bytes([i]) * 20000
        for i, kind in enumerate((X86, ARM), 1)
    ]
    fat = _fat(thin)
    assert parts(fat) == dict(zip((X86, ARM), thin, strict=True))
    assert len(fat) % PAGE == 0


@wheel
@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_there_is_one_for_each_system(version: Fmi, tmp_path: Path) -> None:
    """Of its system and processor, with the calls in its table of names; the same each time."""
    made = handed(cases(tmp_path)["shipped"])
    content = fmu_bytes(made, "ferry", version, everywhere=True)
    assert content == fmu_bytes(made, "ferry", version, everywhere=True)
    with zipfile.ZipFile(io.BytesIO(content)) as packed:
        found = {n: packed.read(n) for n in packed.namelist() if n.startswith("binaries/")}
    of = {path.split("/")[1]: content for path, content in found.items()}
    if version == "2.0":
        dll, apple = of["win64"], parts(of["darwin64"])
    else:
        dll = of["x86_64-windows"]
        apple = {X86: of["x86_64-darwin"], ARM: of["aarch64-darwin"]}
    [place] = struct.unpack_from("<I", dll, 0x3C)
    assert struct.unpack_from("<4sH", dll, place) == (b"PE\0\0", WINDOWS)
    assert {*apple} == {X86, ARM}
    for kind, binary in apple.items():
        assert struct.unpack_from("<Ii", binary) == (THIN, kind)
    for call in CALLS[version]:
        assert call + b"\0" in dll
        assert all(b"_" + call + b"\0" in binary for binary in apple.values())


@wheel
def test_without_a_compiler_of_the_system_s_own_the_wheel_makes_linux_too(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(binaries, "_own_compiler", lambda: None)
    content = fmu_bytes(handed(cases(tmp_path)["shipped"]), "ferry", everywhere=True)
    with zipfile.ZipFile(io.BytesIO(content)) as packed:
        assert packed.read("binaries/linux64/ferry.so")[:4] == b"\x7fELF"
        folders = {n.split("/")[1] for n in packed.namelist() if "binaries" in n}
    assert folders == {"linux64", "win64", "darwin64"}


def test_what_there_is_none_for_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(binaries, "has_cross_compiler", lambda: False)
    assert platform_words(["binaries/linux64/ferry.so", "sources/ferry.c"]) == (
        "Binaries for linux64; for Windows and macOS too with pip install 'trialid[platforms]'."
    )
    assert platform_words(["sources/ferry.c"]).startswith("No C compiler")


def test_without_the_wheel_there_is_linux_alone(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(binaries, "has_cross_compiler", lambda: False)
    content = fmu_bytes(handed(cases(tmp_path)["shipped"]), "ferry", everywhere=True)
    with zipfile.ZipFile(io.BytesIO(content)) as packed:
        assert {n.split("/")[1] for n in packed.namelist() if "binaries" in n} <= {"linux64"}
