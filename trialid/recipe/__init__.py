"""The pipeline file: TOML in, frozen plain data out, every mistake named by file and key.

Checked here: form, files, quantities, units, contradictions. Names of effects and parameters are
checked by the model, which knows them; it says where with `where(recipe, key)`.
"""

import tomllib
from itertools import chain
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError

from trialid.errors import RecipeError
from trialid.recipe.complaints import dotted, own_mistakes, problem, refusal
from trialid.recipe.contradictions import contradictions
from trialid.recipe.form import (
    Origin,
    Recipe,
    SignalSource,
    TrialRecipe,
    Written,
    neighbours,
)

__all__ = [
    "Recipe",
    "SignalSource",
    "TrialRecipe",
    "load",
    "read",
    "signal_key",
    "sources",
    "where",
]


Form = TypeVar("Form", bound=Written)


def load(path: Path) -> Recipe:
    """Give the pipeline in a TOML file.

    Raises
    ------
    RecipeError
        In one line: the file, the key's full path, what is wrong, the nearest valid names.
    """
    return read(content_of(path), path)


def read(content: bytes, path: Path) -> Recipe:
    """Give the pipeline that stands, or is to stand, in a file.

    Raises
    ------
    RecipeError
        As `load`.
    """
    recipe = formed(Recipe, table_of(content, path), Origin(path, content))
    if problems := list(contradictions(recipe)):
        raise refusal(path, problems)
    return _with_shared_signals(recipe)


def formed(form: type[Form], table: dict[str, Any], origin: Origin) -> Form:
    """What a file holds, held against the form it must have.

    Raises
    ------
    RecipeError
        As `load`.
    """
    try:
        return form.model_validate({"name": origin.path.stem, **table}, context=origin)
    except ValidationError as error:
        found = [problem(one, form) for one in own_mistakes(error)]
        raise refusal(origin.path, found) from error


def where(recipe: Written, key: str) -> str:
    """Words that begin an error about a key: `pipelines/zigzag.toml: model.effects`."""
    return f"{recipe.path}: {key}"


def signal_key(recipe: Recipe, trial: TrialRecipe, quantity: str) -> str:
    """Where a trial's signal is written: `trial[0].signals.u`, or `signals.u` when it is shared."""
    if trial.signals.get(quantity) is recipe.signals.get(quantity, trial):
        return dotted("signals", quantity)
    place = [other.name for other in recipe.trials].index(trial.name)
    return dotted("trial", place, "signals", quantity)


def sources(recipe: Recipe) -> tuple[Path, ...]:
    """Every file or folder of logs the pipeline reads, itself first."""
    logs = [log for trial in recipe.trials for log in trial.logs]
    files = chain.from_iterable((log.path, log.template, log.dbc) for log in logs)
    ship = () if recipe.ship is None else (recipe.ship,)
    return (recipe.path, *ship, *recipe.model.effects_from, *(f for f in files if f))


def table_of(content: bytes, path: Path) -> dict[str, Any]:
    """The TOML in a file; RecipeError when it is none."""
    try:
        text = content.decode("utf-8-sig")  # some editors write a byte-order mark
    except UnicodeDecodeError as error:
        raise RecipeError(f"{path}: not TOML: not UTF-8 text (byte {error.start})") from error
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        last = f"at line {text.count(chr(10)) + 1}, the end of the file"
        said = str(error).replace("at end of document", last)
        raise RecipeError(f"{path}: not TOML: {said}") from error


def content_of(path: Path) -> bytes:
    """What a file of the user's holds; RecipeError when it cannot be read."""
    try:
        return path.read_bytes()
    except FileNotFoundError as error:
        raise RecipeError(f"{path}: no such pipeline file ({neighbours(path)})") from error
    except OSError as error:
        raise RecipeError(f"{path}: cannot be read ({error.strerror})") from error


def _with_shared_signals(recipe: Recipe) -> Recipe:
    trials = tuple(
        trial.model_copy(update={"signals": {**recipe.signals, **trial.signals}})
        for trial in recipe.trials
    )
    return recipe.model_copy(update={"trials": trials})
