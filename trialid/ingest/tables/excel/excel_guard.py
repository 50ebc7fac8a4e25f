"""What an Excel file unpacks to, counted before anything believes what it declares.

The reader of sheets sets aside every cell between the first and the last, so that one cell at
XFD1048576 would ask for terabytes; and a few kilobytes can unpack to gigabytes. Any part of the
archive may be a sheet, whatever it is called: all are counted, and the sum is bounded.
"""

import re
import struct
import zipfile
import zlib
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO

from trialid.errors import LogError, reason_of

MOST_BYTES = 400_000_000
"""Unpacked; a sheet of a million rows and ten columns has less."""
MOST_CELLS = 12_000_000
"""Of a sheet as long as Excel allows, 1 048 576 rows, eleven columns."""
FEW_CELLS, CELLS_A_BYTE = 2_000_000, 4
"""A small file may have so many; a larger one so many for each byte it takes. A table of
rising numbers packed to three bytes a cell, a sheet made to harm to a thirtieth of one; half or
twice of it leaves both where they are."""
BLOCK = 1 << 18
LOCAL = struct.Struct("<4s22xHH")
PLACE = re.compile(rb"""r(?<=\sr)\s*=\s*["']\s*([A-Za-z]{0,9})(\d{1,9})""")
ROW = re.compile(rb"<(?:\w{1,40}:)?row(?=[\s/>])")
CELL = re.compile(rb"<(?:\w{1,40}:)?c(?=[\s/>])")
COUNT = re.compile(rb"""ount\s*=\s*["']\s*(\d{1,30})""")
"""`count` and `uniqueCount`; begun by a letter that is rare in them, which is searched for fast."""
LONGEST_TAG = 200
"""Bytes carried over from block to block, so that none is cut."""


def check(path: Path) -> None:
    """LogError unless the file is a sound archive of bearable size."""
    try:
        with zipfile.ZipFile(path) as archive, path.open("rb") as file:
            members = archive.infolist()
            _check_kind(path, [member.filename for member in members])
            total = cells = 0
            for member in members:
                size, more = _checked(path, file, member, MOST_BYTES - total)
                total, cells = total + size, cells + more
                _check_cells(path, cells, "the sheets reach over")
    except (zipfile.BadZipFile, zlib.error, OSError, ValueError, NotImplementedError) as error:
        raise LogError(
            f"{path}: is no sound Excel file ({reason_of(error)}); copy it again, or "
            "export it as CSV"
        ) from error


def _check_kind(path: Path, names: list[str]) -> None:
    """Refuse what the library would read by other rules than those that are counted here."""
    if "xl/workbook.bin" in names or "content.xml" in names:
        kind = "a binary workbook (.xlsb)" if "xl/workbook.bin" in names else "an OpenDocument file"
        raise LogError(f"{path}: is {kind}; save it as .xlsx, or export it as CSV")


def _check_cells(path: Path, cells: int, words: str) -> None:
    most = min(MOST_CELLS, max(FEW_CELLS, CELLS_A_BYTE * path.stat().st_size))
    if cells > most:
        raise LogError(
            f"{path}: {words} {cells} cells; no more than {most / 1e6:.3g} million can be read of "
            "a file of this size: delete stray cells, or export it as CSV"
        )


