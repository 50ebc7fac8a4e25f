"""Reference: the 27 NIST StRD nonlinear regressions, digits counted from both starts.

Digits are log relative errors, -log10(|found - certified| / |certified|), the worst parameter of a
problem counting, at most the 11 that NIST certifies. `pytest -s -k table` shows them all. At the
end of the file: the step control on problems one can check by head.
"""

import functools
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy import exp
from numpy.typing import NDArray

from trialid.least_squares.gauss_newton import EXACT, REASONS, Iteration, Minimum, minimise

Vector = NDArray[np.float64]
Prediction = tuple[Vector, list[Vector]]
Model = Callable[..., Prediction]
"""Prediction (M,) and its derivative to each parameter, from the predictor and the parameters."""

FOLDER = Path(__file__).parent / "nist"
FLOOR = 6.0
"""Digits that every problem must reach from both starts, in parameters, deviations and sum."""
CERTIFIED = 11.0
PATIENCE = 10_000
"""Iterations; nearly all need fewer than 100, MGH10 from start 1 needs 7641 (see the table)."""


# The models, each with its exact derivatives


def saturation(x: Vector, b1: float, b2: float) -> Prediction:
    e = exp(-b2 * x)
    return b1 * (1 - e), [1 - e, b1 * x * e]


def saturation_square(x: Vector, b1: float, b2: float) -> Prediction:
    q = 1 + b2 * x / 2
    return b1 * (1 - q**-2), [1 - q**-2, b1 * x * q**-3]


def saturation_root(x: Vector, b1: float, b2: float) -> Prediction:
    q = 1 + 2 * b2 * x
    return b1 * (1 - q**-0.5), [1 - q**-0.5, b1 * x * q**-1.5]


def saturation_ratio(x: Vector, b1: float, b2: float) -> Prediction:
    q = 1 + b2 * x
    return b1 * b2 * x / q, [b2 * x / q, b1 * x / q**2]


def decay_over_line(x: Vector, b1: float, b2: float, b3: float) -> Prediction:
    line = b2 + b3 * x
    y = exp(-b1 * x) / line
    return y, [-x * y, -y / line, -x * y / line]


def three_decays(x: Vector, *b: float) -> Prediction:
    y, columns = np.zeros_like(x), []
    for size, rate in zip(b[::2], b[1::2], strict=True):
        e = exp(-rate * x)
        y = y + size * e
        columns += [e, -size * x * e]
    return y, columns


def two_decays(x: Vector, b1: float, b2: float, b3: float, b4: float, b5: float) -> Prediction:
    e4, e5 = exp(-x * b4), exp(-x * b5)
    return b1 + b2 * e4 + b3 * e5, [np.ones_like(x), e4, e5, -b2 * x * e4, -b3 * x * e5]


def two_peaks(x: Vector, b1: float, b2: float, *peaks: float) -> Prediction:
    e = exp(-b2 * x)
    y, columns = b1 * e, [e, -b1 * x * e]
    for size, middle, width in (peaks[:3], peaks[3:]):
        z = (x - middle) / width
        g = exp(-(z**2))
        y = y + size * g
        columns += [g, 2 * size * g * z / width, 2 * size * g * z**2 / width]
    return y, columns


def one_peak(x: Vector, b1: float, b2: float, b3: float) -> Prediction:
    z = (x - b3) / b2
    g = exp(-0.5 * z**2) / b2
    return b1 * g, [g, b1 * g * (z**2 - 1) / b2, b1 * g * z / b2]


def power(x: Vector, b1: float, b2: float) -> Prediction:
    p = x**b2
    return b1 * p, [p, b1 * p * np.log(x)]


def shifted_power(x: Vector, b1: float, b2: float, b3: float) -> Prediction:
    q = b2 + x
    p = q ** (-1 / b3)
    return b1 * p, [p, -b1 * p / q / b3, b1 * p * np.log(q) / b3**2]


