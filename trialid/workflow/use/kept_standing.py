"""What a run has worked out of its fit, kept in its folder: taking the run up again is quick.

It holds the trials on their clock, the covariance, and how all that may be missing or held wrong
stands; the same of each other model whose ranges a prediction holds. It is of one `result.json`,
whose logs are held against their hashes whenever the run is taken up, and of the very sources of
this package: with anything else it counts for nothing, and everything is worked out again. With
effects of other packages or of the user's own, which may read what nobody watches, there is none.
"""

import hashlib
import io
import json
import zipfile
from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from typing import Any, Final, Literal

import numpy as np

from trialid import plugins
from trialid.arrays import Vector
from trialid.cache import source_digest
from trialid.identification.fit import Fit
from trialid.ship.effect import Effect
from trialid.trial import LogSource, Trial
from trialid.workflow.use.kept_models import (
    AboutModel,
    KeptFit,
    KeptModel,
    Known,
    about_model,
    arrays_of,
    kept_model,
)

FILE: Final = "standing.npz"


@dataclass(frozen=True)
class KeptStanding:
    """What a run's folder keeps: trials on their clock, the fit to them, and other models."""

    trials: tuple[Trial, ...]
    model: KeptModel
    others: tuple[KeptModel, ...]

    def of(self, fit: Fit, catalogue: Mapping[str, Effect]) -> KeptFit:
        """The fit to these trials with it."""
        others = ((one.about.has, one.beside(fit, catalogue)) for one in self.others)
        return replace(self.model.of(fit), others=tuple(others))


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
    """All of the file that is no array; the first model is the run's."""

    key: str
    models: tuple[AboutModel, ...]
    trials: tuple[KeptTrial, ...]


def standing_bytes(done: Known, result: bytes) -> bytes | None:
    """The file for a run of this `result.json`; None where it could be stale unseen."""
    if plugins.packages():  # their sources are not ours to watch
        return None
    trials, models = [score.trial for score in done.fit.scores], [("", done), *done.others]
    about = About(
        key=_key(result),
        models=tuple(about_model(*one) for one in models),
        trials=tuple(map(_without_arrays, trials)),
    )
    arrays = dict[str, Any]()
    for i, (_, model) in enumerate(models):
        arrays |= {f"model {i} {name}": x for name, x in arrays_of(model).items()}
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
    own, *others = (
        kept_model(row, _under(f"model {i} ", arrays), catalogue)
        for i, row in enumerate(about.models)
    )
    trials = tuple(_trial(i, row, arrays) for i, row in enumerate(about.trials))
    return KeptStanding(trials, own, tuple(others))


def _under(prefix: str, arrays: Mapping[str, Vector]) -> dict[str, Vector]:
    return {n.removeprefix(prefix): x for n, x in arrays.items() if n.startswith(prefix)}


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
