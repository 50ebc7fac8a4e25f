"""An effect into a pipeline's text or out of it, and nothing else: comments and form are kept.

Text in, text out. Each change is checked by reading the new text: it must say what the old one said
but for the names asked for, else the file is the user's to edit by hand.
"""

import copy
import json
import re
import tomllib
from collections.abc import Callable, Iterable, Sequence
from typing import Any, Final

import tomlkit
from tomlkit.exceptions import TOMLKitError

from trialid.errors import RecipeError
from trialid.recipe.array_text import with_name, without_name
from trialid.recipe.complaints import dotted

Keys = tuple[str, str]
EFFECTS: Final[Keys] = ("model", "effects")
FREE: Final[Keys] = ("identify", "free")
OWN_WORDS: Final[tuple[Keys, ...]] = (
    ("identify", "priors"), ("identify", "bounds"), ("model", "values"),
)  # fmt: skip
"""Tables in which a user says something of one parameter."""

BY_ADD: Final = "  # start, by linearisation"
"""Marks a line that is not the user's."""

BOM: Final = "\N{ZERO WIDTH NO-BREAK SPACE}"


def add_effect(text: str, effect: str, parameters: Iterable[str]) -> str:
    """The pipeline with an effect at the end of its list, and these parameters free.

    Raises
    ------
    RecipeError
        The lists are not there, or cannot be changed without changing something else.
    """
    text = _with(text, EFFECTS, effect)
    for name in parameters:
        text = _with(text, FREE, name)
    return text


def drop_effect(text: str, effect: str, parameters: Sequence[str]) -> tuple[str, tuple[str, ...]]:
    """The pipeline without an effect and all that it says of the effect's parameters.

    What `add_effect` has put in is taken out byte for byte. Priors, bounds and values of these
    parameters would stand there for nothing, which a pipeline may not: they go too, and come back
    in words (`identify.priors.GM3 = { mean = 2.0, std = 0.5 }`).

    Raises
    ------
    RecipeError
        As `add_effect`.
    """
    free = _list(text, FREE)
    for name in [n for n in reversed(free) if n in parameters]:
        text = _without(text, FREE, name)
    for name in parameters:
        text = _without_start(text, name)
    text = _without(text, EFFECTS, effect)
    said = []
    for table in OWN_WORDS:
        for name in parameters:
            value = _data(text).get(table[0], {}).get(table[1], {}).get(name)
            if value is not None:
                said.append(f"{dotted(*table, name)} = {_inline(value)}")
                text = _without_entry(text, table, name)
    return text, tuple(said)


def start_at(text: str, name: str, value: float) -> str:
    """The pipeline with a start for a parameter, in a line of its own below the effects.

    `drop_effect` takes such a line out again byte for byte.

    Raises
    ------
    RecipeError
        As `add_effect`.
    """
    expected = copy.deepcopy(_data(text))
    expected[EFFECTS[0]].setdefault("values", {})[name] = value
    array = _source(text, EFFECTS)
    at = text.find(array)
    while at >= 0:
        new = _with_line(text, at, at + len(array), f"values.{name} = {value}{BY_ADD}")
        if _says(new, expected):
            return new
        at = text.find(array, at + 1)
    new = _dumped(text, EFFECTS, "add", name, lambda model: model["values"].add(name, value))
    if not _says(new, expected):
        raise RecipeError(_by_hand(("model", "values"), "add", name))
    return new


def _with_line(text: str, start: int, stop: int, line: str) -> str:
    """The text with a line after the one where a value ends, as far in and as deep as its key."""
    before = text[:start].rpartition("\n")[2]
    key = re.fullmatch(r"(\s*(?:[\w-]+\s*\.\s*)?)effects\s*=\s*", before)
    if key is None:
        return text
    line = key[1] + line
    ends = "\r\n" if "\r\n" in text else "\n"
    at = text.find("\n", stop) + 1
    return f"{text[:at]}{line}{ends}{text[at:]}" if at else f"{text}{ends}{line}"


