"""Where a model explains too little and a drive is recorded that it does not read, that is said."""

from types import SimpleNamespace

import numpy as np
import pytest

from trialid.identification.adequacy import drives_unread
from trialid.ship.actuators import Actuator

BOW = Actuator(name="bow_thruster", kind="tunnel", x=6.0, y=0.0, command="share")
STERN = Actuator(name="stern", kind="tunnel", x=-6.0, y=0.0, command="share")
STILL, still = ("stern",), np.zeros(2)
RUDDER = Actuator(name="rudder_port", kind="rudder", x=-6.0, y=-1.0)


def made(recorded: tuple[str, ...], read: tuple[str, ...], *actuators: Actuator):
    """A fit as far as it tells what is recorded, read and aboard."""
    signals = {name: still if name in STILL else np.array([0.0, 1.0]) for name in recorded}
    trial = SimpleNamespace(use="fit", signals=signals)
    return SimpleNamespace(
        scores=(SimpleNamespace(trial=trial),),
        model=SimpleNamespace(ship=SimpleNamespace(actuators=actuators)),
        problem=SimpleNamespace(
            simulator=SimpleNamespace(equations=SimpleNamespace(inputs=read)),
        ),
    )


@pytest.mark.parametrize("name", ["bow_thruster", "bow_thruster_order"])
def test_what_is_recorded_and_unread_is_added_first(name):
    """Of an outsider's with a bow thruster 76 % were left, with `check the ship's file`."""
    said = drives_unread(made(("r", "delta", name), ("delta", "u"), RUDDER, BOW))
    assert "`trialid add PIPELINE tunnels`" in said
    assert "bow_thruster" in said


def test_what_is_read_or_not_recorded_is_not_said():
    assert not drives_unread(made(("r", "bow_thruster"), ("bow_thruster",), BOW))
    assert not drives_unread(made(("r", "delta"), ("delta",), RUDDER, BOW))
    assert not drives_unread(made(("r", "delta", "stern"), ("delta",), RUDDER, STERN))
    assert not drives_unread(made(("r", "rudder_port"), (), RUDDER))
