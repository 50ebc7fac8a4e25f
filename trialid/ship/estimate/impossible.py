"""What no ship has: particulars that are missing, impossible or contradict one another, all told.

Limits are those of floating things, not of merchant ships: only what must be a slip is refused.
"""

import math
from collections.abc import Callable, Iterator
from numbers import Real
from typing import Final

from trialid.ship.estimate.hull_form import GRAVITY, HullForm, complete
from trialid.ship.estimate.hydrostatics import metacentre
from trialid.ship.estimate.particulars_given import WORDS, Given, known_names, tell

LONGEST: Final = 500.0
"""[m] The longest ship ever built had 440 between perpendiculars."""
SHORTEST: Final = 0.3
"""[m] Of a model that can be steered."""
LEAST_BLOCK: Final = 0.05
"""A rowing shell has 0.4, a catamaran over its whole beam 0.2, a slender one of 5 m 0.09. Kilograms
for tonnes are off by a thousand."""
ALIKE: Final = 0.05
"""Share by which a block coefficient and a displacement may differ, as they are rounded."""
HIGHEST: Final = 1.5
"""Factor on the estimated metacentre that a GM may reach: beyond it gravity is below the keel."""
FASTEST: Final = 3.0
"""Froude number of a racing boat."""
DEEPEST: Final = 2.0
"""Draught over beam of no ship: a racing yacht's with her keel is 1.2, a submarine's 1; ..."""
OF_MODELS: Final = 10.0
"""[m] ... model yachts, which are shorter, hang their keels to three times their beam."""
SLIMMEST: Final = 40.0
"""Length over beam, and beam over draught, of no hull: a rowing shell has 30. Over both hulls of a
light catamaran it is more, 50 of one of 5 m and 320 kg, ..."""
LIGHTEST: Final = 12.0
"""... whose length over the cube root of her volume tells that she is no slip: 7 of that one, 10 of
racing trimarans; of feet for metres 13 to 26 of merchant ships, of kilograms for tonnes 40."""
ROLL_RADII: Final = (0.2, 0.7)
"""Radius of gyration in roll over the beam, the water's with it: ships have 0.3 to 0.45."""
WATERS: Final = (900.0, 1100.0)
"""[kg/m^3]"""

Found = Iterator[tuple[str, str]]
"""The particular that is wrong, and what is wrong with it."""


def complaints(given: Given) -> tuple[str, ...]:
    """Everything that is wrong, a sentence each; empty where a ship can be made of it."""
    found = dict[str, str]()
    for checks in ((_missing, _no_numbers), (_size, _sides, _fullness), (_volume, _period)):
        sound = _without(given, found)
        for check in checks:
            for name, words in check(sound):
                found.setdefault(name, words)
    sound = _without(given, found)
    if sound.length is not None:
        form = complete(sound)
        for look in WHOLE:
            for name, words in look(sound, form):
                found.setdefault(name, words)
    return tuple(found.values())


def _without(given: Given, wrong: dict[str, str]) -> Given:
    return Given(**{n: getattr(given, n) for n in known_names(given) if n not in wrong})


def _missing(given: Given) -> Found:
    if given.length is None:
        yield "length", "the length is missing (between perpendiculars, in metres)"


def _no_numbers(given: Given) -> Found:
    for name in known_names(given):
        value = getattr(given, name)
        if not isinstance(value, Real) or not math.isfinite(value):
            yield name, f"{WORDS[name].name} {value!r} is not a number"
        elif value <= 0.0 and name != "x_G":
            yield name, f"{tell(given, name)} is not above zero"


def _size(given: Given) -> Found:
    L = given.length
    if L is not None and not SHORTEST <= L <= LONGEST:
        hint = "was it in millimetres?" if L > LONGEST else "was it in kilometres?"
        yield "length", f"{tell(given, 'length')} is no ship's; {hint}"
    if not WATERS[0] < given.rho < WATERS[1]:
        yield "rho", f"{tell(given, 'rho')} is no water's; fresh has 998, the sea 1025"


