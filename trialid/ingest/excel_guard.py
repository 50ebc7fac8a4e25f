"""What an Excel file unpacks to, counted before anything believes what it declares.

The reader of sheets sets aside every cell between the first and the last, so that one cell at
XFD1048576 would ask for terabytes; and a few kilobytes can unpack to gigabytes.
"""

import re
import struct
import zipfile
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

from trialid.errors import LogError, said

MOST_BYTES = 400_000_000
"""Unpacked; a sheet of a million rows and ten columns has less."""
MOST_CELLS = 20_000_000
BLOCK = 1 << 18
LOCAL = struct.Struct("<4s22xHH")
ROW = re.compile(rb"""r\s*=\s*["']\s*[A-Za-z]{0,9}(\d{1,9})""")
COLUMN = re.compile(rb"""r\s*=\s*["']\s*([A-Za-z]{1,9})\d""")


def check(path: Path) -> None:
    """LogError unless the file is a sound archive of bearable size."""
    try:
        with zipfile.ZipFile(path) as archive, path.open("rb") as file:
            total = 0
            for member in archive.infolist():
                total += _checked(path, file, member, MOST_BYTES - total)
    except (zipfile.BadZipFile, zlib.error, OSError, ValueError, NotImplementedError) as error:
        raise LogError(
            f"{path}: is no sound Excel file ({said(error)}); copy it again, or export it as CSV"
        ) from error


def _checked(path: Path, file: BinaryIO, member: zipfile.ZipInfo, left: int) -> int:
    """Bytes a member unpacks to; its cells are counted when it is a sheet."""
    size, rows, columns, checksum = 0, 0, 0, 0
    sheet = "sheet" in member.filename.lower()
    tail = b""
    for block in _unpacked(file, member):
        size, checksum = size + len(block), zlib.crc32(block, checksum)
        if size > left:
            raise LogError(
                f"{path}: unpacks to more than {MOST_BYTES // 10**6} MB; export it as CSV"
            )
        if sheet:
            rows, columns = _reach(tail + block, rows, columns)
            tail = block[-32:]
        if rows * columns > MOST_CELLS:
            raise LogError(
                f"{path}: {member.filename} reaches to row {rows}, column {columns}; no more than "
                f"{MOST_CELLS // 10**6} million cells can be read: delete stray cells, or export "
                "it as CSV"
            )
    if checksum != member.CRC:
        raise ValueError(f"the checksum of {member.filename} does not fit")
    return size


def _reach(text: bytes, rows: int, columns: int) -> tuple[int, int]:
    """Last row and column of the cells named in a piece of a sheet, and before."""
    numbers = set(ROW.findall(text))
    letters = {one.upper() for one in set(COLUMN.findall(text))}
    last = max(map(int, numbers), default=0)
    return max(rows, last), max(columns, max(map(_number, letters), default=0))


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