def rational(x: Vector, above: tuple[float, ...], below: tuple[float, ...]) -> Prediction:
    """Polynomial over 1 + polynomial."""
    top = np.polynomial.polynomial.polyval(x, above)
    bottom = np.polynomial.polynomial.polyval(x, (1.0, *below))
    y = top / bottom
    columns = [x**k / bottom for k in range(len(above))]
    return y, columns + [-y * x**k / bottom for k in range(1, len(below) + 1)]


def quadratics(x: Vector, *b: float) -> Prediction:
    return rational(x, b[:3], b[3:])


def cubics(x: Vector, *b: float) -> Prediction:
    return rational(x, b[:4], b[4:])


def enzyme(x: Vector, b1: float, b2: float, b3: float, b4: float) -> Prediction:
    bottom = x**2 + x * b3 + b4
    q = (x**2 + x * b2) / bottom
    return b1 * q, [q, b1 * x / bottom, -b1 * q * x / bottom, -b1 * q / bottom]


def arrhenius(x: Vector, b1: float, b2: float, b3: float) -> Prediction:
    q = x + b3
    e = exp(b2 / q)
    return b1 * e, [e, b1 * e / q, -b1 * b2 * e / q**2]


def logistic(x: Vector, b1: float, b2: float, b3: float) -> Prediction:
    e = exp(b2 - b3 * x)
    q = 1 + e
    return b1 / q, [1 / q, -b1 * e / q**2, b1 * x * e / q**2]


def richards(x: Vector, b1: float, b2: float, b3: float, b4: float) -> Prediction:
    e = exp(b2 - b3 * x)
    q = 1 + e
    p = q ** (-1 / b4)
    slope = b1 * p * e / q / b4
    return b1 * p, [p, -slope, x * slope, b1 * p * np.log(q) / b4**2]


def dielectric(x: Vector, b1: float, b2: float, b3: float) -> Prediction:
    time, temperature = x
    e = exp(-b3 * temperature)
    return b1 - b2 * time * e, [np.ones_like(time), -time * e, b2 * time * temperature * e]


def quantum_defect(x: Vector, b1: float, b2: float, b3: float, b4: float) -> Prediction:
    z = x - b4
    r = z**2 + b3**2
    y = b1 - b2 * x - np.arctan(b3 / z) / np.pi
    return y, [np.ones_like(x), -x, -z / r / np.pi, -b3 / r / np.pi]


def three_cycles(x: Vector, b1: float, b2: float, b3: float, *cycles: float) -> Prediction:
    w = 2 * np.pi * x
    c, s = np.cos(w / 12), np.sin(w / 12)
    y, columns = b1 + b2 * c + b3 * s, [np.ones_like(x), c, s]
    for period, even, odd in (cycles[:3], cycles[3:]):
        c, s = np.cos(w / period), np.sin(w / period)
        y = y + even * c + odd * s
        columns += [w / period**2 * (even * s - odd * c), c, s]
    return y, columns


MODELS: dict[str, Model] = {
    "Misra1a": saturation,
    "Chwirut2": decay_over_line,
    "Chwirut1": decay_over_line,
    "Lanczos3": three_decays,
    "Gauss1": two_peaks,
    "Gauss2": two_peaks,
    "DanWood": power,
    "Misra1b": saturation_square,
    "Kirby2": quadratics,
    "Hahn1": cubics,
    "Nelson": dielectric,
    "MGH17": two_decays,
    "Lanczos1": three_decays,
    "Lanczos2": three_decays,
    "Gauss3": two_peaks,
    "Misra1c": saturation_root,
    "Misra1d": saturation_ratio,
    "Roszman1": quantum_defect,
    "ENSO": three_cycles,
    "MGH09": enzyme,
    "Thurber": cubics,
    "BoxBOD": saturation,
    "Rat42": logistic,
    "MGH10": arrhenius,
    "Eckerle4": one_peak,
    "Rat43": richards,
    "Bennett5": shifted_power,
}
"""In NIST's order: lower, average, higher difficulty."""


