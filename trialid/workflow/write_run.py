"""A run's folder: report, result, series, a recording for plot tools, the pipeline."""

import hashlib
import json
import os
import tempfile
from functools import partial
from pathlib import Path

from trialid import own_files
from trialid.report.files.overlay import write_mcap
from trialid.report.pages.page import write_page
from trialid.result import track_series
from trialid.result.force_series import force_series, write_force_csv
from trialid.result.json_file import text_of
from trialid.result.series import write_csv
from trialid.result.track_series import write_track_csv
from trialid.second_process import both
from trialid.workflow.outcome import Outcome, Run
from trialid.workflow.run_folder import ORIGIN
from trialid.workflow.use import kept_standing
from trialid.workflow.use.kept_standing import standing_bytes


def write(done: Run | Outcome, folder: Path) -> None:
    """The run's folder: report, result, series, a recording that opens in plot tools, the pipeline.

    Everything is written aside and moved in place at the end, each file at one stroke; what is not
    ours in the folder stays.

    Raises
    ------
    TrialidError
        A file that is not ours stands in the way; the folder is as it was.
    """
    with own_files.replacing(folder) as work:
        _write_files(done, work)
        _write_origin(done, work, folder)


def run_files(done: Run | Outcome, folder: Path) -> dict[str, bytes]:
    """What `write` writes into a folder, by name, for whoever brings it there."""
    with tempfile.TemporaryDirectory() as made:
        work = Path(made)
        _write_files(done, work)
        _write_origin(done, work, folder)
        return {path.name: path.read_bytes() for path in sorted(work.iterdir())}


def _write_files(done: Run | Outcome, folder: Path) -> None:
    both(
        partial(_write_pages, done, folder),
        partial(write_mcap, folder / "predicted.mcap", done.result, done.series),
    )


def _write_pages(done: Run | Outcome, folder: Path) -> None:
    """All but the recording, which takes as long."""
    result = text_of(done.result).encode()
    (folder / "result.json").write_bytes(result)
    write_csv(folder / "series.csv", done.series)
    tracks = [one.track for one in done.series if one.track is not None]
    if tracks:
        write_track_csv(folder / track_series.FILE, tracks)
    forces = force_series(done.force) if done.force is not None else ()
    if forces:
        write_force_csv(folder / "missing_force.csv", forces)
    write_page(folder / "report.html", done.result, done.series, forces)
    (folder / "pipeline.toml").write_bytes(done.pipeline.content)
    standing = _standing(done, result)
    if standing is not None:
        (folder / kept_standing.FILE).write_bytes(standing)


def _standing(done: Run | Outcome, result: bytes) -> bytes | None:
    """What makes taking the run up quick; None with effects that may change unseen."""
    if isinstance(done, Outcome) or done.pipeline.model.effects_from:
        return None
    return standing_bytes(done.findings.before, result)


def _write_origin(done: Run | Outcome, work: Path, folder: Path) -> None:
    """`run.json`: what `trialid run --repeat` needs to find the logs again from the folder."""
    pipeline = done.pipeline
    origin = {
        "schema": ORIGIN,
        "version": done.result.version,
        "pipeline": Path(os.path.relpath(pipeline.path.resolve(), folder.resolve())).as_posix(),
        "sha256": hashlib.sha256(pipeline.content).hexdigest(),
        "seed": pipeline.identify.seed,
        "force": done.force is not None,
        "grown": done.grown,
    }
    text = json.dumps(origin, indent=1) + "\n"
    (work / "run.json").write_text(text, encoding="utf-8")
