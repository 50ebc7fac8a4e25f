"""The house rules: what ruff, mypy and the layers' contract cannot say of how this code is kept."""

from collections.abc import Callable, Iterator, Mapping
from typing import Final

from house.imports import dependencies
from house.names import function_names, module_names
from house.order import set_orders
from house.shapes import (
    dataclass_keywords,
    error_returns,
    package_fronts,
    positional_arguments,
    string_subscripts,
)
from house.sizes import file_lengths, folder_sizes, format_skips, function_lengths, readme
from house.sources import Breach, House

__all__ = ["RULES", "Breach", "House", "Rule"]

Rule = Callable[[House], Iterator[Breach]]

RULES: Final[Mapping[str, Rule]] = {
    "file-length": file_lengths,
    "folder-size": folder_sizes,
    "function-length": function_lengths,
    "format-skip": format_skips,
    "readme": readme,
    "module-name": module_names,
    "function-name": function_names,
    "package-front": package_fronts,
    "dataclass-keywords": dataclass_keywords,
    "positional-arguments": positional_arguments,
    "string-subscript": string_subscripts,
    "error-return": error_returns,
    "set-order": set_orders,
    "dependencies": dependencies,
}
"""Every rule by its name: what it finds, each with the place and what to do."""
