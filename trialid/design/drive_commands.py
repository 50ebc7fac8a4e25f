"""What a boat's drives are told, by the clock."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from trialid.arrays import Vector


@dataclass(frozen=True)
class Drive:
    """Command actuators instead of the rudder, one value a sample of the trial's clock.

    Attributes
    ----------
    commands
        By the actuator's name, SI; (n,) each.
    before
        What each holds in the approach.
    """

    commands: Mapping[str, Vector]
    before: Mapping[str, float]

    def courses(self, at: int, samples: int) -> dict[str, Vector]:
        """What is ordered of each over a whole test that begins at sample `at`; (samples,) each.

        What is commanded last is held to the end.
        """
        found = {}
        for name, values in self.commands.items():
            order = np.full(samples, values[-1])
            order[:at] = self.before[name]
            part = values[: samples - at]
            order[at : at + len(part)] = part
            found[name] = order
        return found
