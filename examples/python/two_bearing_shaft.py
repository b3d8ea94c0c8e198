"""A shaft on two bearings, FMI packages in FMPy, moved by leapfrog. Usage: two_bearing_shaft.py [DIRECTORY]"""

import sys
from pathlib import Path

import numpy as np
import roulement
from fmpy import extract, instantiate_fmu, read_model_description
from roulement.coupling import FmuBearing, Leapfrog, rigid

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
path = str(roulement.package(roulement.Scene.load("examples/coupling/bearing.toml"), folder / "bearing.fmu"))
description, unpacked = read_model_description(path), extract(path)
HALF = 0.05  # half the distance of the bearings [m]; both carry the thrust of the scene, against each other


class Pair:
    """Two bearings as one about the middle of the shaft; the second is turned by 180 degrees about z."""

    def __init__(self):
        self.parts = []
        for side in (1, -1):
            slave = instantiate_fmu(unpacked, description, "CoSimulation")
            slave.setupExperiment(), slave.enterInitializationMode(), slave.exitInitializationMode()
            bearing = FmuBearing(slave, {v.name: v.valueReference for v in description.modelVariables})
            seen = np.diag([side, side, 1.0, side, 1.0])  # by the bearing: x, y, z, about y, about z of its race
            seen[1, 4], seen[2, 3] = HALF, -HALF * side
            self.parts.append((bearing, bearing.place(), seen))

    place = lambda self: np.zeros(5)
    wrench = lambda self: sum(seen.T @ bearing.wrench() for bearing, _, seen in self.parts)

    def step(self, step, place, velocity):
        return sum(seen.T @ bearing.step(step, at + seen @ place, seen @ velocity) for bearing, at, seen in self.parts)


shaft = Leapfrog(Pair(), rigid(2.0, 2e-3), lambda time: [0, 200.0, 0, 0, 2.0])
places = np.array([shaft.step(2e-5) or shaft.place for _ in range(250)])
print(f"under 200 N and 2 N m: y {places[:, 1].mean() * 1e6:.3f} um, tilt {places[:, 4].mean() * 1e6:.1f} urad in the mean")
