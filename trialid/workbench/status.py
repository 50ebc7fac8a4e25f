"""What a page is told at every moment, and from which it knows what to ask for."""

from dataclasses import dataclass, replace

from trialid.workbench.document import Document
from trialid.workbench.shown import Shown, Trouble, Working


@dataclass(frozen=True)
class Counts:
    """Each grows when a page should ask for that again."""

    serial: int = 0
    screen: int = 0
    series: int = 0

    def grown(self, screen: bool = False, series: bool = False) -> "Counts":
        """The counts after a change."""
        return replace(
            self, serial=self.serial + 1, screen=self.screen + screen, series=self.series + series
        )


@dataclass(frozen=True)
class Status:
    """Where things are; `undo` and `redo` in words, None where there is nothing."""

    serial: int
    version: str
    stage: str
    working: Working | None
    trouble: Trouble | None
    undo: str | None
    redo: str | None
    screen: int
    series: int


def status_of(
    document: Document,
    shown: Shown,
    counts: Counts,
    working: Working | None,
    trouble: Trouble | None,
) -> Status:
    """Where things are."""
    return Status(
        serial=counts.serial,
        version=document.version,
        stage=shown.stage,
        working=working,
        trouble=trouble,
        undo=document.done[-1].words if document.done else None,
        redo=document.undone[-1].words if document.undone else None,
        screen=counts.screen,
        series=counts.series,
    )
