"""What a run has worked out of its fit, kept in its folder: taking the run up again is quick.

It holds the trials on their clock, the covariance, and how all that may be missing or held wrong
stands. It is of one `result.json`, whose logs are held against their hashes whenever the run is
taken up, and of the very sources of this package: with anything else it counts for nothing, and
everything is worked out again. With effects of other packages or of the user's own, which may read
what nobody watches, there is none.
"""

import hashlib
import io
import json
import zipfile
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final, Literal, Protocol

import numpy as np

from trialid import plugins
from trialid.accuracy.likely import Standing
from trialid.accuracy.one_missing import Reduced, Rival
from trialid.arrays import Vector
from trialid.cache import source_digest
from trialid.diagnosis.may_be_off import Doubts
from trialid.diagnosis.search.augment import Trace
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect
from trialid.trial import LogSource, Trial

FILE: Final = "standing.npz"
COVARIANCE: Final = "covariance"
ARRAYS: Final = ("gram", "moves", "deviations")


class Named(Protocol):
    """Anything with a name."""

    @property
    def name(self) -> str:
        """The name."""


class Trusted(Protocol):
    """How sure a fit is by noise: its unknowns and their covariance."""

    @property
    def parameters(self) -> Sequence[Named]:
        """The unknowns."""

    @property
    def covariance(self) -> Vector:
        """Of the unknowns; (n, n)."""


class Known(Protocol):
    """A fit with how sure it is and what may be missing in it."""

    @property
    def fit(self) -> Fit:
        """The fit."""

    @property
    def accuracy(self) -> Trusted:
        """How sure it is."""

    @property
    def doubts(self) -> Doubts:
        """What may be missing or held wrong."""


@dataclass(frozen=True)
class Unknown:
    """The name of something that was fitted."""

    name: str


@dataclass(frozen=True)
class KeptAccuracy:
    """Unknowns and their covariance by noise."""

    parameters: tuple[Unknown, ...]
    covariance: Vector


@dataclass(frozen=True)
class KeptFit:
    """A fit with what was kept of it."""

    fit: Fit
    accuracy: KeptAccuracy
    doubts: Doubts


@dataclass(frozen=True)
class KeptStanding:
    """What a run's folder keeps: trials on their clock, and how sure the fit to them is."""

    trials: tuple[Trial, ...]
    accuracy: KeptAccuracy
    doubts: Doubts

    def of(self, fit: Fit) -> KeptFit:
        """The fit to these trials with it."""
        return KeptFit(fit, self.accuracy, self.doubts)


@dataclass(frozen=True, kw_only=True)
class TraceRow:
    """A way in which an effect may be missing, the effect by its name."""

    effect: str
    columns: tuple[int, ...]
    parameters: tuple[str, ...]
    tried: Mapping[str, float]


@dataclass(frozen=True, kw_only=True)
class KeptTrial:
    """A trial without its arrays, which are kept by their names."""

    name: str
    use: Literal["fit", "check"]
    period: float
    remarks: tuple[str, ...]
    logs: tuple[LogSource, ...]
    start: int
    opening: float
    signals: tuple[str, ...]
    valid: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class About:
    """All of the file that is no array."""

    key: str
    unknowns: tuple[str, ...]
    variance: float
    independent: float
    rivals: tuple[Rival, ...]
    held: tuple[str, ...]
    missing: tuple[TraceRow, ...]
    trials: tuple[KeptTrial, ...]


def standing_bytes(done: Known, result: bytes) -> bytes | None:
    """The file for a run of this `result.json`; None where it could be stale unseen."""
    if plugins.packages():  # their sources are not ours to watch
        return None
    trials, doubts = [score.trial for score in done.fit.scores], done.doubts
    reduced = doubts.standing.known
    about = About(
        key=_key(result),
        unknowns=tuple(p.name for p in done.accuracy.parameters),
        variance=reduced.variance,
        independent=reduced.independent,
        rivals=doubts.standing.rivals,
        held=doubts.held,
        missing=tuple(
            TraceRow(
                effect=t.effect.name, columns=t.columns, parameters=t.parameters, tried=t.tried
            )
            for t in doubts.missing
        ),
        trials=tuple(map(_without_arrays, trials)),
    )
    arrays = {name: getattr(reduced, name) for name in ARRAYS}
    arrays |= {COVARIANCE: done.accuracy.covariance}
    for i, trial in enumerate(trials):
        arrays |= {f"{i} signal {name}": x for name, x in trial.signals.items()}
        arrays |= {f"{i} valid {name}": x for name, x in trial.valid.items()}
    stream = io.BytesIO()
    np.savez_compressed(stream, about=np.array(json.dumps(asdict(about))), **arrays)
    return stream.getvalue()


def _without_arrays(trial: Trial) -> KeptTrial:
    return KeptTrial(
        name=trial.name,
        use=trial.use,
        period=trial.period,
        remarks=trial.remarks,
        logs=trial.logs,
        start=trial.start,
        opening=trial.opening,
        signals=tuple(trial.signals),
        valid=tuple(trial.valid),
    )


def standing_of(folder: Path, catalogue: Mapping[str, Effect]) -> KeptStanding | None:
    """What the folder keeps of its run; None where there is nothing, or it is of something else."""
    from pydantic import TypeAdapter

    try:
        content = (folder / FILE).read_bytes()
        result = (folder / "result.json").read_bytes()
        with np.load(io.BytesIO(content), allow_pickle=False) as found:
            arrays = {name: found[name] for name in found.files}
        about = TypeAdapter(About).validate_json(str(arrays.pop("about")))
        if plugins.packages() or about.key != _key(result):
            return None
        return _read(about, arrays, catalogue)
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile):
        return None


def _read(
    about: About, arrays: Mapping[str, Vector], catalogue: Mapping[str, Effect]
) -> KeptStanding:
    reduced = Reduced(
        variance=about.variance,
        independent=about.independent,
        **{name: arrays[name] for name in ARRAYS},
    )
    missing = tuple(
        Trace(catalogue[t.effect], t.columns, t.parameters, t.tried) for t in about.missing
    )
    return KeptStanding(
        trials=tuple(_trial(i, row, arrays) for i, row in enumerate(about.trials)),
        accuracy=KeptAccuracy(tuple(map(Unknown, about.unknowns)), arrays[COVARIANCE]),
        doubts=Doubts(Standing(reduced, about.rivals), about.held, missing),
    )


def _trial(place: int, row: KeptTrial, arrays: Mapping[str, Vector]) -> Trial:
    return Trial(
        name=row.name,
        use=row.use,
        period=row.period,
        signals={name: arrays[f"{place} signal {name}"] for name in row.signals},
        valid={name: arrays[f"{place} valid {name}"].astype(bool) for name in row.valid},
        remarks=row.remarks,
        logs=row.logs,
        start=row.start,
        opening=row.opening,
    )


def _key(result: bytes) -> str:
    """Of a run's result, and of all that it would be worked out anew with."""
    made = hashlib.sha256(result)
    made.update(f"{source_digest()} numpy {np.__version__}".encode())
    return made.hexdigest()
