"""The four logs of the sample, read as the shipped pipeline says: one motion in four writings."""

import tomllib
from pathlib import Path
from typing import Final

import numpy as np
import pytest

from trialid import ingest
from trialid.names import units
from trialid.names.quantities import SIGNALS
from trialid.sample.rudder_orders import APPROACH, clock, zigzag
from trialid.sample.sample_sensors import START, WRITERS, Sensor, _sample

PIPELINE = Path(__file__).parents[2] / "pipelines" / "hidden_effect.toml"
TRIALS: Final = {t["name"]: t for t in tomllib.loads(PIPELINE.read_text("utf-8"))["trial"]}
T = START + (np.arange(50) * 1e8).astype(np.int64)
LOGGED = {
    name: (T, np.linspace(first, last, 50))
    for name, first, last in (
        *(("delta", -0.1, 0.2), ("r", 0.001, 0.008)),
        *(("phi", -0.05, 0.03), ("u", 7.3, 6.5)),
    )
}


@pytest.mark.parametrize("name", WRITERS)
def test_what_is_logged_is_read_in_si_and_to_starboard(name: str, tmp_path: Path) -> None:
    file, write = WRITERS[name]
    write(tmp_path / file, LOGGED)
    channels = ingest.read(tmp_path / file).channels
    assert {*TRIALS[name]["signals"]} == {*LOGGED}
    for signal, asked in TRIALS[name]["signals"].items():
        if "as" in asked:  # a quaternion's roll: tests/alignment/test_frames.py
            continue
        factor = units.factor(asked["unit"], SIGNALS[signal].unit)
        side = -1.0 if asked.get("positive") == "port" else 1.0
        found = side * factor * np.asarray(channels[asked["channel"]].y)
        np.testing.assert_allclose(found, LOGGED[signal][1], atol=1e-4, err_msg=signal)


def test_a_sensor_that_is_late_logs_what_was() -> None:
    """By hand: of a motion that grows by one a second, late by 0.7 s, it logs t - 0.7."""
    stamps, values = _sample(clock(), Sensor(4.0, 0.0, late=0.7), np.random.default_rng(0))
    t = (stamps - START) / 1e9
    np.testing.assert_allclose(values[t > 1.0], t[t > 1.0] - 0.7, atol=1e-6)


@pytest.mark.study(turn="each")
def test_a_zigzag_reverses_where_the_heading_is_on_the_side_of_the_rudder() -> None:
    """A ship that turns with her rudder, a tenth of it each second."""
    delta = zigzag(10.0, 10.0, lambda rudder: np.cumsum(rudder) * 0.1 * 0.1)
    psi = np.cumsum(delta) * 0.01
    over = np.flatnonzero(np.diff(np.sign(delta[clock() > APPROACH + 20.0])))
    assert len(over) > 10
    assert 8.0 < np.rad2deg(psi).max() < 20.0
    assert -20.0 < np.rad2deg(psi).min() < -8.0
