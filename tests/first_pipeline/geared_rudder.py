"""A rudder as a gear moves it."""

import numpy as np
from numpy.typing import NDArray


def geared(orders: NDArray[np.float64], step: float = 1.5) -> NDArray[np.float64]:
    """The angle that follows orders [deg] by so much a sample; (N,)."""
    delta = np.zeros(len(orders))
    for k in range(1, len(orders)):
        delta[k] = delta[k - 1] + np.clip(orders[k] - delta[k - 1], -step, step)
    return delta
