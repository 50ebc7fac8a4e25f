"""Arrays as annotations name them."""

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]


Mask = NDArray[np.bool_]
