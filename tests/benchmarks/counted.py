"""A page of results by seeds: asked for on the command line, counted, written."""

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Final

sys.path.insert(0, str(Path(__file__).parents[2] / ".ci"))
from at_commit import commit_of

ROOT: Final = Path(__file__).parents[2]
RESULTS: Final = Path(__file__).parent / "results"


def counted(
    doc: str | None, page: Callable[[range], tuple[str, bool]], name: str, records: int, first: int
) -> int:
    """Exit status of a script with the options `--records`, `--first-seed` and `--write`.

    Parameters
    ----------
    doc
        The script's own words: what is counted stands in their first line.
    page
        The table over some seeds, and whether all is as it should be.
    name
        Of the page of results.
    """
    parser = argparse.ArgumentParser(description=doc)
    parser.add_argument("--records", type=int, default=records)
    parser.add_argument("--first-seed", type=int, default=first)
    parser.add_argument("--write", action="store_true")
    asked = parser.parse_args()
    seeds = range(asked.first_seed, asked.first_seed + asked.records)
    table, good = page(seeds)
    if asked.write:
        script = Path(sys.argv[0]).resolve().relative_to(ROOT)
        head = (
            f"# {name[0].upper()}{name[1:].replace('_', ' ')}\n\n{(doc or '').splitlines()[0]}\n\n"
            f"`python {script}` at {commit_of(RESULTS)}, seeds "
            f"{seeds[0]} to {seeds[-1]}, none of them used\nwhile building.\n\n"
        )
        (RESULTS / f"{name}.md").write_text(head + table, encoding="utf-8")
    return 0 if good else 1