# The problems


@dataclass(frozen=True)
class Problem:
    """One `.dat` file: data, starts (2, n_theta) and certified values."""

    name: str
    level: str
    x: Vector
    y: Vector
    starts: Vector
    certified: Vector
    deviations: Vector
    squares: float
    deviation: float

    def evaluate(self, b: Vector) -> tuple[Vector, Vector] | None:
        """Residual and Jacobian; None where either leaves the range of numbers."""
        with np.errstate(all="ignore"):
            y, columns = MODELS[self.name](self.x, *b)
            residual, jacobian = self.y - y, np.column_stack(columns)
        if np.isfinite(residual).all() and np.isfinite(jacobian).all():
            return residual, jacobian
        return None


@functools.cache
def read(name: str) -> Problem:
    text = (FOLDER / f"{name}.dat").read_text()
    rows = re.findall(r"^ *b\d+ = +(\S+) +(\S+) +(\S+) +(\S+)$", text, re.MULTILINE)
    table = np.array(rows, dtype=float)
    said = dict(re.findall(r"^([A-Z][\w ]+): +(\S+)$", text, re.MULTILINE))
    data = np.loadtxt(text[text.rindex("Data:") :].splitlines()[1:])
    assert len(data) == int(said["Number of Observations"])
    # the degrees of freedom are counted: Rat43 states 9 and means the 11 of its own deviation
    level = re.search(r"(\w+) Level of Difficulty", text)
    assert level
    return Problem(
        name=name,
        level=level[1],
        x=data[:, 1:].T if data.shape[1] > 2 else data[:, 1],
        y=np.log(data[:, 0]) if name == "Nelson" else data[:, 0],
        starts=table[:, :2].T,
        certified=table[:, 2],
        deviations=table[:, 3],
        squares=float(said["Residual Sum of Squares"]),
        deviation=float(said["Residual Standard Deviation"]),
    )


def digits(found: Vector | float, certified: Vector | float) -> float:
    """Correct digits of the worst value, at most the certified ones."""
    error = np.max(np.abs((np.asarray(found) - certified) / certified))
    return float(-np.log10(max(error, 10**-CERTIFIED)))


def spread(jacobian: Vector) -> Vector:
    """Roots of the diagonal of (J'J)^-1, from QR; (n_theta,)."""
    R = np.linalg.qr(jacobian, mode="r")
    return np.linalg.norm(np.linalg.solve(R, np.eye(len(R))), axis=1)


def along(residual: Vector, jacobian: Vector) -> float:
    """Share of the residual that a linear step could still take away."""
    Q, _ = np.linalg.qr(jacobian / np.linalg.norm(jacobian, axis=0))
    return float(np.linalg.norm(Q.T @ residual) / np.linalg.norm(residual))


def search(problem: Problem, start: int, max_iterations: int = PATIENCE) -> Minimum:
    first = problem.starts[start - 1]
    return minimise(
        problem.evaluate, first, np.abs(first), max_iterations=max_iterations, tolerance=1e-8
    )


@functools.cache
def solve(name: str, start: int) -> Minimum:
    return search(read(name), start)


@dataclass(frozen=True)
class Score:
    """Digits of one run."""

    parameters: float
    deviations: float
    squares: float

    @classmethod
    def of(cls, problem: Problem, end: Minimum) -> "Score":
        variance = 2 * end.V / (len(problem.y) - len(end.theta))
        return cls(
            digits(end.theta, problem.certified),
            digits(np.sqrt(variance) * spread(end.jacobian), problem.deviations),
            digits(2 * end.V, problem.squares),
        )


RUNS = [(name, start) for name in MODELS for start in (1, 2)]
MINIMA = [pytest.param(*run, id="{}-{}".format(*run)) for run in RUNS]
"""The runs, the one that ends elsewhere marked."""


# The data are what NIST certifies


