"""Gazebo's file: read back as the plugin reads it, the same forces, and the cost that it states."""

import re
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from test_bad_input import trialid_

from trialid.design.hull_terms import hull_terms, in_hull_terms
from trialid.design.prediction.seen_range import SeenRange
from trialid.effects import CATALOGUE
from trialid.identification.trial_score import of_trial
from trialid.progress import silent
from trialid.ship.model import ShipModel
from trialid.ship.motion import derivatives
from trialid.workflow.use.finished_model import FinishedModel, finished_model

ORDER = "UVWPQR"
TURNED = np.array([1.0, -1.0, -1.0, 1.0, -1.0, -1.0])
"""From axes forward, to starboard, down to Gazebo's forward, to port, up."""


@pytest.fixture(scope="module")
def model(run_folder: Path) -> FinishedModel:
    return finished_model(run_folder, silent)


@pytest.fixture(scope="module")
def text(run_folder: Path, tmp_path_factory: pytest.TempPathFactory) -> str:
    out = tmp_path_factory.mktemp("gazebo") / "ferry.sdf"
    told = trialid_("export", str(run_folder), "--as", "gazebo", "--out", str(out))
    assert told.exit_code == 0, told.stderr
    return out.read_text(encoding="utf-8")


class Plugin:
    """The plugin's own sums, from its file: gz-sim, Hydrodynamics.cc."""

    def __init__(self, text: str) -> None:
        root = ElementTree.fromstring(text)
        given = {e.tag: e.text for e in root.iter("plugin").__next__()}
        assert given["disable_coriolis"] == "true"
        self.linear, self.mass = np.zeros((6, 6)), np.zeros((6, 6))
        self.by_size, self.plain = np.zeros((6, 6, 6)), np.zeros((6, 6, 6))
        read = 0
        for i, row in enumerate("xyzkmn"):
            for j, one in enumerate(ORDER):
                read += f"{row}{one}" in given
                self.linear[i, j] = float(given.get(f"{row}{one}", 0.0))
                read += f"{row}Dot{one}" in given
                self.mass[i, j] = float(given.get(f"{row}Dot{one}", 0.0))
                for k, other in enumerate(ORDER):
                    read += f"{row}{one}abs{other}" in given
                    self.by_size[i, j, k] = float(given.get(f"{row}{one}abs{other}", 0.0))
                    self.plain[i, j, k] = float(given.get(f"{row}{one}{other}", 0.0))
        assert read == len(given) - 3  # link, water and Coriolis: nothing is written unread
        inertial = next(root.iter("inertial"))
        self.m = float(inertial.findtext("mass"))
        self.x_G, _, up, *_ = map(float, inertial.findtext("pose").split())
        self.z_G = -up
        self.I_xx = float(inertial.findtext("inertia/ixx")) + self.m * self.z_G**2
        self.I_zz = float(inertial.findtext("inertia/izz")) + self.m * self.x_G**2

    def forces(self, velocity: np.ndarray) -> np.ndarray:
        """Of the hull, in axes forward, to starboard, down; (6,)."""
        s = velocity * TURNED
        D = self.linear + self.by_size @ np.abs(s) + self.plain @ s
        return (D @ s) * TURNED

    def accelerations(self, u: float, x: np.ndarray, extra: np.ndarray) -> np.ndarray:
        """Of v, p, r with rigid body and added masses; `extra` are Y, K, N of all else."""
        v, p, r, phi = x
        forces = self.forces(np.array([u, v, 0.0, p, 0.0, r]))[[1, 3, 5]] + extra
        z = self.z_G * np.cos(phi)
        added = (self.mass * np.outer(TURNED, TURNED))[np.ix_([1, 3, 5], [1, 3, 5])]
        M = np.array(
            [
                [self.m, -self.m * z, self.m * self.x_G],
                [-self.m * z, self.I_xx, 0.0],
                [self.m * self.x_G, 0.0, self.I_zz],
            ]
        )
        turning = self.m * u * r * np.array([-1.0, z, -self.x_G])
        return np.linalg.solve(M - added, forces + turning)


def other_forces(model: ShipModel, delta: float, phi: float, u: float, v: float) -> np.ndarray:
    """Rudder, by its equation; a hull afloat rights by GM."""
    p = model.ship.particulars
    q = 0.5 * p["rho"] * p["L"] ** 2 * (u * u + v * v)
    Y, K, N = (model.value(f"{n}delta") * delta * q for n in "YKN")
    right = p["rho"] * p["g"] * p["nabla"] * model.value("GM") * phi
    return np.array([Y, K * p["L"] - right, N * p["L"]])


