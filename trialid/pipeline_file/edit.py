"""What a person changes in a pipeline's model: an effect more or less, a parameter free or fixed.

Text in, text out; comments and form are kept, as `place` sees to.
"""

import copy
import re
from collections.abc import Iterable, Sequence
from itertools import product
from typing import Final

from trialid.pipeline_file.complaints import dotted_key
from trialid.pipeline_file.place import (
    Keys,
    data_of,
    inline,
    names_in,
    says,
    source_of,
    with_entry,
    with_item,
    with_key_of,
    without_entry,
    without_item,
)

EFFECTS: Final[Keys] = ("model", "effects")
FREE: Final[Keys] = ("identify", "free")
PRIORS: Final[Keys] = ("identify", "priors")
BOUNDS: Final[Keys] = ("identify", "bounds")
VALUES: Final[Keys] = ("model", "values")
OWN_WORDS: Final[tuple[Keys, ...]] = (PRIORS, BOUNDS, VALUES)
"""Tables in which a user says something of one parameter."""

BY_ADD: Final = "  # start, by linearisation"
"""Marks a line that is not the user's."""


def add_effect(text: str, effect: str, parameters: Iterable[str]) -> str:
    """The pipeline with an effect at the end of its list, and these parameters free.

    Raises
    ------
    PipelineError
        The lists are not there, or cannot be changed without changing something else.
    """
    text = with_item(text, EFFECTS, effect)
    for name in parameters:
        text = with_item(text, FREE, name)
    return text


def drop_effect(text: str, effect: str, parameters: Sequence[str]) -> tuple[str, tuple[str, ...]]:
    """The pipeline without an effect and all that it says of the effect's parameters.

    What `add_effect` has put in is taken out byte for byte. Priors, bounds and values of these
    parameters would stand there for nothing, which a pipeline may not: they go too, and come back
    in words (`identify.priors.GM3 = { mean = 2.0, std = 0.5 }`).

    Raises
    ------
    PipelineError
        As `add_effect`.
    """
    free = names_in(text, FREE)
    for name in [n for n in reversed(free) if n in parameters]:
        text = without_item(text, FREE, name)
    for name in parameters:
        text = _without_start(text, name)
    text = without_item(text, EFFECTS, effect)
    return _without_words(text, OWN_WORDS, parameters)


def set_free(text: str, name: str) -> str:
    """The pipeline with a parameter free.

    Raises
    ------
    PipelineError
        As `add_effect`.
    """
    return with_item(text, FREE, name)


def fix_parameter(text: str, name: str) -> tuple[str, tuple[str, ...]]:
    """The pipeline with a parameter fixed, and without its prior and bounds, which come in words.

    Raises
    ------
    PipelineError
        As `add_effect`.
    """
    return _without_words(without_item(text, FREE, name), (PRIORS, BOUNDS), [name])


def hold_parameter(text: str, name: str) -> tuple[str, tuple[str, ...]]:
    """The same, and without the start that came with its being freed: it is the ship file's again.

    Raises
    ------
    PipelineError
        As `add_effect`.
    """
    return fix_parameter(_without_start(text, name), name)


def set_bounds(text: str, name: str, bounds: tuple[float, float] | None) -> str:
    """The pipeline with these bounds of a parameter, or with none.

    Raises
    ------
    PipelineError
        As `add_effect`.
    """
    if bounds is None:
        return _without_words(text, (BOUNDS,), [name])[0]
    return with_entry(text, BOUNDS, name, list(bounds))


def set_value(text: str, name: str, value: float | None) -> str:
    """The pipeline with a parameter's value or start, or with the ship file's again.

    Raises
    ------
    PipelineError
        As `add_effect`.
    """
    text = _without_start(text, name)
    if value is None:
        return _without_words(text, (VALUES,), [name])[0]
    return with_entry(text, VALUES, name, value)


def set_use(text: str, trial: int, use: str) -> str:
    """The pipeline with a trial, counted from 0, to `fit` or to `check`.

    Raises
    ------
    PipelineError
        As `add_effect`.
    """
    return with_key_of(text, "trial", trial, "use", use)


def _without_words(
    text: str, tables: Sequence[Keys], names: Sequence[str]
) -> tuple[str, tuple[str, ...]]:
    """The text without what tables say of parameters, and that in words."""
    said = []
    for table, name in product(tables, names):
        said_there = data_of(text).get(table[0], {}).get(table[1], {})
        value = said_there.get(name) if isinstance(said_there, dict) else None  # or `"ship"`
        if value is not None:
            said.append(f"{dotted_key(*table, name)} = {inline(value)}")
            text = without_entry(text, table, name)
    return text, tuple(said)


def start_at(text: str, name: str, value: float) -> str:
    """The pipeline with a start for a parameter, in a line of its own below the effects.

    `drop_effect` takes such a line out again byte for byte.

    Raises
    ------
    PipelineError
        As `add_effect`.
    """
    expected = copy.deepcopy(data_of(text))
    expected[EFFECTS[0]].setdefault("values", {})[name] = value
    array = source_of(text, EFFECTS)
    at = text.find(array)
    while at >= 0:
        new = _with_line(text, at, at + len(array), f"values.{name} = {value}{BY_ADD}")
        if says(new, expected):
            return new
        at = text.find(array, at + 1)
    return with_entry(text, VALUES, name, value)


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
