"""Natural frequencies and critical speeds of rotor.toml by ROSS: writes ross.json.

ROSS has beams, disc and gyroscopic terms of its own; the bearings are the stiffness matrices (6 x 6) that `roulement equilibrium --json` gives
at each speed, added at their nodes.

Needs `pip install ross-rotordynamics==2.3.0 "plotly<6"`. Usage: rotor_in_ross.py PROGRAM (the program `roulement`)
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import ross

HERE = Path(__file__).parent
RPM = np.pi / 30
SPEEDS = [1000, 3000, 6000, 9000, 12000, 15000]
LEFT, LENGTH, STEP = -0.02, 0.44, 0.01
DISC, BEARINGS = 0.15, {"left": (0.0, 1), "right": (0.4, -1)}
# Our displacements and rotations by the coordinates of a node of ROSS, whose z is the axis of the shaft.
AXES = [2, 0, 1, 5, 3, 4]


def equilibrium(program, rpm):
    text = (HERE / "rotor.toml").read_text().replace("9000 rpm", f"{rpm} rpm")
    with tempfile.NamedTemporaryFile("w", suffix=".toml") as file:
        file.write(text)
        file.flush()
        said = subprocess.run([program, "equilibrium", file.name, "--json"], capture_output=True, text=True, check=True)
    return json.loads(said.stdout)


def node(position):
    return round((position - LEFT) / STEP)


steel = ross.Material("steel", rho=7800, E=206e9, Poisson=0.3)
elements = [ross.ShaftElement(L=STEP, idl=0.0, odl=0.025, material=steel) for _ in range(round(LENGTH / STEP))]
disc = ross.DiskElement(n=node(DISC), m=2.0, Ip=1.2e-2, Id=6e-3)
rotor = ross.Rotor(elements, [disc])
size = 6 * (len(elements) + 1)


def whole(of):
    matrix = np.zeros((size, size))
    for element in [*rotor.shaft_elements, *rotor.disk_elements]:
        at = list(element.dof_global_index.values())
        matrix[np.ix_(at, at)] += of(element)
    return matrix


mass, beams, gyroscopic = (whole(lambda element: getattr(element, name)()) for name in "MKG")
# Without the turn about the axis.
kept = [k for k in range(size) if k % 6 != 5]


def frequencies(stiffness, speed):
    """[Hz] of all that swings, at stiffness of the bearings in axes of their own and a speed [rad/s]."""
    matrix = beams.copy()
    for name, (position, direction) in BEARINGS.items():
        turned = np.diag([direction, direction, 1] * 2)
        own = turned @ np.array(stiffness[name]) @ turned
        at = [6 * node(position) + k for k in AXES]
        matrix[np.ix_(at, at)] += own
    m, k, g = (of[np.ix_(kept, kept)] for of in (mass, matrix, gyroscopic))
    zero, one = np.zeros_like(m), np.eye(len(m))
    first = np.block([[zero, one], [-np.linalg.solve(m, k), -np.linalg.solve(m, speed * g)]])
    values = np.linalg.eigvals(first).imag
    return np.sort(values[values > 1.0]) / (2 * np.pi)


rows, program = [], sys.argv[1]
for rpm in SPEEDS:
    bearings = equilibrium(program, rpm)["bearings"]
    stiffness = {name: bearings[name]["stiffness"] for name in BEARINGS}
    rows.append({"rpm": rpm, "stiffness": stiffness, "frequencies": list(frequencies(stiffness, rpm * RPM)[:10])})
# Where a frequency is that of the turn: between rows the stiffness changes by little.
critical = []
for below, above in zip(rows, rows[1:]):
    for k in range(10):
        low, high = (row["frequencies"][k] * 60 - row["rpm"] for row in (below, above))
        if (low > 0) != (high > 0):
            share = low / (low - high)
            critical.append(below["rpm"] + share * (above["rpm"] - below["rpm"]))
versions = {"ross": ross.__version__, "numpy": np.__version__}
(HERE / "ross.json").write_text(json.dumps({"versions": versions, "rows": rows, "critical_rpm": sorted(critical)}, indent=1) + "\n")
