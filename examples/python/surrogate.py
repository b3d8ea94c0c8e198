"""Surrogate of the bearing's force for a real-time model: a smooth function of the displacement, fitted to equilibria."""

import time

import numpy as np
import roulement
from scipy.interpolate import RBFInterpolator
from scipy.stats import qmc

held = [f"load.{axis}.displacement" for axis in "xyz"]
scene = roulement.Scene.load("scenes/thrust.toml").with_({"load.x.force": None, **dict.fromkeys(held, 0.0)})
LOW, HIGH = np.array([5e-6, -3e-6, -3e-6]), np.array([20e-6, 3e-6, 3e-6])  # displacement x, y, z of the inner race [m]


def force(displacement):
    """External force that holds the race there [N]."""
    return roulement.equilibrium(scene.with_(dict(zip(held, displacement)))).load[:3]


places = qmc.scale(qmc.Sobol(3, rng=1).random(256), LOW, HIGH)
begin = time.perf_counter()
forces = np.array([force(place) for place in places])
solve = (time.perf_counter() - begin) / len(places)
fit = RBFInterpolator((places - LOW) / (HIGH - LOW), forces, kernel="cubic")

others = qmc.scale(qmc.LatinHypercube(3, rng=2).random(64), LOW, HIGH)
exact = np.array([force(place) for place in others])
begin = time.perf_counter()
found = fit((others - LOW) / (HIGH - LOW))
evaluate = (time.perf_counter() - begin) / len(others)
error = np.abs(found - exact).max() / np.abs(exact).max()
print(f"equilibrium {solve * 1e3:.2f} ms, surrogate {evaluate * 1e6:.1f} us, largest error {error:.2e} of the largest force")
