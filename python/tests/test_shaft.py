"""Shafts from matrices: reduction and the file."""

import json
import re
import zipfile
from pathlib import Path

import numpy as np
import pytest
import roulement
from roulement import shaft, sweep

SCENES = Path(__file__).resolve().parents[2] / "scenes"


def chain(size):
    """Masses of 1 kg between springs of 1 N/m, free at both ends."""
    stiffness = 2 * np.eye(size) - np.eye(size, k=1) - np.eye(size, k=-1)
    stiffness[0, 0] = stiffness[-1, -1] = 1
    return np.diag(np.linspace(1, 2, size)), stiffness


def test_closed_form_a_reduced_structure_has_the_static_stiffness_of_the_whole():
    mass, stiffness = chain(12)
    interface = [0, 7]
    inner = [k for k in range(12) if k not in interface]
    coupling = stiffness[np.ix_(inner, interface)]
    exact = stiffness[np.ix_(interface, interface)] - coupling.T @ np.linalg.solve(stiffness[np.ix_(inner, inner)], coupling)
    for highest in (0.0, 0.1, 1e3):
        reduced = shaft.reduce(mass, stiffness, interface, highest)
        assert reduced["stiffness"][:2, :2] == pytest.approx(exact, abs=1e-12)
        # Modes are not coupled to the interface by stiffness, and have unit mass.
        assert np.abs(reduced["stiffness"][:2, 2:]).max(initial=0) < 1e-12
        assert reduced["mass"][2:, 2:] == pytest.approx(np.eye(len(reduced["frequencies"])), abs=1e-12)
        # A rigid displacement has the whole mass.
        rigid = np.zeros(len(reduced["mass"]))
        rigid[:2] = 1
        assert rigid @ reduced["mass"] @ rigid == pytest.approx(mass.sum())


def test_invariant_with_all_modes_frequencies_are_those_of_the_whole():
    mass, stiffness = chain(9)
    reduced = shaft.reduce(mass, stiffness, [0, 8], np.inf)
    whole, small = (np.sort(np.linalg.eigvals(np.linalg.solve(m, k)).real) for m, k in [(mass, stiffness), (reduced["mass"], reduced["stiffness"])])
    assert small == pytest.approx(whole, abs=1e-12)


def test_invariant_sparse_matrices_are_reduced_as_dense_ones():
    from scipy import sparse

    mass, stiffness = chain(100)
    interface = [80, 0]
    # Of 98 modes between 0 and 0.3 Hz some, none, more than are looked for at first, and all.
    for highest, least, most in ((0.03, 5, 20), (0.0, 0, 0), (0.12, 25, 47), (1.0, 98, 98)):
        whole = shaft.reduce(mass, stiffness, interface, highest)
        small = shaft.reduce(sparse.csc_array(mass), sparse.csc_array(stiffness), interface, highest)
        assert least <= len(small["frequencies"]) <= most
        assert small["frequencies"] == pytest.approx(whole["frequencies"], rel=1e-9)
        assert small["stiffness"][:2, :2] == pytest.approx(whole["stiffness"][:2, :2], abs=1e-12)
        # Modes have a sign of their own.
        signs = np.sign(np.sum(small["shapes"][:, 2:] * whole["shapes"][:, 2:], axis=0))
        assert np.abs(small["shapes"][:, 2:] * signs - whole["shapes"][:, 2:]).max(initial=0) < 1e-6
        assert small["shapes"][:, :2] == pytest.approx(whole["shapes"][:, :2], abs=1e-12)
        again = shaft.reduce(sparse.csc_array(mass), sparse.csc_array(stiffness), interface, highest)
        assert all(np.array_equal(small[key], again[key]) for key in small)


def test_closed_form_weights_of_a_structure_that_is_held(tmp_path):
    """A chain on a spring to the ground: what the file's translations weigh is what gravity does, and moves the interface as it does the whole."""
    mass, stiffness = chain(12)
    stiffness[0, 0] += 1
    reduced = shaft.reduce(mass, stiffness, [7], 0.1)
    weights = reduced["shapes"].T @ mass @ np.ones((12, 3))
    path = tmp_path / "held.json"
    shaft.write(path, reduced["mass"], reduced["stiffness"], None, {0.0: np.zeros((6, len(weights)))}, weights=weights)
    file = json.loads(path.read_text())
    read = np.array(file["mass"]) @ file["translations"]
    assert read == pytest.approx(weights, rel=1e-9)
    exact = np.linalg.solve(stiffness, mass @ np.ones(12))[7]
    assert np.linalg.solve(reduced["stiffness"], read[:, 0])[0] == pytest.approx(exact, rel=1e-9)
    for translations, weights in ((None, None), (np.eye(3), np.eye(3))):
        with pytest.raises(ValueError, match="either"):
            shaft.write(path, np.eye(3), np.eye(3), translations, {}, weights=weights)


