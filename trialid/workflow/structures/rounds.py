"""The fits that comparing structures takes, kept as they are done, and the choice from them."""

import json
from collections.abc import Sequence
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
from trialid.trial import Trial
from trialid.workflow.structures.asked_structures import Structure
from trialid.workflow.structures.leave_out import KeptFit, digest, fit_whole, fit_without, key_of

FITS: Final = "fits.json"
"""The fits that are done, by a hash of all that went into them."""

Out = tuple[str, ...]
"""Names of the trials that a fit leaves out, in the order of the pipeline."""


@dataclass(kw_only=True)
class Rounds:
    """The fits to do and those done. State: `done`, by structure and by what is left out.

    Attributes
    ----------
    sources
        Hashes of the files beside the logs that the fits rest on.
    folder
        Where fits are found again, and kept whatever comes after; None keeps none.
    """

    structures: tuple[Structure, ...]
    trials: tuple[Trial, ...]
    sources: tuple[str, ...]
    folder: Path | None
    progress: Progress
    done: dict[tuple[str, Out], KeptFit] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.fitted = tuple(t for t in self.trials if t.use == "fit")
        self.names = tuple(t.name for t in self.fitted)
        self.digests = {t.name: digest(t) for t in self.trials}
        self.kept = {} if self.folder is None else kept_fits(self.folder / FITS)

    def fit(self, leaving: Sequence[Out]) -> None:
        """Fit every structure that stands without each of these groups of trials."""
        fits = len(self.structures) * (1 + len(self.names) + comb(len(self.names), 2))
        for structure in self.structures:
            for out in leaving:
                if not self.why_not(structure):
                    without = f" without {' and '.join(out)}" if out else ""
                    self.progress(f"fitting {structure.name}{without}", len(self.done) / fits)
                    self.done[structure.name, out] = self._fit(structure, out)

    def _fit(self, structure: Structure, out: Out) -> KeptFit:
        used = self.fitted if out else self.trials
        key = key_of(structure, [self.digests[t.name] for t in used], self.sources, out)
        if key not in self.kept:
            whole = self.done.get((structure.name, ()))
            made = fit_without(structure, used, out, whole) if whole else fit_whole(structure, used)
            self.kept[key] = made
            self._keep()
        return self.kept[key]

    def _keep(self) -> None:
        if self.folder is not None:
            text = json.dumps({key: asdict(fit) for key, fit in self.kept.items()}, allow_nan=False)
            with own_files.replacing(self.folder, below=(FITS,)) as work:
                (work / FITS).write_text(text + "\n", encoding="utf-8")

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
