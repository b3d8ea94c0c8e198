"""Simulations step by step: bits of the package in FMPy, snapshots, derivatives, price; coupling to a shaft."""

import copy
import subprocess
import sys
import time
import zipfile

import numpy as np
import pytest
import roulement
from conftest import PROGRAM, ROOT, bits, instance_of, program
from roulement import coupling

STEP = 2e-5


def fmu_of(scene, directory, name):
    """An instance of the package of a scene, made by the command line, and its references by name."""
    (directory / f"{name}.toml").write_text(scene.source)
    program("fmu", directory / f"{name}.toml", "-o", directory / f"{name}.fmu")
    return instance_of(directory / f"{name}.fmu")


def moved(simulation, k):
    """Tilts and pushes a race in pose drive."""
    simulation["inner.velocity.y"] = 1e-3 * np.sin(0.3 * k)
    simulation["inner.rotation_rate.z"] = 0.05


@pytest.mark.parametrize("method", ["hht", "esdirk3"])
def test_consistency_steps_have_the_bits_of_the_package(posed, tmp_path, method):
    posed = posed.with_({"solver.method": method})
    fmu, references = fmu_of(posed, tmp_path, "posed")
    simulation = roulement.Simulation(posed)
    outputs = [name for name, (_, causality, _) in simulation.variables.items() if causality == "output" and not name.startswith("statistics")]
    assert len(outputs) > 20 and set(references) == set(simulation.variables)
    real = [name for name in outputs if name in references]
    for k in range(20):
        moved(simulation, k)
        names = ["inner.velocity.y", "inner.rotation_rate.z"]
        fmu.setReal([references[name] for name in names], [simulation[name] for name in names])
        fmu.doStep(k * STEP, STEP)
        assert simulation.step(STEP) == simulation.time
        theirs = fmu.getReal([references[name] for name in real])
        assert np.array_equal(bits(theirs), bits([simulation[name] for name in real])), k
    fmu.terminate()
    fmu.freeInstance()


def test_invariant_copies_and_snapshots_go_on_to_the_same_bits(posed):
    simulation = roulement.Simulation(posed)
    for k in range(3):
        moved(simulation, k)
        simulation.step(STEP)
    other, point, data = simulation.copy(), simulation.snapshot(), simulation.dumps()
    again = copy.copy(simulation)
    stranger = roulement.Simulation(posed)
    stranger.loads(data)

    def goes_on(one):
        for k in range(3, 8):
            moved(one, k)
            one.step(STEP)
        return bits([*one["inner.force"], *one["inner.moment"], one["friction_power"], one.time])

    end = goes_on(simulation)
    simulation.restore(point)
    assert all(np.array_equal(end, goes_on(one)) for one in (simulation, other, again, stranger))
    with pytest.raises(ValueError, match="another scene"):
        roulement.Simulation(posed.with_({"bearing.balls": 9})).restore(point)


def test_derivatives_are_those_of_repeated_steps(posed):
    simulation = roulement.Simulation(posed)
    simulation.step(STEP)
    start = simulation.copy()
    simulation.step(STEP)
    matrix = simulation.derivatives("inner.force", ["inner.position", "inner.velocity.x"])
    assert matrix.shape == (3, 4)
    for column, (name, change) in enumerate([("inner.position.x", 1e-9), ("inner.position.y", 1e-9), ("inner.position.z", 1e-9), ("inner.velocity.x", 1e-4)]):
        ends = []
        for sign in (1, -1):
            one = start.copy()
            one[name] = one[name] + sign * change
            one.step(STEP)
            ends.append(one["inner.force"])
        difference = (ends[0] - ends[1]) / (2 * change)
        # Steps end where Newton's iteration does: to 1e-9 of the load of 1.5 kN over the change of the force.
        assert np.abs(matrix[:, column] - difference).max() < 2e-3 * np.abs(matrix[:, column]).max(), name


def test_parameters_inputs_and_refusals(thrust):
    dry = roulement.Simulation(thrust, values={"friction": 0.12})
    assert dry["friction"] == 0.12
    with pytest.raises(KeyError, match="inner.forc"):
        dry.signal("inner.forc")
    with pytest.raises(ValueError, match="finite"):
        dry["inner.applied_force"] = [np.nan, 0, 0]
        dry.step(STEP)
    with pytest.raises(ValueError, match="not positive"):
        dry.step(0.0)
    with pytest.raises(ValueError):
        dry["friction_power"] = 1.0


