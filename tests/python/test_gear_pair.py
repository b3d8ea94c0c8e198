"""Two shafts on linear bearings and a helical mesh that varies, against a model of its own: rigid bodies and springs, advanced by the classical method of Runge and Kutta.

The only thing that both have in common are the data here. Bearings are springs; one more shaft, which touches nothing, has a bearing with balls, as a scene needs one.
"""

import csv
import math

import numpy

from conftest import roulement

TEETH = (21, 38)
MODULE, HELIX, PRESSURE = 2e-3, math.radians(18), math.radians(20)
STIFFNESS, VARIES, DAMPING_RATIO = 1.5e8, 0.2, 0.03
SPEED, TORQUE = 160.0, 60.0  # rad/s of the first shaft; N m on the second
MASS = (1.4, 2.2)
POLAR = (6e-4, 2.4e-3)
TRANSVERSE = (2.5e-3, 4e-3)
PLACES = ((-0.045, 0.06), (-0.05, 0.05))  # m, bearings along each shaft
RADIAL, AXIAL, RADIAL_DAMPING, AXIAL_DAMPING = (2.2e8, 1.6e8), (9e7, 7e7), (900.0, 700.0), (500.0, 400.0)
GEAR = (0.008, 0.012)  # m, the gears along the shafts
END, ROW = 8e-3, 2e-5  # s

DISTANCE = MODULE * sum(TEETH) / (2 * math.cos(HELIX))


def scene():
    """The same in the words of the program."""
    text = ""
    for index, name in enumerate(("one", "two")):
        drive = f"speed = {SPEED}" if index == 0 else f"torque = {TORQUE}"
        # The middles of both gears lie in one plane.
        origin = [GEAR[0] - GEAR[1], 0.0, DISTANCE] if index else [0.0, 0.0, 0.0]
        text += f"""
[[shaft]]
name = "{name}"
origin = {origin}
{drive}
mass = {MASS[index]}
polar_inertia = {POLAR[index]}
transverse_inertia = {TRANSVERSE[index]}
"""
        for side, place in zip(("left", "right"), PLACES[index], strict=True):
            text += f"""
[[bearing]]
name = "{name}_{side}"
shaft = "{name}"
stiffness = {{ radial = {RADIAL[index]}, axial = {AXIAL[index]}, radial_damping = {RADIAL_DAMPING[index]}, axial_damping = {AXIAL_DAMPING[index]} }}
mounting = {{ position = {place} }}
"""
    return text + f"""
[[shaft]]
name = "idle"
origin = [0, 0.5, 0]
speed = 1
mass = 1
polar_inertia = 1e-3
transverse_inertia = 1e-3

[[bearing]]
name = "front"
shaft = "idle"
catalogue = "6205"
mounting = {{ position = -0.04, preload = {{ force = 100 }} }}

[[bearing]]
name = "back"
shaft = "idle"
catalogue = "6205"
mounting = {{ position = 0.04, direction = "-x", preload = {{ force = 100 }} }}

[[mesh]]
name = "teeth"
normal_module = {MODULE}
helix_angle = {HELIX}
stiffness = {STIFFNESS}
damping_ratio = {DAMPING_RATIO}
backlash = 0.0002
stiffness_variation = [{{ amplitude = {VARIES}, phase = {math.pi / 2} }}]
gears = [
    {{ shaft = "one", position = {GEAR[0]}, teeth = {TEETH[0]}, face_width = 0.02 }},
    {{ shaft = "two", position = {GEAR[1]}, teeth = {TEETH[1]}, face_width = 0.02 }},
]

[solver]
max_step = "2 us"
initial_step = "1 us"

[load]
duration = {END}
output_interval = {ROW}
"""


