"""Small text files of the user's: read within bounds, whatever they are and hold.

A device, a pipe, a file of gigabytes; TOML nested thousands deep or with numbers of thousands of
digits: each is an `OSError` or a `TOMLDecodeError`, which every reader tells in its own words.
"""

import errno
import os
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from trialid.errors import TrialidError

MOST_BYTES: Final = 20_000_000
"""Of a text that people write or edit, a thousand times as long as the shipped pipelines."""
MOST_OF_A_RESULT: Final = 200_000_000
"""Bytes of `result.json`; that of a small run has ten thousand."""
DEEPEST: Final = 40
"""Tables and arrays in one another; a pipeline has five."""
MOST_PARTS: Final = 64
"""Of a dotted key, which the parser walks anew for every part."""
LARGEST: Final = 2**63
"""As TOML has it; Python would read any number of digits, in the square of their count."""


def path_of(given: Any, call: str) -> Path:
    """A path that was given to a call; TrialidError where it is none."""
    if not isinstance(given, str | os.PathLike) or not os.fspath(given):
        raise TrialidError(f"{call}: expected the path of a file or folder, got {given!r}")
    return Path(given)


def content(path: Path, most: int = MOST_BYTES) -> bytes:
    """The bytes of a file.

    Raises
    ------
    OSError
        It cannot be read, is no file but a device or a pipe, or is larger than any of its kind.
    """
    if path.exists() and not path.is_file() and not path.is_dir():
        raise OSError(errno.EINVAL, "is no file but a device or a pipe", str(path))
    with path.open("rb") as stream:
        found = stream.read(most + 1)
    if len(found) > most:
        raise OSError(errno.EFBIG, f"has more than {most // 10**6} MB", str(path))
    return found


def text(path: Path, most: int = MOST_BYTES) -> str:
    """The text of a file, a byte-order mark left out.

    Raises
    ------
    OSError, UnicodeDecodeError
        As `content`; or it is not UTF-8.
    """
    return content(path, most).decode("utf-8-sig").replace("\r\n", "\n")


def toml(text: str) -> dict[str, Any]:
    """What a text of TOML says.

    Raises
    ------
    tomllib.TOMLDecodeError
        It is none, or nested deeper or with larger whole numbers than anybody writes.
    """
    _check_keys(text)
    try:
        found = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except RecursionError as error:
        raise tomllib.TOMLDecodeError("nested too deeply") from error
    except ValueError as error:  # of a number with thousands of digits
        raise tomllib.TOMLDecodeError("a number of too many digits") from error
    _check_values(found)
    return found


def _check_keys(text: str) -> None:
    for number, line in enumerate(text.split("\n"), 1):
        if line.count(".") > MOST_PARTS and _parts(line) > MOST_PARTS:
            raise tomllib.TOMLDecodeError(
                f"a key of more than {MOST_PARTS} parts (at line {number})"
            )


def _check_values(found: dict[str, Any]) -> None:
    for value, depth in _inside(found):
        if depth > DEEPEST:
            raise tomllib.TOMLDecodeError("nested too deeply")
        if isinstance(value, int) and abs(value) >= LARGEST:
            raise tomllib.TOMLDecodeError("a whole number larger than 64 bits hold")


def _parts(line: str) -> int:
    """The most parts of a dotted key that this line may have; none in a comment."""
    if line.lstrip().startswith("#"):
        return 0
    pieces = line.split("=")
    keys = pieces if line.lstrip().startswith("[") else pieces[:-1]
    return max((_last(key).count(".") + 1 for key in keys), default=0)


def _last(text: str) -> str:
    """What stands after the last comma or brace: there a key begins."""
    return text[max(text.rfind(","), text.rfind("{")) + 1 :]


def _inside(found: dict[str, Any]) -> Iterator[tuple[Any, int]]:
    """Every value, with how deep it lies; no deeper than is refused."""
    todo: list[tuple[Any, int]] = [(found, 0)]
    while todo:
        value, depth = todo.pop()
        yield value, depth
        if isinstance(value, dict):
            todo += [(one, depth + 1) for one in value.values()]
        elif isinstance(value, list):
            todo += [(one, depth + 1) for one in value]
