"""Workbooks drawn from a grammar: sound and unsound places, counts, kinds, names and nesting.

    python drawn_workbooks.py FOLDER SEED COUNT

reads so many of them one after another, in a process that may have 3 GB, and prints a line each:
what came out. Who calls it sees by the lines whether the process lived to the end.
"""

import resource
import sys
import time
import zipfile
from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

MOST: Final = 3 * 10**9
"""Bytes of address space: libraries alone take one of three."""

MAIN: Final = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
OFFICE: Final = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
PACKAGE: Final = "http://schemas.openxmlformats.org/package/2006/relationships"
LARGE: Final = ("1048576", "1048577", "4294967295", "4294967296", "18446744073709551615", "9" * 30)
COUNTS: Final = ("0", "1", "2", "-1", "1e9", "0x10", "A", "", " 3", *LARGE)
FAR: Final = ("XFD1048576", "XFE1", "ZZZZZZZ1", "A99999999999", "AMJ1048576")
PLACES: Final = ("A1", "B2", "A0", "a1", "1A", "$A$1", "A1:B2", "", *FAR)
HEADER: Final = ("time", "roll", "rudder")
KINDS: Final = ("n", "s", "str", "inlineStr", "b", "e", "d", "x", "")
NUMBERS: Final = ("0", "1.5", "-1e308", "1e999", "nan", "0,5", "4294967295", "")
VALUES: Final = (*NUMBERS, "TRUE", "2023-11-05T14:00:00", "#N/A", "a" * 300, "&amp;", "\u202e")


@dataclass(frozen=True)
class Hand:
    """What draws: usual things, and odd ones every so often."""

    rng: np.random.Generator
    wild: float

    def odd(self) -> bool:
        """Whether this one is odd."""
        return bool(self.rng.random() < self.wild)

    def one(self, usual: str, others: tuple[str, ...]) -> str:
        """The usual, or one of the others."""
        return others[int(self.rng.integers(len(others)))] if self.odd() else usual


def draw(path: Path, rng: np.random.Generator) -> Path:
    """One workbook."""
    hand = Hand(rng, float(rng.choice([0.0, 0.003, 0.01, 0.1])))
    prefix = hand.one("", ("x:",))
    count = int(rng.integers(1, 3))
    sheets = {hand.one(f"sheet{i}.xml", (f"x{i}.xml",)): _sheet(hand, prefix) for i in range(count)}
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        link = f'<Relationship Id="r" Type="{OFFICE}/officeDocument" Target="xl/workbook.xml"/>'
        archive.writestr("_rels/.rels", _relations(link))
        archive.writestr("xl/workbook.xml", _book(sheets, hand))
        links = "".join(
            f'<Relationship Id="r{i}" Type="{OFFICE}/worksheet" Target="w/{name}"/>'
            for i, name in enumerate(sheets)
        )
        links += f'<Relationship Id="t" Type="{OFFICE}/sharedStrings" Target="sharedStrings.xml"/>'
        archive.writestr("xl/_rels/workbook.xml.rels", _relations(links))
        archive.writestr("xl/sharedStrings.xml", _strings(hand))
        for name, text in sheets.items():
            archive.writestr(f"xl/w/{name}", text)
    return path


def _relations(links: str) -> str:
    return f'<Relationships xmlns="{PACKAGE}">{links}</Relationships>'


def _book(sheets: dict[str, str], hand: Hand) -> str:
    named = "".join(
        f'<sheet name="S{i}" sheetId="{hand.one(str(i + 1), COUNTS)}" r:id="r{i}"/>'
        for i in range(len(sheets))
    )
    return f'<workbook xmlns="{MAIN}" xmlns:r="{OFFICE}"><sheets>{named}</sheets></workbook>'


def _strings(hand: Hand) -> str:
    counts = f'count="{hand.one("3", COUNTS)}" uniqueCount="{hand.one("3", COUNTS)}"'
    texts = "".join(f"<si><t>{hand.one(text, VALUES)}</t></si>" for text in HEADER)
    return f'<sst xmlns="{MAIN}" {counts}>{texts}</sst>'


def _sheet(hand: Hand, prefix: str) -> str:
    name = f' xmlns:x="{MAIN}"' if prefix else f' xmlns="{MAIN}"'
    reach = hand.one("A1:C20", (*PLACES, *(f"A1:{place}" for place in PLACES)))
    rows = "".join(_row(hand, prefix, i + 1) for i in range(20))
    rows *= 2000 if hand.odd() else 1
    return (
        f'<{prefix}worksheet{name}><{prefix}dimension ref="{reach}"/><{prefix}sheetData>{rows}'
        f"</{prefix}sheetData></{prefix}worksheet>"
    )


def _row(hand: Hand, prefix: str, number: int) -> str:
    place = "" if hand.odd() else f' r="{hand.one(str(number), COUNTS)}"'
    spans = f' spans="1:{hand.one("3", COUNTS)}"' if hand.odd() else ""
    cells = "".join(_cell(hand, prefix, number, k) for k in range(3)) * (50 if hand.odd() else 1)
    return f"<{prefix}row{place}{spans}>{cells}</{prefix}row>"


def _cell(hand: Hand, prefix: str, row: int, column: int) -> str:
    place = "" if hand.odd() else f' r="{hand.one(f"{chr(65 + column)}{row}", PLACES)}"'
    kind = hand.one("s" if row == 1 else "n", KINDS)
    value = hand.one(str(column if row == 1 else row), VALUES)
    style = f' s="{hand.one("0", COUNTS)}"' if hand.odd() else ""
    if kind == "inlineStr":
        return f'<{prefix}c{place} t="{kind}"{style}><is><t>{value}</t></is></{prefix}c>'
    return f'<{prefix}c{place} t="{kind}"{style}><{prefix}v>{value}</{prefix}v></{prefix}c>'


def outcome(path: Path) -> str:
    """What reading gives: `read`, `refused`, or why it offends."""
    from trialid.errors import TrialidError
    from trialid.ingest import draft_template, read

    try:
        read(path)
        draft_template(path)
    except TrialidError as error:
        said = str(error)
        sound = said.isprintable() and str(path) in said and len(said) < 2000
        return "refused" if sound else f"offends: {said[:200]!r}"
    except BaseException as error:  # noqa: BLE001 - whatever else comes out is what is looked for
        return f"offends: {type(error).__name__} {str(error)[:200]!r}"
    return "read"


def main() -> None:
    """Read them one after another and print a line each."""
    folder, seed, count = Path(sys.argv[1]), int(sys.argv[2]), int(sys.argv[3])
    resource.setrlimit(resource.RLIMIT_AS, (MOST, MOST))
    for number in range(count):
        path = draw(folder / f"{number}.xlsx", np.random.default_rng((seed, number)))
        began = time.process_time()
        said = outcome(path)
        late = time.process_time() - began > 10.0
        print(number, "offends: over 10 s" if late else said, flush=True)
        path.unlink()


if __name__ == "__main__":
    main()
