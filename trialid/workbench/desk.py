"""Where a person works: the file, the model it holds as far as it is known, and what is being done.

One lock guards it all, and one thread at a time computes. A computation that nobody wants any more
is let go at once; it ends by itself at its next word of progress.
"""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Final

from trialid.errors import PipelineError, TrialidError
from trialid.pipeline_file import Pipeline
from trialid.result.change_rows import StepRow
from trialid.workbench.compute import Job, LetGo, Seat, Task, give_back_memory, work_out
from trialid.workbench.document import Document, Step
from trialid.workbench.shelf import Shelf
from trialid.workbench.shown import Shown, Trouble, Working, goes_on, place_of
from trialid.workbench.status import Counts, Status, status_of
from trialid.workbench.watch import Files, source_states, watch_list
from trialid.workbench.wishes import Granted, find_edit, grant, read_wish
from trialid.workflow import history
from trialid.workflow.build_model import available
from trialid.workflow.edit_pipeline import Edit
from trialid.workflow.outcome import Outcome

KEPT: Final = 12
"""How many models stay at hand for undo, their series included."""

POLL: Final = 0.3
"""Between two looks at the files [s]; a change is taken up when it has stood for one of them."""


@dataclass
class Desk:
    """A pipeline file at work.

    Raises PipelineError when the file is no pipeline to begin with.
    """

    path: Path
    _lock: threading.RLock = field(default_factory=threading.RLock)
    _computing: threading.Lock = field(default_factory=threading.Lock)
    _ended: threading.Event = field(default_factory=threading.Event)
    _shelf: Shelf = field(default_factory=Shelf)
    _kept: dict[str, Outcome] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self._document = Document(self.path)
        pipeline = self._document.pipeline
        self._shown = Shown(pipeline, available(pipeline))
        self._working: Working | None = None
        self._trouble: Trouble | None = None
        self._outside: Trouble | None = None
        self._job: Job | None = None
        self._counts = Counts()
        self._begin(Task(pipeline, "opening"), None)
        known = {path: one for path, one in watch_list(pipeline).items() if path != self.path}
        threading.Thread(target=self._watch, args=(known,), daemon=True).start()

    @property
    def shown(self) -> Shown:
        """What is known at this moment."""
        with self._lock:
            return self._shown

    @property
    def status(self) -> Status:
        """Where things are at this moment."""
        with self._lock:
            trouble = self._outside or self._trouble
            return status_of(self._document, self._shown, self._counts, self._working, trouble)

    @property
    def closed(self) -> bool:
        """Whether it is at its end: nothing is written any more."""
        return self._ended.is_set()

    def edit(self, asked: object) -> None:
        """Do what a page asks for: it is in the file when this returns, the refit has begun.

        Raises
        ------
        Outdated
            The file was changed meanwhile.
        TrialidError
            It cannot be done; nothing has changed.
        """
        wish = read_wish(asked)
        with self._open():
            self._document.check(wish.version)
            found = grant(self._document.pipeline, wish)
            step = self._document.put(found.after, found.words)
            self._changed(found, step)

    def undo(self, version: str) -> None:
        """Take the last edit back; as `edit`."""
        self._stepped(version, self._document.undo, "undo: {}")

    def redo(self, version: str) -> None:
        """Make the edit that was undone last again; as `edit`."""
        self._stepped(version, self._document.redo, "again: {}")

    def again(self) -> None:
        """Work the file's model out once more."""
        with self._open():
            self._document.reread()
            self._trouble = None
            self._begin(Task(self._document.pipeline, "fit again", None, self._shown), None)

    def cancel(self) -> None:
        """Stop computing, and take the edit back that it was for."""
        with self._lock:
            job = self._job
            if job is not None:
                self._trouble = None
                self._let_go(job)
                if not self._back(job, "cancelled"):
                    words = "stopped; what is shown is not all of the file's model: fit it again"
                    self._trouble = Trouble("fit", f"{job.task.why}: {words}")
                    self._count()

    def close(self) -> None:
        """Stop computing and watching; nothing is written any more."""
        with self._lock:
            self._ended.set()
            if self._job is not None:
                self._let_go(self._job)

    @contextmanager
    def _open(self) -> Iterator[None]:
        """The lock, unless it is closed: nothing is written then."""
        with self._lock:
            if self.closed:
                raise PipelineError("the workbench is closed; nothing was done")
            yield

    def _stepped(self, version: str, move: Callable[[], Step], words: str) -> None:
        with self._open():
            self._document.check(version)
            old = self._document.pipeline
            step = move()
            after = self._document.pipeline
            self._changed(Granted(after, words.format(step.words), find_edit(old, after)), None)

    def _changed(self, found: Granted, step: Step | None) -> None:
        """Work out what the file holds now, its last complete model being the one before."""
        before = self._shown
        whole = self._job is None and before.run is not None
        kept = self._known(found.after) if step is None else None
        self._trouble = None
        task = Task(
            found.after, found.words, found.edit if whole else None, before, kept, recorded=True
        )
        self._begin(task, step)

    def _known(self, pipeline: Pipeline) -> Outcome | None:
        """What was found for this very model on these very files."""
        return self._kept.get(_name(pipeline, source_states(pipeline)))

    def _begin(self, task: Task, step: Step | None) -> None:
        if self._job is not None:
            self._let_go(self._job)
        self._job = Job(task, step, source_states(task.pipeline))
        self._working = Working(task.why, "waiting", None)
        self._count()
        threading.Thread(target=self._compute, args=(self._job,), daemon=True).start()

    def _compute(self, job: Job) -> None:
        """Work a job out; its end is shown whatever it is."""
        with self._computing:
            try:
                work_out(job.task, self._shelf, _Seat(self, job))
            except LetGo:
                return
            except TrialidError as error:
                self._failed(job, error)
            except BaseException as error:
                self._failed(
                    job, PipelineError(f"a bug in trialid: {type(error).__name__}: {error}")
                )
                raise
            else:
                self._finished(job)
            finally:
                give_back_memory()

    def _finished(self, job: Job) -> None:
        with self._lock:
            if job.wanted:
                self._job = self._working = None
                self._count()

    def _failed(self, job: Job, error: TrialidError) -> None:
        """What cannot be fitted is not kept in the file: the edit is taken back."""
        with self._lock:
            if not job.wanted:
                return
            self._let_go(job)
            taken = self._back(job, "back")
            end = f"; {job.task.why}: taken back" if taken else ""
            self._trouble = Trouble("fit" if taken else place_of(error), f"{error}{end}")
            self._count()

    def _let_go(self, job: Job) -> None:
        job.wanted = False
        self._job = self._working = None
        self._count()

    def _back(self, job: Job, why: str) -> bool:
        """The model before a job's edit again; whether the file could be put back."""
        taken = job.step is not None and self._document.take_back(job.step)
        if taken:
            pipeline = self._document.pipeline
            self._begin(Task(pipeline, why, None, self._shown, self._known(pipeline)), None)
        return taken

    def _watch(self, known: Files) -> None:
        """Look at the files until the end; a change counts when it has stood for one look."""
        stood: Files = {}
        while not self._ended.wait(POLL):
            now = watch_list(self._document.pipeline)
            if now == stood and now != known:
                self._look({path for path in now if now[path] != known.get(path, now[path])})
                known = now
            stood = now

    def _look(self, changed: set[Path]) -> None:
        """Take over what was changed elsewhere."""
        with self._lock:
            if self.closed:
                return
            trouble, self._outside = self._outside, None
            try:
                if self._document.reread():
                    self._changed_elsewhere(f"{self.path.name} was edited elsewhere")
                elif changed - {self.path} or (trouble and trouble.where == "effects"):
                    available(self._document.pipeline)
                    self._changed_elsewhere("an effect file or the ship was edited")
            except TrialidError as error:
                self._outside = Trouble(place_of(error), str(error))
            if self._outside != trouble:
                self._count()

    def _changed_elsewhere(self, why: str) -> None:
        self._trouble = None
        self._begin(Task(self._document.pipeline, why, None, self._shown), None)

    def _count(self, screen: bool = False, series: bool = False) -> None:
        self._counts = self._counts.grown(screen, series)