def test_a_step_with_bound_signals_costs_little_more_than_the_step(posed):
    """Price of Python around a step: pose and twist set, wrench read."""
    simulation = roulement.Simulation(posed)
    pose, twist = simulation.signal("inner.position"), simulation.signal("inner.velocity")
    force, moment = simulation.signal("inner.force"), simulation.signal("inner.moment")
    place, still = pose.value, np.zeros(3)

    def around():
        pose.value, twist.value = place, still
        return force.value, moment.value

    least = np.inf
    for _ in range(20):
        begin = time.perf_counter()
        for _ in range(200):
            around()
        least = min(least, (time.perf_counter() - begin) / 200)
    print(f"bound signals of a step: {least * 1e6:.2f} us")
    assert least < 15e-6, least


@pytest.fixture(scope="module")
def shaft_scene():
    return roulement.Scene.load(ROOT / "examples" / "coupling" / "bearing.toml")


def path(scheme, bearing, step, steps, **options):
    """Places of a shaft of 1 kg under thrust, and a radial force from time 0."""
    shaft = scheme(bearing, coupling.rigid(1.0, 2.1e-3), lambda time: [1500.0, 30.0, 0, 0, 0], coupling.gyroscopic(1.1e-4, 628.3), **options)
    places = [shaft.place]
    for _ in range(steps):
        shaft.step(step)
        places.append(shaft.place)
    return np.array(places)


def test_recipes_agree_with_small_steps_and_with_the_package(shaft_scene, tmp_path):
    fine = path(coupling.Leapfrog, coupling.Bearing(roulement.Simulation(shaft_scene)), 2e-6, 640)[::10]
    size = np.abs(fine[:, :3] - fine[0, :3]).max()
    for scheme, bound in [(coupling.Leapfrog, 0.02), (coupling.Euler, 0.05), (coupling.Implicit, 0.05)]:
        coarse = path(scheme, coupling.Bearing(roulement.Simulation(shaft_scene)), 2e-5, 64)
        assert np.abs(coarse - fine)[:, :3].max() < bound * size, (scheme, np.abs(coarse - fine)[:, :3].max() / size)
        fmu, references = fmu_of(shaft_scene, tmp_path, scheme.__name__)
        packed = path(scheme, coupling.FmuBearing(fmu, references), 2e-5, 64)
        # Times add up in another order: steps of another last bit.
        assert np.abs(packed - coarse)[:, :3].max() < 1e-6 * size
        fmu.freeInstance()


def test_packages_are_made_with_nothing_but_the_installed_package(thrust, tmp_path):
    """No program, no environment, no folder of the project: as on a machine where only the wheel was installed."""
    (tmp_path / "scene.toml").write_text(thrust.source)
    code = "import roulement, sys; roulement.package(roulement.Scene.load(sys.argv[1]), sys.argv[2])"
    command = [sys.executable, "-c", code, tmp_path / "scene.toml", tmp_path / "own.fmu"]
    ended = subprocess.run(list(map(str, command)), cwd=tmp_path, env={}, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    fmu, references = instance_of(tmp_path / "own.fmu")
    fmu.doStep(0.0, STEP)
    simulation = roulement.Simulation(thrust)
    simulation.step(STEP)
    names = [f"inner.force.{axis}" for axis in "xyz"]
    assert np.array_equal(bits(fmu.getReal([references[name] for name in names])), bits(simulation["inner.force"]))
    fmu.freeInstance()


def test_packages_are_those_of_the_command_line(thrust, tmp_path):
    library = next(PROGRAM.parent.glob("*roulement.so"))
    (tmp_path / "scene.toml").write_text(thrust.source)
    program("fmu", tmp_path / "scene.toml", "-o", tmp_path / "one.fmu", "--name", "bearing")
    roulement.package(thrust, tmp_path / "other.fmu", library=library, name="bearing")
    one, other = (zipfile.ZipFile(tmp_path / name) for name in ("one.fmu", "other.fmu"))
    assert sorted(one.namelist()) == sorted(other.namelist())
    for name in one.namelist():
        assert one.read(name) == other.read(name), name
