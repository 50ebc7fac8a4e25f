"""Ships drawn and sailed by the kernel: the helmsman's own passages, ranges that draws fill."""

from pathlib import Path

import numpy as np
import pytest
import s175q
from typical import known_by

from trialid.accuracy.likely import Rows, stand
from trialid.accuracy.one_missing import Rival
from trialid.design.helm import carry_out, vessel
from trialid.design.prediction.drawn_ships import draw_ships, sail_draws
from trialid.design.prediction.keeping_place import sail_each
from trialid.design.standard import LENGTHS, STEPS, STRAIGHT, in_calm
from trialid.effects import CATALOGUE
from trialid.errors import DesignError, TrialidError
from trialid.ship.model import ShipModel
from trialid.workflow.notebook.front import run
from trialid.workflow.use.orders import named_manoeuvre

EFFECTS = ("linear_hull", "linear_rudder", "linear_roll", "heel_yaw", "yaw_drag_rar")
MODEL = ShipModel(s175q.SHIP, ("v", "p", "r", "phi"), tuple(CATALOGUE[n] for n in EFFECTS))
GEARED = (MODEL + CATALOGUE["rudder_servo"]).with_values({"T_delta": 3.0})


def ship(model: ShipModel):
    return in_calm(vessel(model, 0.5, {"u": 7.33}, np.deg2rad(3.0)))


@pytest.mark.parametrize("model", [MODEL, GEARED], ids=["ramp", "gear"])
@pytest.mark.parametrize("words", [("zigzag", "20", "10"), ("circle", "35")])
def test_a_ship_that_keeps_her_place_sails_as_the_helmsman_says(model, words) -> None:
    """The same orders at the same samples and the same motion, for the second ship too."""
    base, asked = ship(model), named_manoeuvre(words)
    one = STEPS * base.period
    theta = np.array([base.model.value(n) for n in base.simulator.equations.parameters])
    other = theta.copy()
    other[base.simulator.equations.parameters.index("Nr")] *= 1.3
    changed = ship(model.with_values({"Nr": 1.3 * model.value("Nr")}))
    passages = sail_each(base, [theta, other], asked.told, STRAIGHT * one, LENGTHS * one)
    for found, expected_ship in zip(passages, (base, changed), strict=True):
        expected = carry_out(expected_ship, asked.told(), STRAIGHT * one, LENGTHS * one)
        n = found.trial.samples
        assert n > 5 * STEPS
        for name in ("delta_order", "delta", "psi", "r", "phi"):
            assert np.array_equal(found.trial.signals[name], expected.trial.signals[name][:n])
        assert np.array_equal(found.x, expected.x[:n])
        assert asked.reading.read(found, None) == asked.reading.read(expected, None)


def test_what_acts_late_is_refused() -> None:
    late = (MODEL + CATALOGUE["rudder_record_delay"]).with_values({"tau_delta": 1.0})
    asked = named_manoeuvre(["circle", "35"])
    with pytest.raises(DesignError, match="delta acts late"):
        next(sail_each(ship(late), np.zeros((1, 9)), asked.told, 1.0, 10.0))


def test_parameters_of_another_model_are_refused() -> None:
    """The kernel would read what lies beside them."""
    asked = named_manoeuvre(["circle", "35"])
    with pytest.raises(ValueError, match=r"thetas: a row a ship of .*Ndelta.*, got"):
        next(sail_each(ship(MODEL), np.zeros((1, 0)), asked.told, 1.0, 10.0))


def test_draws_of_what_is_missing_have_the_moments_of_the_average() -> None:
    """Expected moves and variances by the formulas, through a rival that the rows speak for."""
    rng = np.random.default_rng(1)
    psi, S = rng.standard_normal((400, 2)), rng.standard_normal((400, 1))
    S[:, 0] += 0.8 * psi[:, 0]
    rows = Rows(
        residual=0.4 * S[:, 0] + rng.standard_normal(400),
        psi=psi,
        priors=np.zeros((2, 2)),
        held=rng.standard_normal((400, 1)) + psi[:, 1:],
        deviations=np.array([0.3]),
        S=S,
        level=1.0,
    )
    standing = stand(rows, [Rival("it", (0,), (1.0,))])
    average, drawn = standing.average(), standing.draw(40_000, np.random.default_rng(2))
    middle = average.shifts.mean(axis=0)
    about = (average.variances + average.shifts**2).mean(axis=0) - middle**2
    assert drawn.moves.mean(axis=0) == pytest.approx(middle, abs=4.0 * np.sqrt(about.max() / 4e4))
    assert drawn.moves.var(axis=0) == pytest.approx(about, rel=0.05)
    with_it = drawn.columns[drawn.rivals == 0]
    assert len(with_it) > 30_000
    assert with_it[:, 1].mean() > 0.2
    assert (drawn.columns[drawn.rivals < 0][:, 1] == 0.0).all()


