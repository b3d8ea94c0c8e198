"""The gearbox of docs/gearbox.md in three masters: two bearings and a shaft in FMPy (gearbox.py), as SSP file in Ecos, as OSP system
structure in libcosim. Prints what the bearings carry, beside statics by hand.

Usage: masters.py DIRECTORY [MASTER ...]    (fmpy ecos libcosim if none is named)
Leaves there: Shaft.fmu, gearbox.ssp, gearbox-osp, and forces over time, MASTER.csv. Needs the program `roulement` (on the path, or ROULEMENT_BIN), the
Python package, FMPy, and pythonfmu, ecospy with tbb, libcosimpy for the masters.
"""

import ctypes
import multiprocessing
import os
import shutil
import subprocess
import sys
import time as clock
import tomllib
from pathlib import Path

import gearbox
import numpy as np

HERE = Path(__file__).resolve().parent
SYSTEM = tomllib.loads((HERE / "system.toml").read_text())
STEP, STOP = float(SYSTEM["step"].removesuffix(" us")) * 1e-6, float(SYSTEM["stop"].removesuffix(" ms")) * 1e-3  # [s]
STEPS = round(STOP / STEP)
START = 0.01  # of the means [s]: the torque is on, and 23 periods of the mesh are left
SIDES = {"left": [1, 1, 1], "right": [-1, -1, 1]}  # signs from the axes of a bearing to those of the shaft
FORCES = [(side, f"inner.force.{axis}") for side in SIDES for axis in "xyz"]


def make(folder):
    """Builds the shaft, and writes the system for both masters."""
    from pythonfmu import FmuBuilder

    for name in ("system.toml", "bearing.toml"):
        shutil.copy(HERE / name, folder)
    FmuBuilder.build_FMU(str(HERE / "shaft.py"), dest=str(folder))
    program = os.environ.get("ROULEMENT_BIN", "roulement")
    subprocess.run([program, "system", folder / "system.toml", "-o", folder], check=True)


def fmpy(folder):
    """The shaft in Python, by leapfrog: a bearing is told the end of a step at its start."""
    found = gearbox.run(folder, STEP * STEPS)
    # In the axes of the shaft already.
    return np.column_stack([found["time"], *(found[side, "force"] for side in SIDES)])


def ecos(folder):
    """The SSP file in Ecos. It sets the start values of a file only if their parameter set is named."""
    # oneTBB of the wheel; else that of the system.
    library = Path(sys.prefix) / "lib" / "libtbb.so.12"
    ctypes.CDLL(str(library) if library.exists() else "libtbb.so.12", mode=ctypes.RTLD_GLOBAL)
    from ecospy import EcosSimulation

    rows = []
    with EcosSimulation(ssp_path=str(folder / "gearbox.ssp"), step_size=STEP) as simulation:
        simulation.init(parameter_set="start")
        for step in range(1, STEPS + 1):
            simulation.step()
            rows.append([step * STEP, *(simulation.get_real(f"{side}::{name}") for side, name in FORCES)])
        simulation.terminate()
    return turned(rows)


def libcosim(folder):
    """The OSP system structure in libcosim."""
    from fmpy import read_model_description
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver

    log_output_level(CosimLogLevel.WARNING)
    of = {side: {v.name: v.valueReference for v in read_model_description(str(folder / "gearbox-osp" / f"{side}.fmu")).modelVariables} for side in SIDES}
    execution, observer = CosimExecution.from_osp_config_file(str(folder / "gearbox-osp")), CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    index = {side: execution.slave_index_from_instance_name(side) for side in SIDES}
    rows = []
    for step in range(1, STEPS + 1):
        assert execution.step()
        rows.append([step * STEP, *(observer.last_real_values(index[side], [of[side][name]])[0] for side, name in FORCES)])
    return turned(rows)


def turned(rows):
    """Times and forces in the axes of the shaft."""
    return np.array(rows) * [1, *SIDES["left"], *SIDES["right"]]


def of_means(rows):
    """Rows from START on."""
    return rows[rows[:, 0] > START + STEP / 2]


def means(rows):
    """What the shaft does to both bearings, mean from START on [N]: opposite to their forces on it; x, y, z of left and right."""
    return -of_means(rows)[:, 1:].mean(axis=0).reshape(2, 3)


def table(found):
    """Prints forces of all masters (swings are standard deviations), and returns the largest difference of a radial force to that by hand, over it."""
    hand = np.array([np.linalg.norm(radial) for radial in gearbox.by_hand().values()])
    axial = gearbox.mesh(gearbox.TORQUE)[0]
    print("| master | radial, left [N] | radial, right [N] | axial, left [N] | axial, right [N] | sum of both [N] | axial, left, swings by [N] |")
    print("|---|---:|---:|---:|---:|---:|---:|")
    print(f"| by hand | {hand[0]:.1f} | {hand[1]:.1f} | | | {axial:.1f} | |")
    worst = 0.0
    for master, rows in found.items():
        left, right = mean = means(rows)
        radial, swing = np.linalg.norm(mean[:, 1:], axis=1), of_means(rows)[:, 1].std()
        print(f"| {master} | {radial[0]:.1f} | {radial[1]:.1f} | {left[0]:.1f} | {right[0]:.1f} | {left[0] + right[0]:.1f} | {swing:.0f} |")
        worst = max(worst, *abs(radial / hand - 1))
    print(f"largest difference of a radial force from that by hand: {worst * 100:.2f} %")
    masters = list(found)
    for k, one in enumerate(masters):
        for other in masters[:k]:
            apart = np.abs(means(found[one]) - means(found[other])).max()
            print(f"{other} and {one}: means differ by {apart:.2g} N at most", end="")
            same = found[one].shape == found[other].shape
            print(f", single rows by {np.abs(found[one] - found[other])[:, 1:].max():.2g} N" if same else "")
    return worst


def save(master, folder):
    """Runs a master and leaves its forces over time."""
    began = clock.process_time()
    np.savetxt(folder / f"{master}.csv", globals()[master](folder), delimiter=",", fmt="%.17g")
    print(f"{master}: {clock.process_time() - began:.1f} s of CPU time", flush=True)


def main(folder, masters):
    """Runs masters and prints their table; returns what `table` does."""
    folder.mkdir(parents=True, exist_ok=True)
    make(folder)
    for master in masters:
        # Each in a process of its own: their libraries stay in whoever loads them.
        process = multiprocessing.get_context("spawn").Process(target=save, args=(master, folder))
        process.start()
        process.join()
        if process.exitcode:
            sys.exit(f"{master} failed with exit code {process.exitcode}")
    return table({master: np.loadtxt(folder / f"{master}.csv", delimiter=",") for master in masters})


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), sys.argv[2:] or ["fmpy", "ecos", "libcosim"])
