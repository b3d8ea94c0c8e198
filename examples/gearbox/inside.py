"""The gearbox of gearbox.py with the shaft inside: `roulement run` of shaft.toml, and the same table from its results.

Usage: inside.py DIRECTORY    (the program from ROULEMENT_BIN, or `roulement` on the path)
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np

PHASES = {"aligned": (0.02, 0.03), "tilted by 1 mrad": (0.05, 0.06), "without oil": (0.07, 0.08)}  # [s], 23 periods of the mesh each
BY_HAND = {"left": 744, "right": 591}  # [N] docs/gearbox.md, "The loads by hand"
STEP = 4e-5  # from one row to the next [s]


def columns(path, names):
    """Columns of a table whose header has units behind the names."""
    header = path.open().readline().rstrip().split(",")
    at = [next(k for k, title in enumerate(header) if title.split(" [")[0] == name) for name in names]
    return np.loadtxt(path, delimiter=",", skiprows=1, usecols=at)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    scene = Path(__file__).with_name("shaft.toml")
    subprocess.run([os.environ.get("ROULEMENT_BIN", "roulement"), "run", scene, "-o", folder], check=True)
    print("\n| phase | bearing | radial force, by hand [N] | axial force [N] | ball loads [N] | losses [W] |\n|---|---|---:|---:|---:|---:|")
    loads = [f"ball[{ball}].inner.load" for ball in range(1, 14)]
    tables = {side: columns(folder / side / "results.csv", ["time", *(f"inner.force.{axis}" for axis in "xyz"), "friction_power", *loads]) for side in BY_HAND}
    for phase, (start, end) in PHASES.items():
        for side, table in tables.items():
            rows = table[(table[:, 0] > start) & (table[:, 0] < end + STEP)]
            axial, *radial = rows[:, 1:4].mean(axis=0)
            print(f"| {phase} | {side} | {np.linalg.norm(radial):.0f}, {BY_HAND[side]} | {abs(axial):.0f} | {rows[:, 5:].min():.0f} to {rows[:, 5:].max():.0f} | {rows[:, 4].mean():.1f} |")
