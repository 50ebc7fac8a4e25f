"""Each route to the noise against what was put in: no fit is needed, a residual is enough."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.signal import lfilter

from trialid.diagnosis.noise.residual import effective_in
from trialid.diagnosis.noise.split import split
from trialid.diagnosis.noise.variance import hac, lag_window
from trialid.ship.actuators import Actuator
from trialid.trial import Trial
from trialid.trial_rows import Stretch

PERIOD = 0.5
NOTHING = SimpleNamespace(traces=())
SIGMA = 0.2


def noise(seed, n, rho=0.0):
    """Noise of variance 1 that keeps a share of itself from sample to sample."""
    e = np.random.default_rng(seed).standard_normal(n + 400)
    return lfilter([np.sqrt(1.0 - rho**2)], [1.0, -rho], e)[400:]


def trial(name, left, predicted=None, delta=None, use="fit"):
    """A trial of one output whose model leaves this; predicted amidships unless said."""
    n = len(left)
    y = np.zeros(n) if predicted is None else predicted
    angle = np.zeros(n) if delta is None else delta
    mask = {"r": np.ones(n, dtype=bool), "delta": np.ones(n, dtype=bool)}
    made = Trial(name, use, PERIOD, {"r": y + left, "delta": angle}, mask)
    return SimpleNamespace(
        trial=made, response=SimpleNamespace(y=y[:, None]), compared=np.ones((n, 1), dtype=bool)
    )


SHIP = SimpleNamespace(actuators=(), particulars={"L": 175.0, "g": 9.81})


def fit_of(*scores, y_rms=1.0, ship=SHIP):
    """A fit as far as its residual goes."""
    left = [s.trial.signals["r"] - s.response.y[:, 0] for s in scores if s.trial.use == "fit"]
    eps = float(np.sqrt(np.mean(np.concatenate(left) ** 2))) / y_rms
    read = SimpleNamespace(equations=SimpleNamespace(inputs=("delta", "u")))
    problem = SimpleNamespace(
        outputs=("r",),
        y_rms=np.array([y_rms]),
        weights=np.ones(1),
        unknowns=(),
        simulator=read,
        trials=tuple(s.trial for s in scores if s.trial.use == "fit"),
    )
    return SimpleNamespace(
        model=SimpleNamespace(ship=ship),
        scores=scores,
        problem=problem,
        eps_rmsn=eps,
        eps_by_output={"r": eps},
        theta=np.zeros(0),
        residual=np.concatenate(left),
        at_bounds=(),
    )


def steered(n):
    """A rudder that goes over every ten to forty seconds, and never in the same rhythm."""
    switches = np.cumsum(np.random.default_rng(9).integers(20, 80, n))
    return 0.3 * (-1.0) ** np.searchsorted(switches, np.arange(n))


def test_the_mean_of_a_quiet_stretch_is_no_noise():
    """A gyro's zero, as large as the noise itself: it is the model's, that left the bias out."""
    quiet = trial("quiet", SIGMA * noise(1, 4000) + SIGMA)
    chosen, _ = split(fit_of(quiet), NOTHING, {})
    assert chosen.method == "quiet stretch"
    assert chosen.noise == pytest.approx(SIGMA, rel=0.05)
    assert chosen.undermodelling == pytest.approx(SIGMA, rel=0.05)


def test_a_stretch_in_which_the_model_moves_is_not_quiet():
    """Amidships, but the roll from before dies away: what the model leaves there is its own."""
    n = 2000
    roll = np.where(np.arange(n) < 400, np.sin(np.arange(n) / 5.0), 0.0)
    left = SIGMA * noise(2, n) + 0.4 * roll
    chosen, _ = split(fit_of(trial("decay", left, predicted=roll)), NOTHING, {})
    assert chosen.noise == pytest.approx(SIGMA, rel=0.1)


TWIN = SimpleNamespace(
    actuators=tuple(Actuator(name=n, kind="thruster", x=-0.8, y=0.0) for n in ("left", "right")),
    particulars={"L": 175.0 / 36.0, "g": 9.81},
)


def with_thrusters(name, left, port, starboard):
    """A trial of a boat of two thrusters; they go ahead, revolutions [rad/s]."""
    made = trial(name, left)
    del made.trial.signals["delta"]
    made.trial.signals.update(left_order=port, right=starboard)
    return made


def test_a_boat_without_a_rudder_is_quiet_where_all_her_thrusters_rest():
    """For ten seconds, a sixth of a ship 36 times as long; what one of them stirs is no noise."""
    n = 1600
    still, moved = np.full(n, 60.0), 60.0 + 20.0 * steered(5 * n)[::5]
    left = SIGMA * noise(3, n) + np.where(np.arange(n) < 1200, 0.03 * (moved - 60.0), 0.0)
    moved[1200:] = 60.0
    for port, starboard in ((still, moved), (moved, still)):
        chosen, _ = split(
            fit_of(with_thrusters("a", left, port, starboard), ship=TWIN), NOTHING, {}
        )
        assert chosen.method == "quiet stretch"
        assert chosen.noise == pytest.approx(SIGMA, rel=0.15)
    short = with_thrusters("b", left[:1218], moved[:1218], still[:1218])
    assert (
        "no stretch of 10 s, actuator at rest"
        in split(fit_of(short, ship=TWIN), NOTHING, {})[0].why
    )


def test_two_runs_are_one_manoeuvre_where_every_thruster_did_the_same():
    """What the model leaves of both alike is its own; a run with another port side is no repeat."""
    n = 1600
    port, starboard = 60.0 + 20.0 * steered(n), 60.0 - 20.0 * steered(n)
    runs = [
        with_thrusters(f"{i}", SIGMA * noise(i, n) + steered(n), port, starboard) for i in (5, 6)
    ]
    chosen, _ = split(fit_of(*runs, ship=TWIN), NOTHING, {})
    assert chosen.method == "repeated manoeuvre"
    assert chosen.noise == pytest.approx(SIGMA, rel=0.1)
    other = with_thrusters("other", SIGMA * noise(7, n) + steered(n), starboard, starboard)
    again, _ = split(fit_of(runs[0], other, ship=TWIN), NOTHING, {})
    assert "no two trials have the same actuator record" in again.why


@pytest.mark.parametrize("rho", [0.0, 0.9])
def test_intervals_of_the_noise_hold_it_in_19_of_20_records(rho):
    held = []
    for seed in range(150):
        quiet = trial("quiet", SIGMA * noise(seed, 2000, rho))
        chosen, _ = split(fit_of(quiet), NOTHING, {})
        low, high = chosen.noise_interval
        held.append(low <= SIGMA <= high)
    assert 0.90 <= np.mean(held) <= 0.995


def test_intervals_of_the_model_part_know_the_chance_in_the_error_itself():
    """The noise is known well, from a long approach; the fitted trial is short."""
    held = []
    for seed in range(150):
        n, model = 240, 0.1
        off = np.sqrt(2.0) * model * np.sin(np.arange(n) / 11.0)
        short = trial("short", SIGMA * noise(seed, n) + off, delta=steered(n))
        approach = trial("approach", SIGMA * noise(seed + 500, 12_000), use="check")
        chosen, _ = split(fit_of(short, approach), NOTHING, {})
        low, high = chosen.undermodelling_interval
        held.append(low <= model <= high)
    assert 0.90 <= np.mean(held) <= 1.0


def test_a_stretch_that_is_too_short_for_its_noise_gives_no_figure():
    """A minute and a half of a swell of half a minute is three waves."""
    n = 3000
    delta = np.where(np.arange(n) < 180, 0.0, steered(n))
    slow = trial("slow", SIGMA * noise(3, n, 0.97), delta=delta)
    chosen, routes = split(fit_of(slow), NOTHING, {})
    assert not chosen.available
    assert "too short, the noise is known to" in routes[2].why
    fast = trial("fast", SIGMA * noise(3, n), delta=delta)
    assert split(fit_of(fast), NOTHING, {})[0].noise == pytest.approx(SIGMA, rel=0.2)


def test_a_mean_taken_out_of_every_piece_costs_a_sample_each():
    """Forty declared pieces of ten samples: without it a tenth of the variance would be missing."""
    found = []
    for seed in range(40):
        n = 1200
        pieces = [(k * 15.0, k * 15.0 + 5.0) for k in range(40)]
        many = trial("many", SIGMA * noise(seed, n), delta=steered(n))
        _, routes = split(fit_of(many), NOTHING, {}, {"many": pieces})
        low, high = routes[2].noise_interval
        found.append((low**2 + high**2) / 2.0)
    assert np.mean(found) == pytest.approx(SIGMA**2, rel=0.05)


def test_what_differs_between_two_runs_is_the_noise_of_both():
    """The model errs alike in both: half of the difference's squares are one run's."""
    n = 3000
    off = 0.15 * np.sin(np.arange(n) / 9.0)
    runs = [trial(f"run {k}", off + SIGMA * noise(k, n), delta=steered(n)) for k in (20, 21)]
    chosen, _ = split(fit_of(*runs), NOTHING, {})
    assert chosen.method == "repeated manoeuvre"
    assert chosen.noise == pytest.approx(SIGMA, rel=0.05)
    assert chosen.undermodelling == pytest.approx(np.sqrt(np.mean(off**2)), rel=0.05)
    low, high = chosen.noise_interval
    assert low < SIGMA < high


def test_a_stated_figure_is_in_the_outputs_own_unit():
    n = 1000
    moving = trial("moving", 0.5 * noise(4, n), delta=steered(n))
    fit = fit_of(moving, y_rms=2.0)
    chosen, _ = split(fit, NOTHING, {"r": 0.3})
    assert chosen.noise == pytest.approx(0.15)
    assert chosen.noise**2 + chosen.undermodelling**2 == pytest.approx(fit.eps_rmsn**2)


@pytest.mark.parametrize("rho", [0.0, 0.6, 0.9])
def test_effective_samples_of_a_variance(rho):
    """(1 - rho^2) / (1 + rho^2) of the samples for a first-order process."""
    n = 100_000
    expected = n * (1.0 - rho**2) / (1.0 + rho**2)
    assert effective_in(noise(5, n, rho), np.ones(n, dtype=bool)) == pytest.approx(
        expected, rel=0.1
    )


def test_variance_of_a_sum_of_coloured_products():
    """N (1 + rho) / (1 - rho) for the sum of a first-order process; a twentieth is looked over."""
    n, rho = 100_000, 0.9
    part = [Stretch(0, 0, slice(0, n), np.ones(n, dtype=bool))]
    assert lag_window(part) == n // 20
    found = [
        float(
            hac(
                noise(seed, 4000, rho)[:, None],
                [Stretch(0, 0, slice(0, 4000), np.ones(4000, dtype=bool))],
            )[0, 0]
        )
        for seed in range(60)
    ]
    assert np.mean(found) == pytest.approx(4000 * (1.0 + rho) / (1.0 - rho), rel=0.15)


def test_no_sum_of_products_has_a_negative_variance():
    """However regular a swing: of any other period the neighbours' weights leave something."""
    n = 2000
    part = [Stretch(0, 0, slice(0, n), np.ones(n, dtype=bool))]
    for omega in np.linspace(0.05, 0.5, 40):
        swing = np.cos(omega * np.arange(n))[:, None]
        assert hac(swing, part)[0, 0] > -1e-9 * n