def test_it_states_what_it_costs(model: FinishedModel, text: str) -> None:
    """Both trials simulated by the plugin's sums and Newton's law: the error that is printed."""
    plugin, fit = Plugin(text), model.fit
    squares = np.zeros((2, 2))
    for score in fit.scores:
        values, start = of_trial(fit, score.trial)
        trial, h = score.trial, score.trial.period
        delta = trial.signals["delta"] + next(
            (x for n, x in values.items() if n.startswith("delta_0")), 0.0
        )
        speed = trial.signals["u"]
        y = np.array([start.get(s, 0.0) for s in ("v", "p", "r", "phi")])

        def rates(now: np.ndarray, d: float, u: float) -> np.ndarray:
            extra = other_forces(fit.model, d, now[3], u, now[0])
            return np.append(plugin.accelerations(u, now, extra), now[1])

        path = [y]
        for k in range(trial.samples - 1):
            d, u = delta[k : k + 2], speed[k : k + 2]
            half = 0.5 * (d[0] + d[1]), 0.5 * (u[0] + u[1])
            k1 = rates(y, d[0], u[0])
            k2 = rates(y + 0.5 * h * k1, *half)
            k3 = rates(y + 0.5 * h * k2, *half)
            k4 = rates(y + h * k3, d[1], u[1])
            y = y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4)
            path.append(y)
        states = np.array(path)
        for c, (name, column, bias) in enumerate((("r", 2, "b_r"), ("phi", 3, "b_phi"))):
            here = score.compared[:, c]
            measured = trial.signals[name][here]
            found = states[here, column] + values.get(bias, 0.0)
            squares[c] += np.sum((found - measured) ** 2), np.sum(measured**2)
    for name, (left, whole) in zip(("r", "phi"), squares, strict=True):
        [stated] = re.findall(rf"COST {name}: error on the fitted trials ([0-9.]+)%", text)
        assert 100.0 * np.sqrt(left / whole) == pytest.approx(float(stated), abs=0.02)


TERMS = ("linear_hull", "linear_rudder", "linear_roll", "yaw_drag_rar", "sway_drag_var", "heel_yaw")
SEEN = {
    "u": SeenRange(6.5, 7.5),
    "v": SeenRange(-0.6, 0.6),
    "p": SeenRange(-0.03, 0.03),
    "r": SeenRange(-0.012, 0.012),
    "phi": SeenRange(-0.2, 0.2),
}


def test_terms_that_are_there_are_found_as_they_are(model: FinishedModel) -> None:
    ship = model.fit.model.ship
    whole = ShipModel(ship, ("v", "p", "r", "phi"), tuple(CATALOGUE[n] for n in TERMS))
    found = hull_terms(whole, SEEN, {})
    p = ship.particulars
    quadratic = 0.5 * p["rho"] * p["L"] ** 5 * whole.value("Nrar")
    assert found.values["N"]["r", "r", True] == pytest.approx(quadratic, rel=0.02)
    linear = 0.5 * p["rho"] * p["L"] ** 2 * whole.value("Yv")
    assert found.values["Y"]["u", "v", True] == pytest.approx(linear, rel=0.02)
    assert max(found.left_out.values()) < 0.01
    assert found.heeled == ("heel_yaw",)
    assert found.elsewhere == ("linear_rudder",)
    reduced = in_hull_terms(whole, found)
    at = {"v": 0.4, "p": 0.01, "r": -0.008, "phi": 0.0}
    given = {"u": 7.0, "delta": 0.2}
    rates = [
        derivatives(m, at, given, {n: m.value(n) for n in m.parameters}) for m in (whole, reduced)
    ]
    for name, value in rates[0].items():
        assert rates[1][name] == pytest.approx(value, rel=0.01)


def test_what_has_no_term_is_told(model: FinishedModel) -> None:
    ship = model.fit.model.ship
    cubic = ShipModel(ship, ("v", "r"), tuple(CATALOGUE[n] for n in (*TERMS[:2], "sway_cubic_vvv")))
    found = hull_terms(cubic.with_values({"Yvvv": -1.0}), SEEN, {})
    assert 0.02 < found.left_out["sway_cubic_vvv"] < 0.5
    assert found.left_out["linear_hull"] < 0.01