@dataclass(frozen=True)
class _Seat(Seat):
    """The desk as one job sees it: closed to it as soon as the job is not wanted any more."""

    desk: Desk
    job: Job

    def progress(self, words: str, share: float | None) -> None:
        with self.desk._lock:
            self._check()
            self.desk._working = Working(self.job.task.why, words, share)
            self.desk._count()

    def show(self, shown: Shown) -> None:
        desk = self.desk
        with desk._lock:
            self._check()
            if shown.run is not None:
                kept = {**desk._kept, _name(shown.pipeline, self.job.files): shown.run}
                desk._kept = dict(list(kept.items())[-KEPT:])
            series = shown.series is not desk._shown.series and not goes_on(desk._shown, shown)
            desk._shown = shown
            desk._count(screen=True, series=series)

    def amend(self, edit: Edit) -> None:
        with self.desk._lock:
            self._check()
            if self.job.step is not None:
                self.job.step = self.desk._document.amend(edit.after)
                self.desk._count()

    def record(self, steps: tuple[StepRow, ...]) -> None:
        with self.desk._lock:
            self._check()
            with history.append_steps(self.job.task.pipeline.path, steps):
                pass

    def _check(self) -> None:
        if not self.job.wanted:
            raise LetGo


def _name(pipeline: Pipeline, files: Files) -> str:
    """What one model is told from another by: its pipeline, and the files it rests on."""
    return repr((pipeline.content, files))
