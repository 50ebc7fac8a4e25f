"""Which quantity a channel is by what it is called, and the unit its name ends with.

A name is cut into words; the longest phrase of the dictionary found in it decides. A name that
could be two quantities, that speaks of a limit or an error, or whose unit does not fit is none.
"""

import functools
from collections.abc import Mapping, Sequence
from typing import Final

from trialid.inspection.name_words import (
    UNITS_IN_NAMES,
    bare_words,
    drop_number,
    sides,
    unit_of_rate,
    without_side,
    without_unit,
    words,
)
from trialid.inspection.usual_units import to_si
from trialid.names.quantities import SIGNALS
from trialid.names.side_words import SIDES

PHRASES: Final = {
    "delta": "rudder, rud, rudder angle, rudder position, rudder feedback, ruder, ruderlage, "
    "ruderwinkel, rorvinkel, roerhoek, roderutslag, angle de barre, angle barre, angolo timone, "
    "angulo timon, ángulo timón, steering angle, outboard angle, motor angle, drive angle, "
    "nozzle angle, tiller angle, azimuth angle, pod angle, jet angle, rsa, rudder sensor angle, "
    "helm angle, roder, rodervinkel, timon, timón, timone, leme, angle safran, "
    "angulo de timon, ángulo de timón, barre",
    "delta_order": "rudder order, rudder command, commanded rudder, ordered rudder, ruderkommando, "
    "helm order",
    "r": "rate of turn, turn rate, rot, yaw rate, yawrate, yaw speed, yawspeed, yaw velocity, "
    "yaw dot, psi dot, psidot, heading rate, heading dot, girhastighet, velocidad de giro, "
    "angular rate z, ang vel z, omega z, wendegeschw, drehgeschw, drehrate, "
    "wendegeschwindigkeit, drehgeschwindigkeit, gierrate, giergeschwindigkeit, svinghastighet, "
    "draaisnelheid, angular velocity z, twist angular z, gyro z, taux de giration, "
    "taux de virage, vitesse de giration, velocidad de guinada, velocidad de guiñada, "
    "taxa de guinada, velocita di accostata, velocità di accostata",
    "p": "roll rate, rollrate, rollgeschwindigkeit, roll speed, rollspeed, roll velocity, "
    "roll dot, phi dot, phidot, angular rate x, ang vel x, omega x, angular velocity x, "
    "twist angular x, gyro x",
    "phi": "roll, roll angle, rolling, heel, heel angle, rollwinkel, kraengung, krängung, "
    "kraengungswinkel, krängungswinkel, krengning, slagside, list angle, bank angle, gite, gîte, "
    "roulis, escora, angulo de escora, ángulo de escora, sbandamento, rollio, slagzij, "
    "inclinometer",
    "psi": "heading, true heading, gyro heading, yaw, yaw angle, hdg, hdt, kurs, steuerkurs, "
    "kompasskurs, kreiselkurs, cap vrai, cap compas, prua, rumbo verdadero, rumbo aguja",
    "u": "stw, sow, speed through water, speed water, water speed, speed log, log speed, logspeed, "
    "doppler log, em log, surge speed, surge velocity, surge vel, vel surge, forward speed, "
    "fwd speed, speed fwd, speed forward, speed ahead, forward velocity, longitudinal speed, "
    "longitudinal velocity, long speed, vitesse surface, boat speed, "
    "fahrt durchs wasser, fahrt durch wasser, fahrt durch das wasser, fart gjennom vannet, fdw, "
    "fart genom vattnet, fd w, dvl u, vel u, velocity u, loch, corredera, bsp, boatspeed",
    "v": "sway speed, sway velocity, sway vel, vel sway, lateral speed, lateral velocity, "
    "lat speed, transverse speed, transverse velocity, dvl v, vel v, velocity v",
    "n": "rpm, shaft speed, shaft rpm, propeller rate, propeller rpm, propeller speed, revs, "
    "drehzahl, wellendrehzahl, propellerdrehzahl, engine rpm, engine speed, motordrehzahl, "
    "jet rpm, impeller rpm, revolutions, rate of revolutions, shaft revolutions, "
    "propeller revolutions, propeller revolution, revolution rate, main shaft",
    "V_aw": "aws, apparent wind speed, wind speed apparent, relative wind speed, "
    "wind speed relative, wind velocity relative, wind velo relative, relative wind velocity, "
    "rel wind speed, wind speed rel",
    "gamma_aw": "awa, apparent wind angle, wind angle apparent, relative wind angle, "
    "relative wind direction, wind angle relative, wind direction relative, wind dir relative, "
    "relative wind dir, rel wind angle, rel wind dir, rel wind direction, wind angle rel, "
    "wind dir rel",
    "h": "depth, water depth, depth below keel, depth below transducer",
}
"""What recorders call a quantity."""

