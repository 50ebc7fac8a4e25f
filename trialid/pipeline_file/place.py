"""Single places of a pipeline's text changed: comments and form are kept.

Each change is checked by reading the new text: it must say what the old one said but for the place
asked for, else the file is the user's to edit by hand.
"""

import copy
import json
import re
import tomllib
from collections.abc import Callable
from operator import delitem, setitem
from typing import Any, Final

import tomlkit
from tomlkit.exceptions import TOMLKitError
from tomlkit.items import InlineTable

from trialid import user_files
from trialid.errors import PipelineError
from trialid.pipeline_file.array_text import with_name, without_name
from trialid.pipeline_file.complaints import dotted_key

Keys = tuple[str, str]
BOM: Final = "\N{ZERO WIDTH NO-BREAK SPACE}"


def with_item(text: str, keys: Keys, name: str) -> str:
    """The text with a name more at the end of an array."""
    return _rewritten(
        text, keys, lambda array: with_name(array, name), [*names_in(text, keys), name], "add", name
    )


def without_item(text: str, keys: Keys, name: str) -> str:
    """The text with a name less in an array."""
    wanted = [n for n in names_in(text, keys) if n != name]
    return _rewritten(text, keys, lambda array: without_name(array, name), wanted, "drop", name)


def _rewritten(
    text: str, keys: Keys, change: Callable[[str], str], wanted: list[str], verb: str, name: str
) -> str:
    """The text with one array changed where that, and only that, gives the list wanted."""
    expected = copy.deepcopy(data_of(text))
    expected[keys[0]][keys[1]] = wanted
    array = source_of(text, keys)
    changed = change(array)
    at = text.find(array)
    while at >= 0:
        new = text[:at] + changed + text[at + len(array) :]
        if says(new, expected):
            return new
        at = text.find(array, at + 1)
    raise PipelineError(by_hand(keys, verb, name))


def with_entry(text: str, table: Keys, name: str, value: Any) -> str:
    """The text with one entry of a table set: `bounds.Yv = [-1.0, 0.0]`."""
    expected = copy.deepcopy(data_of(text))
    expected.setdefault(table[0], {}).setdefault(table[1], {})[name] = value
    new = _dumped(text, table, "set", name, lambda part: setitem(_in(part, table), name, value))
    if not says(new, expected):
        raise PipelineError(by_hand(table, "set", name))
    return new


def _in(section: Any, table: Keys) -> Any:
    """The table, made where it is not there, on one line."""
    return section.setdefault(table[1], tomlkit.inline_table())


def with_key_of(text: str, tables: str, index: int, key: str, value: Any) -> str:
    """The text with one key of one of several tables set: `use` of the second `[[trial]]`."""
    expected = copy.deepcopy(data_of(text))
    expected[tables][index][key] = value
    keys = (tables, key)
    new = _dumped(text, keys, "set", str(value), lambda each: setitem(each[index], key, value))
    if not says(new, expected):
        raise PipelineError(by_hand(keys, "set", str(value)))
    return new


def without_entry(text: str, table: Keys, name: str) -> str:
    """The text with an entry of a table less, and without the `{}` that would be left of it."""
    expected = copy.deepcopy(data_of(text))
    del expected[table[0]][table[1]][name]
    new = _dumped(text, table, "drop", name, lambda section: delitem(section[table[1]], name))
    if not says(new, expected):
        raise PipelineError(by_hand(table, "drop", name))
    return _without_bare(new, table)


def _without_bare(text: str, table: Keys) -> str:
    """The text without an inline table that is empty, unless the user says something beside it."""
    section: Any = tomlkit.parse(text.removeprefix(BOM))[table[0]]
    left = section.get(table[1])
    if left or not isinstance(left, InlineTable) or left.trivia.comment:
        return text
    expected = copy.deepcopy(data_of(text))
    del expected[table[0]][table[1]]
    new = _dumped(text, table, "drop", table[1], lambda part: delitem(part, table[1]))
    return new if says(new, expected) else text


def _dumped(text: str, keys: Keys, verb: str, name: str, change: Callable[[Any], object]) -> str:
    """The text with one of its sections changed by TOML Kit."""
    try:
        document = tomlkit.parse(text.removeprefix(BOM))
        change(document[keys[0]])
        new = tomlkit.dumps(document)
    except (TOMLKitError, KeyError) as error:
        raise PipelineError(by_hand(keys, verb, name)) from error
    if "\n" not in text.replace("\r\n", ""):  # every line ends as on Windows: new ones too
        new = re.sub(r"(?<!\r)\n", "\r\n", new)
    return text[: text.startswith(BOM)] + new


def by_hand(keys: Keys, verb: str, name: str) -> str:
    """Why a place is left to the user."""
    return (
        f"{dotted_key(*keys)}: cannot be changed without touching the rest; {verb} {name!r} by hand"
    )


def source_of(text: str, keys: Keys) -> str:
    """An array as the file writes it."""
    try:
        section: Any = tomlkit.parse(text.removeprefix(BOM))[keys[0]]
        return str(section[keys[1]].as_string())
    except TOMLKitError as error:
        raise PipelineError(f"{dotted_key(*keys)}: cannot be found in the text: {error}") from error


def names_in(text: str, keys: Keys) -> list[str]:
    """What an array holds."""
    table = data_of(text).get(keys[0])
    found = table.get(keys[1]) if isinstance(table, dict) else None
    if not isinstance(found, list):
        raise PipelineError(f"{dotted_key(*keys)}: missing; the pipeline needs it")
    return found


def data_of(text: str) -> dict[str, Any]:
    """What a text says."""
    try:
        return user_files.toml(text.removeprefix(BOM))
    except tomllib.TOMLDecodeError as error:
        raise PipelineError(f"not TOML: {error}") from error


def says(text: str, expected: dict[str, Any]) -> bool:
    """Whether a text holds this data, an empty table being none."""
    try:
        return _pruned(user_files.toml(text.removeprefix(BOM))) == _pruned(expected)
    except tomllib.TOMLDecodeError:
        return False


def _pruned(value: Any) -> Any:
    if not isinstance(value, dict):
        return value
    kept = {key: _pruned(each) for key, each in value.items()}
    return {key: each for key, each in kept.items() if each != {}}


def inline(value: Any) -> str:
    """A value as TOML has it on one line.

    >>> inline({"mean": 2.0, "std": 0.5}), inline([-1, 2.5]), inline("m")
    ('{ mean = 2.0, std = 0.5 }', '[-1, 2.5]', '"m"')
    """
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {inline(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(inline, value)) + "]"
    return json.dumps(value) if isinstance(value, str) else str(value)
