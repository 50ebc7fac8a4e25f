"""A replay in the terminal: time, signals, the residual in its band, alarms."""

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Final

import numpy as np

from trialid.errors import harmless
from trialid.names import labels
from trialid.replay.clock import Pace
from trialid.replay.closing_words import band_words
from trialid.replay.playback import Playback
from trialid.ship.actuators import actuator_quantities

if TYPE_CHECKING:
    from rich.console import Console, Group

REFRESH: Final = 0.2
"""Between two pictures [s]."""

HALF: Final = 12
"""Characters of a bar on either side of zero."""

BROAD: Final = 4.0
"""Deviations of noise at the end of a bar."""

NOTHING: Final = 0.01
"""Share of its noise below which what is predicted is shown as zero."""

LAST: Final = 5
"""Alarms and other events that are listed."""

Show = Callable[[Playback, Pace, float], None]


@contextmanager
def live(console: "Console") -> Iterator[Show]:
    """Give the function that keeps the picture fresh."""
    from rich.live import Live

    drawn = -math.inf
    with Live(console=console, auto_refresh=False, transient=True) as picture:

        def show(playback: Playback, pace: Pace, now: float) -> None:
            nonlocal drawn
            if now - drawn >= REFRESH:
                drawn = now
                picture.update(draw(playback, pace), refresh=True)

        yield show


def draw(playback: Playback, pace: Pace) -> "Group":
    """The picture of a moment."""
    from rich.console import Group
    from rich.table import Table
    from rich.text import Text

    place = max(playback.at - 1, 0)
    table = Table(box=None, pad_edge=False)
    for heading in ("", "measured", "predicted", f"residual, |{'noise band':^{2 * HALF - 1}}|", ""):
        table.add_column(heading, justify="right" if heading[:1] in "mp" else "left")
    residual = playback.residual[place]
    for c, band in enumerate(playback.bands.of):
        ratio = float(residual[c]) / band.sigma if band.sigma else math.nan
        seen = float(playback.measured[place, c]) if playback.compared[place, c] else math.nan
        predicted = float(playback.stream.y[place, c])
        table.add_row(
            labels.label(band.output), _shown(band.output, seen),
            _shown(band.output, predicted if abs(predicted) > NOTHING * band.sigma else 0.0),
            bar(ratio), _deviations(ratio),
        )  # fmt: skip
    events = [e for e in playback.events() if e.t <= place * playback.trial.period][-LAST:]
    told = [(f"{e.t:8.1f} s  {harmless(e.words)}", "red" if e.warning else "") for e in events]
    lines = [Text(words, style) for words, style in told] or [Text("no alarm")]
    for said in (_about(playback, place), _commands(playback, place)):
        if said:
            lines.insert(0, Text(harmless(said)))
    return Group(Text(harmless(_heading(playback, pace, place))), table, *lines)


def bar(ratio: float) -> str:
    """A residual in units of its noise, from the middle to one side.

    >>> bar(4.0)[12:], bar(math.nan).strip()
    ('|############', '|')
    """
    length = 0 if math.isnan(ratio) else min(round(abs(ratio) / BROAD * HALF), HALF)
    mark = "#" if math.isnan(ratio) or abs(ratio) > 2.0 else "="
    left = mark * length if ratio < 0.0 else ""
    right = mark * length if ratio > 0.0 else ""
    return f"{left:>{HALF}}|{right:<{HALF}}"


def _heading(playback: Playback, pace: Pace, place: int) -> str:
    t, end = place * playback.trial.period, playback.trial.duration
    if not pace.running:
        how = "paused"
    elif playback.growing:
        how = "following"
    else:
        how = "as fast as possible" if math.isinf(pace.speed) else f"{pace.speed:g} times"
    return f"{playback.trial.name}  {t:.1f} of {end:.1f} s  {how}  {playback.doing(place + 1)}"


def _shown(name: str, value: float) -> str:
    return labels.shown_text(name, None if math.isnan(value) else value)


def _about(playback: Playback, place: int) -> str:
    """The band about the prediction, and what is measured outside of it just now."""
    half, off = playback.prediction_band, np.abs(playback.residual[place])
    errors = zip(playback.fit.problem.outputs, off, strict=True)
    outside = [c for c, e in errors if c in half and e > half[c]]
    now = f" (now outside: {', '.join(outside)})" if outside else ""
    return band_words(half) + now


def _commands(playback: Playback, place: int) -> str:
    """What each of the ship's actuators is told or does just now; empty for a single rudder."""
    known, signals = actuator_quantities(playback.fit.model.ship.actuators), playback.trial.signals
    told = [n for n in playback.fit.problem.simulator.equations.inputs if n in known]
    return ", ".join(f"{n} {labels.command_text(known[n], signals[n][place])}" for n in told)


def _deviations(ratio: float) -> str:
    return "not compared" if math.isnan(ratio) else f"{ratio:+.1f} sigma"
