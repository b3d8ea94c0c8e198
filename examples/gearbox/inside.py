"""The gearbox of gearbox.py with the shaft inside: `roulement run` of shaft.toml; the same table and picture from its results.

Usage: inside.py DIRECTORY [DOCUMENT]    (the program from ROULEMENT_BIN, or `roulement` on the path; the table is put into the document)
Leaves there: what `roulement run` writes, and inside.png where matplotlib is installed.
"""

import importlib.util
import os
import subprocess
import sys
from pathlib import Path

import gearbox
import numpy as np


def columns(path, names):
    """Columns of a table whose header has units behind the names."""
    header = path.open().readline().rstrip().split(",")
    at = [next(k for k, title in enumerate(header) if title.split(" [")[0] == name) for name in names]
    return np.loadtxt(path, delimiter=",", skiprows=1, usecols=at, ndmin=2)


def results(folder):
    """Columns over time as of `gearbox.run`."""
    found = {"time": columns(folder / "shaft.csv", ["time"])[:, 0]}
    # The shaft is rigid, and its middle halfway between the bearings.
    found["shaft"] = sum(columns(folder / "shaft.csv", [f"shaft.{side}.{name}" for name in ("x", "y", "z", "ry", "rz")]) for side in ("left", "right")) / 2
    for side in ("left", "right"):
        found |= {(side, key): columns(folder / side / "results.csv", names) for key, names in gearbox.WANTED.items()}
    return gearbox.in_axes_of_shaft(found)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    scene = Path(__file__).with_name("shaft.toml")
    subprocess.run([os.environ.get("ROULEMENT_BIN", "roulement"), "run", scene, "-o", folder], check=True)
    found = results(folder)
    print("\n" + gearbox.table(found))
    if len(sys.argv) > 2:
        gearbox.put(Path(sys.argv[2]), "shaft inside", gearbox.table(found))
    if importlib.util.find_spec("matplotlib"):
        gearbox.picture(found, folder / "inside.png")
