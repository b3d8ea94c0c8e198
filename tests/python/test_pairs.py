"""Two bearings in every master: instances of one package and of two, with a shaft between them (`shaft.py`)."""

import json
import math
import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT, build, pose_drive
from fmpy import read_model_description
from pythonfmu import FmuBuilder

HERE = Path(__file__).parent
STEP, STEPS = 4e-6, 500
THRUST = 3000.0  # on the shaft [N]: twice that of the scene
WATCHED = [(end, f"inner.{name}") for end in ("front", "rear") for name in ("force.x", "force.y", "turned")]
WATCHED += [("front", "balls.loaded"), ("rear", "balls.loaded")]


def connections():
    sys.path.insert(0, str(HERE))
    import shaft

    for end in shaft.ENDS:
        for name in shaft.WRENCH:
            yield end, f"inner.{name}", "shaft", f"{end}.{name}"
        for name in [*shaft.PLACE, *shaft.RATES, "speed"]:
            yield "shaft", f"{end}.{name}", end, f"inner.{name}"


@pytest.fixture(scope="module")
def systems(tmp_path_factory, thrust_text):
    """Systems with two instances of one package, and with one each of two."""
    directory = tmp_path_factory.mktemp("pairs")
    text = pose_drive(thrust_text, "shaft")
    front = build(text, directory, "front_bearing")
    # The other one lists its dependencies over a step: no master of these is led astray by that.
    rear = text.replace("ball_race = 0.08", "ball_race = 0.06") + 'dependencies = "step"\n'
    rear = build(rear, directory, "rear_bearing")
    start = {v.name: float(v.start) for v in read_model_description(front).modelVariables if v.causality == "input"}
    numbers = f'{start["inner.position.x"]!r}, {THRUST!r}, {start["inner.speed"]!r}'
    script = (HERE / "shaft.py").read_text()
    zeros = "START, THRUST, SPEED = 0.0, 0.0, 0.0"
    assert zeros in script
    (directory / "shaft.py").write_text(script.replace(zeros, f"START, THRUST, SPEED = {numbers}"))
    shaft = FmuBuilder.build_FMU(str(directory / "shaft.py"), dest=str(directory))
    files = {}
    for name, other in [("one package", front), ("two packages", rear)]:
        system = {
            "instances": {"front": str(front), "shaft": str(shaft), "rear": str(other)},
            "connections": list(connections()),
            "start": {"front": start, "rear": start},
            "watched": WATCHED,
            "step": STEP,
            "steps": STEPS,
        }
        files[name] = directory / f"{name}.json"
        files[name].write_text(json.dumps(system))
    return files, start["inner.speed"]


@pytest.fixture(scope="session")
def cofmupy_python():
    """Python of an environment of its own: CoFmuPy needs another version of FMPy."""
    environment = Path(f"{os.environ.get('ROULEMENT_VENV', ROOT / '.venv')}-cofmupy")
    requirements, installed = HERE / "cofmupy-requirements.txt", environment / "installed.txt"
    python = environment / "bin" / "python"
    if not (installed.exists() and installed.read_text() == requirements.read_text()):
        subprocess.run([sys.executable, "-m", "venv", environment], check=True)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "--no-deps", "--no-compile", "-r", requirements]
        subprocess.run(pip, check=True)
        installed.write_text(requirements.read_text())
    return python


@pytest.mark.parametrize("packages", ["one package", "two packages"])
@pytest.mark.parametrize("master", ["fmpy", "ssp", "libcosim", "ecos", "fmucontainer", "cofmupy"])
def test_two_bearings_carry_a_shaft(systems, master, packages, request):
    files, speed = systems
    python = request.getfixturevalue("cofmupy_python") if master == "cofmupy" else sys.executable
    command = [python, HERE / "masters.py", master, files[packages]]
    run = subprocess.run(command, capture_output=True, text=True, cwd=HERE)
    assert run.returncode == 0, run.stdout[-3000:] + run.stderr[-3000:]
    values = json.loads(run.stdout.splitlines()[-1])
    front, rear = values[:3], values[3:6]
    # Both share the thrust, and both turn with the shaft; masters differ in when they hand values over.
    assert math.isclose(front[0] + rear[0], -THRUST, rel_tol=0.05), values
    assert math.isclose(front[0], rear[0], rel_tol=0.05), values
    turned = speed * STEP * STEPS
    assert all(math.isclose(end[2], turned, rel_tol=0.01) for end in (front, rear)), (values, turned)
    assert values[6:] == [10, 10]
