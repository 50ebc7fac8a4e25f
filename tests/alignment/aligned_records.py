"""Drawn records as series, altered and aligned to trials."""

from made_recordings import channel, recording
from made_trials import record
from real_channels import series

from trialid.alignment import SignalSource, align

UNITS = {"u": "m/s", "r": "rad/s", "p": "rad/s"}


def healthy(seed):
    return {q: series(q, t, y) for q, (t, y) in record(seed).channels.items()}


def with_values(signals, quantity, y):
    one = signals[quantity]
    return {**signals, quantity: series(quantity, one.t, y)}


def aligned(signals, stated=None):
    """The trial, each signal with its own stamps [ns]; `stated` are units of the pipeline."""
    log = recording(
        *(
            channel(q, one.t / 1e9, one.y, UNITS.get(q, "rad"), epoch=0)
            for q, one in signals.items()
        )
    )
    sources = [
        SignalSource(q, q, (stated or {}).get(q), "starboard" if q == "delta" else None)
        for q in signals
    ]
    period = signals["r"].t[-1] / 1e12
    return align("t", "fit", [log], sources, period)
