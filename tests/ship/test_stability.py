"""Eq. 15 and 16 by hand, their error against Monte Carlo, and the heel's part in them."""

from dataclasses import replace

import numpy as np
import pytest

from trialid.effects import CATALOGUE
from trialid.ship.model import ShipModel
from trialid.ship.stability import Stability, couple_roll, levers, stability
from trialid.simulation.integrate import prepare, respond
from trialid.simulation.reference import evaluator
from trialid.simulation.trace import trace
from trialid.trial import Trial

M_X, M_X_L_X = 0.000238, 0.0000074494
HULL = {"Yv": -0.0116, "Yr": 0.00242, "Nv": -0.0038545, "Nr": -0.00222, "m": 0.00792, "x_G": 0.0}
RUDDER = HULL | {"Yv": -0.01189081, "Yr": 0.00293553, "Nv": -0.00371021, "Nr": -0.00247579}
HEEL = {"Kv": 0.0003122, "Kr": -0.00007256, "Yphi": -0.000063, "Nphi": -0.0001424, "z_G": 0.0}
LINEAR = (
    "linear_hull", "centripetal_added_mass", "heel_sway", "heel_yaw", "roll_rate_yaw",
    "linear_roll", "heel_roll", "linear_rudder",
)  # fmt: skip


def stiffness(U: float, GM: float = 0.3) -> float:
    """2 g nabla GM / (L^3 U^2) - K_phi: righting moment per radian, primed."""
    return 2.0 * 9.81 * 21222.0 * GM / (175.0**3 * U**2) + 0.000021


def with_surge_mass(c: dict[str, float]) -> dict[str, float]:
    """The water that turns with the hull acts like part of Y_r and K_r."""
    return c | {"Yr": c["Yr"] - M_X} | ({"Kr": c["Kr"] + M_X_L_X} if "Kr" in c else {})


def determinant(c: dict[str, float]) -> float:
    return c["Yv"] * (c["Nr"] - c["m"] * c["x_G"]) - (c["Yr"] - c["m"]) * c["Nv"]


def test_by_hand() -> None:
    c = {"Yv": -4.0, "Nv": -1.0, "Yr": 2.0, "Nr": -3.0, "m": 10.0, "x_G": 0.5}
    assert levers(c) == (1.0, 0.25)
    found = stability(c)
    assert (found.L_r, found.L_v, found.margin, found.standard_error) == (1.0, 0.25, 0.75, None)
    assert found.stable
    assert not stability(c | {"Nv": -5.0}).stable


@pytest.mark.parametrize(("error", "told"), [(0.3, True), (0.4, None), (float("nan"), None)])
def test_a_margin_within_the_noise_tells_nothing(error: float, told: bool | None) -> None:
    """At a dock a ship was said to be unstable by -0.05 +- 0.33."""
    assert Stability(1.0, 0.25, 0.75, error).stable is told
    assert Stability(0.25, 1.0, -0.75, error).stable is (None if told is None else False)


def test_what_moves_nothing_has_no_part_in_its_error() -> None:
    """An arm to the roll axis where no roll is fitted has no covariance that anybody knows."""
    known, unknown = np.diag([1e-8]), np.array([[1e-8, np.nan], [np.nan, np.nan]])
    alone = stability(HULL, ("Nv",), known).standard_error
    assert alone is not None
    assert stability(HULL, ("Nv", "z_slip"), unknown).standard_error == alone
    assert np.isnan(stability(HULL, ("Nv", "Nr"), unknown).standard_error or 0.0)


@pytest.mark.parametrize(("ship", "printed"), [(RUDDER, 0.162), (HULL, 0.055)])
def test_the_s175_with_and_without_its_rudder(ship: dict[str, float], printed: float) -> None:
    assert stability(with_surge_mass(ship)).margin == pytest.approx(printed, abs=0.0006)


def test_error_of_the_margin_against_monte_carlo() -> None:
    """Errors of 2 %; those of N_v and N_r go together, so that L_r - L_v is better than each."""
    names = ("Nv", "Nr", "Yv", "Yr")
    centre = np.array([RUDDER[n] for n in names])
    size = 0.02 * np.abs(centre)
    correlation = np.eye(4)
    correlation[0, 1] = correlation[1, 0] = 0.9
    covariance = correlation * np.outer(size, size)
    drawn = np.random.default_rng(20260101).multivariate_normal(centre, covariance, 40_000)
    Nv, Nr, Yv, Yr = drawn.T
    L_r, L_v = Nr / (Yr - 0.00792), Nv / Yv
    found = stability(RUDDER, names, covariance)
    assert found.standard_error == pytest.approx((L_r - L_v).std(), rel=0.03)
    assert (L_r + L_v).std() > 1.2 * (L_r - L_v).std()
    assert found.margin == pytest.approx((L_r - L_v).mean(), rel=0.01)


def test_error_of_the_roll_coupled_margin_against_monte_carlo() -> None:
    names = ("Nv", "Kr", "Nphi", "Kv")
    values = RUDDER | HEEL | {"G_phi": stiffness(11.52)}
    rng = np.random.default_rng(20260102)
    size = np.array([0.05 * abs(values[n]) for n in names])
    covariance = np.diag(size**2)
    drawn = rng.multivariate_normal([values[n] for n in names], covariance, 4_000)
    margins = [
        stability(values | dict(zip(names, row, strict=True)), coupled=True).margin for row in drawn
    ]
    found = stability(values, names, covariance, coupled=True).standard_error
    assert found == pytest.approx(np.std(margins), rel=0.04)


