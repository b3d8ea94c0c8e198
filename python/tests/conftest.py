"""The installed package beside the command line."""

import csv
import os
import subprocess
from pathlib import Path

import numpy as np
import pytest
import roulement

ROOT = Path(__file__).resolve().parents[2]
# A shelf of one bearing, a catalogue of one's own.
SHELF = """
[[bearing]]
designation = "6205"
bore = "25 mm"
outside = "52 mm"
width = "15 mm"
dynamic_load_rating = "14.1 kN"
static_load_rating = "7.8 kN"
balls = 9
ball_diameter = "7.9 mm"
"""
PROGRAM = Path(os.environ.get("ROULEMENT_BIN", ROOT / "target" / "release" / "roulement"))


def program(*arguments, check=True):
    """Runs the command line."""
    return subprocess.run([PROGRAM, *map(str, arguments)], check=check, capture_output=True, text=True)


def table_of(path):
    """A CSV table as an array for each column, by name without unit."""
    with open(path, newline="") as file:
        header, *rows = csv.reader(file)
    return {name.split(" [")[0]: column for name, column in zip(header, zip(*rows))}


def cases(count, duration):
    """A table of cases that differ in friction."""
    rows = [f"{0.04 + 0.08 * k / count!r},{duration}" for k in range(count)]
    return "friction.ball_race,load.duration\n" + "\n".join(rows) + "\n"


def bits(array):
    """Numbers as integers: equal bits alone are equal."""
    return np.ascontiguousarray(array, dtype=float).view(np.int64)


def instance_of(package):
    """An instance of a package in FMPy, after its start, and its references by name."""
    from fmpy import extract, read_model_description
    from fmpy.fmi2 import FMU2Slave

    description = read_model_description(str(package))
    folder = extract(str(package), unzipdir=str(package.with_suffix("")))
    slave = FMU2Slave(guid=description.guid, unzipDirectory=folder, modelIdentifier=description.coSimulation.modelIdentifier, instanceName="b")
    slave.instantiate()
    slave.setupExperiment(startTime=0.0)
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    return slave, {v.name: v.valueReference for v in description.modelVariables}


@pytest.fixture
def thrust():
    """The thrust case, 2 ms of it."""
    return roulement.Scene.load(ROOT / "scenes" / "thrust.toml").with_({"load.duration": "2 ms"})


@pytest.fixture
def posed(thrust):
    """The same with the inner race in pose drive."""
    return thrust.with_({"inner.drive": "pose"})
