"""Runs a pose-driven bearing as an FMU in FMPy while the inner race is tilted, and plots what it answers.

Usage: misalignment.py PACKAGE.fmu DIRECTORY
"""

import math
import shutil
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

STEP = 1e-4  # communication step [s]
DURATION = 0.06  # [s]
SPEED = 200 * math.pi  # 6000 rpm [rad/s]
TILT = 1e-3  # largest misalignment [rad]


def tilt(time):
    """Misalignment about z and its rate: at rest for 10 ms, up within 30 ms, held for 20 ms; smooth."""
    s = min(max((time - 0.01) / 0.03, 0.0), 1.0)
    moving = 0.0 < s < 1.0
    return TILT * s * s * (3 - 2 * s), TILT * 6 * s * (1 - s) / 0.03 if moving else 0.0


def shaft_inputs(time, x):
    """Inputs of the inner race at a time: held at x, its axis tilted about z; it spins by itself."""
    angle, rate = tilt(time)
    return {"inner.position.x": x, "inner.rotation.z": angle, "inner.rotation_rate.z": rate, "inner.speed": SPEED}


def simulate(package):
    """Steps the package and returns its outputs by name, one row per communication point."""
    description = read_model_description(package)
    references = {v.name: v.valueReference for v in description.modelVariables}
    outputs = [v.name for v in description.modelVariables if v.causality == "output" and v.type == "Real"]
    directory = tempfile.mkdtemp()
    extract(package, unzipdir=directory)
    bearing = FMU2Slave(
        guid=description.guid,
        unzipDirectory=directory,
        modelIdentifier=description.coSimulation.modelIdentifier,
        instanceName="bearing",
    )
    bearing.instantiate()
    bearing.setupExperiment(startTime=0.0)
    bearing.enterInitializationMode()
    bearing.exitInitializationMode()
    # The package starts where the bearing carries the scene's thrust: hold it there.
    (x,) = bearing.getReal([references["inner.position.x"]])
    rows = []
    for k in range(round(DURATION / STEP)):
        time = k * STEP
        inputs = shaft_inputs(time, x)
        bearing.setReal([references[name] for name in inputs], list(inputs.values()))
        bearing.doStep(time, STEP)
        rows.append([time + STEP, *bearing.getReal([references[name] for name in outputs])])
    bearing.terminate()
    bearing.freeInstance()
    shutil.rmtree(directory)
    return dict(zip(["time", *outputs], np.array(rows).T))


def plot(result, directory):
    """Draws tilt and moment, loads of all balls, and cage speed and power."""
    time = result["time"] * 1e3
    balls = sum(name.endswith(".inner.load") for name in result)
    figure, axes = plt.subplots(2, 2, figsize=(10, 6.5), sharex=True, layout="constrained")
    axes[0, 0].plot(time, [tilt(t)[0] * 1e3 for t in result["time"]], color="black")
    axes[0, 0].set_ylabel("tilt of the inner race about z [mrad]")
    axes[0, 1].plot(time, -result["inner.moment.y"], label="about y")
    axes[0, 1].plot(time, -result["inner.moment.z"], label="about z")
    axes[0, 1].set_ylabel("moment to hold the race [N m]")
    axes[0, 1].legend()
    for j in range(1, balls + 1):
        axes[1, 0].plot(time, result[f"ball[{j}].inner.load"], lw=1, color=plt.cm.viridis(j / balls))
    axes[1, 0].set_ylabel("load of each ball on the inner race [N]")
    power, cage = axes[1, 1], axes[1, 1].twinx()
    power.plot(time, result["friction_power"], color="tab:red")
    power.set_ylabel("friction power [W]", color="tab:red")
    cage.plot(time, result["cage.speed"], color="tab:blue")
    cage.set_ylabel("cage speed [rad/s]", color="tab:blue")
    for axis in axes[1]:
        axis.set_xlabel("time [ms]")
    for axis in axes.flat:
        axis.grid(alpha=0.3)
    figure.suptitle("Scripted misalignment of a ball bearing: FMU run in FMPy (1500 N, 6000 rpm)")
    for ending in ("svg", "png"):
        figure.savefig(directory / f"misalignment.{ending}", dpi=110)


def main():
    package, directory = sys.argv[1], Path(sys.argv[2])
    result = simulate(package)
    assert all(np.isfinite(values).all() for values in result.values())
    directory.mkdir(parents=True, exist_ok=True)
    plot(result, directory)
    print(f"at {TILT * 1e3} mrad: moment {-result['inner.moment.z'][-1]:.3f} N m about z,", end=" ")
    loads = [result[name][-1] for name in result if name.endswith(".inner.load")]
    print(f"ball loads {min(loads):.1f} to {max(loads):.1f} N")
    print(f"plots in {directory}")


if __name__ == "__main__":
    main()
