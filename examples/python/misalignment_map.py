"""Map of rating life and friction power over misalignment and thrust, from a sweep. Usage: misalignment_map.py [DIRECTORY]"""

import sys
from pathlib import Path

import numpy as np
import roulement
from matplotlib.figure import Figure
from roulement import sweep

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "build/python")
folder.mkdir(parents=True, exist_ok=True)
tilts, loads = np.linspace(0, 2, 5), np.linspace(500, 2000, 4)  # [mrad], [N]
scene = roulement.Scene.load("scenes/thrust.toml").with_({"rating": {"reliability": 0.9}, "load.duration": "4 ms"})
cases = [{"outer.misalignment.rz": f"{tilt} mrad", "load.x.force": load} for load in loads for tilt in tilts]
table = sweep.run(cases, scene, folder / "misalignment", progress=True)

figure = Figure(figsize=(10, 4), layout="constrained")
columns = [("life.L10r.end", "rating life L10 [1e6 revolutions]"), ("friction_power.mean", "friction power [W]")]
for axes, (name, title) in zip(figure.subplots(1, 2), columns):
    values = table[name].reshape(len(loads), len(tilts))
    drawn = axes.contourf(tilts, loads, values, 12)
    figure.colorbar(drawn, ax=axes)
    axes.set(xlabel="misalignment [mrad]", ylabel="thrust [N]", title=title)
    print(f"{title}: {values.min():.4g} to {values.max():.4g}")
figure.savefig(folder / "misalignment_map.svg")
