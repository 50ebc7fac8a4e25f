"""A table of a user's file, and the plain numbers in it."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, Strict

# Strict, because a pipeline that writes "0.5" or true for a number has a slip worth showing.
Number = Annotated[float, Strict()]
Positive = Annotated[Number, Field(gt=0)]
NotNegative = Annotated[Number, Field(ge=0)]


class Section(BaseModel):
    """A table of the pipeline file: frozen, finite numbers, no key it does not know.

    The line under a key says what it means: the guide's page of keys is made of them.
    """

    model_config = ConfigDict(
        frozen=True, extra="forbid", allow_inf_nan=False, use_attribute_docstrings=True
    )