@pytest.mark.parametrize("name", MODELS)
def test_certified_values_follow_from_the_data(name: str) -> None:
    problem = read(name)
    point = problem.evaluate(problem.certified)
    assert point is not None
    residual, jacobian = point
    squares = float(residual @ residual)
    if name == "Lanczos1":
        # 14 digits of data, 11 of parameters: the printed ones cannot give a sum of 1.4e-25
        assert squares < 1e-19
    else:
        assert digits(squares, problem.squares) >= 9.9
    freedom = len(residual) - len(problem.certified)
    assert digits(np.sqrt(problem.squares / freedom), problem.deviation) >= 9.9
    assert digits(problem.deviation * spread(jacobian), problem.deviations) >= 7.0


@pytest.mark.parametrize("name", MODELS)
def test_jacobian_is_exact(name: str) -> None:
    """Against complex steps, which have no truncation error."""
    problem = read(name)
    for b in (problem.starts[1], problem.certified):
        point = problem.evaluate(b)
        assert point is not None
        for k, column in enumerate(point[1].T):
            shifted = b.astype(complex)
            shifted[k] += 1e-30j
            with np.errstate(over="ignore"):
                y, _ = MODELS[name](problem.x.astype(complex), *shifted)
            slope = y.imag / 1e-30
            assert np.linalg.norm(slope - column) <= 1e-12 * np.linalg.norm(column)


# The digits


@pytest.mark.parametrize(("name", "start"), MINIMA)
def test_digits(name: str, start: int) -> None:
    problem, end = read(name), solve(name, start)
    score = Score.of(problem, end)
    assert score.parameters >= FLOOR
    if name == "Lanczos1":
        # a perfect fit to the last digit of the data: what is left is rounding, not noise
        assert end.reason == "exact"
        assert end.V <= EXACT
    else:
        assert score.deviations >= FLOOR
        assert score.squares >= 9.0


@pytest.mark.parametrize(("name", "start"), MINIMA)
def test_reason_is_true(name: str, start: int) -> None:
    end = solve(name, start)
    assert end.converged
    assert end.reason in REASONS
    if end.reason == "exact":
        assert end.V <= EXACT
    elif end.reason == "orthogonal":
        assert along(end.residual, end.jacobian) < 1.1e-8
    else:  # the last digits of V decide: no fall of V that a number can show is left
        assert along(end.residual, end.jacobian) < 1e-6


@pytest.mark.parametrize(("name", "start"), MINIMA)
def test_default_patience_promises_nothing_false(name: str, start: int) -> None:
    """After 50 iterations either the certified values, or the word that more are needed."""
    problem = read(name)
    end = search(problem, start, max_iterations=50)
    if end.converged:
        assert Score.of(problem, end).parameters >= FLOOR
    else:
        assert end.reason == "iterations"
        assert len(end.iterations) == 51


@pytest.mark.parametrize(("name", "start"), RUNS)
def test_way_down(name: str, start: int) -> None:
    """V falls at every accepted step, and the record ends where the search does."""
    end = solve(name, start)
    V = [i.V for i in end.iterations]
    assert all(after < before for before, after in pairwise(V))
    assert V[-1] == end.V
    assert end.evaluations >= len(V)
    point = read(name).evaluate(end.theta)
    assert point is not None
    np.testing.assert_array_equal(point[0], end.residual)
    np.testing.assert_array_equal(point[1], end.jacobian)


@pytest.mark.parametrize("name", [n for n in MODELS if n != "MGH10"])
def test_second_run_is_identical(name: str) -> None:
    once, again = solve(name, 1), search(read(name), 1)
    assert once.theta.tobytes() == again.theta.tobytes()
    assert once.residual.tobytes() == again.residual.tobytes()
    assert once.iterations == again.iterations
    assert (once.reason, once.evaluations) == (again.reason, again.evaluations)


