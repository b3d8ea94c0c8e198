"""The package in other masters: libcosimpy (DNV's libcosim) and ecospy (Ecos), against the native run.

Both are required: a missing one fails. ecospy needs oneTBB, which the `tbb` wheel brings.
"""

import csv
import ctypes
import math
import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROULEMENT, build, pose_drive, roulement
from fmpy import read_model_description

ROOT = Path(__file__).resolve().parents[2]
STEP = 2.0**-13  # sums of steps are exact
STEPS = 80
NAMES = ["inner.force.x", "inner.force.y", "inner.position.x", "inner.drive_torque", "cage.speed", "energy.dissipated"]


@pytest.fixture(scope="module")
def thrust(tmp_path_factory, thrust_text):
    """Package of the thrust case, value references, and the rows of its native run."""
    directory = tmp_path_factory.mktemp("masters")
    text = thrust_text.replace('"50 ms"', str(STEPS * STEP)).replace('"100 us"', str(STEP))
    # Balls that stick on one race damp the swing along the axis which a step of the load begins.
    text += "\n[start]\nspin_balance = false\n"
    package = build(text, directory, "thrust")
    roulement("run", directory / "thrust.toml", "-o", directory, "--steps-end-at-rows")
    with open(directory / "results.csv") as table:
        rows = [{name.split(" [")[0]: float(v) for name, v in row.items()} for row in csv.DictReader(table)]
    references = {v.name: v.valueReference for v in read_model_description(package).modelVariables}
    return package, references, [[row[name] for name in NAMES] for row in rows]


def test_libcosimpy_gives_the_native_run(thrust):
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    package, references, rows = thrust
    # libcosim counts time in nanoseconds.
    execution = CosimExecution.from_step_size(round(STEP * 1e9))
    slave = execution.add_local_slave(CosimLocalSlave(fmu_path=str(package), instance_name="bearing"))
    observer = CosimObserver.create_last_value()
    assert execution.add_observer(observer)
    wanted = [references[name] for name in NAMES]
    for row in rows[1:]:
        assert execution.step()
        got = observer.last_real_values(slave, wanted)
        assert all(math.isclose(a, b, rel_tol=1e-6, abs_tol=1e-6 * max(map(abs, row))) for a, b in zip(got, row)), (got, row)
    assert execution.stop() is not False


def test_libcosimpy_sets_inputs(thrust):
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimManipulator import CosimManipulator
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    package, references, _ = thrust
    execution = CosimExecution.from_step_size(round(STEP * 1e9))
    slave = execution.add_local_slave(CosimLocalSlave(fmu_path=str(package), instance_name="bearing"))
    observer, manipulator = CosimObserver.create_last_value(), CosimManipulator.create_override()
    execution.add_observer(observer)
    execution.add_manipulator(manipulator)
    manipulator.slave_real_values(slave, [references["inner.applied_force.x"]], [1000.0])
    assert execution.step(200)
    (force,) = observer.last_real_values(slave, [references["inner.force.x"]])
    assert math.isclose(force, -1000, rel_tol=0.01)


ECOS = """
import ctypes, sys
from pathlib import Path

tbb = Path(sys.prefix) / "lib" / "libtbb.so.12"
ctypes.CDLL(str(tbb), mode=ctypes.RTLD_GLOBAL)
from ecospy import EcosSimulation, EcosSimulationStructure

package, step, steps, names = sys.argv[1], float(sys.argv[2]), int(sys.argv[3]), sys.argv[4:]
with EcosSimulationStructure() as structure:
    structure.add_model("bearing", package)
    with EcosSimulation(structure=structure, step_size=step) as simulation:
        simulation.init()
        for _ in range(steps):
            simulation.step()
            print(*[repr(simulation.get_real("bearing::" + name)) for name in names], flush=True)
        simulation.set_real("bearing::inner.applied_force.x", 1000.0)
        for _ in range(200):
            simulation.step()
        print(repr(simulation.get_real("bearing::inner.force.x")), flush=True)
        simulation.terminate()
"""


