"""Roll decays drawn at random: of a model or a ship, held before or not, by a hand that moves."""

import numpy as np

from trialid.trial import Trial


def drawn(seed, held, **others):
    """A decay, and the sample at which she was let go: the first, where she is not held."""
    rng = np.random.default_rng(seed)
    period = rng.choice([2.4, 12.0])
    dt, heel = period / rng.uniform(24.0, 60.0), np.deg2rad(rng.uniform(4.0, 20.0))
    before = int(rng.uniform(0.5, 3.0) * period / dt) if held else 0
    swing = free_swing(rng, heel, period, dt, int(rng.uniform(4.0, 15.0) * period / dt))
    hand = 0.02 * heel * np.sin(np.arange(before) * dt * rng.uniform(0.5, 2.0))
    phi = rng.choice([-1.0, 1.0]) * np.concatenate([heel + hand, swing])
    phi = phi + rng.normal(0.0, np.deg2rad(rng.uniform(0.02, 0.15)), len(phi))
    signals = {"phi": phi} | {name: np.full(len(phi), x) for name, x in others.items()}
    valid = {name: np.ones(len(phi), np.bool_) for name in signals}
    return Trial("decay", "fit", float(dt), signals, valid), before


def free_swing(rng, heel, period, dt, samples):
    """Linear and quadratic damping, about a list."""
    w, ratio, eddies = 2.0 * np.pi / period, rng.uniform(0.02, 0.15), rng.uniform(0.0, 0.3)
    rest, x, p, found = np.deg2rad(rng.normal(0.0, 0.5)), heel, 0.0, []
    for _ in range(samples):
        found.append(x)
        for _ in range(10):
            p += 0.1 * dt * (-(w**2) * (x - rest) - 2.0 * ratio * w * p - eddies * p * abs(p))
            x += 0.1 * dt * p
    return np.array(found)
