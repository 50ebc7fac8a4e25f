"""Two pods: their angles are read, which were passed over for two thrusters that never turn."""

from pathlib import Path

import numpy as np
import pytest
from made_boat import T, begun, table

from trialid import pipeline_file
from trialid.errors import LogError
from trialid.inspection import inspect_log
from trialid.ship.estimate import Given
from trialid.workflow.first_pipeline import starter
from trialid.workflow.run import run


def turned(seed: int) -> np.ndarray:
    """Angles of both pods alike [rad], clockwise from ahead, held for 10 s each."""
    steps = np.random.default_rng(seed).uniform(-0.5, 0.5, len(T) // 100)
    return np.repeat(steps, 100)


SIDES = ("Azimuth port rpm", "Azimuth stbd rpm")
ENDS = ("pod_aft_rpm", "pod_fwd_rpm")
AT_ENDS = ("pod_aft_angle_deg", "pod_fwd_angle_deg")
AFT_BOTH = ("aft_azimuth_1_angle_deg", "aft_azimuth_2_angle_deg")


def pods(
    path: Path,
    names: tuple[str, ...],
    seed: int = 3,
    sign: float = 1.0,
    *,
    turns: tuple[str, ...] = SIDES,
    less: float = 0.0,
) -> Path:
    """A log of a ship of 20 m that pods turn: to port where they push to starboard.

    The second is turned and driven `less` than the first, as a share: by 2 at the other end.
    """
    a = turned(seed)
    u, r, psi = (np.zeros(len(T)) for _ in range(3))
    u[0] = 4.0
    for k in range(len(T) - 1):
        u[k + 1] = u[k] + 0.1 * (0.8 * np.cos(a[k]) - 0.05 * u[k] * abs(u[k]))
        r[k + 1] = r[k] + 0.1 * (-0.05 * np.sin(a[k]) - 0.4 * r[k])
        psi[k + 1] = psi[k] + 0.1 * r[k]
    rng = np.random.default_rng(seed)
    rpm = 120.0 + rng.standard_normal(len(T))
    columns = {name: abs(1.0 - less * k) * rpm for k, name in enumerate(turns)}
    columns |= {n: sign * (1.0 - less * k) * np.rad2deg(a) for k, n in enumerate(names)}
    columns["yaw_rate_dps"] = np.rad2deg(r) + 0.02 * rng.standard_normal(len(T))
    columns["stw_mps"] = u + 0.01 * rng.standard_normal(len(T))
    return table(path, columns)


NAMES = ("Azimuth port angle [deg]", "Azimuth stbd angle [deg]")


@pytest.mark.study(turn="each")
def test_pods_are_begun_with_their_angles(tmp_path: Path) -> None:
    logs = [pods(tmp_path / f"run{i}.csv", NAMES, i) for i in range(3)]
    made = begun(tmp_path, *logs)
    text, ship = made.files[tmp_path / "p.toml"], made.files[tmp_path / "p_ship.toml"]
    assert 'thruster_port_angle      = { channel = "Azimuth port angle", unit = "deg" }' in text
    assert 'effects = ["azimuths", ' in text
    assert '"k_pod_ahead"' in text
    assert ship.count('kind = "azimuth"') == 2
    done = run(pipeline_file.load(tmp_path / "p.toml"))
    assert done.result.fit.eps_rmsn_by_output["r"] < 0.05


def test_an_angle_that_counts_to_port_is_read_so(tmp_path: Path) -> None:
    text = begun(tmp_path, pods(tmp_path / "a.csv", NAMES, sign=-1.0)).files[tmp_path / "p.toml"]
    assert text.count('unit = "deg", positive = "port"') == 2


@pytest.mark.parametrize("turned_round", [(), (2,), (0, 1, 2)])
def test_an_angle_of_another_side_than_in_the_other_logs_is_told(
    tmp_path: Path, turned_round: tuple[int, ...]
) -> None:
    """Of a ferry whose pods stood fore and aft both sides were written, and no word said.

    The rate of turn is not confirmed by a heading here: so the user is asked.
    """
    logs = [
        pods(tmp_path / f"run{i}.csv", NAMES, i, -1.0 if i in turned_round else 1.0)
        for i in range(3)
    ]
    text = begun(tmp_path, *logs).files[tmp_path / "p.toml"]
    said = "by the motion port, and of the same name clockwise in run0.csv"
    assert text.count(said) == (2 if turned_round == (2,) else 0)
    assert ("FILL IN starboard or port" in text) == (turned_round == (2,))


@pytest.mark.study(turn="each")
def test_a_ferry_with_a_pod_at_either_end_is_begun(tmp_path: Path) -> None:
    """An outsider's had to be mapped by hand; the one that stands ahead turns her the other way."""
    logs = [pods(tmp_path / f"run{i}.csv", AT_ENDS, i, turns=ENDS, less=2.0) for i in range(3)]
    made = begun(tmp_path, *logs)
    text, ship = made.files[tmp_path / "p.toml"], made.files[tmp_path / "p_ship.toml"]
    assert 'thruster_fore_angle = { channel = "pod_fwd_angle_deg", unit = "deg" }' in text
    assert 'thruster_aft        = { channel = "pod_aft_rpm", unit = "rpm" }' in text
    assert "positive" not in text.split("[align]")[0]
    assert [line for line in ship.splitlines() if line.startswith("at = ")] == [
        "at = [-0.8, 0.0]  # m ahead, m to starboard",
        "at = [0.8, 0.0]  # m ahead, m to starboard",
    ]
    done = run(pipeline_file.load(tmp_path / "p.toml"))
    assert done.result.fit.eps_rmsn_by_output["r"] < 0.05


def test_her_own_file_says_which_of_two_at_the_ends_is_which(tmp_path: Path) -> None:
    log = pods(tmp_path / "a.csv", AT_ENDS, turns=ENDS, less=2.0)
    begun(tmp_path, log)
    text = (tmp_path / "p_ship.toml").read_text("utf-8")
    own = tmp_path / "own.toml"
    own.write_text(text.replace("thruster_aft", "rear").replace("thruster_fore", "front"), "utf-8")
    made = starter([inspect_log(log)], tmp_path / "q.toml", own, Given(length=2.0))
    assert 'front_angle = { channel = "pod_fwd_angle_deg"' in made.files[tmp_path / "q.toml"]
    own.write_text(text.replace("at = [0.8, 0.0]", "at = [-0.7, 0.0]"), "utf-8")
    with pytest.raises(LogError, match="names 2 aft and 0 ahead; write an"):
        starter([inspect_log(log)], tmp_path / "q.toml", own, Given(length=2.0))


def test_ends_that_may_be_exchanged_are_told(tmp_path: Path) -> None:
    log = pods(tmp_path / "a.csv", AT_ENDS[::-1], turns=ENDS[::-1], less=2.0)
    text = begun(tmp_path, log).files[tmp_path / "p.toml"]
    assert text.count('unit = "deg", positive = "port"') == 2
    assert text.count("CAREFUL: or fore and aft are exchanged") == 2


@pytest.mark.parametrize(
    ("turns", "angles"),
    [
        (ENDS, AT_ENDS[:1]),
        (("pod_aft_port_rpm", "pod_fwd_stbd_rpm"), AT_ENDS),
        (ENDS, ("pod_aft_wind_angle_deg", "pod_fwd_wind_angle_deg")),
        (("rear_motor_1_rpm", "rear_motor_2_rpm"), ()),
        (("aft_azimuth_1_rpm", "aft_azimuth_2_rpm"), AFT_BOTH),
    ],
)
def test_ends_without_an_angle_each_are_no_pods(
    tmp_path: Path, turns: tuple[str, ...], angles: tuple[str, ...]
) -> None:
    log = pods(tmp_path / "a.csv", angles, turns=turns, less=0.4)
    try:
        text = begun(tmp_path, log).files[tmp_path / "p.toml"]
    except LogError as unread:
        text = str(unread)
    assert "thruster_fore" not in text
    assert ("thruster_port_angle" in text) is (angles == AFT_BOTH)


@pytest.mark.parametrize(
    "turns", [("azimuth_1_rpm", "azimuth_2_rpm"), ("aft_azimuth_1_rpm", "aft_azimuth_2_rpm")]
)
def test_pods_of_a_number_keep_their_angles_where_a_name_says_an_end(
    tmp_path: Path, turns: tuple[str, ...]
) -> None:
    text = begun(tmp_path, pods(tmp_path / "a.csv", AFT_BOTH, turns=turns)).files[
        tmp_path / "p.toml"
    ]
    assert 'thruster_port_angle      = { channel = "aft_azimuth_1_angle_deg"' in text


def test_angles_that_are_called_so_are_no_rudders(tmp_path: Path) -> None:
    """`azimuth angle` alone is what steers a boat; with one to each side she has two pods."""
    names = ("azimuth_angle_port [deg]", "azimuth_angle_stbd [deg]")
    text = begun(tmp_path, pods(tmp_path / "a.csv", names)).files[tmp_path / "p.toml"]
    assert 'effects = ["azimuths", ' in text
    assert "rudder" not in text.split("[model]")[0]


def test_one_angle_alone_turns_no_pods(tmp_path: Path) -> None:
    text = begun(tmp_path, pods(tmp_path / "a.csv", NAMES[:1])).files[tmp_path / "p.toml"]
    assert 'effects = ["thrusters", ' in text
    assert "_angle" not in text


NUMBERED = ("azimuththruster_speed_rpm_1", "azimuththruster_speed_rpm_2")
OF_NUMBER = ("azimuththruster_angle_deg_1", "azimuththruster_angle_deg_2")


def test_two_that_always_do_the_same_are_placed_by_their_numbers(tmp_path: Path) -> None:
    log = pods(tmp_path / "a.csv", OF_NUMBER, turns=NUMBERED)
    made = begun(tmp_path, log)
    text, ship = made.files[tmp_path / "p.toml"], made.files[tmp_path / "p_ship.toml"]
    assert not made.to_fill
    assert 'thruster_port            = { channel = "azimuththruster_speed_rpm_1"' in text
    assert 'thruster_port_angle      = { channel = "azimuththruster_angle_deg_1"' in text
    assert text.count("CAREFUL: which is to port does not show") == 2
    assert ship.count('command = "revolutions"') == 2


@pytest.mark.study(turn="each")
def test_two_that_do_not_are_asked_for_and_run_when_that_is_filled_in(tmp_path: Path) -> None:
    made = begun(tmp_path, pods(tmp_path / "a.csv", OF_NUMBER, turns=NUMBERED, less=0.2))
    assert len(made.to_fill) == 2
    for path, text in made.files.items():
        path.write_text(text.replace('unit = "?"', 'unit = "rpm"'), encoding="utf-8")
    done = run(pipeline_file.load(tmp_path / "p.toml"))
    assert done.result.fit.eps_rmsn_by_output["r"] < 0.3  # the second as logged is not as sailed
