"""What `roulement system` writes: the SSP file in Ecos, the OSP structure in libcosim, its schema; the gearbox in all masters.

All masters are required: a missing one fails.
"""

import json
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from conftest import ROOT, ROULEMENT, roulement
from lxml import etree
from pythonfmu import FmuBuilder

HERE = Path(__file__).parent
STEP, STEPS = 1e-3, 3
SYSTEM = f"""
name = "pair"
step = {STEP}
stop = 0.1
connections = ["one.out -> other.in", "other.out -> one.in"]
[components.one]
fmu = "Gain.fmu"
[components.other]
fmu = "Other.fmu"
mounting = "-x"
[start]
one.length = 3
other.length = 5.0
"""


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    """Folder of a system of two instances of one package, connected both ways with signs, units and start values."""
    folder = tmp_path_factory.mktemp("system")
    FmuBuilder.build_FMU(str(HERE / "gain.py"), dest=str(folder))
    # A file for each: components of one share it.
    shutil.copy(folder / "Gain.fmu", folder / "Other.fmu")
    description = folder / "system.toml"
    description.write_text(SYSTEM)
    roulement("system", description, "-o", folder)
    return folder


@pytest.fixture(scope="module")
def sharing(tmp_path_factory):
    """The same with one package for both."""
    folder = tmp_path_factory.mktemp("sharing")
    FmuBuilder.build_FMU(str(HERE / "gain.py"), dest=str(folder))
    description = folder / "system.toml"
    description.write_text(SYSTEM.replace("Other.fmu", "Gain.fmu"))
    roulement("system", description, "-o", folder)
    with zipfile.ZipFile(folder / "pair.ssp") as archive:
        assert archive.namelist() == ["SystemStructure.ssd", "resources/one.fmu"]
    return folder


@pytest.mark.parametrize("master", ["ecos", "libcosim"])
@pytest.mark.parametrize("packages", ["pair", "sharing"])
def test_masters_honour_signs_units_and_start_values(packages, master, request):
    pair = request.getfixturevalue(packages)
    watched = [f"{component}.seen.{name}" for component in ("one", "other") for name in ("x", "z", "warm")]
    command = [sys.executable, HERE / "written_system.py", master, pair, "pair", str(STEP), str(STEPS), *watched]
    run = subprocess.run(command, capture_output=True, text=True)
    assert run.returncode == 0, run.stdout[-3000:] + run.stderr[-3000:]
    # What the other one gives, mm as m, x the other way, degC as K.
    wanted = [-0.005, 0.005, 293.15, -0.003, 0.003, 293.15]
    assert json.loads(run.stdout.splitlines()[-1]) == pytest.approx(wanted, rel=1e-15)


def test_the_structure_keeps_the_schema_of_ssp(pair):
    schema = Path(fmpy.__file__).parent / "ssp" / "schema" / "SystemStructureDescription.xsd"
    with zipfile.ZipFile(pair / "pair.ssp") as archive:
        etree.XMLSchema(etree.parse(schema)).assertValid(etree.fromstring(archive.read("SystemStructure.ssd")))
        assert archive.namelist() == ["SystemStructure.ssd", "resources/one.fmu", "resources/other.fmu"]
        assert archive.read("resources/one.fmu") == (pair / "Gain.fmu").read_bytes()


def test_the_gearbox_agrees_in_all_masters_and_with_statics(tmp_path):
    environment = os.environ | {"ROULEMENT_BIN": str(ROULEMENT)}
    run = subprocess.run([sys.executable, ROOT / "examples/gearbox/masters.py", tmp_path], capture_output=True, text=True, env=environment)
    assert run.returncode == 0, run.stdout[-3000:] + run.stderr[-3000:]
    rows = {master: np.loadtxt(tmp_path / f"{master}.csv", delimiter=",") for master in ("fmpy", "ecos", "libcosim")}
    means = {}
    for master, of in rows.items():
        # 23 periods of the mesh.
        means[master] = -of[of[:, 0] > 0.0100025, 1:].mean(axis=0)
        left, right = means[master].reshape(2, 3)
        # By hand, docs/gearbox.md.
        radial = np.linalg.norm([left[1:], right[1:]], axis=1)
        assert radial == pytest.approx([744, 591], rel=0.01), master
        assert left[0] + right[0] == pytest.approx(338, rel=0.01), master
    # Ecos and libcosim hand over at the same points; times of the latter are whole nanoseconds. The largest force is 2 kN.
    assert np.abs(rows["ecos"] - rows["libcosim"])[:, 1:].max() < 1e-5
    # The shaft in Python knows each force at its own time, the package predicts it: vibration differs, means hardly do.
    assert np.abs(means["fmpy"] - means["ecos"]).max() < 0.001 * np.abs(means["fmpy"]).max()
