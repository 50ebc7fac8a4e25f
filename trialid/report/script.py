"""The modules of the report's script as one text: a page alone has nowhere to load them from."""

import re
from collections.abc import Sequence
from functools import cache
from importlib import resources
from typing import Final

MODULES: Final = (
    "plots/numbers.js",
    "plots/sizes.js",
    "plots/painting.js",
    "plots/track.js",
    "plots/zoom.js",
    "plots/drawings.js",
    "plots/chart.js",
    "plots/picture.js",
    "plots/signals.js",
    "plots.js",
    "page.js",
)
"""Each after those it imports from."""

_IMPORT: Final = re.compile(r"^import .*\n", re.MULTILINE)
_EXPORT: Final = re.compile(r"^export (?=(?:async function|function|const) )", re.MULTILINE)


@cache
def script() -> str:
    """What draws the plots of a report, without `uPlot`, for one `<script type="module">`."""
    files = resources.files("trialid.report")
    return join_modules([files.joinpath(name).read_text(encoding="utf-8") for name in MODULES])


def join_modules(modules: Sequence[str]) -> str:
    r"""Modules in the order of their imports as one: they find each other's names in one scope.

    Imports stand on one line each, exports before what they export, and no name occurs twice.

    >>> join_modules(["export const two = 2;", 'import { two } from "./two.js";\nwrite(two);'])
    'const two = 2;\nwrite(two);'
    """
    return "\n".join(_EXPORT.sub("", _IMPORT.sub("", module)) for module in modules)
