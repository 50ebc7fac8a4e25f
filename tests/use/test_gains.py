"""Gains of an autopilot: textbook loops, promises that a simulated ship keeps, refusals."""

import json
from pathlib import Path

import numpy as np
import pytest
from test_bad_input import trialid_
from test_nomoto import MODEL, ship
from typical import known_by

from trialid.design.following import sailed_ship
from trialid.design.helm import vessel
from trialid.design.steering.closed_loop import answer, hold_heading, hold_rate
from trialid.design.steering.gains import heading_gains, rate_gains
from trialid.design.steering.nomoto import nomoto
from trialid.design.steering.straight_course import LinearShip
from trialid.errors import DesignError
from trialid.progress import silent
from trialid.ship.model import ShipModel
from trialid.workflow.use.finished_model import finished_model
from trialid.workflow.use.predict import spread_of

CERTAIN = known_by("Nr", 0.0)


def first_order(K: float, T: float) -> LinearShip:
    A, B = np.array([[-1.0 / T]]), np.array([K / T])
    return LinearShip(states=("r",), A=A, B=B, speed=1.0, length=1.0)


def test_a_loop_without_an_integral_is_a_lag() -> None:
    """No overshoot: r / r_d = 1 / (1 + s / w), 5 % after 3 / w; L = (w T - 1) / (T s + 1)."""
    K, T, w = 0.05, 30.0, 0.2
    found = answer(hold_rate(first_order(K, T), (w * T - 1.0) / K, 1e-7, 1.0 / K), w)
    assert found.overshoot == pytest.approx(0.0, abs=1e-6)
    assert found.settling == pytest.approx(-np.log(0.05) / w, rel=0.02)
    crossing = np.sqrt((w * T - 1.0) ** 2 - 1.0) / T
    assert found.phase_margin == pytest.approx(np.pi - np.arctan(crossing * T), rel=1e-4)
    assert found.delay_margin == pytest.approx(found.phase_margin / crossing, rel=1e-3)


def test_a_loop_of_second_order_overshoots_by_its_damping() -> None:
    """Kp = w_n^2 T / K, Kd = (2 z w_n T - 1) / K: exp(-pi z / sqrt(1 - z^2))."""
    K, T, w, z = 0.05, 30.0, 0.1, 0.5
    ship = first_order(K, T)
    found = answer(hold_heading(ship, w * w * T / K, 1e-7, (2.0 * z * w * T - 1.0) / K), w)
    assert found.overshoot == pytest.approx(np.exp(-np.pi * z / np.sqrt(1.0 - z * z)), rel=1e-3)
    late = answer(hold_heading(ship, w * w * T / K, 1e-7, -1.0 / K), w)
    assert not late.stable


def test_the_delay_margin_is_where_the_loop_swings() -> None:
    """With all-passes of that delay the closed loop is at its limit: 0.98 decays, 1.02 does not."""
    ship = first_order(0.05, 30.0)
    found = answer(hold_heading(ship, 6.0, 0.03, 60.0), 0.1)
    for share, stable in ((0.98, True), (1.02, False)):
        tau, n = share * found.delay_margin / 8.0, 8
        A = np.zeros((1 + n, 1 + n))
        A[0, 0], A[0, 1] = -1.0 / 30.0, 0.05 / 30.0
        B = np.zeros(1 + n)
        # a chain of first-order all-passes, (1 - s tau / 2) / (1 + s tau / 2), behind the rudder
        states, drive = chain(tau, n)
        A[1:, 1:], B[1:] = states, drive
        A[0, 1:] = 0.05 / 30.0 * pass_through(n)
        B[0] = 0.05 / 30.0 * (-1.0) ** n
        late = LinearShip(states=("r", *map(str, range(n))), A=A, B=B, speed=1.0, length=1.0)
        assert answer(hold_heading(late, 6.0, 0.03, 60.0), 0.1).stable == stable


def chain(tau: float, n: int) -> tuple[np.ndarray, np.ndarray]:
    """y_i = -u_i + x_i, dx_i/dt = (2 / tau) (2 u_i - x_i): all-passes one behind another."""
    A, B = np.zeros((n, n)), np.zeros(n)
    for i in range(n):
        A[i, i] = -2.0 / tau
        for j in range(i):
            A[i, j] = 4.0 / tau * (-1.0) ** (i - 1 - j)
        B[i] = 4.0 / tau * (-1.0) ** i
    return A, B


