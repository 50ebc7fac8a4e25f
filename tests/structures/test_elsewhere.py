"""Structures compared by many workers: the same digits, whatever order fits come back in."""

import random
import shutil
from functools import partial
from pathlib import Path

import pytest
from compared import FITS, result_in, run

from trialid.errors import NotIdentifiable, TrialidError
from trialid.fleet import structure_fits
from trialid.fleet.inputs import pack_inputs
from trialid.fleet.structure_fits import FitParcel, OtherInputs, do_fit
from trialid.identification import fit as search
from trialid.pipeline_file import load
from trialid.workflow.structures import leave_out
from trialid.workflow.structures.compare_structures import compare_structures
from trialid.workflow.structures.comparison import Comparison


def silent(words, share):
    pass


def drawn(pipeline, travel="path", stop=None):
    """What does fits as a worker would, in an order that is drawn, and is broken off if asked."""
    files = [path for path in pipeline.path.parent.iterdir() if path.suffix != ".json"]
    inputs, _ = pack_inputs(pipeline.path, pipeline.content, files, travel)

    def compute(tasks):
        for number, task in enumerate(random.Random(7).sample(tasks, len(tasks))):
            if number == stop:
                raise KeyboardInterrupt
            yield task, do_fit(FitParcel(task=task, name=str(pipeline.path), inputs=inputs))

    return compute


@pytest.fixture(autouse=True)
def fresh(monkeypatch):
    """A worker that has done nothing yet."""
    monkeypatch.setattr(structure_fits, "_READ", {})


def test_in_any_order_by_content_no_digit_differs(done, turning, tmp_path, count) -> None:
    pipeline = load(turning)
    compute = drawn(pipeline, "content")
    found = compare_structures(pipeline, silent, tmp_path / "many", compute=compute)
    assert found == result_in(done[0])
    assert count["fits"] == FITS
    for name in ("structures.json", "fits.json"):
        assert (tmp_path / "many" / name).read_bytes() == (done[0] / name).read_bytes()


def test_what_came_back_before_an_interruption_is_kept(turning, tmp_path, count) -> None:
    pipeline, folder = load(turning), tmp_path / "many"
    with pytest.raises(KeyboardInterrupt):
        compare_structures(pipeline, silent, folder, False, drawn(pipeline, stop=2))
    assert count["fits"] == 2
    compare_structures(pipeline, silent, folder, False, drawn(pipeline))
    assert count["fits"] == 15


def test_a_structure_that_falls_says_the_same(turning, monkeypatch) -> None:
    """One after the other its further fits are not done; at once they are, and nobody sees it."""

    def failing(trials, model, *given, **named):
        held = [t.name for t in trials if t.use == "check"]
        if "steps-20" in held and any(e.name == "rudder_slipstream" for e in model.effects):
            raise NotIdentifiable("nothing excites the ship")
        return search.identify(trials, model, *given, **named)

    monkeypatch.setattr(leave_out, "identify", failing)
    pipeline = load(turning)
    alone = compare_structures(pipeline, stability=False)
    assert alone.row("cross-flow, race").why_not == "without steps-20: nothing excites the ship"
    assert compare_structures(pipeline, stability=False, compute=drawn(pipeline)) == alone


def test_a_worker_that_reads_other_logs_is_refused(copy) -> None:
    pipeline = load(copy)
    compared = Comparison(pipeline, silent)
    task = compared.task(compared.structures[0], (), None)
    inputs, _ = pack_inputs(pipeline.path, pipeline.content, (), "path")
    log = copy.parent / "steps-20.csv"
    log.write_text(log.read_text(encoding="utf-8").replace("100,", "100.0001,", 1), "utf-8")
    with pytest.raises(OtherInputs, match="reads other logs"):
        do_fit(FitParcel(task=task, name="other", inputs=inputs))


def test_jobs_of_workers_elsewhere_are_refused_in_one_line(turning) -> None:
    said = run(turning, "--on", "tcp://127.0.0.1:9", "--jobs", "2")
    assert said.exit_code == 2
    assert "--jobs goes with --on local" in said.stderr


def test_jobs_alone_are_of_this_machine(turning, monkeypatch) -> None:
    asked = []

    def compute_of(pipeline, on, jobs, tell):
        asked.append((on, jobs))
        raise TrialidError("asked")

    monkeypatch.setattr("trialid.fleet.structure_fits.compute_of", compute_of)
    for more in ((), ("--jobs", "1"), ("--on", "local")):
        assert run(turning, *more).exit_code == 2
    assert asked == [(None, None), ("local", 1), ("local", None)]


@pytest.mark.study(turn=2)
def test_by_dask_no_bit_differs(done, turning, tmp_path) -> None:
    """Processes of this machine by path; a scheduler and workers of their own by content."""
    pytest.importorskip("distributed")
    run_on = partial(run, turning, "--quiet", "--on")
    assert run_on("local", "--jobs", "2", "--out", tmp_path / "local").exit_code == 0
    same(tmp_path / "local", done[0])
    from distributed import LocalCluster

    cluster = LocalCluster(
        n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0"
    )
    with cluster:
        place = cluster.scheduler_address
        assert run_on(place, "--out", tmp_path / "content").exit_code == 0
    same(tmp_path / "content", done[0])


def same(one: Path, other: Path) -> None:
    for name in ("structures.json", "fits.json"):
        assert (one / name).read_bytes() == (other / name).read_bytes()


@pytest.mark.study(turn=7)
def test_a_lost_worker_is_one_line_and_what_was_done_is_kept(turning, tmp_path) -> None:
    """An effect file that ends its worker; the others' fits are there the next time."""
    pytest.importorskip("distributed")
    copy = shutil.copytree(turning.parent, tmp_path / "copy") / turning.name
    (copy.parent / "deadly.py").write_text(DEADLY, encoding="utf-8")
    text = copy.read_text(encoding="utf-8")
    copy.write_text(text.replace("[identify]", 'effects_from = ["deadly.py"]\n[identify]'), "utf-8")
    told = run(*f"{copy} --quiet --on local --jobs 1 --out {tmp_path}/out".split())
    assert told.exit_code == 2
    assert told.stderr.count("\n") == 1
    assert "its workers died" in told.stderr


DEADLY = """import os, signal
from pathlib import Path

from trialid import Force, effect

if "spawn" in Path("/proc/self/cmdline").read_text():
    os.kill(os.getpid(), signal.SIGKILL)


@effect(source="nowhere")
def spare(r, *, N_spare=-0.1):
    '''N = N_spare r'''
    return Force(N=N_spare * r)
"""