def test_a_free_parameter_of_another_equation_adds_nothing() -> None:
    covariance = np.diag([1e-8, 1e6])
    two = stability(RUDDER, ("Nr", "Kp"), covariance).standard_error
    assert two == stability(RUDDER, ("Nr",), covariance[:1, :1]).standard_error


@pytest.mark.parametrize(("U", "printed"), [(7.33, 9.43e-6), (11.52, 8.59e-6), (16.54, 7.34e-6)])
def test_heel_takes_stability_away_and_more_so_with_speed(U: float, printed: float) -> None:
    """Determinant of the S-175: 1.006e-5 upright; as printed, without m_x l_x."""
    c = with_surge_mass(RUDDER)
    assert determinant(c) == pytest.approx(1.006e-5, rel=1e-3)
    coupled = couple_roll(c | HEEL | {"G_phi": stiffness(U)})
    assert determinant(coupled) == pytest.approx(printed, rel=1e-3)
    assert 0.0 < stability(coupled).margin < stability(c).margin


@pytest.fixture
def linear(s175q: ShipModel) -> ShipModel:
    """S175Q without its modulus terms, off-centre, so that m z_G and m x_G count."""
    ship = replace(s175q.ship, mass={**s175q.ship.mass, "x_G": -0.01, "z_G": -0.004})
    return ShipModel(ship, ("v", "p", "r", "phi"), tuple(CATALOGUE[n] for n in LINEAR))


def coefficients(model: ShipModel, U: float) -> dict[str, float]:
    names = ("Yv", "Yr", "Nv", "Nr", "Kv", "Kr", "Yphi", "Nphi", "m", "x_G", "z_G")
    c = {n: model.value(n) for n in names}
    return c | {
        "Yr": c["Yr"] + model.value("Yurm"),
        "Kr": c["Kr"] + model.value("Kurm"),
        "G_phi": stiffness(U, model.value("GM")),
    }


@pytest.mark.parametrize("U", [5.0, 7.33, 11.52])
def test_a_slow_turn_of_the_whole_model(U: float, linear: ShipModel) -> None:
    """Steady v and r of the simulation solve the roll-coupled sway and yaw equations."""
    delta, samples = 1e-6, 4000
    signals = {"u": np.full(samples, U), "delta": np.full(samples, delta)}
    trial = Trial("turn", "fit", 1.0, signals, {})
    v, _, r, _ = respond(prepare(linear, (), ("r",)), trial, {}, {}, False).states[-1]
    c = coefficients(linear, U)
    flat = couple_roll(c)
    tilt = linear.value("Kdelta") / c["G_phi"]
    matrix = [
        [flat["Yv"], flat["Yr"] - c["m"]],
        [flat["Nv"], flat["Nr"] - c["m"] * c["x_G"]],
    ]
    push = [linear.value(f"{row}delta") + c[f"{row}phi"] * tilt for row in "YN"]
    expected = -np.linalg.solve(matrix, push) * delta
    assert v / U == pytest.approx(expected[0], rel=1e-6)
    assert r * 175.0 / U == pytest.approx(expected[1], rel=1e-6)


def slowest(model: ShipModel, U: float) -> float:
    """The real eigenvalue nearest to zero on a straight course [1/s]."""
    eq = trace(model, (), ("r",))
    x = {"u": U, "delta": 0.0} | {n: model.value(n) for n in eq.parameters}
    symbols = (*eq.states, *eq.inputs, *eq.parameters)
    entries = evaluator(list(eq.J.values()), symbols, scalar=True)([x.get(s, 0.0) for s in symbols])
    J = np.zeros((len(eq.states), len(eq.states)))
    for place, entry in zip(eq.J, entries, strict=True):
        J[place] = entry
    return max(e.real for e in np.linalg.eigvals(J) if abs(e.imag) < 1e-9)


@pytest.mark.parametrize("excess", [-1e-3, 1e-3])
def test_the_margin_changes_sign_with_the_eigenvalue(excess: float, linear: ShipModel) -> None:
    """At the N_r where the roll-coupled margin is nil the slow eigenvalue passes zero."""
    U = 11.52
    c = coefficients(linear, U)
    L_v = levers(couple_roll(c))[1]
    flat = couple_roll(c | {"Nr": 0.0})
    neutral = c["m"] * c["x_G"] + L_v * (flat["Yr"] - c["m"]) - flat["Nr"]
    moved = linear.with_values({"Nr": neutral * (1.0 + excess)})
    margin = stability(coefficients(moved, U), coupled=True)
    assert margin.stable == (slowest(moved, U) < 0.0) == (excess > 0.0)
    assert abs(slowest(moved, U)) < 1e-4


def test_water_that_turns_with_the_hull_counts(s175q: ShipModel) -> None:
    """As `trialid.result.build` calls it: coefficients by their names in the model."""
    values = {n: s175q.value(n) for n in ("Yv", "Yr", "Yurm", "Nv", "Nr", "m", "x_G")}
    assert stability(values).margin == pytest.approx(0.162, abs=0.0006)
