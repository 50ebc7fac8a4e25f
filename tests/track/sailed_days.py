"""A day of trials as a log: manoeuvres, course keeping and harbour movements, by a plain ship.

The ship is a nonlinear Nomoto of first order with a speed that turns cost, apart from the package's
own models; who sails her knows when each manoeuvre began and ended.
"""

from dataclasses import dataclass, field

import numpy as np

from trialid.trial import Trial

PERIOD = 1.0
GEAR = np.deg2rad(3.0)
DEG = np.deg2rad(1.0)


@dataclass(kw_only=True)
class Day:
    """The ship, and what was logged so far."""

    rng: np.random.Generator
    length: float = 150.0
    speed: float = 7.5
    K: float = 0.06
    T: float = 25.0
    a: float = 8.0
    rows: list[tuple[float, ...]] = field(default_factory=list)
    truth: list[tuple[str, int, int]] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.r, self.psi, self.delta, self.x, self.y = 0.0, 0.3, 0.0, 0.0, 0.0
        self.u, self.n = self.speed, 10.0

    def step(self, order: float, shaft: float = 10.0) -> None:
        """One second; what is logged is what was before it."""
        self.rows.append((order, self.delta, self.n, self.u, self.r, self.psi, self.x, self.y))
        for _ in range(5):
            h = PERIOD / 5
            self.delta += np.clip(order - self.delta, -GEAR * h, GEAR * h)
            self.n += np.clip(shaft - self.n, -0.8 * h, 0.8 * h)
            way = max(self.u, 0.0) / self.speed
            rate = self.K * way * self.delta - self.r - self.a * self.r * abs(self.r) * 10.0
            self.r += h * rate / self.T
            thrust = self.n * abs(self.n) / 100.0 * self.speed**2
            drag = self.u * abs(self.u) + 4e5 * self.r**2
            self.u += h * (thrust - drag) / (4.0 * self.length)
            self.psi += h * self.r
            self.x += h * self.u * np.cos(self.psi)
            self.y += h * self.u * np.sin(self.psi)

    @property
    def now(self) -> int:
        return len(self.rows)

    def keep(self, course: float, seconds: int) -> None:
        """A course by an autopilot, its rudder within 2 deg once she is on it."""
        for _ in range(seconds):
            off = (course - self.psi + np.pi) % (2 * np.pi) - np.pi
            most = 2 * DEG if abs(off) < 5 * DEG and abs(self.r) < 0.1 * DEG else 12 * DEG
            self.step(float(np.clip(0.8 * off - 25.0 * self.r, -most, most)))

    def settle(self) -> None:
        """Straight on, at her speed."""
        for _ in range(60):
            self.keep(self.psi + 5.0 * self.r, 10)
            if abs(self.r) < 0.02 * DEG and self.u > 0.9 * self.speed:
                break
        self.keep(self.psi, 120)

    def until(self, order: float, done) -> None:
        for _ in range(3000):
            if done():
                return
            self.step(order)

    def turning_circle(self) -> None:
        side = self.rng.choice([-1.0, 1.0])
        angle, goal = self.rng.choice([20.0, 25.0, 35.0]) * DEG, self.rng.uniform(190, 560) * DEG
        begin, psi = self.now, self.psi
        self.until(side * angle, lambda: abs(self.psi - psi) > goal)
        self.truth.append(("turning circle", begin, self.now))

    def zigzag(self) -> None:
        angle = self.rng.choice([10.0, 15.0, 20.0]) * DEG
        heading = self.rng.choice([angle, angle, 10.0 * DEG])
        side, psi, begin = self.rng.choice([-1.0, 1.0]), self.psi, self.now
        for _ in range(int(self.rng.integers(3, 6))):
            goal = side * heading
            self.until(side * angle, lambda s=side, g=goal: s * (self.psi - psi - g) > 0.0)
            side = -side
        self.until(side * angle, lambda: side * (self.psi - psi) > 0.0)  # back on her course
        self.truth.append(("zig-zag", begin, self.now))

    def pull_out(self) -> None:
        """A turn of 20 deg of rudder until it is steady, then midships."""
        side, psi, first = self.rng.choice([-1.0, 1.0]), self.psi, self.now
        goal = self.rng.uniform(110, 170) * DEG
        self.until(side * 20 * DEG, lambda: abs(self.psi - psi) > goal)
        begin = self.now
        self.until(0.0, lambda: self.now - begin > 160)
        self.truth += [("turn", first, begin), ("pull-out", begin, self.now)]

    def spiral(self) -> None:
        """25 deg to -25 by steps of 5 or 10, each as long as the rate takes to settle."""
        side, begin = self.rng.choice([-1.0, 1.0]), self.now
        angles = np.arange(25.0, -26.0, -self.rng.choice([5.0, 10.0]))
        for angle in side * angles * DEG:
            at = self.now
            self.until(angle, lambda a=at: self.now - a > 110)
        self.truth.append(("spiral", begin, self.now))

    def stop(self) -> None:
        """Full astern until she has next to no way."""
        begin, u = self.now, self.u
        for _ in range(1500):
            if self.u <= 0.1 * u:
                break
            self.step(0.0, -8.0)
        self.truth.append(("stop", begin, self.now))
        for _ in range(900):
            self.step(0.0)
            if self.u > 0.85 * self.speed:
                break

    def williamson(self) -> None:
        """Out by 60 deg, round, steered on to the reciprocal course and kept for three lengths."""
        side, psi, begin = self.rng.choice([-1.0, 1.0]), self.psi, self.now
        angle = self.rng.choice([25.0, 30.0, 35.0]) * DEG
        away, short = self.rng.uniform(50, 70) * DEG, self.rng.uniform(15, 40) * DEG
        self.until(side * angle, lambda: side * (self.psi - psi) > away)
        goal, span = psi - side * np.pi, round(3.0 * self.length / self.speed)
        self.until(-side * angle, lambda: side * (goal - self.psi) > -short)
        eased = self.now
        for _ in range(1500):
            self.keep(goal, 1)
            kept = np.array([row[5] for row in self.rows[max(eased, self.now - span) :]])
            if len(kept) == span and np.abs(kept - self.psi).max() <= 3.0 * DEG:
                break
        self.truth.append(("Williamson turn", begin, self.now))

    def harbour(self) -> None:
        """Rudder about, courses changed, speed taken off: nothing that has a name."""
        for _ in range(int(self.rng.integers(2, 7))):
            kind = self.rng.integers(3)
            if kind == 0:
                self.keep(self.psi + self.rng.uniform(-120, 120) * DEG, 200)
            elif kind == 1:
                for _ in range(int(self.rng.integers(3, 9))):
                    order = self.rng.uniform(-30, 30) * DEG
                    for _ in range(int(self.rng.integers(5, 25))):
                        self.step(float(order))
            else:
                shaft = self.rng.uniform(3.0, 9.0)
                for _ in range(int(self.rng.integers(40, 160))):
                    self.step(float(self.rng.uniform(-4, 4) * DEG), float(shaft))


