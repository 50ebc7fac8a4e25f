"""Roll decays of ships of any size, by an integrator that is none of the package's."""

from dataclasses import dataclass, replace

import numpy as np
from s175q import SHIP
from scipy.integrate import solve_ivp

from trialid.effects import CATALOGUE
from trialid.identification.fit import identify
from trialid.identification.problem import Settings
from trialid.ship.model import ShipModel
from trialid.trial import Trial


@dataclass(frozen=True, kw_only=True)
class Roller:
    """A ship that rolls: S-175 of another length, her weights as they are spread in her.

    Attributes
    ----------
    length, GM
        Of the ship [m].
    ratio, square, cube
        Linear damping over critical; damping by |p| p and p^3 over the inertia [1, s].
    arm
        GM3 [m].
    list
        Heel that she rolls about [rad].
    """

    length: float = 3.5
    GM: float = 0.03
    ratio: float = 0.03
    square: float = 0.0
    cube: float = 0.0
    arm: float = 0.0
    list: float = 0.0

    @property
    def ship(self):
        times = self.length / SHIP.particulars["L"]
        sizes = {"L": 1, "B": 1, "T": 1, "nabla": 3, "U0": 0.5, "D_R": 1, "x_R": 1}
        known = SHIP.particulars
        sized = {n: known[n] * times**k for n, k in sizes.items() if n in known}
        coefficients = {**SHIP.coefficients, "GM": self.GM}
        return replace(SHIP, particulars={**known, **sized}, coefficients=coefficients)

    @property
    def weight(self):
        known = self.ship.particulars
        return known["rho"] * known["g"] * known["nabla"]

    @property
    def inertia(self):
        """With the water that rolls along [kg m^2]."""
        known = self.ship
        whole = known.mass["I_xx"] - known.mass["Kpdot"]
        return 0.5 * known.particulars["rho"] * self.length**5 * whole

    @property
    def omega(self):
        """Of small rolls [rad/s]."""
        return float(np.sqrt(self.weight * self.GM / self.inertia))

    def decay(self, heel, seed, cycles=12, use="fit", speed=0.0, noise=0.05):
        """Let go at a heel [deg], 25 samples in a period, with noise [deg]."""
        period = 2.0 * np.pi / self.omega / 25.0
        t = period * np.arange(25 * cycles + 1)

        def slope(_, x):
            phi, p = x
            held = self.weight * (self.GM * (phi - self.list) + self.arm * phi**3) / self.inertia
            lost = 2.0 * self.ratio * self.omega * p + self.square * abs(p) * p + self.cube * p**3
            return [p, -held - lost]

        phi = solve_ivp(
            slope, (0.0, t[-1]), [np.deg2rad(heel), 0.0], t_eval=t, rtol=1e-9, atol=1e-9
        ).y[0]
        phi = phi + np.deg2rad(noise) * np.random.default_rng(seed).standard_normal(len(t))
        signals = {"phi": phi, "u": np.full(len(t), speed)}
        valid = {n: np.ones(len(t), bool) for n in signals}
        return Trial(f"decay-{heel}", use, period, signals, valid)

    def decays(self, seed, heels=(7, 18), **how):
        return [self.decay(heel, seed + heel, **how) for heel in heels]

    def fit(self, trials, effects=("linear_roll",), free=("Kp", "GM")):
        """Fitted from a quarter less GM than she has."""
        chosen = tuple(CATALOGUE[e] for e in effects)
        model = ShipModel(self.ship, ("p", "phi"), chosen).with_values({"GM": 0.75 * self.GM})
        started = {"Kp0": -0.02 * self.inertia * self.omega} if "Kp0" in free else {}
        settings = Settings(free, ("phi",), nuisance=("initial_state", "bias"))
        return identify(trials, model.with_values(started), settings)
