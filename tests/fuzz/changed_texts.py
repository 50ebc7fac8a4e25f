r"""Change the files that people write by hand, read them, and see that only our errors come out.

    PYTHONPATH=. python tests/fuzz/changed_texts.py --count 4000 --seed 0 --out table.md

Pipelines, designs, ship files, templates and histories: lines lost, doubled and exchanged, numbers
far out, letters that steer terminals, the file cut short. A text offends when anything but a
TrialidError comes out, of one printable line that names the file, or when it takes over 10 s of
the processor. The same seed changes the same letters.
"""

import argparse
import re
import sys
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np
from limits import LONGEST_MESSAGE, Hang, time_limit

from trialid.errors import TrialidError
from trialid.ingest import draft_template
from trialid.ingest.tables.templates import template
from trialid.pipeline_file import load
from trialid.pipeline_file.design_file import load_design
from trialid.ship.particulars import read_ship
from trialid.workflow import history

ROOT: Final = Path(__file__).resolve().parents[2]
NUMBER: Final = re.compile(r"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
NUMBERS: Final = ("0", "-1", "1e308", "-1e308", "1e400", "5e-324", "nan", "inf", "9" * 400, "1_0")
NO_NUMBERS: Final = ("0x7f", "true", "'a'", "[]", "{}", "1979-05-27", "")
LETTERS: Final = "\"'[]{}=,.#\\\n\t\0\x1b\x7f\u202e\ud7ffé \ufeff-_0"


@dataclass(frozen=True)
class Kind:
    """Files of one kind: sound ones, and how they are read."""

    name: str
    sound: tuple[str, ...]
    file: str
    read: Callable[[Path], Any]


@dataclass(frozen=True, kw_only=True)
class Row:
    """What became of all changed texts of a kind."""

    kind: str
    count: int
    read: int
    refused: int
    worst: float
    offending: tuple[str, ...]


def home(place: Path) -> Path:
    """A folder from which the files that are shipped find their ships and logs."""
    (place / "sample_data").symlink_to(ROOT / "sample_data")
    (place / "pipelines").mkdir()
    return place / "pipelines"


def kinds(folder: Path) -> tuple[Kind, ...]:
    """Every kind, its sound texts from what is shipped and from what the program drafts."""
    pipelines = sorted((ROOT / "pipelines").glob("*.toml"))
    texts = {p.stem: p.read_text(encoding="utf-8") for p in pipelines}
    ships = sorted((ROOT / "sample_data" / "ships").glob("*.toml"))
    table = folder / "table.csv"
    table.write_text("Run 7\nDate;Time;roll\n" + "05/11/2023;14:00:01;1,5\n" * 20, encoding="utf-8")
    drafted = draft_template(table).replace("reviewed = false", "reviewed = true")
    step = '{"effects": ["linear_hull"], "eps_rmsn": 0.1, "added": "yaw_drag_rar"}\n'
    designs = tuple(text for name, text in texts.items() if name.startswith("design"))
    fitted = tuple(text for name, text in texts.items() if not name.startswith("design"))
    return (
        Kind("pipeline", fitted, "a.toml", load),
        Kind("design", designs, "a.toml", load_design),
        Kind("ship file", tuple(p.read_text("utf-8") for p in ships), "a.toml", read_ship),
        Kind("template", (drafted,), "a.toml", template.load),
        Kind("history", (step * 4,), "a.history.jsonl", _history),
    )


def _history(path: Path) -> Any:
    return history.read(path.with_name("a.toml"))


def changed(text: str, rng: np.random.Generator) -> str:
    """The text with one to four changes."""
    for _ in range(int(rng.integers(1, 5))):
        text = CHANGES[int(rng.integers(len(CHANGES)))](text, rng)
    return text


def _lines(text: str, rng: np.random.Generator) -> str:
    """A line lost, doubled, or put elsewhere."""
    lines = text.splitlines(keepends=True) or [""]
    one, other = rng.integers(len(lines), size=2)
    taken = lines.pop(int(one))
    kind = int(rng.integers(3))
    if kind:
        lines[int(other) : int(other)] = [taken] * kind
    return "".join(lines)


def _number(text: str, rng: np.random.Generator) -> str:
    """A number far out, or what is none."""
    found = list(NUMBER.finditer(text))
    if not found:
        return text
    at = found[int(rng.integers(len(found)))]
    others = (*NUMBERS, *NO_NUMBERS)
    return text[: at.start()] + others[int(rng.integers(len(others)))] + text[at.end() :]


def _letter(text: str, rng: np.random.Generator) -> str:
    """A letter changed, lost, or put between."""
    at = int(rng.integers(len(text) + 1))
    new = LETTERS[int(rng.integers(len(LETTERS)))] * int(rng.choice([0, 1, 1, 1, 300]))
    return text[:at] + new + text[at + int(rng.integers(2)) :]


def _cut(text: str, rng: np.random.Generator) -> str:
    """The end is not there, or comes from another place."""
    at, other = (int(x) for x in rng.integers(len(text) + 1, size=2))
    return text[:at] + (text[other:] if rng.random() < 0.7 else "")


CHANGES: Final = (_lines, _lines, _number, _number, _letter, _cut)


def complaint(kind: Kind, path: Path) -> tuple[bool, str]:
    """Whether the file was read, and why it offends; no words where it does not."""
    try:
        with time_limit():
            kind.read(path)
    except TrialidError as error:
        said = str(error)
        if not said.isprintable() or len(said) > LONGEST_MESSAGE:
            return False, f"its message is no line: {said[:200]!r}"
        return False, "" if str(path) in said else f"its message names no file: {said[:200]}"
    except (Exception, Hang) as error:  # noqa: BLE001 - what else comes out is looked for
        return False, f"{type(error).__name__}: {str(error)[:200]}"
    return True, ""


def tried(kind: Kind, folder: Path, count: int, seed: int) -> Row:
    """So many changed texts of a kind."""
    read, worst, offending = 0, 0.0, list[str]()
    path = folder / kind.file
    for number in range(count):
        rng = np.random.default_rng((seed, number))
        text = changed(kind.sound[number % len(kind.sound)], rng)
        path.write_text(text, encoding="utf-8", errors="surrogatepass", newline="")
        began = time.process_time()
        was_read, why = complaint(kind, path)
        worst = max(worst, time.process_time() - began)
        read += was_read
        offending += [f"{kind.name} {number}: {why}"] if why else []
    path.unlink()
    return Row(
        kind=kind.name,
        count=count,
        read=read,
        refused=count - read,
        worst=worst,
        offending=tuple(offending),
    )


def table(rows: tuple[Row, ...], count: int, seed: int) -> str:
    """The page of results."""
    head = (
        "# Changed texts\n\n"
        f"`python tests/fuzz/changed_texts.py --count {count} --seed {seed}`: files that people\n"
        "write by hand, with one to four changes each. None may offend: anything but our own\n"
        "error of one line that names the file came out, or it took over 10 s.\n\n"
        "| file | texts | read | refused | worst s | offend |\n"
        "| --- | --- | --- | --- | --- | --- |\n"
    )
    return head + "".join(
        f"| {r.kind} | {r.count} | {r.read} | {r.refused} | {r.worst:.2f} | {len(r.offending)} |\n"
        for r in rows
    )


def main() -> int:
    """Change, read, count; exit status 1 where one offends."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--count", type=int, default=4000, help="of each kind")
    asked.add_argument("--seed", type=int, default=0)
    asked.add_argument("--out", type=Path)
    said = asked.parse_args()
    with tempfile.TemporaryDirectory() as place:
        folder = home(Path(place))
        rows = tuple(tried(kind, folder, said.count, said.seed) for kind in kinds(folder))
    text = table(rows, said.count, said.seed)
    print(text, *(line for row in rows for line in row.offending[:20]), sep="\n")
    if said.out:
        said.out.write_text(text, encoding="utf-8")
    return 1 if any(row.offending for row in rows) else 0


if __name__ == "__main__":
    sys.exit(main())
