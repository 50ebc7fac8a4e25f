"""Nothing shared but the place: test modules import `s175q` beside this file; studies in turn."""

import os

from turns import pytest_collection_modifyitems as pytest_collection_modifyitems  # noqa: PLC0414

# xdist tells its workers the width of a terminal; what is tested is what a file or a pipe gets.
os.environ.pop("COLUMNS", None)
