"""The rigid pinion shaft of docs/gearbox.md as a package that pythonfmu builds: `pythonfmu build -f shaft.py`. Runs where Python is.

Seats of bearings have the variables that a bearing in pose drive has (`interface.orientation = "shaft"`): places and rates of
the inner race are outputs, forces and moments on the shaft are inputs, all in the axes of the shaft (x along it).

Masters hand values over at communication points, all at once: a bearing that is told a place at one point is there at
the next one, and its force comes back at that one. So the shaft is a step ahead. It is moved by leapfrog; the forces of the
bearings are predicted by a step (`ahead`), mesh and weight are known.
"""

import math
from xml.etree.ElementTree import SubElement

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

SEATS = ("left", "right")
WRENCH = {"force.x": "N", "force.y": "N", "force.z": "N", "moment.y": "N.m", "moment.z": "N.m"}
PLACE = {"position.x": "m", "position.y": "m", "position.z": "m", "rotation.y": "rad", "rotation.z": "rad"}
RATES = {"velocity.x": "m/s", "velocity.y": "m/s", "velocity.z": "m/s", "rotation_rate.y": "rad/s", "rotation_rate.z": "rad/s"}
# Unit, start value, meaning.
PARAMETERS = {
    "mass": ("kg", 1.8, "shaft and pinion"),
    "inertia.polar": ("kg.m2", 6e-4, "about the axis"),
    "inertia.transverse": ("kg.m2", 4e-3, "across the axis, about the middle"),
    "speed": ("rad/s", 6000 * math.pi / 30, "spin about the axis, constant"),
    "gravity": ("m/s2", 9.81, "along -z"),
    "mesh.position": ("m", -0.01, "middle of the pinion along the shaft; its pitch point lies in the direction of y"),
    "mesh.torque": ("N.m", 30.0, "transmitted, when it is on"),
    "mesh.rise": ("s", 0.01, "time in which the torque comes on"),
    "mesh.ripple": ("1", 0.1, "part of the torque that swings at mesh frequency"),
    "mesh.teeth": ("1", 23.0, "number of teeth"),
    "mesh.pitch_radius": ("m", 0.0238, "pitch radius"),
    "mesh.pressure_angle": ("rad", math.radians(20), "pressure angle, normal"),
    "mesh.helix_angle": ("rad", math.radians(-15), "helix angle, positive for right-hand teeth"),
} | {f"{seat}.{key}": value for seat, at in zip(SEATS, (-0.05, 0.05)) for key, value in {
    "along": ("m", at, "middle of the bearing along the shaft"),
    "offset": ("m", 0.0, "position.x of the race at the start, when the shaft is at 0")}.items()}
BASE = {"1": {}, "kg": {"kg": 1}, "m": {"m": 1}, "s": {"s": 1}, "rad": {"rad": 1}, "m/s": {"m": 1, "s": -1}, "rad/s": {"rad": 1, "s": -1},
        "m/s2": {"m": 1, "s": -2}, "N": {"kg": 1, "m": 1, "s": -2}, "N.m": {"kg": 1, "m": 2, "s": -2}, "kg.m2": {"kg": 1, "m": 2}}


# Of the values one to four steps back, for the next one: a straight line is met, delay has no part of third order (which would drive
# vibration), and of what else is possible with four the sum of squares is least (a parabola through three makes noise at high frequency grow).
WEIGHTS = (13 / 7, -2 / 7, -1.0, 3 / 7)


def ahead(past):
    """The next one of equally spaced lists of values, from the last four, the newest first."""
    return [sum(weight * values[k] for weight, values in zip(WEIGHTS, past)) for k in range(len(past[0]))]


