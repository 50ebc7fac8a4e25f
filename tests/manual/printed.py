"""What the documents show as printed, and the project that their commands run in.

    python tests/manual/printed.py

runs them and writes what they print now into the fences that say `text printed`: the one before is
the `sh` that prints it.
"""

import os
import re
import shutil
import stat
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from trialid.guide import TOPICS

ROOT: Final = Path(__file__).parents[2]
DOCUMENTS: Final = {
    "README": ROOT / "README.md",
    **{topic: ROOT / "trialid" / "guide" / f"{topic}.md" for topic in TOPICS},
}
FENCE: Final = re.compile(r"^```([^\n]*)\n(.*?)^```$", re.DOTALL | re.MULTILINE)
PRINTED: Final = "text printed"
LONGEST: Final = 300
"""A page whose commands need more hangs [s]."""

SAMPLE: Final = "trialid run pipelines/hidden_effect.toml"
"""What is run once, and not again by every page that begins with it."""


@dataclass(frozen=True)
class Block:
    """One fence of a document: what kind it says it is, its text, the line it begins on."""

    kind: str
    text: str
    line: int


def blocks(document: str) -> Iterator[Block]:
    """Every fence of a document, in order."""
    text = DOCUMENTS[document].read_text(encoding="utf-8")
    for found in FENCE.finditer(text):
        yield Block(found[1], found[2], text.count("\n", 0, found.start()) + 1)


def sample_project(folder: Path) -> str:
    """Samples and pipelines, a `trialid` of this interpreter, the sample run; what it printed."""
    lay_out(folder)
    return shell(folder, SAMPLE)


def lay_out(folder: Path) -> None:
    """Samples and pipelines, and a `trialid` of this interpreter."""
    for name in ("pipelines", "sample_data"):
        shutil.copytree(ROOT / name, folder / name)
    shim = folder / "bin" / "trialid"
    shim.parent.mkdir()
    shim.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m trialid "$@"\n', encoding="utf-8")
    shim.chmod(shim.stat().st_mode | stat.S_IXUSR)


def shell(folder: Path, commands: str) -> str:
    """What commands print at 80 columns; the first that fails is shown with all it says."""
    paths = f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
    done = subprocess.run(
        ["bash", "-euo", "pipefail", "-c", commands],
        cwd=folder,
        env={**os.environ, "PATH": paths, "PYTHONPATH": str(ROOT), "COLUMNS": "80"},
        capture_output=True,
        text=True,
        check=False,
        timeout=LONGEST,
    )
    assert done.returncode == 0, f"{commands}\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
    return done.stdout


def to_run(text: str) -> str:
    """A block without what installs, and without what was run for all pages already.

    A line that installs ends with what is to be run; the tests are those that are running.
    """
    lines = []
    for line in text.replace("\\\n", " ").splitlines():
        last = line.rpartition("&&")[2].strip().removeprefix(".venv/bin/")
        if last not in ("pytest", SAMPLE):
            lines.append(last if "pip install" in line else line)
    return "\n".join(lines)


def told(folder: Path, commands: str, sample: str) -> str:
    """What a block prints; of the sample's run what it printed before."""
    rest = to_run(commands)
    return shell(folder, rest) if rest.strip() else sample


def main() -> None:
    """Write what is printed now, and name the documents that were stale."""
    with TemporaryDirectory() as place:
        sample = sample_project(Path(place, "project"))
        for name, path in DOCUMENTS.items():
            shows = any(block.kind == PRINTED for block in blocks(name))
            if shows and _bring_up_to_date(path, Path(place), sample):
                sys.stdout.write(f"{path.relative_to(ROOT)}\n")


def _bring_up_to_date(path: Path, place: Path, sample: str) -> bool:
    """Fill the fences of a document; whether any was stale."""
    folder = Path(shutil.copytree(place / "project", place / path.stem))
    text = path.read_text(encoding="utf-8")
    end = text.rindex(f"```{PRINTED}")
    last = ""

    def fill(found: re.Match[str]) -> str:
        nonlocal last
        if found[1] == "sh" and found.start() < end:
            last = told(folder, found[2], sample)
        return f"```{found[1]}\n{last if found[1] == PRINTED else found[2]}```"

    new = FENCE.sub(fill, text)
    path.write_text(new, encoding="utf-8")
    return new != text


if __name__ == "__main__":
    main()
