"""A text of any encoding brought to one, as a whole or in blocks of whole lines."""

import codecs
import itertools
import re
from collections.abc import Iterator
from pathlib import Path

BLOCK = 2 << 20
"""Bytes read at once: small beside what a long log's numbers take, large beside a line."""
LONGEST_LINE = 2_000_000
"""Bytes of a line, more than the columns of any table."""
UTF_16 = (b"\xff\xfe", b"\xfe\xff")
UTF_8 = b"\xef\xbb\xbf"
"""Byte-order marks."""
ONE_BYTE = re.compile(r"ascii|us-ascii|(windows|cp|iso|latin|mac)[-_]?[\w-]+", re.IGNORECASE)
"""Names of encodings in which separators and digits are the bytes they are in ASCII."""


class OddTextError(Exception):
    """A text that is not read block by block: only as a whole it can be said what it holds."""


def wide_codec(head: bytes, encoding: str | None) -> str | None:
    """The encoding of a text in which separators and digits are not what they are in ASCII."""
    named = "utf-16" if head.startswith(UTF_16) else (encoding or "utf-8").lower().replace("_", "-")
    plain = named in ("utf-8", "utf8", "utf-8-sig") or ONE_BYTE.fullmatch(named)
    return None if plain else named


def unify_text(raw: bytes, encoding: str | None) -> bytes:
    """The text in UTF-8 where its encoding is wide, without byte-order mark, lines ended by LF."""
    named = wide_codec(raw, encoding)
    if named is not None:
        whole = raw[: len(raw) // 2 * 2] if named.startswith("utf-16") else raw
        text = whole.decode(named, "replace").removeprefix("\ufeff")
        raw = text.encode("utf-8", "replace")
    raw = raw.removeprefix(UTF_8)
    return raw if b"\n" in raw else raw.replace(b"\r", b"\n")


def text_blocks(path: Path, encoding: str | None) -> Iterator[bytes]:
    """The text as `unify_text` has it, in blocks of whole lines; the last may lack its end.

    Raises OddTextError for a line that is longer than the columns of any table.
    """
    rest = b""
    for piece in _pieces(path, encoding):
        block = rest + piece
        if first_long_line(block) is not None:
            raise OddTextError
        end = block.rfind(b"\n") + 1
        rest = block[end:]
        if end:
            yield block[:end]
    if rest:
        yield rest


def first_long_line(raw: bytes) -> int | None:
    """Where a line begins that is longer than the columns of any table; None where none is."""
    at = 0
    while len(raw) - at > LONGEST_LINE:
        end = raw.rfind(b"\n", at, at + LONGEST_LINE)
        if end < 0:
            return at
        at = end + 1
    return None


def _pieces(path: Path, encoding: str | None) -> Iterator[bytes]:
    """The text in UTF-8 or a code page, piece by piece, lines ended as the first piece shows."""
    pieces = _decoded(path, encoding)
    first = next(pieces, b"").removeprefix(UTF_8)
    bare = b"\n" not in first
    for piece in itertools.chain([first], pieces):
        yield piece.replace(b"\r", b"\n") if bare else piece


def _decoded(path: Path, encoding: str | None) -> Iterator[bytes]:
    with path.open("rb") as file:
        piece = file.read(BLOCK)
        named = wide_codec(piece, encoding)
        decode = codecs.getincrementaldecoder(named or "utf-8")("replace").decode
        while piece:
            following = file.read(BLOCK)
            if named is None:
                yield piece
            else:  # half a character of two bytes at the end is none
                ended = not following and not named.startswith("utf-16")
                yield decode(piece, ended).encode("utf-8", "replace")
            piece = following