class Shaft(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.units = {}
        self.set = {name: start for name, (_, start, _) in PARAMETERS.items()}
        self.place, self.rates = [0.0] * 5, [0.0] * 5  # of the shaft's middle: x, y, z, about y, about z
        self.told = [0.0] * 5, [0.0] * 5  # place and rates that lead the bearings there within a step
        self.on_seats = {seat: [0.0] * 5 for seat in SEATS}
        self.past = []
        for name, (unit, _, meaning) in PARAMETERS.items():
            self.add(name, unit, Fmi2Causality.parameter, self.set, name, meaning)
        for seat in SEATS:
            for k, (name, unit) in enumerate(WRENCH.items()):
                self.add(f"{seat}.{name}", unit, Fmi2Causality.input, self.on_seats[seat], k)
            for k, ((place, unit), (rate, of_rate)) in enumerate(zip(PLACE.items(), RATES.items())):
                self.give(f"{seat}.{place}", unit, lambda k=k, seat=seat: self.at(0, k, seat))
                self.give(f"{seat}.{rate}", of_rate, lambda k=k, seat=seat: self.at(1, k, seat))
            self.give(f"{seat}.speed", "rad/s", lambda: self.set["speed"])

    def add(self, name, unit, causality, values, key, meaning=""):
        """A variable that is set."""
        self.units[name] = unit
        fixed = {"variability": Fmi2Variability.fixed} if causality == Fmi2Causality.parameter else {}
        put = lambda value: values.__setitem__(key, value)
        self.register_variable(Real(name, causality=causality, start=values[key], getter=lambda: values[key], setter=put, description=meaning, **fixed))

    def give(self, name, unit, get):
        """An output."""
        self.units[name] = unit
        self.register_variable(Real(name, causality=Fmi2Causality.output, getter=get))

    def to_xml(self, *arguments, **options):
        """The model description with what pythonfmu leaves out: units, and what is known after the initialization."""
        root = super().to_xml(*arguments, **options)
        definitions = root.makeelement("UnitDefinitions", {})
        for name, exponents in BASE.items():
            SubElement(SubElement(definitions, "Unit", name=name), "BaseUnit", {base: str(power) for base, power in exponents.items()})
        root.insert(1, definitions)
        for variable in root.iter("ScalarVariable"):
            variable.find("Real").set("unit", self.units[variable.get("name")])
        structure = root.find("ModelStructure")
        SubElement(structure, "InitialUnknowns").extend(structure.find("Outputs"))
        return root

    def at(self, which, k, seat):
        """Component of place (0) or rates (1) of the race at a seat."""
        values, along = self.told[which], self.set[f"{seat}.along"]
        start = self.set[f"{seat}.offset"] if (which, k) == (0, 0) else 0.0
        return start + values[k] + {1: values[4] * along, 2: -values[3] * along}.get(k, 0.0)

    def load(self, time):
        """Wrench of mesh and weight about the middle [N, N m] at a time [s]."""
        of = lambda name: self.set[f"mesh.{name}"]
        on = 0.5 - 0.5 * math.cos(math.pi * min(time / of("rise"), 1.0))
        tangential = of("torque") / of("pitch_radius") * on * (1 + of("ripple") * math.sin(of("teeth") * self.set["speed"] * time))
        helix, radius, position = of("helix_angle"), of("pitch_radius"), of("position")
        x, y, z = -tangential * math.tan(helix), -tangential * math.tan(of("pressure_angle")) / math.cos(helix), tangential
        return [x, y, z - self.set["mass"] * self.set["gravity"], -position * z, position * y - radius * x]

    def do_step(self, current_time, step_size):
        total = [0.0] * 5
        for seat in SEATS:
            (x, y, z, about_y, about_z), along = self.on_seats[seat], self.set[f"{seat}.along"]
            total = [a + b for a, b in zip(total, (x, y, z, about_y - along * z, about_z + along * y))]
        self.past = [total, *(self.past or [total] * 3)[:3]]
        force = [a + b for a, b in zip(ahead(self.past), self.load(current_time + step_size))]
        before, transverse = self.rates, self.set["inertia.transverse"]
        # The gyroscopic moment turns the rate of the tilt, taken as a complex number: half of it before and half after the kick.
        turn = 0.5j * step_size * self.set["inertia.polar"] * self.set["speed"] / transverse
        tilt = (complex(*before[3:]) * (1 + turn) + step_size / transverse * complex(*force[3:])) / (1 - turn)
        self.rates = [a + step_size * b / self.set["mass"] for a, b in zip(before[:3], force)] + [tilt.real, tilt.imag]
        self.place = [a + step_size * b for a, b in zip(self.place, self.rates)]
        # Rates are those in the middle of a step: half a step on at its end.
        end = [1.5 * b - 0.5 * a for a, b in zip(before, self.rates)]
        self.told = [a - step_size * b for a, b in zip(self.place, end)], end
        return True
