"""Friction map of a rolling contact: force over creepage and spin by three creep laws. Usage: friction_map.py [DIRECTORY]"""

import sys
from pathlib import Path

import numpy as np
import roulement
from matplotlib.figure import Figure

folder = Path(sys.argv[1] if len(sys.argv) > 1 else "build/python")
folder.mkdir(parents=True, exist_ok=True)
creep, spin = np.meshgrid(np.linspace(0, 4e-3, 41), np.linspace(0, 20, 21))  # [-], [1/m]
contact = {"peak_pressure": 1.5e9, "semi_axis_x": 0.12e-3, "semi_axis_y": 0.9e-3, "friction": 0.08}
figure = Figure(figsize=(12, 3.6), layout="constrained")
for axes, law in zip(figure.subplots(1, 3), ["saturated", "regularised", "kalker_table"]):
    forces = roulement.contact(law, creep_x=creep, spin=spin, **contact)
    size = np.hypot(forces["fx"], forces["fy"])
    drawn = axes.contourf(creep, spin, size, np.linspace(0, 1, 11))
    axes.set(title=law, xlabel="longitudinal creepage [-]", ylabel="spin [1/m]")
    print(f"{law}: at most {size.max():.3f} of the friction limit, {size[-1, 10]:.3f} at creepage 1e-3 and spin 20 1/m")
figure.colorbar(drawn, ax=axes, label="creep force over mu N [-]")
figure.savefig(folder / "friction_map.svg")
