"""Ships of the tests, as their owners would state them."""

import math

import numpy as np

from trialid.ship.estimate import Given

S175 = Given(
    length=175.0,
    beam=25.4,
    draught=8.5,
    displacement=21222.0 * 1025.0,
    speed=7.33,
    GM=0.3,
    rudder_area=33.0376,
    rudder_aspect=1.8219,
    propeller_diameter=6.533,
)
NAVAL = Given(
    length=51.5, beam=8.6, draught=2.3, displacement=357.0 * 1014.0, rho=1014.0, speed=8.0, GM=1.1
)


def drawn(seed):
    """An ordinary ship of any size, stated in full."""
    rng = np.random.default_rng(seed)
    L = 10.0 ** rng.uniform(0.3, 2.5)
    B = L / rng.uniform(4.0, 9.0)
    return Given(
        length=L,
        beam=B,
        draught=B / rng.uniform(2.0, 5.0),
        block=rng.uniform(0.4, 0.85),
        speed=math.sqrt(9.81 * L) * rng.uniform(0.08, 0.35),
        GM=B * rng.uniform(0.01, 0.12),
    )
