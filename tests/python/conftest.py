"""Packages built by the command line, and an FMPy slave with its log, for all tests."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest
from fmpy import extract, fmi2, read_model_description

ROOT = Path(__file__).resolve().parents[2]
ROULEMENT = Path(os.environ.get("ROULEMENT_BIN", ROOT / "target" / "release" / "roulement"))


def roulement(*arguments, check=True):
    """Runs the command line."""
    return subprocess.run([ROULEMENT, *map(str, arguments)], check=check, capture_output=True, text=True)


def build(scene_text, directory, name):
    """Packs a scene given as text; returns the path of the package."""
    scene, package = directory / f"{name}.toml", directory / f"{name}.fmu"
    scene.write_text(scene_text)
    roulement("fmu", scene, "-o", package)
    return package


def pose_drive(text, orientation="quaternion"):
    """The same scene with the inner race driven by its pose."""
    return oriented(text.replace('drive = "wrench"', 'drive = "pose"', 1), orientation)


def oriented(text, orientation):
    """The same scene with orientations written in another form."""
    return f'{text}\n[interface]\norientation = "{orientation}"\n'


@pytest.fixture(scope="session")
def thrust_text():
    return (ROOT / "scenes" / "thrust.toml").read_text()


@pytest.fixture(scope="session")
def packages(tmp_path_factory, thrust_text):
    """Packages of the thrust case, by drive."""
    directory = tmp_path_factory.mktemp("packages")
    return {
        "wrench": build(thrust_text, directory, "wrench"),
        "pose": build(pose_drive(thrust_text), directory, "pose"),
        "shaft": build(pose_drive(thrust_text, "shaft"), directory, "shaft"),
        "wrench, quaternion": build(oriented(thrust_text, "quaternion"), directory, "wrench_quaternion"),
    }


class Slave:
    """An instance of a package, with variables by name and the messages of its logger."""

    def __init__(self, package, directory, name="bearing", guid=None):
        self.messages = []
        self.description = read_model_description(package)
        self.references = {v.name: v.valueReference for v in self.description.modelVariables}
        self.directory = directory
        extract(package, unzipdir=directory)
        self.fmu = fmi2.FMU2Slave(
            guid=guid or self.description.guid,
            unzipDirectory=str(directory),
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.callbacks = fmi2.fmi2CallbackFunctions()
        self.callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(self._log)
        self.callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmi2.calloc)
        self.callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmi2.free)
        self.instantiated = False

    def _log(self, environment, instance, status, category, message):
        self.messages.append((status, category.decode(), message.decode()))

    def instantiate(self):
        self.fmu.instantiate(callbacks=self.callbacks, loggingOn=True)
        self.instantiated = True
        return self

    def start(self, time=0.0):
        if not self.instantiated:
            self.instantiate()
        self.fmu.setupExperiment(startTime=time)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        return self

    def get(self, *names):
        return self.fmu.getReal([self.references[name] for name in names])

    def set(self, **values):
        """Sets variables; dots of names are written as double underscores."""
        names = [name.replace("__", ".") for name in values]
        self.fmu.setReal([self.references[name] for name in names], list(values.values()))

    def outputs(self):
        return self.fmu.getReal(
            [v.valueReference for v in self.description.modelVariables if v.type == "Real" and v.causality == "output"]
        )

    def state_bytes(self):
        state = self.fmu.getFMUState()
        try:
            return self.fmu.serializeFMUState(state)
        finally:
            self.fmu.freeFMUState(state)

    def close(self):
        if self.instantiated:
            self.fmu.freeInstance()
            self.instantiated = False


@pytest.fixture
def slave(packages, tmp_path):
    """Makes slaves and frees them at the end."""
    slaves = []

    def make(drive="wrench", **options):
        directory = tmp_path / f"slave{len(slaves)}"
        slaves.append(Slave(packages[drive], directory, **options))
        return slaves[-1]

    yield make
    for made in slaves:
        made.close()
        shutil.rmtree(made.directory, ignore_errors=True)
