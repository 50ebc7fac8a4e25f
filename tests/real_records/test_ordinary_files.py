"""Logs of people who see the program for the first time: read as they are, without a template."""

import pytest
from real_record import DATA

from trialid.ingest import read
from trialid.inspection import inspect_log

NEWCOMER, BASIN = DATA / "newcomer", DATA / "esso_osaka"
pytestmark = [
    pytest.mark.real_data,
    pytest.mark.skipif(not NEWCOMER.is_dir(), reason=f"no logs in {NEWCOMER}"),
]

COASTER = {"delta": "Ruderlage", "r": "Wendegeschwindigkeit", "psi": "Kurs", "phi": "Krängung"}
FERRY = {"delta": "rudder_port_deg", "r": "rot_deg_min", "psi": "heading_deg", "phi": "roll_deg"}
MODEL = {
    "delta": "delta_rudder", "r": "r_angvelo", "psi": "psi_hat", "u": "u_velo", "v": "vm_velo",
    "n": "n_prop",
}  # fmt: skip
BOAT = {"r": "/imu/data:angular_velocity.z", "psi": "/imu/data:orientation"}
KNOWN = {
    **{f"newcomer/twin{k}.csv": FERRY for k in (10, 15, 20)},
    **{f"newcomer/z{k}.{kind}": COASTER for k in (10, 15, 20) for kind in ("csv", "xlsx")},
    **{f"newcomer/usv{k}.mcap": BOAT for k in (1, 2)},
    **{f"esso_osaka/{path.name}": MODEL for path in sorted(BASIN.glob("*.csv"))},
}


@pytest.mark.parametrize("name", KNOWN)
def test_what_is_recognised_without_a_template(name):
    found = inspect_log(DATA / name)
    known = {q: [one.name for one in found.sources(q)] for q in KNOWN[name]}
    print(f"\n{name}: {found.duration:.1f} s, " + ", ".join(f"{q} {c}" for q, c in known.items()))
    assert {q: c[0] for q, c in known.items()} == KNOWN[name]
    assert found.duration > 100.0


def test_every_file_there_is_in_the_list():
    there = {f"{place.name}/{file.name}" for place in (NEWCOMER, BASIN) for file in place.iterdir()}
    assert there == set(KNOWN)


def test_the_same_trial_as_text_and_as_a_sheet_is_the_same():
    for k in (10, 15, 20):
        text, sheet = (read(NEWCOMER / f"z{k}.{kind}") for kind in ("csv", "xlsx"))
        assert list(text.channels) == list(sheet.channels)
        for one, other in zip(text.channels.values(), sheet.channels.values(), strict=True):
            assert one.y.tolist() == other.y.tolist()
            assert one.t.tolist() == other.t.tolist()
            assert one.unit == other.unit


def test_both_rudders_of_the_ferry_are_offered():
    found = inspect_log(NEWCOMER / "twin10.csv")
    names = {one.name for one in found.sources("delta")}
    assert names == {"rudder_port_deg", "rudder_stbd_deg"}


def test_the_rows_of_commas_below_a_trial_are_no_part_of_it():
    recording = read(BASIN / "zigzag_31-Jul-2020_13_50_28.csv")
    assert recording.channels["u_velo"].t.size == 1701
    assert recording.remarks == ("327 rows without any value, left out",)
