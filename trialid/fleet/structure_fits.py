"""The fits of a comparison of structures, done by the workers that do the runs of a fleet."""

import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any

from trialid.errors import TrialidError
from trialid.fleet.dask_workers import LOCAL, answers, check_threads, connect, trouble
from trialid.fleet.inputs import Inputs, laid_out, pack_inputs
from trialid.fleet.task import file_hash, files_of, key_of
from trialid.pipeline_file import Pipeline, read
from trialid.progress import silent
from trialid.threads import one_thread
from trialid.workflow.structures.comparison import Comparison, FitTask
from trialid.workflow.structures.leave_out import KeptFit
from trialid.workflow.structures.rounds import Compute


@dataclass(frozen=True, kw_only=True)
class FitParcel:
    """What a worker needs: the fit, and what its comparison reads, which has a name."""

    task: FitTask
    name: str
    inputs: Inputs


_READ: dict[str, Comparison] = {}
"""The comparison that this worker did fits of last."""


class OtherInputs(OSError):
    """A worker reads other files than the one that asks."""


@one_thread
def do_fit(parcel: FitParcel) -> KeptFit:
    """Do a fit; one that comes to nothing says so, and is no error."""
    warnings.filterwarnings("ignore", category=RuntimeWarning)  # as the command line does
    compared = _comparison(parcel)
    asked = parcel.task
    structure = next(s for s in compared.structures if s.name == asked.structure)
    if compared.task(structure, asked.left_out, asked.whole).key != asked.key:
        raise OtherInputs("the worker reads other logs, ship or effects than the command does")
    return compared.fit(asked)


def _comparison(parcel: FitParcel) -> Comparison:
    """Trials and structures, read once for all the fits that a worker does."""
    if parcel.name not in _READ:
        inputs = parcel.inputs
        with laid_out(inputs) as root:
            made = Comparison(read(inputs.content, root / inputs.pipeline), silent)
        _READ.clear()
        _READ[parcel.name] = made
    return _READ[parcel.name]


@contextmanager
def compute_of(
    pipeline: Pipeline, on: str | None, jobs: int | None, tell: Callable[[str], None]
) -> Iterator[Compute | None]:
    """What does the fits of a pipeline's structures; None where they are done here, in turn.

    Workers are sought with the first fit that is new. Logs travel by path on this machine, by
    content to others. `tell` is given the address of the dashboard.
    """
    if on is None:
        yield None
        return
    with ExitStack() as stack:
        clients: list[Any] = []

        def compute(tasks: Sequence[FitTask]) -> Iterator[tuple[FitTask, KeptFit]]:
            if not clients:
                clients.append(stack.enter_context(connect(on, jobs, len(tasks))))
                check_threads(clients[0])
                tell(f"Dask: {clients[0].dashboard_link}")
            yield from _fits(clients[0], _parcel_of(pipeline, on), tasks)

        yield compute


def _parcel_of(pipeline: Pipeline, on: str) -> Callable[[FitTask], FitParcel]:
    """What makes up a fit for a worker."""
    place, content, files = pipeline.path, pipeline.content, files_of(pipeline)
    inputs, _ = pack_inputs(place, content, files, "path" if on == LOCAL else "content")
    name = key_of(content, place, files, file_hash())
    return lambda task: FitParcel(task=task, name=name, inputs=inputs)


def _fits(
    client: Any, pack: Callable[[FitTask], FitParcel], tasks: Sequence[FitTask]
) -> Iterator[tuple[FitTask, KeptFit]]:
    """Every fit with what came of it; those that are done before a worker fails are given back.

    Raises
    ------
    TrialidError
        A worker could not do one, and no one of several that tried it.
    """
    lost = ""
    for task, future in answers(client, do_fit, tasks, lambda task: f"fit-{task.key}", pack):
        if future.status == "finished":
            yield task, future.result()
        else:
            left = " and ".join(task.left_out)
            which = f"{task.structure} without {left}" if left else task.structure
            lost = lost or f"{which}: {trouble(future)}; what was done is kept"
    if lost:
        raise TrialidError(lost)
