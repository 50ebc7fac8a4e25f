"""A ship with two screws and a rudder behind each: which of the four is at fault, and how.

Her rudders tell themselves apart by the races they stand in: exchanged, one stuck; a screw a fifth
weak. Her truth is a programme of its own (`three_ships.py`); the
seeds of the studies were never looked at while building.
"""

import dataclasses

import pytest
import three_ships as truth
from three_models import CARGO

from trialid.diagnosis.diagnose import DiagnoseSettings, diagnose
from trialid.diagnosis.verdict import Verdict
from trialid.effects import CATALOGUE
from trialid.effects.actuators import actuator_effects

EFFECTS = {**CATALOGUE, **actuator_effects(CARGO.ship)}
SIDES = ("port", "stbd")


def acting(fault: str, side: str) -> truth.Push:
    """What the actuators do of what the log shows."""

    def push(now: truth.Row, u: float, v: float, r: float) -> tuple[float, float, float]:
        done = dict(now)
        if fault == "exchanged":
            done |= {"rudder_port": now["rudder_stbd"], "rudder_stbd": now["rudder_port"]}
        elif fault == "weak":
            done[f"screw_{side}"] *= 0.8**0.5
        elif fault == "stuck":
            done[f"rudder_{side}"] = 0.1 if side == "port" else -0.07
        return truth.twin_screws(done, u, v, r)

    return push


def verdict(seed: int, fault: str) -> Verdict:
    case = dataclasses.replace(CARGO, push=acting(fault, SIDES[seed % 2]))
    return diagnose(case.fitted(seed), DiagnoseSettings(candidates=EFFECTS)).verdict


def wanted(seed: int, fault: str) -> str | None:
    side = SIDES[seed % 2]
    return {
        "": None,
        "weak": f"screw_{side}_weak",
        "stuck": f"rudder_{side}_stuck",
        "exchanged": "rudder_port_rudder_stbd_exchanged",
    }[fault]


@pytest.mark.study
def test_rudders_exchanged_are_named_where_their_races_differ() -> None:
    found = verdict(2203, "exchanged")
    assert found.effect == wanted(2203, "exchanged")
    assert len(found.family) == 1


@pytest.mark.parametrize(
    ("faults", "seeds"),
    [
        pytest.param(("", "exchanged"), range(2240, 2250), marks=pytest.mark.study(turn=1)),
        pytest.param(("weak", "stuck"), range(2220, 2230), marks=pytest.mark.study(turn=3)),
    ],
)
def test_faults_are_named_on_their_side_and_no_other(faults, seeds) -> None:
    """Ten records of each; a wrong name in at most 2 of 100, a right one in 95."""
    right, wrong = 0, []
    for seed in seeds:
        for fault in faults:
            found = verdict(seed, fault)
            if found.effect == wanted(seed, fault):
                right += 1
            elif found.effect is not None:
                wrong.append(f"{seed} {fault or 'nothing'}: {found.sentence}")
            else:
                print(seed, fault, found.sentence)
    print(right, wrong)
    assert right >= 0.95 * len(seeds) * len(faults)
    assert len(wrong) <= 0.02 * len(seeds) * len(faults)