def _sides(given: Given) -> Found:
    L = given.length
    if L is None or L > LONGEST:
        return
    for name in ("beam", "draught"):
        value = getattr(given, name)
        if value is not None and value > L:
            yield name, f"{tell(given, name)} is more than the length {L:g} m; are both in metres?"
    B, T = given.beam, given.draught
    if B is not None and T is not None and L > OF_MODELS and DEEPEST * B < T <= L:
        yield "draught", f"{tell(given, 'draught')} is {T / B:.2g} times the beam {B:g} m; a slip?"
    if given.x_G is not None and abs(given.x_G) > 0.5 * L:
        yield "x_G", f"{tell(given, 'x_G')} is outside a ship of {L:g} m"


def _fullness(given: Given) -> Found:
    if given.block is not None and given.block > 1.0:
        yield "block", f"{tell(given, 'block')} is above 1: no hull is fuller than its box"
    elif given.block is not None and given.block < LEAST_BLOCK:
        yield "block", f"{tell(given, 'block')} is below {LEAST_BLOCK:g}: no hull is so slight"


def _volume(given: Given) -> Found:
    L, B, T = given.length, given.beam, given.draught
    if given.displacement is None or L is None or B is None or T is None:
        return
    found = given.displacement / given.rho / (L * B * T)
    said = f"{tell(given, 'displacement')} is a block coefficient of {found:.3g}"
    if not LEAST_BLOCK <= found <= 1.0:
        yield "displacement", f"{said} with this length, beam and draught; was it in tonnes?"
    elif given.block is not None and abs(found / given.block - 1.0) > ALIKE:
        yield "block", f"{said}, and {tell(given, 'block')} is stated; leave one of them out"


def _period(given: Given) -> Found:
    if given.GM is None or given.beam is None or given.roll_period is None:
        return
    radius = given.roll_period * math.sqrt(GRAVITY * given.GM) / (2.0 * math.pi * given.beam)
    if not ROLL_RADII[0] < radius < ROLL_RADII[1]:
        yield (
            "roll_period",
            f"{tell(given, 'roll_period')} and {tell(given, 'GM')} contradict each other: a radius "
            f"of gyration of {radius:.2g} times the beam, where ships have 0.3 to 0.45",
        )


def _shape(given: Given, form: HullForm) -> Found:
    """What a displacement, a beam or a draught makes of the sides that are not stated."""
    by = next((n for n in ("displacement", "beam", "draught") if n in known_names(given)), "length")
    wrong = (
        form.B > form.L
        or form.T > form.L
        or form.L > SLIMMEST * form.B
        or (form.B > SLIMMEST * form.T and LIGHTEST**3 * form.volume < form.L**3)
    )
    if wrong:
        box = f"{form.L:.4g} x {form.B:.3g} x {form.T:.3g} m"
        yield by, f"{tell(given, by)} makes a hull of {box}; check the units"


def _stability(given: Given, form: HullForm) -> Found:
    height = metacentre(form.B, form.T, form.block)
    by = "GM" if given.GM is not None else "roll_period"
    if by in known_names(given) and HIGHEST * height < form.GM:
        came = "" if by == "GM" else f", a GM of {form.GM:.3g} m,"
        yield (
            by,
            f"{tell(given, by)}{came} would put gravity below the keel: the metacentre is about "
            f"{height:.3g} m above it",
        )


def _rudder(given: Given, form: HullForm) -> Found:
    plane = form.L * form.T
    if given.rudder_area is not None and given.rudder_area >= plane:
        said = tell(given, "rudder_area")
        yield "rudder_area", f"{said} is no less than the lateral plane of {plane:.4g} m^2"
    if given.propeller_diameter is not None and given.propeller_diameter > form.T:
        said = tell(given, "propeller_diameter")
        yield "propeller_diameter", f"{said} is more than the draught {form.T:.3g} m"


def _way(given: Given, form: HullForm) -> Found:
    if given.speed is not None and form.froude > FASTEST:
        yield "speed", f"{tell(given, 'speed')} is a Froude number of {form.froude:.2g}"


WHOLE: Final[tuple[Callable[[Given, HullForm], Found], ...]] = (_shape, _stability, _rudder, _way)
"""What only the whole hull shows, with what is not stated filled in."""
