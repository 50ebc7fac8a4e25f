"""A pipeline file under the hands of several: a screen or two, and whoever has it in an editor.

Every edit is in the file, whole, before it is answered for; the file is only ever replaced by one
that was made from what it holds.
"""

import hashlib
from dataclasses import dataclass
from pathlib import Path

from trialid.errors import PipelineError
from trialid.pipeline_file import Pipeline, content_of, load, read
from trialid.pipeline_file.rewrite import rewriting

ELSEWHERE = "the edit made outside"


class Outdated(PipelineError):
    """An edit of a file that holds something else by now."""


@dataclass(frozen=True)
class Step:
    """One edit: in words, and the whole file before and after."""

    words: str
    old: bytes
    new: bytes


class Document:
    """The file as it was last read, and the edits since the workbench was opened.

    Not safe for several threads at once; the desk sees to that.
    """

    def __init__(self, path: Path) -> None:
        self.pipeline: Pipeline = load(path)
        self.undone: tuple[Step, ...] = ()
        self.done: tuple[Step, ...] = ()

    @property
    def path(self) -> Path:
        """Where it is."""
        return self.pipeline.path

    @property
    def version(self) -> str:
        """What tells one content from another."""
        return hashlib.sha256(self.pipeline.content).hexdigest()

    def check(self, version: str) -> None:
        """Refuse an edit that was asked for in view of another content.

        Raises
        ------
        Outdated
            It is not the one here, or the file has changed since it was read.
        """
        if version != self.version or self.on_disk() != self.pipeline.content:
            raise Outdated(
                f"{self.path.name} was changed meanwhile, in another window or by an editor; "
                "nothing was done: look at it as it is now, and do it again if you still want it"
            )

    def on_disk(self) -> bytes | None:
        """What the file holds now; None where there is none to be read."""
        try:
            return content_of(self.path)
        except PipelineError:
            return None

    def put(self, after: Pipeline, words: str) -> Step:
        """Write an edit that can be undone.

        Raises
        ------
        PipelineError
            It cannot be written; the file is as it was.
        """
        step = Step(words, self.pipeline.content, after.content)
        self._write(after)
        self.done, self.undone = (*self.done, step), ()
        return step

    def amend(self, after: Pipeline) -> Step:
        """Write more of the last edit: the two are undone together."""
        last = self.done[-1]
        step = Step(last.words, last.old, after.content)
        self._write(after)
        self.done = (*self.done[:-1], step)
        return step

    def take_back(self, step: Step) -> bool:
        """Undo the last edit as if it had never been; False where the file does not allow it.

        It may hold more by now, or the disk may be full.
        """
        if not self.done or self.done[-1] != step or self.on_disk() != step.new:
            return False
        try:
            self._write(read(step.old, self.path))
        except PipelineError:
            return False
        self.done = self.done[:-1]
        return True

    def undo(self) -> Step:
        """Write what the file held before the last edit.

        Raises
        ------
        PipelineError
            There is nothing to undo, or it cannot be written.
        """
        if not self.done:
            raise PipelineError("there is nothing to undo")
        step = self.done[-1]
        self._write(read(step.old, self.path))
        self.done, self.undone = self.done[:-1], (*self.undone, step)
        return step

    def redo(self) -> Step:
        """Write the edit that was undone last.

        Raises
        ------
        PipelineError
            There is none, or it cannot be written.
        """
        if not self.undone:
            raise PipelineError("there is nothing to do again")
        step = self.undone[-1]
        self._write(read(step.new, self.path))
        self.done, self.undone = (*self.done, step), self.undone[:-1]
        return step

    def reread(self) -> bool:
        """Take over what somebody else has written; whether it is something else.

        Raises
        ------
        PipelineError
            It is no pipeline (yet); what was read before stays.
        """
        found = content_of(self.path)
        if found == self.pipeline.content:
            return False
        after = read(found, self.path)
        step = Step(ELSEWHERE, self.pipeline.content, found)
        self.pipeline = after
        self.done, self.undone = (*self.done, step), ()
        return True

    def _write(self, after: Pipeline) -> None:
        with rewriting(self.path, self.pipeline.content, after.content) as stroke:
            stroke()
        self.pipeline = after
