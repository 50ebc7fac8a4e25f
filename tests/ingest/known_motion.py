"""One motion as series, and whether a log of it gives the same trial."""

import numpy as np

from trialid.alignment import align
from trialid.ingest import read

START = 1_700_000_000_000_000_000


def _series(rate, motion):
    t = np.arange(0, 120, 1 / rate)
    return START + np.rint(t * 1e9).astype(np.int64), motion(t)


MOTIONS = {
    "delta": lambda t: np.radians(30) * np.sin(0.06 * t),
    "r": lambda t: 0.01 * np.sin(0.06 * t - 0.9),
    "phi": lambda t: 0.05 * np.sin(0.5 * t),
    "u": lambda t: 7.0 + 0.1 * t / 120,
    "psi": lambda t: np.radians(350 + 20 * np.sin(0.05 * t)),
}
RATES = {"delta": 10, "r": 50, "phi": 25, "u": 5, "psi": 10}
SERIES = {name: _series(RATES[name], motion) for name, motion in MOTIONS.items()}


def check_comes_back(form, path):
    """Every value, at its stamp, and the aligned trial."""
    written = form.write(path, SERIES)
    recording = read(path, None, written.aids)
    trial = align("motion", "fit", [recording], written.sources, 0.2)
    for source in written.sources:
        name = source.quantity
        error = np.abs(trial.signals[name] - MOTIONS[name](trial.t))
        valid = trial.valid[name]
        assert valid.mean() > 0.95
        steepest = np.abs(np.gradient(MOTIONS[name](trial.t), trial.t)).max()
        bound = written.resolution[name] + steepest * written.clock_resolution
        assert error[valid].max() < bound + 1e-3 * np.ptp(MOTIONS[name](trial.t))
        channel = recording.channels[source.channel]
        since = np.sort(channel.t) - channel.t.min()
        assert np.abs(since - (SERIES[name][0] - START)).max() <= written.clock_resolution * 1e9