def pass_through(n: int) -> np.ndarray:
    return np.array([(-1.0) ** (n - 1 - j) for j in range(n)])


@pytest.mark.parametrize("gains", [rate_gains, heading_gains])
def test_promises_are_those_of_the_simulated_ship(gains) -> None:
    """A small step, the controller on the clock of the simulation, no rudder rate."""
    boat = ship(MODEL)
    found = gains(boat, CERTAIN)
    overshoot, settling = stepped(MODEL, found.values, 1e-5)
    assert overshoot == pytest.approx(found.promise.fitted.overshoot, abs=0.01)
    assert settling == pytest.approx(found.promise.fitted.settling, rel=0.05)
    assert found.promise.stable == 1.0
    assert found.promise.ranges["overshoot"] == pytest.approx([found.promise.fitted.overshoot] * 2)


def stepped(model: ShipModel, gains, step: float) -> tuple[float, float]:
    """Overshoot and settling of the ship herself under the gains, her heading or rate stepped."""
    p = model.ship.particulars
    time = p["L"] / p["U0"]
    sailed = vessel(model, time / 48.0, {"u": p["U0"]}, 1.0)
    eq, run, h = sailed.simulator.equations, sailed.simulator.engine, time / 96.0
    theta = np.array([sailed.model.value(n) for n in eq.parameters])
    x, whole = np.zeros(len(eq.states)), 0.0
    r, psi = eq.states.index("r"), eq.states.index("psi")
    steered = r if "FF" in gains else psi
    held, path = np.full((2, len(eq.inputs)), p["U0"]), []
    limit = np.full(len(x), np.inf)
    for _ in range(6000):
        e = step - x[steered]
        whole += e * h
        if steered == r:
            delta = gains["FF"] * step + gains["P"] * e + gains["I"] * whole
        else:
            delta = gains["Kp"] * e + gains["Ki"] * whole - gains["Kd"] * x[r]
        held[:, eq.inputs.index("delta")] = delta
        X, _ = run.simulate(theta, x, held, limit, h, 1)
        x = X[1]
        path.append(x[steered] / step)
    outside = np.flatnonzero(np.abs(np.array(path) - 1.0) > 0.05)
    return max(path) - 1.0, (int(outside[-1]) + 2) * h


