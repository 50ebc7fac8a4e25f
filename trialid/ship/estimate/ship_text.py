"""The text of a ship file that was made of particulars: a comment for each number."""

import textwrap
from collections.abc import Iterator
from typing import Final

from trialid.ship.estimate.all_numbers import Estimated
from trialid.ship.estimate.hull_form import typical
from trialid.ship.estimate.particulars_given import SEA, known_names, told_of
from trialid.ship.estimate.sway_yaw import WIDEST
from trialid.toml_text import quote

WIDTH: Final = 100
HEAD: Final = """\
# Made by `trialid ship` from {told}.
# Every number has its source, and its scatter: one standard deviation over ships, as a share of it.
# [uncertainty] repeats the scatter: for numbers that are held, and with priors = "ship" in a
# pipeline for those that are estimated. Put in your own figures where you have them, with theirs.
"""
AS_STATED: Final = ", as stated"
STATED: Final = {
    "L": "length",
    "B": "beam",
    "T": "draught",
    "U0": "speed",
    "rho": "rho",
}
"""Particulars of the file, and what states them."""
GUESSED: Final = {"B": ("L/B", "B/T"), "T": ("B/T",), "U0": ("Fn",), "nabla": ("C_B",)}
"""Particulars of the file, and the typical ratios that may stand for them."""


def ship_text(made: Estimated, speed_words: str = "as stated") -> str:
    """A ship file; `read_ship` gives the same ship.

    Parameters
    ----------
    speed_words
        Where a stated speed is from.
    """
    ship = made.ship
    lines = [
        *_wrapped(HEAD.format(told=told_of(made.given))),
        *(f"# {words}" for words in assumption_words(made)),
        f"name = {quote(ship.name)}",
        f'source = "{ship.source}"',
        f'notes = "{ship.notes}"',
        'system = "prime"',
        'rudder_positive = "starboard"',
        "",
        "[particulars]",
        *_particulars(made, speed_words),
        "",
        "[mass]  # over 1/2 rho L^3, L^4 or L^5; the origin is midships, at the height of G",
        *(_number(made, n) for n in ship.mass),
        "",
        "[coefficients]",
        *(_number(made, n) for n in ship.coefficients),
        "",
        "[uncertainty]  # one standard deviation, as a share of the number",
        *(f"{n} = {share:g}" for n, share in ship.uncertainty.items()),
    ]
    return "\n".join(lines) + "\n"


def assumption_words(made: Estimated) -> Iterator[str]:
    """What had to be assumed, a line each."""
    ratios = typical(made.form.L)
    for name in made.assumed:
        ratio = ratios[name]
        size = f" {ratio.value:.3g}" if ratio.value else ""
        yield f"ASSUMED: {ratio.what}{size} +-{100.0 * ratio.share:.0f} % ({ratio.source})"
    wide = made.form.B / made.form.L
    if wide > WIDEST:
        yield (
            f"OUTSIDE: beam over length {wide:.2g}; Clarke's hulls end at {WIDEST:g}, what is "
            "written is of that, with more scatter"
        )


def _particulars(made: Estimated, speed_words: str) -> Iterator[str]:
    units = {"nabla": "m^3", "rho": "kg/m^3", "g": "m/s^2", "U0": "m/s"}
    for name, value in made.ship.particulars.items():
        words = _origin(made, name)
        words = f", {speed_words}" if name == "U0" and words == AS_STATED else words
        yield f"{name} = {value:g}  # {units.get(name, 'm')}{words}"


def _origin(made: Estimated, name: str) -> str:
    """Whether a particular is stated, follows from others, or is assumed."""
    if name == "g" or (name == "rho" and made.given.rho == SEA):
        return ""
    if STATED.get(name) in known_names(made.given):
        return AS_STATED
    guessed = [r for r in GUESSED.get(name, ()) if r in made.assumed]
    return f", ASSUMED by {guessed[0]}" if guessed else ", from what is stated"


def _number(made: Estimated, name: str) -> str:
    found = made.numbers[name]
    scatter = f", +-{100.0 * found.share:.3g} %" if found.share else ""
    return f"{name} = {found.value:g}  # {found.source}{scatter}"


def _wrapped(head: str) -> Iterator[str]:
    """The head, its first line on several where the particulars are many."""
    for line in head.splitlines():
        yield from textwrap.wrap(line, WIDTH, subsequent_indent="#     ")