class Model:
    """x, y, z, ry, rz of both shafts, and how far the second one turns beyond what the teeth make of the first one's turn."""

    def __init__(self):
        transverse = math.atan(math.tan(PRESSURE) / math.cos(HELIX))
        base_helix = math.asin(math.sin(HELIX) * math.cos(PRESSURE))
        radii = [DISTANCE * teeth / sum(TEETH) for teeth in TEETH]
        # The second axis is at +z of the first. A tooth there goes along -y, and is pressed back, away from the other gear, and, right-hand, along +x.
        normal = numpy.array([
            math.sin(base_helix),
            math.cos(base_helix) * math.cos(transverse),
            -math.cos(base_helix) * math.sin(transverse),
        ])
        arms = [numpy.array([GEAR[0], 0, radii[0]]), numpy.array([GEAR[1], 0, -radii[1]])]
        # Approach of the teeth by the coordinates: minus what the normal sees of the first body's motion at the pitch point less the second's.
        self.approach = numpy.zeros(11)
        for index, (arm, sign) in enumerate(zip(arms, (-1, 1), strict=True)):
            moment = numpy.cross(arm, normal)
            own = 5 * index
            self.approach[own : own + 3] = sign * normal
            self.approach[own + 3 : own + 5] = sign * moment[1:]
        self.approach[10] = numpy.cross(arms[1], normal)[0]
        mass, polar = numpy.zeros(11), numpy.array(POLAR)
        self.stiffness, self.damping = numpy.zeros((11, 11)), numpy.zeros((11, 11))
        for index in range(2):
            own = 5 * index
            mass[own : own + 5] = [MASS[index]] * 3 + [TRANSVERSE[index]] * 2
            for place in PLACES[index]:
                for row, factors in ((0, {0: 1.0}), (1, {1: 1.0, 4: place}), (2, {2: 1.0, 3: -place})):
                    way = numpy.zeros(11)
                    for column, factor in factors.items():
                        way[own + column] = factor
                    k = AXIAL[index] if row == 0 else RADIAL[index]
                    c = AXIAL_DAMPING[index] if row == 0 else RADIAL_DAMPING[index]
                    self.stiffness += k * numpy.outer(way, way)
                    self.damping += c * numpy.outer(way, way)
            # Angular momentum of the spin turns with the axis (1, rz, -ry).
            spin = SPEED if index == 0 else -SPEED * TEETH[0] / TEETH[1]
            self.damping[own + 3, own + 4] += polar[index] * spin
            self.damping[own + 4, own + 3] -= polar[index] * spin
        mass[10] = POLAR[1]
        self.mass = mass
        bases = [radius * math.cos(transverse) * math.cos(base_helix) for radius in radii]
        mobility = sum(base**2 / inertia for base, inertia in zip(bases, POLAR, strict=True))
        self.mesh_damping = 2 * DAMPING_RATIO * math.sqrt(STIFFNESS / mobility)
        self.load = numpy.zeros(11)
        self.load[10] = TORQUE
        # Teeth touch after half the backlash, and come in over 0.1 um.
        self.free = 0.5 * 0.0002 + 0.5e-7
        pressed = self.stiffness + STIFFNESS * numpy.outer(self.approach, self.approach)
        self.start = numpy.linalg.solve(pressed, self.load + self.approach * STIFFNESS * self.free)

    def normal_force(self, time, place, rate):
        # Teeth come and go as the first gear turns against the line of centres that both take along: the second one has its share.
        turned = SPEED * time - TEETH[1] / sum(TEETH) * place[10]
        varied = STIFFNESS * (1 + VARIES * math.sin(TEETH[0] * turned))
        return varied * (self.approach @ place - self.free) + self.mesh_damping * (self.approach @ rate)

    def acceleration(self, time, place, rate):
        force = self.load - self.stiffness @ place - self.damping @ rate
        return (force - self.approach * self.normal_force(time, place, rate)) / self.mass

    def run(self, step=2e-6):
        """Rows of normal force, and of the forces of the left bearing of the first shaft on it."""
        place, rate = self.start.copy(), numpy.zeros(11)
        rows, per_row = [], round(ROW / step)
        for n in range(round(END / step) + 1):
            time = n * step
            if n % per_row == 0:
                left = PLACES[0][0]
                y, vy = place[1] + left * place[4], rate[1] + left * rate[4]
                z, vz = place[2] - left * place[3], rate[2] - left * rate[3]
                bearing = [-RADIAL[0] * y - RADIAL_DAMPING[0] * vy, -RADIAL[0] * z - RADIAL_DAMPING[0] * vz]
                rows.append([self.normal_force(time, place, rate), *bearing])
            a = self.acceleration(time, place, rate)
            b = self.acceleration(time + step / 2, place + rate * step / 2, rate + a * step / 2)
            c = self.acceleration(time + step / 2, place + rate * step / 2 + a * step**2 / 4, rate + b * step / 2)
            d = self.acceleration(time + step, place + rate * step + b * step**2 / 2, rate + c * step)
            place = place + rate * step + (a + b + c) * step**2 / 6
            rate = rate + (a + 2 * b + 2 * c + d) * step / 6
        return numpy.array(rows)


def test_a_gear_pair_moves_as_a_model_of_its_own(tmp_path):
    file = tmp_path / "pair.toml"
    file.write_text(scene())
    roulement("run", file, "-o", tmp_path / "run")
    with (tmp_path / "run" / "shaft.csv").open(newline="") as table:
        lines = csv.reader(table)
        names = [name.split(" ")[0] for name in next(lines)]
        wanted = [names.index(name) for name in ("teeth.normal_force", "one_left.force.y", "one_left.force.z")]
        found = numpy.array([[float(line[column]) for column in wanted] for line in lines])
    expected = Model().run()
    assert found.shape == expected.shape
    # Both swing: the comparison is no one of means alone.
    assert numpy.ptp(expected[:, 0]) > 0.2 * expected[:, 0].mean()
    apart = numpy.abs(found - expected).max(axis=0) / numpy.abs(expected).max(axis=0)
    assert (apart < 0.01).all(), apart
