"""The reference ship, ready to be sailed and rated."""

import numpy as np
from s175q import GYRO, INCLINOMETER, MODEL, OUTPUTS, SHAFT, TEN

from trialid.design.helm import vessel
from trialid.design.rating import Noise, goal
from trialid.design.search import Ship, natural_roll
from trialid.identification.problem import Settings

D = np.deg2rad(1.0)
SPEED = 7.33
VESSEL = vessel(MODEL, 0.5, {"n": SHAFT}, 5.0 * D)
NOISE = {"r": Noise(GYRO), "phi": Noise(INCLINOMETER)}
GOAL = goal(MODEL, Settings(TEN, OUTPUTS, nuisance=("initial_state",)), NOISE)
ROLL = natural_roll(VESSEL)
SHIP = Ship(VESSEL, GOAL, ROLL, SPEED)
