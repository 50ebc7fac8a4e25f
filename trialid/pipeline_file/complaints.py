"""What is wrong with a pipeline file, as one line with the key's full path."""

import json
import re
import reprlib
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from trialid.errors import PipelineError, nearest
from trialid.pipeline_file.form import Pipeline
from trialid.pipeline_file.section import Section

Problem = tuple[str, str]
"""The key's full path, and a sentence that says what is wrong there."""


def refusal(path: Path, problems: Sequence[Problem]) -> PipelineError:
    """The first problem as one line; the others are counted."""
    key, sentence = problems[0]
    more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
    return PipelineError(" ".join(f"{path}: {key}: {sentence}{more}".splitlines()))


def dotted_key(*steps: str | int) -> str:
    """Give a key's full path as TOML would write it.

    >>> dotted_key("trial", 0, "signals", "odd name", "unit")
    'trial[0].signals."odd name".unit'
    """
    text = ""
    for step in steps:
        if isinstance(step, int):
            text += f"[{step}]"
        else:
            bare = re.fullmatch(r"[A-Za-z0-9_-]+", step) is not None
            text += "." + (step if bare else json.dumps(step))
    return text.removeprefix(".")


def own_mistakes(error: ValidationError) -> list[ErrorDetails]:
    """Give what the user wrote wrong, the telling ones first, without what only follows from it."""
    # A list whose entries are refused counts as empty too.
    own = [one for one in error.errors() if one["type"] != "too_short" or not one["input"]]
    # A misspelt key is a missing one too; the misspelling leads.
    return sorted(own, key=lambda one: one["type"] != "extra_forbidden")


def problem(detail: ErrorDetails, form: type[Section] = Pipeline) -> Problem:
    """The place and the sentence for what the check of a form found."""
    say = _SENTENCES.get(detail["type"], _as_reported)
    *parents, key = detail["loc"]
    bare = parents[-2:-1] == ["logs"] and key == "path"  # mostly written without the key
    return dotted_key(*(parents if bare else detail["loc"])), say(detail, form)


_HELD_OUT: Final = frozenset({"hold_out", "held_out", "holdout", "held out", "check", "validation"})
"""What people write for a trial that is not fitted, as a key or as a value."""


def _hint(word: str) -> str:
    """How what was meant is spelt, where it is known."""
    return '; use = "check" holds a trial out' if word.lower() in _HELD_OUT else ""


def _as_reported(detail: ErrorDetails, form: type[Section]) -> str:
    wanted = detail["msg"].replace("Input should be", "must be")
    return f"{wanted}, got {reprlib.repr(detail['input'])}"


def _unknown_key(detail: ErrorDetails, form: type[Section]) -> str:
    *parents, key = detail["loc"]
    keys = _keys(_section(parents, form))
    return f"unknown key; {nearest(str(key), keys)}{_hint(str(key))}"


def _not_listed(detail: ErrorDetails, form: type[Section]) -> str:
    allowed = re.findall(r"'([^']*)'", detail["ctx"]["expected"])
    given = detail["input"]
    if given == "?":
        return f"is still open; write one of {', '.join(map(repr, sorted(allowed)))}"
    return f"{given!r} is not allowed; {nearest(str(given), allowed)}{_hint(str(given))}"


def _not_a_list(detail: ErrorDetails, form: type[Section]) -> str:
    if isinstance(detail["input"], dict):
        key = detail["loc"][-1]
        return f"must be a list of tables; write [[{key}]] with two brackets"
    return f"must be a list in square brackets, got {reprlib.repr(detail['input'])}"


def _not_a_table(detail: ErrorDetails, form: type[Section]) -> str:
    keys = ", ".join(_keys(_section(detail["loc"], form)))
    return f"must be a table (keys: {keys}), got {reprlib.repr(detail['input'])}"


_SENTENCES: Final[Mapping[str, Callable[[ErrorDetails, type[Section]], str]]] = {
    "extra_forbidden": _unknown_key,
    "literal_error": _not_listed,
    "missing": lambda detail, form: "missing; the pipeline needs it",
    "model_type": _not_a_table,
    "too_long": lambda detail, form: f"too long, got {reprlib.repr(detail['input'])}",
    "too_short": lambda detail, form: "must not be empty",
    "tuple_type": _not_a_list,
    "value_error": lambda detail, form: str(detail["ctx"]["error"]),
}


def _keys(section: type[Section]) -> list[str]:
    return [field.alias or name for name, field in section.model_fields.items()]


def _section(steps: Iterable[str | int], form: type[Section]) -> type[Section]:
    """Give the section that stands at a place in a file of this form.

    >>> _section(("trial", 0, "signals", "delta"), Pipeline).__name__
    'SignalSource'
    """
    section = form
    for step in steps:
        for name, field in section.model_fields.items():
            if (field.alias or name) == step:
                section = next(_sections_in(field.annotation), section)
                break
    return section


def _sections_in(annotation: Any) -> Iterator[type[Section]]:
    if isinstance(annotation, type) and issubclass(annotation, Section):
        yield annotation
    for part in getattr(annotation, "__args__", ()):
        yield from _sections_in(part)