def test_table() -> None:
    """The digits of all 54 runs; shown with -s."""
    lines = ["problem   level    start  parameters  deviations  squares  reason      steps  calls"]
    reached = 0
    for name, start in RUNS:
        problem, end = read(name), solve(name, start)
        score = Score.of(problem, end)
        reached += score.parameters >= FLOOR
        lines.append(
            f"{name:9} {problem.level:8} {start:5} {score.parameters:11.1f} "
            f"{score.deviations:11.1f} {score.squares:8.1f}  {end.reason:10} "
            f"{len(end.iterations) - 1:6} {end.evaluations:6}"
        )
    sys.stdout.write("\n" + "\n".join([*lines, f"{reached} of 54 with 6 digits or more"]) + "\n")
    assert reached >= 54


# Step control


def logarithm(b: Vector) -> tuple[Vector, Vector] | None:
    """Model log(b), measured -2; from b = 5 an undamped step goes to b = -13."""
    if b[0] <= 0.0:
        return None
    return -2.0 - np.log(b), 1.0 / b[:, None]


def line(columns: Vector, y: Vector) -> Callable[[Vector], tuple[Vector, Vector]]:
    return lambda b: (y - columns @ b, columns)


def noisy_line(*columns: Vector) -> Callable[[Vector], tuple[Vector, Vector]]:
    """Measured 6 x plus a part that no multiple of x can explain."""
    return line(np.column_stack(columns), 6.0 * X + WAVE)


X = np.array([1.0, 2.0, 3.0, 4.0])
WAVE = np.array([2.0, -1.0, 0.0, 0.0])
"""Orthogonal to X."""


def test_step_out_of_the_domain_is_shortened() -> None:
    refused = []

    def watched(b: Vector) -> tuple[Vector, Vector] | None:
        point = logarithm(b)
        if point is None:
            refused.append(b[0])
        return point

    end = minimise(watched, np.array([5.0]), np.array([5.0]))
    assert refused
    assert refused[0] < -12.0
    assert end.converged
    np.testing.assert_allclose(end.theta, np.exp(-2.0), rtol=1e-9)


def test_step_to_not_a_number_is_shortened() -> None:
    def careless(b: Vector) -> tuple[Vector, Vector]:
        point = logarithm(b)
        return point if point else (np.array([np.nan]), np.array([[np.nan]]))

    end = minimise(careless, np.array([5.0]), np.array([5.0]))
    np.testing.assert_allclose(end.theta, np.exp(-2.0), rtol=1e-9)


def test_overflow() -> None:
    """A finite residual whose square overflows is a step too long, not a warning."""

    def steep(b: Vector) -> tuple[Vector, Vector]:
        y = b**101.0
        return 1.0 - y, 101.0 * b[:, None] ** 100.0

    end = minimise(steep, np.array([0.9]), np.ones(1), max_iterations=200)
    np.testing.assert_allclose(end.theta, 1.0, rtol=1e-9)


def test_infinite_sensitivity_is_a_step_too_long() -> None:
    """Model sqrt(b - 1), measured 0.5 and -0.6: the first step goes to its edge, b = 1."""

    def edge(b: Vector) -> tuple[Vector, Vector]:
        root = np.sqrt(np.maximum(b - 1.0, 0.0))
        slope = np.divide(0.5, root, out=np.full(1, np.inf), where=root > 0.0)
        return np.array([0.5, -0.6]) - root, np.tile(slope, (2, 1))

    end = minimise(edge, np.array([5.0]), np.array([5.0]), max_iterations=200)
    assert np.isfinite(end.jacobian).all()


def test_bounds_hold() -> None:
    """Every visited point lies inside, and a bound only touched on the way is left again."""
    problem = read("Eckerle4")
    low, high = np.array([0.5, 3.0, 440.0]), np.array([3.0, 6.0, 470.0])
    visited = []

    def watched(b: Vector) -> tuple[Vector, Vector] | None:
        visited.append(b.copy())
        return problem.evaluate(b)

    start = problem.starts[0]
    end = minimise(watched, start, np.abs(start), low, high, max_iterations=500)
    assert all(((low <= b) & (b <= high)).all() for b in visited)
    assert any(((low == b) | (b == high)).any() for b in visited[1:])
    assert digits(end.theta, problem.certified) >= FLOOR