def _without_start(text: str, name: str) -> str:
    line = rf"[ \t]*(?:[\w-]+\s*\.\s*)?values\.{re.escape(name)} = \S+{re.escape(BY_ADD)}"
    return re.sub(rf"(?m)^{line}\r?\n|\r?\n{line}\Z", "", text, count=1)


def _with(text: str, keys: Keys, name: str) -> str:
    return _rewritten(
        text, keys, lambda array: with_name(array, name), [*_list(text, keys), name], "add", name
    )


def _without(text: str, keys: Keys, name: str) -> str:
    wanted = [n for n in _list(text, keys) if n != name]
    return _rewritten(text, keys, lambda array: without_name(array, name), wanted, "drop", name)


def _rewritten(
    text: str, keys: Keys, change: Callable[[str], str], wanted: list[str], verb: str, name: str
) -> str:
    """The text with one array changed where that, and only that, gives the list wanted."""
    expected = copy.deepcopy(_data(text))
    expected[keys[0]][keys[1]] = wanted
    array = _source(text, keys)
    changed = change(array)
    at = text.find(array)
    while at >= 0:
        new = text[:at] + changed + text[at + len(array) :]
        if _says(new, expected):
            return new
        at = text.find(array, at + 1)
    raise RecipeError(_by_hand(keys, verb, name))


def _without_entry(text: str, table: Keys, name: str) -> str:
    expected = copy.deepcopy(_data(text))
    del expected[table[0]][table[1]][name]
    new = _dumped(text, table, "drop", name, lambda section: section[table[1]].remove(name))
    if not _says(new, expected):
        raise RecipeError(_by_hand(table, "drop", name))
    return new


def _dumped(text: str, keys: Keys, verb: str, name: str, change: Callable[[Any], object]) -> str:
    """The text with one of its sections changed by TOML Kit."""
    try:
        document = tomlkit.parse(text.removeprefix(BOM))
        change(document[keys[0]])
        return text[: text.startswith(BOM)] + tomlkit.dumps(document)
    except (TOMLKitError, KeyError) as error:
        raise RecipeError(_by_hand(keys, verb, name)) from error


def _by_hand(keys: Keys, verb: str, name: str) -> str:
    return f"{dotted(*keys)}: cannot be changed without touching the rest; {verb} {name!r} by hand"


def _source(text: str, keys: Keys) -> str:
    """An array as the file writes it."""
    try:
        section: Any = tomlkit.parse(text.removeprefix(BOM))[keys[0]]
        return str(section[keys[1]].as_string())
    except TOMLKitError as error:
        raise RecipeError(f"{dotted(*keys)}: cannot be found in the text: {error}") from error


def _list(text: str, keys: Keys) -> list[str]:
    table = _data(text).get(keys[0])
    found = table.get(keys[1]) if isinstance(table, dict) else None
    if not isinstance(found, list):
        raise RecipeError(f"{dotted(*keys)}: missing; the pipeline needs it")
    return found


def _data(text: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text.removeprefix(BOM))
    except tomllib.TOMLDecodeError as error:
        raise RecipeError(f"not TOML: {error}") from error


def _says(text: str, expected: dict[str, Any]) -> bool:
    """Whether a text holds this data, an empty table being none."""
    try:
        return _pruned(tomllib.loads(text.removeprefix(BOM))) == _pruned(expected)
    except tomllib.TOMLDecodeError:
        return False


def _pruned(value: Any) -> Any:
    if not isinstance(value, dict):
        return value
    kept = {key: _pruned(each) for key, each in value.items()}
    return {key: each for key, each in kept.items() if each != {}}


def _inline(value: Any) -> str:
    """A value as TOML has it on one line.

    >>> _inline({"mean": 2.0, "std": 0.5}), _inline([-1, 2.5]), _inline("m")
    ('{ mean = 2.0, std = 0.5 }', '[-1, 2.5]', '"m"')
    """
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{k} = {_inline(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    return json.dumps(value) if isinstance(value, str) else str(value)
