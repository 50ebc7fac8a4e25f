"""Trials as their model needs them: with what steers the ship recorded throughout."""

from collections.abc import Iterable, Mapping

from trialid.alignment.input_gaps import LENGTHS, without_input_gaps
from trialid.names.quantities import SIGNALS, is_input
from trialid.ship.effect import Effect
from trialid.trial import Trial


def known_throughout(
    trial: Trial, particulars: Mapping[str, float], effects: Iterable[Effect]
) -> Trial:
    """The trial, or the longest stretch without a long gap in what these effects read of her helm.

    As it is where her length and speed are not known.
    """
    longest = own_time(particulars)
    read = {signal for effect in effects for signal in effect.signals}
    steering = [
        n for n in trial.signals if n in read and (n not in SIGNALS or is_input(SIGNALS[n]))
    ]
    return trial if longest is None else without_input_gaps(trial, steering, LENGTHS * longest)


def own_time(particulars: Mapping[str, float]) -> float | None:
    """Time in which a ship goes her own length [s]; None where her file does not tell."""
    L, U0 = (particulars.get(name, 0.0) for name in ("L", "U0"))
    return L / U0 if L and U0 else None
