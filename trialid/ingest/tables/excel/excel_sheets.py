"""The sheets of one Excel file, read by a process of its own that may die of it.

    python -P excel_sheets.py FILE

The library sets memory aside by what a file declares and aborts where there is none, which no
`except` can catch. So it is called here, under limits, and what it found goes back through stdout.
Nothing of the package is imported: the process begins in a few hundredths of a second.
"""

import pickle
import sys
from typing import Any

MOST_MEMORY = 1_500_000_000
"""Bytes of addresses. Three million cells were read within 240 MB, so that twelve million, as many
as are let through, should need a gigabyte; half of it would then refuse a sheet of a million rows
and ten columns, twice of it lets one small file take what a small machine has."""
MOST_SECONDS = 120
"""Of computing. Three million cells took 5 s of a busy machine; the guard keeps the rest from being
spent."""

Found = tuple[str | None, dict[str, list[list[Any]]]]
"""What is wrong, or None; and the rows of every sheet."""


def limit() -> None:
    """An end to what takes too much, where the system can; no file of what was in memory."""
    try:
        import resource
    except ImportError:  # Windows: only the process of its own is left
        return
    for what, most in (
        (resource.RLIMIT_AS, MOST_MEMORY),
        (resource.RLIMIT_CPU, MOST_SECONDS),
        (resource.RLIMIT_CORE, 0),
    ):
        _, hard = resource.getrlimit(what)
        low = most if hard == resource.RLIM_INFINITY else min(most, hard)
        try:
            resource.setrlimit(what, (low, low))
        except (OSError, ValueError):  # macOS: no limit on addresses
            continue


def sheets(path: str) -> Found:
    """Every sheet as rows of cells from the first of each, or the library's words."""
    import python_calamine as calamine

    try:
        with open(path, "rb") as file:  # noqa: PTH123  an open file: its name says no format
            book = calamine.CalamineWorkbook.from_filelike(file)
            rows = {
                name: book.get_sheet_by_name(name).to_python(skip_empty_area=False)
                for name in book.sheet_names
            }
    except (calamine.CalamineError, ValueError, OSError, OverflowError) as error:
        return str(error), {}
    return None, rows


if __name__ == "__main__":
    limit()
    pickle.dump(sheets(sys.argv[1]), sys.stdout.buffer, protocol=5)
