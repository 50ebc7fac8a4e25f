"""A ship file to begin with where there is none: a container ship of another length.

A record of motions gives accelerations, never forces: every force it can tell is relative to the
mass. So the masses of a placeholder scale the coefficients, and the simulated motion does not
depend on them much.
"""

from pathlib import Path
from typing import Final

HEAD: Final = """\
# A PLACEHOLDER, not your ship: only L and U0 are hers. Masses and coefficients are those of the
# container ship S-175, primed, so that they grow with L. They are good to begin a fit with: motions
# tell accelerations, and every coefficient found is relative to these masses. Put in your own
# figures where you have them, the masses first; the coefficients found are then your ship's.
"""

S175: Final = """\
m = 0.00792         # mass over 1/2 rho L^3: displacement / (1/2 L^3)
I_xx = 0.0000176    # roll inertia over 1/2 rho L^5
I_zz = 0.000456     # yaw inertia, a radius of gyration of 0.24 L
Xudot = -0.000238   # added masses
Yvdot = -0.007049
Kpdot = -0.0000034
Nrdot = -0.000419

[coefficients]      # where the search begins
Yv = -0.0119
Yr = 0.0029
Nv = -0.0037
Nr = -0.0025
Kv = 0.00031
Kr = -0.00007
Ydelta = -0.0030
Ndelta = 0.0015
Kdelta = 0.0001
Kp = -0.0000075
"""

DENSITY: Final = 1025.0
GRAVITY: Final = 9.81
SHARE_OF_A_BOX: Final = 0.00396
"""Displaced volume over L^3 of the S-175, which m above belongs to."""
GM: Final = 0.3 / 175.0
"""Metacentric height over L of the S-175."""


def placeholder(length: float, speed: float, speed_words: str) -> str:
    """The text of a ship file for a ship of this length [m] and speed [m/s]."""
    return (
        HEAD
        + f'name = "placeholder of {length:g} m"\n'
        + 'source = "PLACEHOLDER: masses and coefficients of the container ship S-175 (Son & '
        + "Nomoto 1982), primed; only the length is the ship's own\"\n"
        + 'system = "prime"\nrudder_positive = "starboard"\n\n[particulars]\n'
        + f"L = {length:g}  # m, as stated\n"
        + f"U0 = {speed:.4g}  # m/s, {speed_words}\n"
        + f"nabla = {SHARE_OF_A_BOX * length**3:.5g}  # m^3, L^3 times the S-175's share: REPLACE\n"
        + f"rho = {DENSITY}\ng = {GRAVITY}\n\n[mass]  # REPLACE\n"
        + S175
        + f"GM = {GM * length:.3g}  # m\n"
    )


def placeholder_path(pipeline: Path) -> Path:
    """Where the placeholder of a pipeline stands: `zigzag.toml` has `zigzag_ship.toml`."""
    return pipeline.with_name(f"{pipeline.stem}_ship.toml")
