"""The runs of a study, each for itself: in this process, in several, or by a scheduler's workers.

Workers elsewhere need the same repository, and where a study's modules lie:

    PYTHONPATH=.:tests/benchmarks dask worker tcp://HOST:8786 --nthreads 1

What comes out is the same: a run depends on its item alone.
"""

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from importlib import import_module
from pathlib import Path
from typing import TypeVar

from trialid.fleet.dask_workers import check_threads, connect

Item = TypeVar("Item")
Found = TypeVar("Found")


def add_options(parser: argparse.ArgumentParser, jobs: int = 1) -> None:
    """`--jobs` and `--on`."""
    parser.add_argument("--jobs", type=int, default=jobs, help="processes of this machine")
    parser.add_argument(
        "--on", metavar="WHERE", help="by Dask: local, tcp://HOST:PORT or a cluster's YAML file"
    )


def spread(
    does: Callable[[Item], Found],
    items: Sequence[Item],
    jobs: int,
    on: str | None = None,
    together: int = 1,
) -> Iterator[Found]:
    """What `does` gives for each item, in their order, as they are done.

    Parameters
    ----------
    together
        Neighbours that one process of several does, since they share what is compiled.
    """
    if on is not None:
        with connect(on, jobs, len(items)) as client:
            check_threads(client)
            print(f"Dask: {client.dashboard_link}", file=sys.stderr)
            for future in client.map(_named(does), items, pure=False):
                yield future.result()
    elif jobs == 1:
        yield from map(does, items)
    else:
        with ProcessPoolExecutor(jobs) as pool:
            yield from pool.map(does, items, chunksize=together)


def _named(does: Callable[[Item], Found]) -> Callable[[Item], Found]:
    """The same function under a name that workers can import: there is none in a script."""
    if does.__module__ != "__main__":
        return does
    module = import_module(Path(sys.modules["__main__"].__file__ or "").stem)
    found: Callable[[Item], Found] = getattr(module, does.__name__)
    return found