def test_the_file_has_what_was_given(tmp_path):
    mass, stiffness = chain(3)
    stations = {0.1: np.eye(6, 3), (0.4, 0, -0.1): 2 * np.eye(6, 3)}
    path = tmp_path / "shaft.json"
    shaft.write(path, mass, stiffness, np.eye(3), stations, polar_inertia=1e-3, title="chain")
    file = json.loads(path.read_text())
    assert file["mass"] == mass.tolist() and file["stiffness"] == stiffness.tolist()
    assert [station["position"] for station in file["stations"]] == [0.1, [0.4, 0, -0.1]]
    assert file["stations"][1]["map"] == (2 * np.eye(6, 3)).tolist()
    assert file["translations"] == np.eye(3).tolist() and "damping" not in file
    assert (file["title"], file["polar_inertia"]) == ("chain", 1e-3)


@pytest.fixture
def pinion(tmp_path):
    """The shipped shaft, for 0.2 ms."""
    text = (SCENES / "shafts/pinion.toml").read_text()
    short = re.sub(r'duration = ".*"', 'duration = "0.2 ms"', text)
    file = tmp_path / "pinion.toml"
    file.write_text(re.sub(r'output_interval = ".*"', 'output_interval = "20 us"', short))
    return file


def test_a_shaft_is_packaged_from_its_file(pinion, tmp_path):
    try:
        path = shaft.package(pinion, tmp_path / "pinion.fmu")
    except FileNotFoundError:
        pytest.skip("built without the library of packages")
    description = zipfile.ZipFile(path).read("modelDescription.xml").decode()
    assert 'modelName="pinion"' in description and 'name="mesh.force.z"' in description


def test_cases_of_a_shaft_run_in_a_sweep(pinion, tmp_path):
    cases = {"bearing.left.set.friction.ball_race": [0.05, 0.1], "shaft.load.mesh.force.z": ["1 kN", "2 kN"]}
    table = sweep.run(cases, pinion, tmp_path / "out")
    assert list(table["status"]) == ["done"] * 4
    # Twice the force deflects the shaft further, and friction costs power.
    z, power = table["left.seat.displacement.z.end"], table["left.friction_power.mean"]
    assert z[1] > z[0] > 0 and power[2] > power[0]


def test_a_shaft_goes_step_by_step(pinion):
    """Inputs act, a bearing's variables have its name before them, and points are come back to with the same bits."""
    simulation = roulement.Simulation(roulement.Scene.load(pinion))
    assert simulation.variables["mesh.force.z"][1] == "input" and simulation.variables["left.inner.force.x"][1] == "output"
    before = simulation["left.seat.displacement.z"]
    assert simulation["left.inner.force"].shape == (3,)
    point = simulation.snapshot()

    def goes_on(force):
        simulation["mesh.force.z"] = force
        for _ in range(10):
            simulation.step(2e-5)
        return np.array([*simulation["left.inner.force"], simulation["shaft.torque"], simulation["left.seat.displacement.z"]])

    end = goes_on(2500.0)
    assert simulation.time == pytest.approx(2e-4)
    assert end[-1] > before + 1e-7
    matrix = simulation.derivatives(["left.inner.force", "right.inner.force"], "mesh.force.z")
    assert matrix.shape == (6, 1) and np.isfinite(matrix).all() and np.abs(matrix).max() > 1e-3
    simulation.restore(point)
    assert np.array_equal(end.view(np.int64), goes_on(2500.0).view(np.int64))
    other = simulation.copy()
    simulation.step(2e-5), other.step(2e-5)
    assert np.array_equal(other["right.inner.force"], simulation["right.inner.force"])
    with pytest.raises(KeyError, match="middle.inner.force"):
        simulation.signal("middle.inner.force")
