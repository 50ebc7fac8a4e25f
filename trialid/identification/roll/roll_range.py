"""What any ship's roll is like: a metacentric height over L and a damping ratio, loosely.

Where a record hardly rolls, righting moment and damping run off together, to a GM of 70 m for a
ferry: the simulated heel then follows the turn without any dynamics, and nothing in the record
objects. Both are therefore held on a logarithmic scale, within a factor of three at one standard
deviation, which a record that does roll overrules.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import NDArray

from trialid.ship.estimate.hydrostatics import metacentre
from trialid.ship.model import ShipModel
from trialid.ship.prime import mass_scale

Vector = NDArray[np.float64]

GM_OVER_L: Final = 0.008
DAMPING_RATIO: Final = 0.06
"""Middle of what ships have: GM of 0.2 to 3 % of L, a damping ratio of 0.02 to 0.2 under way."""

FACTOR: Final = float(np.log(3.0))
"""One standard deviation. A factor of 1.7 would pull multihulls, of 9 would hold nothing."""

NO_SHIPS: Final = 6.0
"""Factor from the middle at which a damping ratio, below 0.01 or above 0.36, is doubted: an
oscillation that goes on by itself is a swell's, and a heel that merely follows the turn has no
period. Of 22 drawn ships whose GM was stated wrong and that were looked at 17 had such a ratio;
half of the factor doubts a twentieth of all ships drawn with ratios of 0.02 to 0.2, twice of it
misses at least 4 of the 17."""

LEAST: Final = 1e-6
"""Share of L below which GM counts as this: the logarithm needs a positive number."""


@dataclass(frozen=True, kw_only=True)
class RollRange:
    """Rows of a search for GM and the roll damping.

    Attributes
    ----------
    GM, Kp
        Where they stand in theta; Kp None where it is not free.
    length
        Of the ship [m].
    critical
        Kp of critical damping at a GM of 1 m, negative; in proportion to sqrt(GM).
    swing
        Frequency of small rolls at a GM of 1 m [rad/s]; in proportion to sqrt(GM) too.
    stiffest
        The greatest GM that a ship like her may have [m].
    known
        Places with a prior of their own: of those this says nothing.
    """

    GM: int
    Kp: int | None
    length: float
    critical: float
    swing: float
    stiffest: float
    known: frozenset[int] = frozenset()

    def damping(self, GM: float, ratio: float) -> float:
        """Kp of a damping ratio at a GM [m]."""
        return ratio * self.critical * float(np.sqrt(GM))

    def off(self, theta: Vector) -> dict[int, float]:
        """Standard deviations from the middle, by the place of GM and Kp in theta."""
        GM = max(float(theta[self.GM]), LEAST * self.length)
        found = {self.GM: float(np.log(GM / (GM_OVER_L * self.length))) / FACTOR}
        if self.Kp is not None:
            found[self.Kp] = float(np.log(max(self.ratio(theta), 1e-6) / DAMPING_RATIO)) / FACTOR
        return {place: z for place, z in found.items() if place not in self.known}

    def ratio(self, theta: Vector) -> float:
        """The damping ratio; that of the middle where it is not searched for."""
        if self.Kp is None:
            return DAMPING_RATIO
        GM = max(float(theta[self.GM]), LEAST * self.length)
        return float(theta[self.Kp]) / self.damping(GM, 1.0)

    def frequency(self, theta: Vector) -> float:
        """Of small rolls with a GM [rad/s]."""
        return self.swing * float(np.sqrt(max(float(theta[self.GM]), LEAST * self.length)))

    def rows(self, theta: Vector) -> tuple[Vector, Vector]:
        """Residual and gradient of the rows, in standard deviations; (k,), (k, n_theta)."""
        off = self.off(theta)
        slopes = np.zeros((len(off), len(theta)))
        GM = max(float(theta[self.GM]), LEAST * self.length)
        for row, place in zip(slopes, off, strict=True):
            if place == self.GM:
                row[self.GM] = 1.0 / (GM * FACTOR)
            else:
                row[place] = 1.0 / (min(theta[place], 1e-6 * self.damping(GM, 1.0)) * FACTOR)
                row[self.GM] = -0.5 / (GM * FACTOR)
        return -np.array(list(off.values())), slopes


def _stiffest(particulars: Mapping[str, float]) -> float:
    """Twice the deviations above the middle, or her metacentre above her keel where that is more.

    Yachts of 12 m stand with 0.09 of their length on ballast beneath them; ships have 0.03 at most.
    """
    most = GM_OVER_L * particulars["L"] * float(np.exp(2.0 * FACTOR))
    if not {"B", "T"} <= particulars.keys():
        return most
    L, B, T = (particulars[n] for n in ("L", "B", "T"))
    return max(most, metacentre(B, T, particulars["nabla"] / (L * B * T)))


def roll_range(
    model: ShipModel, U: float, places: dict[str, int], known: frozenset[int] = frozenset()
) -> RollRange | None:
    """The rows of a model that rolls, None where its GM is not free.

    Parameters
    ----------
    U
        How fast she goes [m/s].
    places
        Free parameters, and where they stand in theta.
    known
        Places with a prior of their own.
    """
    if "GM" not in places or not {"p", "phi"} <= {*model.states}:
        return None
    L, rho, g, nabla = (model.ship.particulars[n] for n in ("L", "rho", "g", "nabla"))
    inertia = mass_scale("I_xx", L, rho) * (model.value("I_xx") - model.value("Kpdot"))
    critical = -2.0 * float(np.sqrt(rho * g * nabla * inertia)) / (0.5 * rho * L**4 * U)
    swing = float(np.sqrt(rho * g * nabla / inertia))
    return RollRange(
        GM=places["GM"],
        Kp=places.get("Kp"),
        length=L,
        critical=critical,
        swing=swing,
        stiffest=_stiffest(model.ship.particulars),
        known=known,
    )
