"""The implicit recipe at a shaft's package: its outer races sit in a housing outside, which the importer moves."""

import numpy as np
import pytest
from conftest import Slave, build
from roulement.coupling import FmuBearing, FmuHousing, Implicit, Leapfrog, rigid

MASS, TILTING = 4.0, 0.03  # of the housing outside [kg, kg m2]
STIFFNESS, DAMPING = np.array([2e7, 2e7, 2e7, 2e5, 2e5]), np.array([4e3, 4e3, 4e3, 30.0, 30.0])  # of what holds it, at its origin
PUSH = 400.0  # [N] on the housing along y, which comes on within 0.2 ms
SEATS = [("left", -0.05, 1), ("right", 0.05, -1)]
MESH = np.array([200.0, -475.0, 1260.0])  # [N] on the shaft, 10 mm from the origin of the housing
LOAD = np.array([*MESH, -0.01 * MESH[2], 0.01 * MESH[1]])  # that about this origin [N, N m]


def text(of_bearings, of_housing=""):
    """A shaft on two bearings back to back, and how their outer races sit."""
    bearing = lambda name, place, direction: f"""
[[bearing]]
name = "{name}"
catalogue = "7206 B"
mounting = {{ position = {place}, direction = "{'+x' if direction == 1 else '-x'}", preload = {{ force = 800 }}{of_bearings[0]} }}
{of_bearings[1]}
"""
    return f"""
[shaft]
speed = "6000 rpm"
mass = 1.8
polar_inertia = 6e-4
transverse_inertia = 4e-3
[[shaft.load]]
name = "mesh"
position = 0.01
force = [{", ".join(map(str, MESH))}]
{''.join(bearing(*seat) for seat in SEATS)}
{of_housing}
[load]
duration = 0.01
output_interval = 1e-4
[solver]
max_step = 1e-5
"""


class Held(FmuHousing):
    """A housing on springs and dampers to the ground: they hold what the bearings carry at the start."""

    def restart(self):
        super().restart()
        self.moved = np.zeros(5), np.zeros(5)

    def held(self):
        place, velocity = self.moved
        return -STIFFNESS * place - DAMPING * velocity

    def wrench(self):
        return super().wrench() + self.held()

    def step(self, step, place, velocity):
        self.moved = place, velocity
        return super().step(step, place, velocity)

    def derivative(self, step, place_gain, velocity_gain):
        return super().derivative(step, place_gain, velocity_gain) - np.diag(STIFFNESS * place_gain + DAMPING * velocity_gain)


@pytest.fixture(scope="module")
def shaft(tmp_path_factory):
    package = build(text(["", 'set = { outer = { drive = "pose" } }']), tmp_path_factory.mktemp("shaft"), "shaft")
    shaft = Held.load(package, seats=SEATS)
    yield shaft
    shaft.close()


@pytest.fixture(scope="module")
def inside(tmp_path_factory):
    """Place of the housing along x, y, z from the start, a row every 20 us, where it is a part of the machine: springs about x hold it there too."""
    housing = f"""
[[housing]]
name = "case"
mass = {MASS}
inertia = [{TILTING}, {TILTING}, {TILTING}]
centre = [0, 0, 0]
stiffness = [{', '.join(map(str, STIFFNESS[:3]))}, 1e7, {STIFFNESS[3]}, {STIFFNESS[4]}]
damping = [{', '.join(map(str, DAMPING[:3]))}, 1e3, {DAMPING[3]}, {DAMPING[4]}]
[[housing.load]]
name = "push"
position = [0, 0, 0]
force = [0, [[0, 0], [2e-4, {PUSH}]], 0]
"""
    folder = tmp_path_factory.mktemp("inside")
    slave = Slave(build(text([', housing = "case"', ""], housing), folder, "inside"), folder / "unzipped").start()
    places = [f"push.displacement.{axis}" for axis in "xyz"]
    references = [slave.references[name] for name in places]
    path = [slave.fmu.getReal(references)]
    for k in range(512):
        slave.fmu.doStep(2e-5 * k, 2e-5)
        path.append(slave.fmu.getReal(references))
    slave.close()
    return np.array(path) - path[0]


def run(shaft, scheme, step, duration):
    """Places of the housing outside, a row for each communication point; ends early where it is lost."""
    shaft.restart()
    # Balls that were just started creep: not what bearings exert then, but what they are loaded with holds the balance.
    body = scheme(shaft, rigid(MASS, TILTING), lambda time: [0, PUSH * min(time / 2e-4, 1), 0, 0, 0] - LOAD)
    path = [body.place]
    for _ in range(round(duration / step)):
        try:
            body.step(step)
        except Exception:  # the shaft has left its bearings: FMPy has no narrower one
            break
        path.append(body.place)
        if not np.abs(body.place).max() < 1e-2:
            break
    return np.array(path)[:, :3]


def error(shaft, inside, scheme, step, duration=0.00512):
    path, every = run(shaft, scheme, step, duration), round(step / 2e-5)
    exact = inside[::every][: len(path)]
    return np.abs(path - exact).max() / np.abs(inside).max()


def stable(shaft, scheme, step):
    """Does what the push has set in motion die down? The largest speed of the last quarter of a run is below that of the first."""
    steps = max(round(0.04 / step), 60)
    path = run(shaft, scheme, step, steps * step)
    speed = np.linalg.norm(np.diff(path, axis=0), axis=1)
    return len(path) > steps and speed[-(steps // 4) :].max() < speed[: steps // 4].max()


def test_the_implicit_scheme_converges_to_the_housing_inside(shaft, inside):
    errors = [error(shaft, inside, Implicit, step) for step in (2e-5, 4e-5, 8e-5)]
    assert errors[0] < 4e-4 and errors[1] < 2e-3 and errors[2] < 0.01, errors
    # It is of second order, and of no lower one.
    assert errors[2] / errors[1] > 3, errors


def test_the_implicit_scheme_stands_640_us_and_leapfrog_80_us(shaft, inside):
    assert stable(shaft, Implicit, 6.4e-4)
    assert error(shaft, inside, Leapfrog, 8e-5) < 0.01
    # Where its step is longer than the reciprocal of the frequency of housing and shaft on the bearings, it is lost.
    assert not error(shaft, inside, Leapfrog, 1.6e-4) < 1


def test_a_race_of_a_shafts_package_is_that_of_a_bearing(shaft):
    shaft.restart()
    one = FmuBearing(shaft.fmu, shaft.references, race="left.outer")
    whole = FmuHousing(shaft.fmu, shaft.references, [("left", 0.0, 1)])
    assert np.array_equal(one.wrench(), whole.wrench()) and np.abs(one.wrench()[:3]).max() > 100
    # The other one points against the shaft's axis.
    turned = FmuHousing(shaft.fmu, shaft.references, [("right", 0.0, -1)]).wrench()
    assert np.array_equal(turned, FmuBearing(shaft.fmu, shaft.references, race="right.outer").wrench() * [-1, -1, 1, -1, 1])
