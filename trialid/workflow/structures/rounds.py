"""The fits that comparing structures takes, kept as they are done, and the choice from them."""

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass, field
from math import comb
from pathlib import Path
from typing import Final

import numpy as np

from trialid import own_files
from trialid.diagnosis.one_standard_error import Choice, choose_structure
from trialid.errors import TrialidError
from trialid.progress import Progress
from trialid.result.json_file import read_object, row_of
from trialid.workflow.structures.asked_structures import Structure
from trialid.workflow.structures.comparison import Comparison, FitTask, Out
from trialid.workflow.structures.leave_out import KeptFit

FITS: Final = "fits.json"
"""The fits that are done, by a hash of all that went into them."""

Compute = Callable[[Sequence[FitTask]], Iterator[tuple[FitTask, KeptFit]]]
"""What does fits elsewhere and gives each back with what came of it, in any order."""


@dataclass(kw_only=True)
class Rounds:
    """The fits to do and those done. State: `done`, by structure and by what is left out.

    Attributes
    ----------
    folder
        Where fits are found again, and kept whatever comes after; None keeps none.
    compute
        What does many fits at once; None does one after the other, here.
    """

    compared: Comparison
    folder: Path | None
    progress: Progress
    compute: Compute | None = None
    done: dict[tuple[str, Out], KeptFit] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.structures, self.names = self.compared.structures, self.compared.names
        self.kept = {} if self.folder is None else kept_fits(self.folder / FITS)
        self.fits = len(self.structures) * (1 + len(self.names) + comb(len(self.names), 2))

    def fit(self, leaving: Sequence[Out]) -> None:
        """Fit every structure that stands without each of these groups of trials."""
        self._elsewhere(leaving)
        for structure in self.structures:
            for out in leaving:
                if not self.why_not(structure):
                    without = f" without {' and '.join(out)}" if out else ""
                    self.progress(f"fitting {structure.name}{without}", len(self.done) / self.fits)
                    self.done[structure.name, out] = self._fit(self._task(structure, out))

    def _elsewhere(self, leaving: Sequence[Out]) -> None:
        """Have them done all at once, to be found among those kept.

        Without knowing which structure falls in the midst: some fits may be done that nobody needs.
        """
        if self.compute is None:
            return
        standing = [s for s in self.structures if not self.why_not(s)]
        asked = [self._task(structure, out) for structure in standing for out in leaving]
        todo = [task for task in asked if task.key not in self.kept]
        for number, (task, made) in enumerate(self.compute(todo) if todo else (), 1):
            self._keep(task, made)
            words = f"{number} of {len(todo)} fits done"
            self.progress(words, (len(self.done) + number) / self.fits)

    def _task(self, structure: Structure, out: Out) -> FitTask:
        return self.compared.task(structure, out, self.done.get((structure.name, ())))

    def _fit(self, task: FitTask) -> KeptFit:
        if task.key not in self.kept:
            self._keep(task, self.compared.fit(task))
        return self.kept[task.key]

    def _keep(self, task: FitTask, made: KeptFit) -> None:
        self.kept[task.key] = made
        if self.folder is not None:
            fits = {key: asdict(self.kept[key]) for key in sorted(self.kept)}
            with own_files.replacing(self.folder, below=(FITS,)) as work:
                (work / FITS).write_text(json.dumps(fits, allow_nan=False) + "\n", "utf-8")

    def why_not(self, structure: Structure) -> str:
        """The first reason against a structure, empty where it stands.

        What fails without two trials is out of the choice without either of them only.
        """
        outs: list[Out] = [(), *((name,) for name in self.names)]
        fits = [self.done.get((structure.name, out)) for out in outs]
        return next((fit.why_not for fit in fits if fit is not None and fit.why_not), "")

    def choice(self, *gone: str) -> Choice | None:
        """The choice among the structures that stand, without any use of these trials."""
        errors, parameters = {}, {}
        for s in self.structures:
            left = {n: self._errors(s, n, gone) for n in self.names if n not in gone}
            found = [each[n] for n, each in left.items() if n in each]
            if len(found) == len(left) and not self.why_not(s):
                errors[s.name] = np.array(found)
                parameters[s.name] = self.done[s.name, ()].parameters
        return choose_structure(errors, parameters)

    def _errors(self, structure: Structure, name: str, gone: Out) -> dict[str, float]:
        """Errors of the fit without these trials; empty where it failed or was not asked for."""
        fit = self.done.get((structure.name, tuple(n for n in self.names if n in (name, *gone))))
        return dict(fit.errors) if fit else {}


def kept_fits(path: Path) -> dict[str, KeptFit]:
    """The fits in a file; none where it cannot be read: they are done anew."""
    try:
        return {key: row_of(KeptFit, row) for key, row in read_object(path, "").items()}
    except TrialidError:
        return {}
