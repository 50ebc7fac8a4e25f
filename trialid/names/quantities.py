"""The dictionary of quantities: one name, one symbol, one SI unit, one positive direction each."""

from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True)
class Quantity:
    """A named signal or ship particular.

    `mirror` is the sign the quantity takes when port and starboard are exchanged: +1 for what the
    mirror leaves alone (surge speed), -1 for what it reverses (rudder angle). `shown` is the unit
    in reports, `length` and `speed` the powers of L and U in its prime scale; `steers` that it is
    an angle of a rudder, whose side no convention settles. `commands` are the kinds of order that
    the ship file may say it is instead, each with its unit.
    """

    name: str
    symbol: str
    unit: str
    shown: str
    meaning: str
    mirror: int = 1
    length: int = 0
    speed: int = 0
    angle: bool = False
    aliases: frozenset[str] = frozenset()
    steers: bool = False
    commands: tuple[tuple[str, str], ...] = ()


def _table(rows: Iterable[Quantity]) -> dict[str, Quantity]:
    return {row.name: row for row in rows}


def _aliases(text: str) -> frozenset[str]:
    return frozenset(text.split())


SIGNALS = _table(
    (
        Quantity(
            "u",
            "u",
            "m/s",
            "m/s",
            "surge speed, through the water, positive forward",
            speed=1,
            aliases=_aliases("stw speed_through_water"),
        ),
        Quantity("v", "v", "m/s", "m/s", "sway speed, positive to starboard", mirror=-1, speed=1),
        Quantity(
            "p",
            "p",
            "rad/s",
            "deg/s",
            "roll rate, positive starboard side going down",
            mirror=-1,
            length=-1,
            speed=1,
            aliases=_aliases("roll_rate"),
        ),
        Quantity(
            "r",
            "r",
            "rad/s",
            "deg/s",
            "yaw rate, positive bow to starboard",
            mirror=-1,
            length=-1,
            speed=1,
            aliases=_aliases("rot yaw_rate rate_of_turn"),
        ),
        Quantity(
            "phi",
            "phi",
            "rad",
            "deg",
            "roll angle, positive starboard side down",
            mirror=-1,
            aliases=_aliases("roll heel"),
        ),
        Quantity(
            "psi",
            "psi",
            "rad",
            "deg",
            "heading, positive clockwise from north",
            mirror=-1,
            angle=True,
            aliases=_aliases("heading yaw"),
        ),
        Quantity(
            "delta",
            "delta",
            "rad",
            "deg",
            "rudder angle, positive turns the ship to starboard",
            mirror=-1,
            aliases=_aliases("rudder rudder_angle"),
            steers=True,
        ),
        Quantity(
            "delta_order",
            "delta_c",
            "rad",
            "deg",
            "ordered rudder angle, positive turns the ship to starboard",
            mirror=-1,
            aliases=_aliases("rudder_order"),
            steers=True,
        ),
        Quantity(
            "n",
            "n",
            "rad/s",
            "rpm",
            "propeller shaft speed, positive ahead",
            length=-1,
            speed=1,
            aliases=_aliases("rpm shaft_speed propeller_rate"),
        ),
        Quantity(
            "n_p",
            "n_p",
            "rad/s",
            "rpm",
            "shaft speed of the port propeller, positive ahead",
            length=-1,
            speed=1,
            aliases=_aliases("rpm_port"),
        ),
        Quantity(
            "n_s",
            "n_s",
            "rad/s",
            "rpm",
            "shaft speed of the starboard propeller, positive ahead",
            length=-1,
            speed=1,
            aliases=_aliases("rpm_starboard"),
        ),
        Quantity(
            "V_aw",
            "V_aw",
            "m/s",
            "m/s",
            "speed of the apparent wind",
            speed=1,
            aliases=_aliases("aws apparent_wind_speed"),
        ),
        Quantity(
            "gamma_aw",
            "gamma_aw",
            "rad",
            "deg",
            "where the apparent wind comes from, off the bow, positive starboard",
            mirror=-1,
            angle=True,
            aliases=_aliases("awa apparent_wind_angle"),
        ),
        Quantity("h", "h", "m", "m", "depth of the water", length=1, aliases=_aliases("depth")),
        Quantity(
            "alpha_w",
            "alpha_w",
            "rad",
            "deg",
            "slope of the waves across the ship, positive water lower to starboard",
            mirror=-1,
            aliases=_aliases("wave_slope"),
        ),
        Quantity("x", "x", "m", "m", "position north of where the trial begins", length=1),
        Quantity("y", "y", "m", "m", "position east of where the trial begins", -1, length=1),
        Quantity("x_dot", "dx/dt", "m/s", "m/s", "speed over ground to the north", speed=1),
        Quantity("y_dot", "dy/dt", "m/s", "m/s", "speed over ground to the east", -1, speed=1),
        Quantity("sog", "SOG", "m/s", "m/s", "speed over ground", speed=1),
        Quantity(
            "cog", "COG", "rad", "deg", "course over ground, clockwise from north", -1, angle=True
        ),
        Quantity(
            "a_x",
            "a_x",
            "m/s^2",
            "m/s^2",
            "what an accelerometer at the origin feels ahead, du/dt - v r",
            length=-1,
            speed=2,
        ),
        Quantity(
            "a_y",
            "a_y",
            "m/s^2",
            "m/s^2",
            "what one feels to starboard, gravity with it: dv/dt + u r - g sin(phi)",
            mirror=-1,
            length=-1,
            speed=2,
        ),
        Quantity("lat", "lat", "rad", "deg", "latitude by WGS 84, positive north"),
        Quantity("lon", "lon", "rad", "deg", "longitude by WGS 84, positive east", angle=True),
        Quantity("U", "U", "m/s", "m/s", "speed through the water sqrt(u^2 + v^2)", speed=1),
        Quantity("t", "t", "s", "s", "time since the start of the trial", length=1, speed=-1),
        Quantity("u_dot", "du/dt", "m/s^2", "m/s^2", "rate of the surge speed"),
        Quantity("v_dot", "dv/dt", "m/s^2", "m/s^2", "rate of the sway speed", mirror=-1),
        Quantity("p_dot", "dp/dt", "rad/s^2", "deg/s^2", "roll acceleration", mirror=-1),
        Quantity("r_dot", "dr/dt", "rad/s^2", "deg/s^2", "yaw acceleration", mirror=-1),
        Quantity(
            "r_ref",
            "r_ref",
            "rad/s",
            "deg/s",
            "yaw rate of a reference sensor, an input",
            mirror=-1,
        ),
        Quantity("X_ext", "X_ext", "N", "N", "known outer force ahead (tug, tow line, test rig)"),
        Quantity(
            "Y_ext", "Y_ext", "N", "N", "known outer force to starboard at the origin", mirror=-1
        ),
        Quantity("K_ext", "K_ext", "N m", "N m", "known outer heeling moment", mirror=-1),
        Quantity("N_ext", "N_ext", "N m", "N m", "known outer yaw moment", mirror=-1),
    )
)
"""Signals an effect may ask for and a log may hold."""