ALONE: Final = {
    "u": "u", "v": "v", "p": "p", "r": "r", "phi": "phi", "psi": "psi", "delta": "delta",
    "n": "n", "rev": "n", "h": "h", "delta_c": "delta_order", "delta_order": "delta_order",
    "compass": "psi", "cap": "psi", "Cap": "psi", "rumbo": "psi", "Rumbo": "psi",
}  # fmt: skip
"""Words that mean a quantity only where they are the whole name of a column."""

ORDERED: Final = frozenset(
    (
        "order", "ordered", "command", "commanded", "cmd", "demand", "demanded", "desired",
        "setpoint", "target", "set", "ord", "ref", "reference",
    )
)  # fmt: skip
"""Words that make a rudder its order, and any other quantity a wish instead of a motion."""

QUALIFIERS: Final = frozenset(
    (
        "hat", "est", "estimated", "meas", "measured", "obs", "observed", "filt", "filtered",
        "velo", "vel", "velocity", "angvelo", "angvel", "mid", "gyro", "imu", "prop", "propeller",
        "shaft", "act", "actual", *ORDERED,
    )
)  # fmt: skip
"""Words behind a letter that leave its meaning: `psi_hat`, `u_velo`, `n_prop`."""
STEERING: Final = frozenset(("steering", "steer", "nozzle", "tiller", "helm"))
STEERED: Final = ORDERED | {"act", "actual", "meas", "measured"}  # may follow without a unit
TURNED: Final = dict.fromkeys((*STEERING, "azimuth", "servo"), "delta")
LETTERS: Final = {**ALONE, "vm": "v", "surge": "u", "sway": "v", "log": "u", **TURNED}
"""What such words may follow; a letter alone and the words only with a unit that fits."""
NAMED: Final = frozenset(("phi", "psi", "delta", "delta_c", "delta_order"))
"""Letters that mean the same without a unit too."""

BARE: Final = frozenset(("u", "v", "p", "r", "phi", "psi", "delta", "n", "rev"))
"""Letters that mean it as capitals or with the unit behind them, where that fits: `R [deg/s]`,
`psi_deg`. A depth is not among them: `H [m]` is a wave's height as often."""
SIDED: Final = frozenset(("delta", "n"))  # a ship may have one to each side: `delta_PS`, `n_S`
OVER_GROUND: Final = frozenset(
    {
        ("sog",), ("speed", "over", "ground"), ("speed", "ground"), ("fahrt", "über", "grund"),
        ("fahrt", "ueber", "grund"), ("füg",), ("fueg",), ("gps", "speed"), ("gnss", "speed"),
        ("speed", "gps"), ("speed", "gnss"), ("gps", "spd"), ("vitesse", "fond"),
        ("velocidad", "fondo"),
        ("velocidad", "sobre", "fondo"), ("velocidad", "sobre", "el", "fondo"),
    }
)  # fmt: skip
RUDDERS: Final = ("delta", "delta_order")
SIDEWAYS: Final = frozenset(("sway", "lateral", "transverse", "transversal", "east", "north"))
COURSES: Final = (
    *("cog", "course", "course over ground", "crs", "g crs", "kurs über grund", "route fond"),
    *("rumbo sobre fondo", "rumbo sobre el fondo"),
)
"""Names of the course over ground, `GCrs` a flight controller's; a `Kurs` alone is a heading."""
SPEEDS: Final = frozenset(
    ("speed", "fahrt", "geschwindigkeit", "fart", "vitesse", "velocidad", "boatspeed", "bsp")
)
"""Names of a speed that leave open whether through the water or over ground."""
HERS: Final = frozenset(("ship", "ships", "vessel", "boat", "own"))
"""Words before it that say no more."""
GROUND: Final = frozenset(("ground", "grund", "cog"))
RECEIVERS: Final = ("gps", "gnss")

