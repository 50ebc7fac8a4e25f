"""What a replay comes to, in words."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from trialid.names import labels
from trialid.replay.playback import Playback


def summary(playback: Playback, start: float, files: Sequence[Path]) -> str:
    """What was played from a time [s] on: how it kept to its band, the alarms, the files."""
    trial = playback.trial
    end = max(playback.furthest - 1, 0) * trial.period
    lines = [f"{trial.name}: played from {start:g} to {end:g} s; band: {playback.bands.source}"]
    if playback.prediction_band:
        shares = (f"{name} {share:.0%}" for name, share in playback.inside(start).items())
        lines.append(f"  {band_words(playback.prediction_band)}; inside it {', '.join(shares)}")
    events = [e for e in playback.events(start) if e.warning]
    lines += [f"  {event.words}" for event in events] or ["  no alarm"]
    if playback.revised:
        moved = f"{playback.revised:.2g} sigma"
        lines.append(f"  what was shown as the log grew moved by up to {moved} once more was there")
    return "\n".join([*lines, *(f"Written: {path}" for path in files)])


def band_words(band: Mapping[str, float]) -> str:
    """The band about the prediction in words, empty where nothing is known of it."""
    halves = (f"{name} +-{labels.shown_text(name, half)}" for name, half in band.items())
    return f"95 % band of the prediction: {', '.join(halves)}" if band else ""