PARTICULARS = _table(
    (
        Quantity("L", "L", "m", "m", "length between perpendiculars", length=1),
        Quantity("rho", "rho", "kg/m^3", "kg/m^3", "density of the water"),
        Quantity("g", "g", "m/s^2", "m/s^2", "acceleration of gravity", length=-1, speed=2),
        Quantity("nabla", "nabla", "m^3", "m^3", "volume of displacement", length=3),
        Quantity("U0", "U_0", "m/s", "m/s", "approach speed of the trial", speed=1),
        Quantity("T", "T", "m", "m", "draught, where the ship file gives it", length=1),
        Quantity("B", "B", "m", "m", "beam, where the ship file gives it", length=1),
    )
)
"""Constants of the ship and the water an effect may ask for."""

QUANTITIES = SIGNALS | PARTICULARS

ACCELERATIONS = ("u_dot", "v_dot", "p_dot", "r_dot")
"""Signals that the equations give and only a sensor may read."""

SLOPES = {"r": "psi", "p": "phi"}
"""Rates and their angles: each is the slope of the other by definition."""

POSITION = ("x", "y")
"""Where the ship is; no force depends on it, and a ship length is its natural measure."""

OVER_GROUND = (*POSITION, "x_dot", "y_dot", "sog", "cog")
"""What a satellite receiver tells and a current changes."""

MASS_PARAMETERS = (
    "m", "x_G", "z_G", "I_xx", "I_zz",
    "Xudot", "Yvdot", "Ypdot", "Yrdot", "Kvdot", "Kpdot", "Krdot", "Nvdot", "Npdot", "Nrdot",
)  # fmt: skip
"""Primed; those a ship file does not give are zero, except m, I_xx and I_zz."""

POSITIONS = frozenset({"lat", "lon", "x", "y"})
"""Where an antenna is."""
RUDDERS = frozenset(name for name, signal in SIGNALS.items() if signal.steers)
"""Half of the literature and many loggers count the rudder to port: its side is never guessed."""

MOTIONS = SIGNALS.keys() - RUDDERS
"""What moves by itself; a rudder may well be held."""


def is_input(quantity: Quantity) -> bool:
    """Whether it is moved, however abruptly: rudders, shafts, actuators, a signal of one's own."""
    return quantity.steers or quantity.name in ("n", "n_p", "n_s") or quantity.name not in SIGNALS
