"""Words that several findings share."""

from trialid.diagnosis.where.leftover import Leftover, mirror, signal_words, unit


def name(output: str) -> str:
    """An output in words and by its name in files: `yaw rate r`."""
    words = signal_words(output)
    return output if words == output else f"{words} {output}"


def figure(value: float) -> str:
    """A number with two digits, never in powers of ten where it can be helped.

    >>> figure(0.0612), figure(12.3), figure(140.2)
    ('0.061', '12', '140')
    """
    return f"{abs(value):.2g}" if abs(value) < 100.0 else f"{abs(value):.0f}"


def share(part: float) -> str:
    """A share in per cent: `62 %`.

    >>> share(0.618), share(0.0012)
    ('62 %', '0.1 %')
    """
    percent = 100.0 * part
    return f"{percent:.0f} %" if percent >= 1.0 or percent == 0.0 else f"{percent:.1g} %"


def how_far_off(left: Leftover, output: int, mean: float) -> str:
    """How a prediction lies off, from measured less predicted in the unit of reports."""
    name = left.outputs[output]
    amount = f"{figure(mean)} {unit(name)}"
    if mirror(name) > 0:
        return f"{amount} too {'low' if mean > 0.0 else 'high'}"
    return f"{amount} too far to {'port' if mean > 0.0 else 'starboard'}"


def share_sentence(samples: float, part: float) -> str:
    """What share of the samples holds what share of the squared error."""
    return f"{share(samples)} of the samples hold {share(part)} of its squared error"