def test_minimum_at_a_bound() -> None:
    """Free, b = (2, 3); with b1 <= 1, b2 is the regression on the rest, and b1 stays at 1."""
    columns = np.column_stack([np.ones(4), X])
    y = columns @ [2.0, 3.0]
    end = minimise(
        line(columns, y), np.zeros(2), np.ones(2), np.full(2, -9.0), np.array([1.0, 9.0])
    )
    assert end.reason == "orthogonal"
    assert end.theta[0] == 1.0
    np.testing.assert_allclose(end.theta[1], X @ (y - 1.0) / (X @ X), rtol=1e-9)


def test_start_outside_the_bounds_is_moved_inside() -> None:
    end = minimise(noisy_line(X), np.array([50.0]), np.ones(1), np.array([7.0]), np.array([9.0]))
    assert end.reason == "orthogonal"
    np.testing.assert_array_equal(end.theta, [7.0])


@pytest.mark.parametrize(
    ("factors", "expected"),
    [((1.0, 1.0), (3.0, 3.0)), ((1.0, 2.0), (3.0, 1.5)), ((1.0, 0.0), (6.0, 0.0))],
)
def test_rank_deficient(factors: tuple[float, float], expected: tuple[float, float]) -> None:
    """b1 f1 + b2 f2 = 6 is all that is known: each is given an equal part, a dead one none.

    That is the minimum-norm step in parameters scaled by the size of their sensitivities.
    """
    end = minimise(noisy_line(*(f * X for f in factors)), np.zeros(2), np.ones(2))
    assert end.converged
    np.testing.assert_allclose(end.theta, expected, rtol=1e-7, atol=1e-12)


def test_rank_deficient_minimum_is_orthogonal() -> None:
    assert minimise(noisy_line(X, X), np.array([3.0, 3.0]), np.ones(2)).reason == "orthogonal"


def test_exact() -> None:
    end = minimise(line(X[:, None], 6.0 * X), np.zeros(1), np.ones(1))
    assert end.reason == "exact"
    assert end.converged
    np.testing.assert_allclose(end.theta, 6.0, rtol=1e-12)


def test_orthogonal_at_the_start() -> None:
    end = minimise(noisy_line(X), np.array([6.0]), np.ones(1))
    assert (end.reason, end.evaluations) == ("orthogonal", 1)


def test_out_of_iterations() -> None:
    end = search(read("Lanczos3"), 1, max_iterations=5)
    assert end.reason == "iterations"
    assert not end.converged
    assert len(end.iterations) == 6


def test_progress_hears_every_accepted_point() -> None:
    heard: list[Iteration] = []
    end = minimise(noisy_line(X), np.zeros(1), np.ones(1), progress=heard.append)
    assert list(dict.fromkeys(heard)) == list(end.iterations[1:])


def test_wrong_jacobian_is_no_minimum() -> None:
    problem = read("Misra1a")

    def wrong(b: Vector) -> tuple[Vector, Vector] | None:
        point = problem.evaluate(b)
        return (point[0], -point[1]) if point else None

    start = problem.starts[1]
    end = minimise(wrong, start, np.abs(start))
    assert end.reason == "stalled"
    assert not end.converged


def test_edge_of_the_domain_is_no_minimum() -> None:
    """Model b, measured 0, defined above 1 only: V falls until the edge and is no minimum there."""

    def walled(b: Vector) -> tuple[Vector, Vector] | None:
        return (-b, np.ones((1, 1))) if b[0] > 1.0 else None

    end = minimise(walled, np.array([5.0]), np.ones(1), max_iterations=500)
    np.testing.assert_allclose(end.theta, 1.0, rtol=1e-6)
    assert not end.converged
