"""What a pipeline says that is known beforehand: number by number, or all that her file knows."""

from collections.abc import Mapping
from typing import Any, Final, NamedTuple

from pydantic import ValidatorFunctionWrapHandler, WrapValidator

from trialid.pipeline_file.section import Number, Positive, Section

SHIP: Final = "ship"
"""The word that stands for every number of the ship file."""


class Word(NamedTuple):
    """A word that may stand where a table is expected; the guide's page of keys tells it."""

    text: str


class Prior(Section):
    """What is known of a parameter beforehand, in the parameter's own unit."""

    mean: Number
    """The value known beforehand."""
    std: Positive
    """Its standard deviation."""

    @property
    def known(self) -> tuple[float, float]:
        """Mean and standard deviation."""
        return self.mean, self.std


class OfTheShip(dict[str, Prior]):
    """Stands for what the ship file knows; holds nothing, as the file is not read here."""


def _priors(given: Any, read: ValidatorFunctionWrapHandler) -> Mapping[str, Prior]:
    if isinstance(given, OfTheShip) or given == SHIP:
        return OfTheShip()
    if isinstance(given, str):
        raise ValueError(f'{given!r} is not known; write "ship", or a table of parameters')
    found: Mapping[str, Prior] = read(given)
    return found


OR_SHIP: Final = WrapValidator(_priors)
"""A table of priors, or the word."""