def test_ecospy_gives_the_native_run_and_sets_inputs(thrust):
    package, _, rows = thrust
    # In a process of its own: it loads its thread pool into whoever imports it.
    run = subprocess.run(
        [sys.executable, "-c", ECOS, str(package), repr(STEP), str(STEPS), *NAMES], capture_output=True, text=True
    )
    assert run.returncode == 0, run.stdout + run.stderr
    lines = [
        [float(number) for number in line.split()] for line in run.stdout.splitlines() if line and line[0] in "-0123456789"
    ]
    assert len(lines) == STEPS + 1
    for got, row in zip(lines, rows[1:]):
        assert got == row
    assert math.isclose(lines[-1][0], -1000, rel_tol=0.01)


def test_ecospy_runs_the_package_of_fmi_3(thrust, tmp_path):
    """Ecos 0.7.2 reads scalars of FMI 3.0; what the crate's own callbacks do is not tried."""
    package, _, rows = thrust
    scene, third = package.with_suffix(".toml"), tmp_path / "third.fmu"
    roulement("fmu", scene, "-o", third, "--fmi", 3)
    run = subprocess.run(
        [sys.executable, "-c", ECOS, str(third), repr(STEP), str(STEPS), *NAMES], capture_output=True, text=True
    )
    assert run.returncode == 0, run.stdout + run.stderr
    lines = [
        [float(number) for number in line.split()] for line in run.stdout.splitlines() if line and line[0] in "-0123456789"
    ]
    assert len(lines) == STEPS + 1
    for got, row in zip(lines, rows[1:]):
        assert got == row


ECOS_PAIR = """
import ctypes, sys
from pathlib import Path
tbb = Path(sys.prefix) / "lib" / "libtbb.so.12"
ctypes.CDLL(str(tbb), mode=ctypes.RTLD_GLOBAL)
from ecospy import EcosSimulation, EcosSimulationStructure

step, steps, name, packages = float(sys.argv[1]), int(sys.argv[2]), sys.argv[3], sys.argv[4:]
with EcosSimulationStructure() as structure:
    for end, package in zip(["left", "right"], packages):
        structure.add_model(end, package)
    with EcosSimulation(structure=structure, step_size=step) as simulation:
        simulation.init()
        if len(packages) == 2:
            simulation.set_real("right::inner.applied_force.x", 1000.0)
        for _ in range(steps):
            simulation.step()
            print(*[repr(simulation.get_real(f"{end}::{name}")) for end, _ in zip(["left", "right"], packages)], flush=True)
        simulation.terminate()
"""


def test_ecospy_runs_two_instances_of_fmi_3(thrust, tmp_path):
    """Two instances of one package of FMI 3.0 under loads of their own: the first as when it is alone."""
    package, _, _ = thrust
    third = tmp_path / "third.fmu"
    roulement("fmu", package.with_suffix(".toml"), "-o", third, "--fmi", 3)

    def forces(*packages):
        arguments = [sys.executable, "-c", ECOS_PAIR, repr(STEP), "200", "inner.force.x", *map(str, packages)]
        run = subprocess.run(arguments, capture_output=True, text=True)
        assert run.returncode == 0, run.stdout + run.stderr
        lines = [line.split() for line in run.stdout.splitlines() if line and line[0] in "-0123456789"]
        assert len(lines) == 200
        return [[float(number) for number in line] for line in lines]

    alone, pair = forces(third), forces(third, third)
    assert [left for left, _ in pair] == [left for (left,) in alone]
    assert math.isclose(pair[-1][1], -1000, rel_tol=0.02) and math.isclose(pair[-1][0], -1500, rel_tol=0.02)


def test_fmi_rs_runs_the_package():
    """Runs the tests of tests/fmi_rs: a master in Rust by the makers of FMPy, built here."""
    environment = os.environ | {
        "ROULEMENT_BIN": str(ROULEMENT),
        "CARGO_TARGET_DIR": str(Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target")).absolute() / "fmi_rs"),
    }
    run = subprocess.run(
        ["cargo", "test", "--quiet", "--locked"],
        cwd=ROOT / "tests" / "fmi_rs",
        env=environment,
        # Cargo asks rustc by its standard input.
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
    )
    assert run.returncode == 0, run.stdout + run.stderr
    # layout.rs, package.rs, version3.rs
    assert run.stdout.count("2 passed") == 2 and "3 passed" in run.stdout