def sail_day(seed: int, choice: int = 6) -> tuple[Trial, Day]:
    """Three to six manoeuvres of any kind in any order, harbour movements before and between."""
    rng = np.random.default_rng([77, seed])
    length = rng.uniform(80.0, 280.0)
    speed = rng.uniform(5.0, 10.0)
    day = Day(rng=rng, length=length, speed=speed, T=0.25 * length / speed * 5.0)
    day.K = rng.uniform(0.8, 1.6) * speed / length
    day.a = 0.1 * (length / speed) * 4.0
    kinds = [day.turning_circle, day.zigzag, day.pull_out, day.spiral, day.stop, day.williamson]
    day.harbour()
    for kind in rng.choice(choice, int(rng.integers(3, 7))):
        day.settle()
        kinds[kind]()
        for _ in range(5):
            day.step(0.0)  # midships, as the helmsman is told
        day.harbour()
    rows = np.array(day.rows).T
    names = ("delta_order", "delta", "n", "u", "r", "psi", "x", "y")
    signals = dict(zip(names, (row.copy() for row in rows), strict=True))
    noise = {"delta": 0.2 * DEG, "u": 0.05, "r": 0.03 * DEG, "psi": 0.2 * DEG, "x": 1.0, "y": 1.0}
    signals = {n: y + noise.get(n, 0.0) * rng.standard_normal(len(y)) for n, y in signals.items()}
    del signals["delta_order"]  # most logs have the rudder alone
    valid = {n: np.ones(len(y), dtype=bool) for n, y in signals.items()}
    return Trial(f"day {seed}", "fit", PERIOD, signals, valid), day