def test_ships_that_cannot_be_are_not_drawn() -> None:
    """Mean and deviation of a mass known to +-50 % that is above zero, by its truncated normal."""
    mass = MODEL.value("m")
    base = vessel(MODEL, 0.5, {"u": 7.33}, 0.05)
    drawn = draw_ships(base, known_by("m", 0.5 * mass), 4000, seed=1).known["m"] / mass
    assert len(drawn) == 4000
    assert drawn.min() > 0.0
    density, above = np.exp(-2.0) / np.sqrt(2.0 * np.pi), 0.9772499
    rise = 0.5 * density / above
    assert drawn.mean() == pytest.approx(1.0 + rise, abs=0.03)
    assert drawn.std() == pytest.approx(np.sqrt(0.25 - rise - rise**2), abs=0.02)


def test_draws_fill_the_range_of_a_number() -> None:
    """Where a parameter alone is uncertain: quantiles of 300 draws at the ends of the range."""
    base, asked = vessel(MODEL, 0.5, {"u": 7.33}, 0.05), named_manoeuvre(["zigzag", "20"])
    deviation = 0.03 * abs(MODEL.value("Nr"))
    spread = known_by("Nr", deviation)
    found = sail_draws(base, asked, spread, draw_ships(base, spread, 300, seed=4))
    values = found["first overshoot 20/20 [deg]"]
    ends = []
    for side in (1.96, -1.96):
        other = MODEL.with_values({"Nr": MODEL.value("Nr") + side * deviation})
        one = vessel(other, 0.5, {"u": 7.33}, 0.05)
        none = known_by("Nr", 0.0)
        ends.append(sail_draws(one, asked, none, draw_ships(one, none, 1, seed=0)))
    low, high = sorted(float(e["first overshoot 20/20 [deg]"][0]) for e in ends)
    assert np.mean((low < values) & (values < high)) == pytest.approx(0.95, abs=0.04)
    assert np.mean(values) == pytest.approx(0.5 * (low + high), abs=0.15 * (high - low))


@pytest.mark.study(turn="each")
def test_a_run_is_drawn_by_its_ranges(run_folder: Path) -> None:
    """The report's range holds about 95 of 100 draws; the same seed gives the same ships."""
    found = run(run_folder.parents[1] / "used.toml")
    drawn = found.draw("zigzag", 20, 20, number=200, seed=3)
    name = "first overshoot 20/20 [deg]"
    value, (low, high) = found.simulate("zigzag", 20, 20).attrs["numbers"][name]
    inside = np.mean((low < drawn.numbers[name]) & (drawn.numbers[name] < high))
    assert 0.85 < inside < 1.0
    assert abs(drawn.numbers[name].median() - value) < 0.5 * (high - low)
    again = found.draw("zigzag", 20, 20, number=200, seed=3)
    assert again.numbers.equals(drawn.numbers)
    assert set(drawn.parameters["missing"]) > {""}
    turn = found.draw(delta=np.full(200, 0.2), period=0.5, number=50, seed=1)
    plain = found.simulate(delta=np.full(200, 0.2), period=0.5)
    r = turn.motion["r"]
    assert r.shape == (50, 200)
    assert turn.t[-1] == pytest.approx(99.5)
    middle = np.median(r[:, -1])
    assert plain["r_from"].iloc[-1] < middle < plain["r_to"].iloc[-1]
    assert np.ptp(r[:, -1]) > 0.0
    with pytest.raises(TrialidError, match="at least 1"):
        found.draw("circle", 35, number=0)