NO_MEASUREMENT: Final = frozenset(
    (
        "covariance", "cov", "variance", "var", "std", "sigma", "stddev", "error", "err", "status",
        "state", "mode", "quality", "valid", "min", "max", "limit", "limits", "rms", "residual",
        "predicted", "acceleration", "accel", "bias", "temperature", "voltage", "deviation",
        "variation", "instance", "id", "seq", "sequence", "engine", "offset", "count", "sid",
        "wave", "des", "acc", "nav", "manual", "accuracy", "raw", "trim",
    )
)  # fmt: skip
"""Words that make a field something else; in a topic they say nothing: `/state:heading`."""

ENGINES: Final = (("engine", "rpm"), ("engine", "speed"))
"""An engine is no measurement of a ship's motion, but for its revolutions."""


def quantity(name: str, unit: str | None) -> str | None:
    """The quantity a channel is by its name; None where that cannot be told.

    >>> quantity("/steering/rudder:data", "rad"), quantity("yaw_rate_degps", None)
    ('delta', 'r')
    >>> quantity("rudder", "m/s"), quantity("heading_error", "deg"), quantity("x", None)
    (None, None, None)
    """
    if (letter := ALONE.get(name)) is not None:
        return letter if _fits(letter, unit) else None
    told = words(name)
    about = {*bare_words(name.rpartition(":")[2])}
    if any(_holds(told, phrase) for phrase in ENGINES):
        about -= {"engine"}
    if NO_MEASUREMENT & about:
        return None
    found = _qualified(name, unit) or _called(name)
    if found is not None and "min" in told and not _fits(found, unit_in_name(name)):
        return None  # a smallest angle, no rate per minute
    if _of_ground(found, told):
        return None
    if ORDERED.intersection(told):
        found = "delta_order" if found in RUDDERS or _best(told) == {*RUDDERS} else None
    if found == "n":
        found = next(iter(sorted(sides(name))), "n")
    return found if found is not None and _fits(found, unit) else None


def _of_ground(found: str | None, told: Sequence[str]) -> bool:
    """Whether a heading is a course over ground by its name, or a speed one over ground."""
    if found == "psi":
        return bool(GROUND.intersection(told))
    return found in ("u", "v") and any(_holds(told, phrase) for phrase in OVER_GROUND)


def _qualified(name: str, unit: str | None) -> str | None:
    """The quantity of a letter with words behind it that leave its meaning."""
    letter, *behind = words(name.rpartition(":")[2]) or ("",)
    found = LETTERS.get(letter)
    more = without_unit(behind)
    about = without_side(name, more) if found in SIDED else more
    if found is None or not QUALIFIERS.issuperset(about):
        return None
    stated = unit or unit_in_name(name)
    fits = stated is not None and _fits(found, stated)
    if about or letter not in ALONE:
        fits = fits or (stated is None and letter in STEERING and STEERED.issuperset(about))
        return found if fits or letter in NAMED else None
    named = letter in NAMED and any(word in SIDES for word in more)
    return found if named or (fits and letter in BARE and is_column(name)) else None


def is_column(name: str) -> bool:
    """Whether a name is a table's column and no field of a message, whose letters have others."""
    return not {":", "/"} & {*name}


def of_some_speed(name: str, unit: str) -> bool:
    """Whether a channel is a speed of which the name does not say relative to what: `Fahrt`."""
    told = [word for word in bare_words(name) if word not in HERS]
    return len(told) == 1 and told[0] in SPEEDS and _fits("u", unit)


