"""`result.json`: written from a result and read back into one; its JSON Schema."""

import json
import math
from collections.abc import Hashable, Mapping
from dataclasses import asdict, fields, is_dataclass, replace
from functools import cache
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
from pydantic import TypeAdapter, ValidationError

from trialid import user_files
from trialid.errors import TrialidError, nearest
from trialid.result.schema import SCHEMA, Result

Row = TypeVar("Row")
NAME = "result.json"


def plain(row: Any) -> dict[str, Any]:
    """A result, or a row of one, as mappings, lists and numbers that `json.dumps` takes."""
    return asdict(row)


def text_of(result: Any) -> str:
    """The content of `result.json`, or of another result's file."""
    return json.dumps(plain(result), indent=1, allow_nan=False) + "\n"


def result_of(data: Mapping[str, Any]) -> Result:
    """The result that plain data holds; keys of another version are passed over.

    Raises
    ------
    TrialidError
        In one line: the key, and what was expected.
    """
    return row_of(Result, data)


def row_of(kind: type[Row], data: Any) -> Row:
    """A row of the schema from plain data.

    Raises
    ------
    TrialidError
        In one line: the key, and what was expected.
    """
    try:
        row: Row = _reader(cast(Hashable, kind)).validate_python(data)
        return row
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(map(str, first["loc"])) or "the whole"
        raise TrialidError(f"{key}: {first['msg'].lower()}") from error


@cache
def _reader(kind: Any) -> TypeAdapter[Any]:
    return TypeAdapter(kind)


def read(path: Path, advice: str = "name the folder of a finished `trialid run`") -> Result:
    """The result in a file.

    Raises
    ------
    TrialidError
        There is none, it is none of this schema, or it was edited; with what to do.
    """
    if not _exists(path):
        advice += _runs_beside(path.parent)
    data = read_object(path, advice)
    if data.get("schema") != SCHEMA:
        raise TrialidError(f"{path}: schema {data.get('schema')!r}, expected {SCHEMA!r}")
    try:
        return result_of(data)
    except TrialidError as error:
        raise TrialidError(f"{path}: {error}; it was edited, run the pipeline anew") from error


def _exists(path: Path) -> bool:
    """Whether there is such a file, or a name that only reading it can complain about."""
    try:
        return path.exists()
    except OSError:
        return True


def _runs_beside(folder: Path) -> str:
    """Words about the finished runs that lie where one was looked for."""
    names = [found.parent.name for found in folder.parent.glob(f"*/{NAME}")]
    return f"; {nearest(folder.name, names)}" if names else ""


def read_object(path: Path, advice: str) -> dict[str, Any]:
    """A JSON object in a file.

    Raises
    ------
    TrialidError
        It cannot be read, or is no object of JSON.
    """
    try:
        text = user_files.text(path, user_files.MOST_OF_A_RESULT)
        found = json.loads(text, parse_constant=_number, parse_float=_number)
    except OSError as error:
        reason = (error.strerror or str(error)).lower()
        raise TrialidError(f"{path}: cannot be read ({reason}); {advice}") from error
    except (ValueError, RecursionError) as error:
        raise TrialidError(f"{path}: not JSON ({error}); {advice}") from error
    try:
        json.dumps(found, ensure_ascii=False).encode("utf-8")
    except (UnicodeEncodeError, RecursionError) as error:
        raise TrialidError(f"{path}: holds what is no text ({error}); {advice}") from error
    if not isinstance(found, dict):
        raise TrialidError(f"{path}: not an object of JSON; {advice}")
    return found


def _number(text: str) -> float:
    """A number of JSON, which has no infinite ones."""
    number = float(text)
    if not math.isfinite(number):
        raise ValueError(f"{text} is no number of JSON")
    return number


def json_schema(kind: type = Result) -> dict[str, Any]:
    """The JSON Schema of `result.json`, or of another result, derived from the rows."""
    dialect = "https://json-schema.org/draft/2020-12/schema"
    return {"$schema": dialect, **_reader(kind).json_schema()}


def finite(value: Any) -> Any:
    """The same with infinite and undefined numbers as None: they are not known.

    >>> finite({"a": [1.0, float("inf")]})
    {'a': [1.0, None]}
    """
    if is_dataclass(value) and not isinstance(value, type):
        return replace(value, **{f.name: finite(getattr(value, f.name)) for f in fields(value)})
    if isinstance(value, Mapping):
        return {k: finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return type(value)(finite(v) for v in value)
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    return value