@dataclass
class Reach:
    """How far the cells of one part reach, those with a place of their own and those without."""

    row: int = 0
    """The last row that is named."""
    column: int = 0
    unnamed_rows: int = 0
    widest: int = 0
    """Most cells without a place in one row."""
    here: int = 0
    """Those of the row that goes on."""

    @property
    def cells(self) -> int:
        """As many as the library may set aside."""
        return (self.row + self.unnamed_rows) * (self.column + self.widest)

    def __str__(self) -> str:
        return f"row {self.row + self.unnamed_rows}, column {self.column + self.widest}"

    def see(self, text: bytes) -> None:
        """Add a piece of the part; tags lie in it whole."""
        places = PLACE.findall(text)
        for letters in sorted({letters for letters, _ in places}):
            self.column = max(self.column, _number(letters.upper()))
        self.row = max(self.row, max((int(number) for _, number in places), default=0))
        named = sum(1 for letters, _ in places if letters)
        if text.count(b"<c") + text.count(b":c") > named:  # at most so many cells
            self._walk(text)

    def _walk(self, text: bytes) -> None:
        """Count row by row, where cells have no place but the next one."""
        for i, piece in enumerate(ROW.split(text)):
            if i:
                self.here = 0
                head = piece.partition(b">")[0]
                self.unnamed_rows += PLACE.search(head) is None
            named = sum(1 for letters, _ in PLACE.findall(piece) if letters)
            self.here += max(len(CELL.findall(piece)) - named, 0)
            self.widest = max(self.widest, self.here)


def _checked(path: Path, file: BinaryIO, member: zipfile.ZipInfo, left: int) -> tuple[int, int]:
    """Bytes a member unpacks to, and cells it reaches over."""
    size, checksum = 0, 0
    reach, rest, declared = Reach(), b"", 0
    for block in _unpacked(file, member):
        size, checksum = size + len(block), zlib.crc32(block, checksum)
        if size > left:
            raise LogError(
                f"{path}: unpacks to more than {MOST_BYTES // 10**6} MB; export it as CSV"
            )
        text, rest = _whole_tags(rest + block)
        reach.see(text)
        declared = max([declared, *map(int, COUNT.findall(text))])
        _check_cells(path, reach.cells, f"{member.filename} reaches to {reach},")
    reach.see(rest)
    _check_cells(path, reach.cells, f"{member.filename} reaches to {reach},")
    if max([declared, *map(int, COUNT.findall(rest))]) > size:
        raise LogError(f"{path}: {member.filename} declares more entries than it has bytes; save "
                       "it again, or export it as CSV")  # fmt: skip
    if checksum != member.CRC:
        raise ValueError(f"the checksum of {member.filename} does not fit")
    return size, reach.cells


def _whole_tags(text: bytes) -> tuple[bytes, bytes]:
    """What goes up to the last tag that is whole, and what is left for the next block."""
    cut = text.rfind(b"<", max(len(text) - LONGEST_TAG, 0))
    return (text, b"") if cut < 0 else (text[:cut], text[cut:])


def _number(letters: bytes) -> int:
    """Give the number of a column.

    >>> _number(b"A"), _number(b"XFD")
    (1, 16384)
    """
    number = 0
    for letter in letters:
        number = number * 26 + letter - 64
    return number


def _unpacked(file: BinaryIO, member: zipfile.ZipInfo) -> Iterator[bytes]:
    """Blocks of what really comes out, whatever the directory says of its size."""
    file.seek(member.header_offset)
    raw = file.read(LOCAL.size)
    if len(raw) < LOCAL.size:
        raise ValueError(f"{member.filename} is cut short")
    magic, name, extra = LOCAL.unpack(raw)
    if magic != b"PK\x03\x04" or member.flag_bits & 1:
        raise ValueError(f"{member.filename} is damaged or encrypted")
    file.seek(member.header_offset + LOCAL.size + name + extra)
    left = member.compress_size
    if member.compress_type == zipfile.ZIP_STORED:
        while left > 0 and (block := file.read(min(BLOCK, left))):
            left -= len(block)
            yield block
    elif member.compress_type == zipfile.ZIP_DEFLATED:
        yield from _inflated(file, left)
    else:
        raise ValueError(f"{member.filename} is packed in an unusual way")


def _inflated(file: BinaryIO, left: int) -> Iterator[bytes]:
    inflate = zlib.decompressobj(-zlib.MAX_WBITS)
    while not inflate.eof:
        packed = inflate.unconsumed_tail
        if not packed:
            packed = file.read(min(BLOCK, left))
            left -= len(packed)
        if not packed:
            return
        yield inflate.decompress(packed, BLOCK)