def test_a_doubtful_ship_has_wider_promises_and_a_wild_one_none(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("trialid.design.steering.gains.NUMBER", 60)
    sure = rate_gains(ship(MODEL), known_by("Ndelta", 0.02 * abs(MODEL.value("Ndelta"))))
    unsure = rate_gains(ship(MODEL), known_by("Ndelta", 0.15 * abs(MODEL.value("Ndelta"))))
    for name in ("overshoot", "delay_margin"):
        width = [np.ptp(one.promise.ranges[name]) for one in (sure, unsure)]
        assert width[1] > 3.0 * width[0]
    lost = known_by("Ndelta", 3.0 * abs(MODEL.value("Ndelta")))
    with pytest.raises(DesignError, match=r"would swing.*ask for less by --bandwidth"):
        rate_gains(ship(MODEL), lost)
    turning_on = known_by("Nv", 2.0 * abs(MODEL.value("Nv")))
    with pytest.raises(DesignError, match=r"would swing.*ask for more by --bandwidth"):
        heading_gains(ship(MODEL), turning_on, 0.1 / nomoto(ship(MODEL), CERTAIN).values["T"])
    wild = MODEL.with_values({"Nv": 4.0 * MODEL.value("Nv")})
    with pytest.raises(DesignError, match=r"as fitted .* not directionally stable.* \(0% of the"):
        heading_gains(ship(wild), CERTAIN)
    open_ = known_by("Nv", 2.0 * abs(wild.value("Nv")))
    with pytest.raises(DesignError, match=r"not directionally stable.* \([2-6]\d% of the ships"):
        heading_gains(ship(wild), open_)
    T = nomoto(ship(MODEL), CERTAIN).values["T"]
    with pytest.raises(DesignError, match="slower than the ship by herself"):
        rate_gains(ship(MODEL), CERTAIN, 0.5 / T)
    assert heading_gains(ship(MODEL), CERTAIN, 29.0 / T).bandwidth == 29.0 / T
    for none in (float("nan"), 31.0 / T):
        with pytest.raises(DesignError, match=r"is none of hers.*30 times what is usual"):
            heading_gains(ship(MODEL), CERTAIN, none)


def test_a_promise_holds_for_other_models_of_the_ship(monkeypatch: pytest.MonkeyPatch) -> None:
    """The ends of each, as if it had been alone with the fitted one; none where one swings."""
    monkeypatch.setattr("trialid.design.steering.gains.NUMBER", 60)
    error = abs(MODEL.value("Ndelta"))
    unlike = MODEL.with_values({"Nr": 1.3 * MODEL.value("Nr")})
    known, other = known_by("Ndelta", 0.02 * error), known_by("Ndelta", 0.1 * error)
    alone = rate_gains(ship(MODEL), known)
    both = rate_gains(ship(MODEL), known, others=[(ship(unlike), other)])
    assert both.values == alone.values
    assert both.promise.fitted == alone.promise.fitted
    for name, (low, high) in alone.promise.ranges.items():
        wide = both.promise.ranges[name]
        assert wide[0] <= low <= high <= wide[1]
    assert np.ptp(both.promise.ranges["delay_margin"]) > 2.0 * (
        np.ptp(alone.promise.ranges["delay_margin"])
    )
    with pytest.raises(DesignError, match="would swing"):
        rate_gains(ship(MODEL), known, others=[(ship(unlike), known_by("Ndelta", 3.0 * error))])


def test_ardupilot_s_file_is_the_gains_at_full_rudder(run_folder: Path, tmp_path: Path) -> None:
    """Output of one is full rudder, scaled down by 1 m/s over the ship's speed; else refused."""
    out = tmp_path / "ferry.param"
    command = ("export", str(run_folder), "--as", "ardupilot", "--out", str(out))
    refused = trialid_(*command)
    assert (refused.exit_code, refused.stderr.count("\n")) == (2, 1)
    assert "--full-rudder 35" in refused.stderr
    told = trialid_(*command, "--full-rudder", "35")
    assert told.exit_code == 0, told.stderr
    text = out.read_text(encoding="utf-8")
    values = dict(x.split(",") for x in text.splitlines() if not x.startswith("#"))
    model = finished_model(run_folder, silent)
    K = nomoto(sailed_ship(model.fit), spread_of(model)).values["K"]
    at_full = float(values["ATC_STR_RAT_FF"]) * np.deg2rad(35.0) * 1.0 / 7.33
    assert at_full == pytest.approx(1.0 / K, rel=1e-5)
    assert float(values["ATC_STR_RAT_P"]) == pytest.approx(float(values["ATC_STR_RAT_FF"]))
    assert values["MOT_SPD_SCA_BASE"] == "1"
    assert "beyond the 0 to 3 of ArduPilot's" in text
    assert "overshoots by" in text
    assert max(map(len, text.splitlines())) <= 100
    for wrong in ("0", "nan", "91"):
        assert trialid_(*command, "--force", "--full-rudder", wrong).exit_code == 2


def test_pid_s_file_says_what_it_promises(run_folder: Path, tmp_path: Path) -> None:
    out = tmp_path / "pid.json"
    command = ("export", str(run_folder), "--as", "pid", "--out", str(out))
    assert trialid_(*command, "--bandwidth", "0.05").exit_code == 0
    found = json.loads(out.read_text(encoding="utf-8"))
    assert (found["schema"], found["bandwidth"]) == ("trialid-pid/1", 0.05)
    model = finished_model(run_folder, silent)
    known = nomoto(sailed_ship(model.fit), spread_of(model)).values
    natural = 0.05 / np.sqrt(1 - 2 * 0.64 + np.sqrt(4 * 0.64**2 - 4 * 0.64 + 2))
    assert found["Kp"] == pytest.approx(natural**2 * known["T"] / known["K"])
    assert found["Kd"] == pytest.approx((1.6 * natural * known["T"] - 1.0) / known["K"])
    low, high = found["promise"]["overshoot"]["likely"]
    assert 0.0 <= low <= high < 1.0
