"""The example of a housing by scikit-fem: its elements against closed forms, its reduction against all elements, its run against statics."""

import importlib.util
import json
import os
import re
import subprocess
import sys

import numpy as np
import pytest
from conftest import PROGRAM, ROOT
from scipy.linalg import eigh
from scipy.sparse.linalg import eigsh, splu

skfem = pytest.importorskip("skfem", reason="scikit-fem is not installed (examples/housing/requirements.txt)")

GRAVITY = np.array([0, 0, -9.81])


@pytest.fixture(scope="module")
def example():
    """The script as a module."""
    spec = importlib.util.spec_from_file_location("housing", ROOT / "examples" / "housing" / "housing.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def housing(example):
    return example.Housing()


@pytest.fixture(scope="module")
def reduced(example, housing):
    return example.reduced(housing)


def strip(example, length, width, height, along):
    """A thin strip from x = 0, one element thick: places, mass, stiffness."""
    grid = skfem.MeshHex.init_tensor(np.linspace(0, length, along + 1), np.linspace(-width / 2, width / 2, 3), np.array([-height / 2, height / 2]))
    return example.assembled(skfem.MeshHex2.from_mesh(grid))


def test_closed_form_a_strip_in_pure_bending_has_the_energy_of_a_beam(example):
    length, width, height, curvature = 0.1, 0.02, 0.002, 0.5
    (x, y, z), _, stiffness = strip(example, length, width, height, 4)
    # Saint-Venant's displacements, squares of the places: the elements have them exactly, so that nothing locks. What is left is rounding: the
    # strip goes (length over height) times as far as it is strained.
    poisson = example.POISSON
    moved = curvature * np.concatenate([-x * z, poisson * y * z, (x**2 - poisson * (y**2 - z**2)) / 2])
    energy = example.YOUNG * width * height**3 / 12 * curvature**2 * length / 2
    assert moved @ stiffness @ moved / 2 == pytest.approx(energy, rel=1e-7)


def test_closed_form_a_cantilever_is_that_of_timoshenko_and_euler(example):
    length, width, height = 0.1, 0.004, 0.004
    places, mass, stiffness = strip(example, length, width, height, 20)
    free = np.flatnonzero(np.tile(places[0] > 1e-9, 3))
    mass, stiffness = (matrix[free][:, free].tocsc() for matrix in (mass, stiffness))
    at = lambda x: 2 * places.shape[1] + np.flatnonzero(np.abs(places - [[x], [0], [0]]).max(axis=0) < 1e-9)[0]
    force = np.zeros(3 * places.shape[1])
    force[at(length)] = 1.0
    inertia = width * height**3 / 12
    shear = example.YOUNG / 2 / (1 + example.POISSON) * 5 / 6 * width * height
    # Away from the node that is pulled at.
    x = 0.8 * length
    deflection = x**2 * (3 * length - x) / (6 * example.YOUNG * inertia) + x / shear
    found = splu(stiffness).solve(force[free])[np.searchsorted(free, at(x))]
    # The clamp holds the width of the section, too: less by a part of height over length.
    assert found == pytest.approx(deflection, rel=0.01)
    value = eigsh(stiffness, 1, mass, sigma=0.0, return_eigenvectors=False)[0]
    euler = 1.875104**4 * example.YOUNG * inertia / (example.DENSITY * width * height * length**4)
    assert value == pytest.approx(euler, rel=0.015)


def test_closed_form_the_housing_has_the_mass_of_its_drawing_and_no_energy_of_rigid_motion(example, housing):
    of = example
    plate = 4 * of.LONG * of.WIDE * of.PLATE
    height = of.BLOCK - of.BOTTOM - of.PLATE
    ends = 2 * of.THICK * (2 * of.BLOCK * height - np.pi * of.BORE**2)
    sides = 2 * of.SIDE * 2 * (of.LONG - of.FLANGE) * height
    # Arcs are parabolas.
    assert housing.total == pytest.approx(of.DENSITY * (plate + ends + sides), rel=1e-3)
    places, _, stiffness = of.assembled(of.mesh(0.03))
    motion = of.rigid(places, (0.01, 0.02, 0.03)) * [1, 1, 1, 10, 10, 10]
    assert np.abs(stiffness @ motion).max() < 1e-12 * abs(stiffness).sum(axis=1).max()


def test_closed_form_weights_are_those_of_a_body_force(example, housing):
    basis = skfem.Basis(housing.mesh, skfem.ElementHex2(), intorder=4)
    pull = example.DENSITY * skfem.LinearForm(lambda v, _: v).assemble(basis)
    assert pull.sum() == pytest.approx(housing.total, rel=1e-12)
    # Mass of held nodes pulls at free ones of the same elements, too.
    exact = housing.by.T @ np.kron(np.eye(3), pull[:, None])
    assert np.abs(housing.weights - exact).max() < 1e-12 * housing.total


def test_invariant_finer_elements_change_little(example, housing):
    coarse = example.Housing(0.03)
    for side in ("left", "right", "top"):
        soft, stiff = (np.diag(each.compliance())[each.at(side)] for each in (housing, coarse))
        # Edges of clamped feet and rigid bores are what elements are never fine enough for. Softer by up to 6 %, turns by up to 8 %.
        assert np.all((stiff < soft) & (soft < stiff * np.repeat([1.06, 1.085], 3))), side


def test_closed_form_reactions_at_a_bore_that_is_moved_are_its_stiffness(example, housing):
    """Without the ties: nodes of bores are displaced one by one, and what holds them there is summed."""
    places, _, stiffness = example.assembled(housing.mesh)
    shapes = np.zeros((3, places.shape[1], 18))
    held = housing.feet.copy()
    for k, (place, nodes) in enumerate(housing.points.values()):
        shapes[:, nodes, 6 * k : 6 * k + 6] = example.rigid(places[:, nodes], place).reshape(3, -1, 6)
        held |= nodes
    shapes, given = shapes.reshape(-1, 18), np.tile(held, 3)
    shapes[~given] = -splu(stiffness[~given][:, ~given].tocsc()).solve(stiffness[~given][:, given] @ shapes[given])
    exact = shapes.T @ (stiffness @ shapes)
    found = np.linalg.inv(housing.compliance())
    scale = np.sqrt(np.outer(np.diag(exact), np.diag(exact)))
    assert np.abs((found - exact) / scale).max() < 1e-9


def test_invariant_the_reduced_housing_is_that_of_all_elements(example, housing, reduced):
    size = len(housing.interface)
    compliance, scale = housing.compliance(), np.sqrt(np.diag(housing.compliance()))
    small = np.linalg.inv(reduced["stiffness"])[:size, :size]
    assert np.abs((small - compliance) / np.outer(scale, scale)).max() < 1e-9
    # Under gravity the interface moves by the same.
    exact = housing.solved(housing.weights @ GRAVITY)[:size]
    found = np.linalg.solve(reduced["stiffness"], reduced["weights"] @ GRAVITY)[:size]
    assert np.abs((found - exact) / scale).max() < 1e-9 * np.abs(exact / scale).max()
    # With unit displacements of the points as translations it would be 23 % less (docs/shaft.md).
    points = sum(np.eye(len(reduced["mass"]), 3, k=-6 * k) for k in range(3))
    bad = np.linalg.solve(reduced["stiffness"], reduced["mass"] @ points @ GRAVITY)
    for side in ("left", "right"):
        down = housing.at(side)[2]
        assert bad[down] / exact[down] == pytest.approx(0.77, abs=0.006)
    for ours, all_elements in zip(reduced["free"], housing.frequencies(6)):
        assert 0 <= ours / all_elements - 1 < 0.01
    # One per cent of critical damping between the first frequency and 5 kHz.
    values, modes = eigh(reduced["stiffness"], reduced["mass"])
    ratio = np.diag(modes.T @ reduced["damping"] @ modes) / (2 * np.sqrt(values))
    within = values < (2 * np.pi * 5e3) ** 2
    assert within.sum() >= 3 and np.all((ratio[within] > 0.0095) & (ratio[within] < 0.01001))


def test_closed_form_bores_move_by_the_compliance_of_all_elements_times_the_bearing_forces(example, housing, reduced, tmp_path):
    environment = {**os.environ, "ROULEMENT_BIN": str(PROGRAM)}
    ended = subprocess.run([sys.executable, example.__file__, tmp_path], capture_output=True, text=True, env=environment)
    assert ended.returncode == 0, ended.stderr
    assert (tmp_path / "housing.png").exists() == (importlib.util.find_spec("matplotlib") is not None)
    # What the file weighs is what gravity pulls at.
    file = json.loads((tmp_path / "housing.json").read_text())
    read = np.array(file["mass"]) @ file["translations"]
    assert np.abs(read - reduced["weights"]).max() < 1e-9 * np.abs(reduced["weights"]).max()
    flexible, rigid = (example.results(tmp_path / name) for name in ("flexible", "rigid"))
    at = example.windows(flexible)
    # Over periods of the mesh inertia has all but no mean. At the start balls are not on their orbits yet: the forces are not those of the equilibrium.
    for row, limit in (("before", 1e-3), ("start", 0.02)):
        exact = example.by_statics(housing, flexible, at[row])
        for side in ("left", "right"):
            by_all, found = exact[housing.at(side)], example.moved(flexible, side, at[row])
            for part in (slice(0, 3), slice(3, 6)):
                assert np.linalg.norm(found[part] - by_all[part]) < limit * np.linalg.norm(by_all[part]), (row, side)
    # Walls yield: of the preload that spacers were ground for, a part is left.
    for side in ("left", "right"):
        axial = [abs(example.wrench(found, side, at["before"])[0]) for found in (rigid, flexible)]
        assert 0.6 * axial[0] < axial[1] < 0.95 * axial[0]
    assert_is_written(ended.stdout)


def assert_is_written(said):
    """Are the tables that the example has printed those of docs/shaft.md? Numbers within half a percent, or 2 in the last digit."""
    written = (ROOT / "docs" / "shaft.md").read_text().split("<!-- begin housing -->")[1].split("<!-- end -->")[0]
    rows_of = lambda text: [line for line in text.splitlines() if line.startswith("| ")]
    number = re.compile(r"\d+(?:\.\d+)?")
    for row, before in zip(rows_of(said), rows_of(written), strict=True):
        assert number.sub("", row) == number.sub("", before)
        for new, of in zip(number.findall(row), number.findall(before), strict=True):
            last = 10.0 ** -len(of.partition(".")[2])
            assert abs(float(new) - float(of)) <= max(0.005 * float(of), 2.001 * last), f"docs/shaft.md is out of date: {row} for {before}"