def over_ground(name: str, unit: str | None) -> bool:
    """Whether a channel is the speed over ground, which no model knows but which is a start."""
    field = bare_words(name.rpartition(":")[2])
    if (NO_MEASUREMENT | SIDEWAYS).intersection(field) or not _fits("u", unit):
        return False
    return any(_holds(words(name), phrase) for phrase in OVER_GROUND)


def is_course(name: str, description: str, unit: str | None) -> bool:
    """Whether a channel is the course over ground, by its name or what the format says of it."""
    field = bare_words(name.rpartition(":")[2])
    if (NO_MEASUREMENT | ORDERED).intersection(field) or not _fits("psi", unit):
        return False
    told = " ".join(word for word in field if word not in RECEIVERS)
    return told in COURSES or description.endswith("course over ground")


def unit_in_name(name: str) -> str | None:
    """The unit a channel's name ends with, or is: `roll_deg`, `speed_mps`, `RPM`.

    >>> unit_in_name("yaw_rate_radps"), unit_in_name("rudder")
    ('rad/s', None)
    """
    field = words(drop_number(name.rpartition(":")[2]))
    if field[:2] == ("angular", "velocity") or field[-3:-1] == ("twist", "angular"):
        return "rad/s"  # as ROS messages have it, which state no unit
    if field[-3:-1] == ("twist", "linear"):
        return "m/s"  # as those do
    if field in (("rpm",), ("rps",)):  # of a shaft, and of nothing else
        return field[0]
    for count in (2, 1):
        if len(field) > count and (unit := UNITS_IN_NAMES.get(" ".join(field[-count:]))):
            if _longest(field) in ("r", "p"):
                return unit_of_rate(unit, field)
            return None if field[-1] == "ms" and not _is_speed(field[:-1]) else unit  # milliseconds
    return None


def _is_speed(told: Sequence[str]) -> bool:
    """Whether words, without those of a unit, are those of a speed."""
    called = tuple(told) in OVER_GROUND or _longest(told) in ("u", "v")
    letter = len(told) == 1 and LETTERS.get(told[0]) in ("u", "v")
    return called or letter or of_some_speed(" ".join(told), "m/s")


def _called(name: str) -> str | None:
    """What the field is called, or, where that says nothing, the whole name."""
    field = words(name.rpartition(":")[2])
    return _longest(field) or (None if _several(field) else _longest(words(name)))


def _longest(told: Sequence[str]) -> str | None:
    """The quantity of the longest phrase in some words; None where two are as long."""
    best = _best(told)
    return best.pop() if len(best) == 1 else None


def _several(told: Sequence[str]) -> bool:
    return len(_best(told)) > 1


def _best(told: Sequence[str]) -> set[str]:
    """The quantities of the longest phrases that stand in some words."""
    for size, phrases in _phrases().items():
        runs = (tuple(told[i : i + size]) for i in range(len(told) - size + 1))
        if best := set[str]().union(*(phrases.get(run, ()) for run in runs)):
            return best - {"n"} if best & {"n_p", "n_s"} else best  # one of two shafts is a shaft
    return set()


@functools.cache
def _phrases() -> Mapping[int, Mapping[tuple[str, ...], set[str]]]:
    """What quantities a phrase calls, by how many words it has, the longest first."""
    ours = [(q, tuple(one.split())) for q, text in PHRASES.items() for one in text.split(", ")]
    known = [(q, tuple(a.split("_"))) for q, signal in SIGNALS.items() for a in signal.aliases]
    found = dict[int, dict[tuple[str, ...], set[str]]]()
    for q, phrase in (*ours, *known):
        found.setdefault(len(phrase), {}).setdefault(phrase, set()).add(q)
    return dict(sorted(found.items(), reverse=True))


def _holds(told: Sequence[str], phrase: Sequence[str]) -> bool:
    """Whether the words of a phrase stand in a name, one after another."""
    starts = range(len(told) - len(phrase) + 1)
    return any(tuple(told[i : i + len(phrase)]) == tuple(phrase) for i in starts)


def _fits(name: str, unit: str | None) -> bool:
    share = unit == "%" and SIGNALS[name].steers  # of its full deflection, which the user knows
    return unit is None or share or to_si(unit, SIGNALS[name].unit) is not None
