#!/usr/bin/env python3
"""Makes the questions of this folder from the reference data of the project (tests/data) and from closed forms. Nothing here calls roulement.

Usage: make.py [FOLDER]     writes questions.csv, contacts.csv and scenes/ into this folder, or into another
"""

import csv
import json
import math
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
DATA = ROOT / "tests" / "data"

JONES = "independent Jones and Harris solver (tests/data/bearing)"
ENERGY = "conservation of energy"
SKF = "SKF's model of friction (Rolling bearings, 2016, pages 105 and 106), a fit and no measurement of one bearing"


class Questions:
    """Rows of questions.csv, and the scenes that they ask about."""

    def __init__(self):
        self.rows, self.scenes = [], {}

    def ask(self, name, family, quantity, unit, value, tolerance, file, source):
        """Adds a question; value and tolerance in the unit."""
        value, tolerance = f"{value:.9g}", f"{tolerance:.3g}"
        row = {"id": name, "family": family, "quantity": quantity, "unit": unit, "value": value, "tolerance": tolerance, "file": file, "source": source}
        self.rows.append(row)

    def scene(self, name, text):
        """Adds a scene; the file that questions name."""
        self.scenes[name] = text
        return f"scenes/{name}.toml"


def toml(key, value):
    """A line of a scene; numbers with all their digits."""
    if isinstance(value, dict):
        inside = ", ".join(toml(name, of) for name, of in value.items())
        return f"{key} = {{ {inside} }}"
    return f"{key} = {value!r}"


def section(name, values):
    """A section of a scene."""
    return "\n".join([f"[{name}]", *(toml(key, value) for key, value in values.items())]) + "\n"


# --- Equilibria --------------------------------------------------------------------------------------------------------------


def equilibria(questions):
    """20 bearings of chance at rest and at speed: loads, angles, displacements, cage speed."""
    for case in json.loads((DATA / "bearing" / "equilibrium.json").read_text())["cases"]:
        bearing = {key: value for key, value in case["bearing"].items() if not isinstance(value, dict)}
        text = f"# {case['family']}, {case['kind']}. Gyroscopic moments are carried by friction at the outer race (Jones). SI units, radians.\n"
        text += section("bearing", bearing) + section("ball", case["bearing"]["ball"]) + section("race", case["bearing"]["race"])
        speeds = {"inner_speed": case["inner_speed"], "outer_speed": case["outer_speed"]}
        text += section("load", speeds | case["conditions"])
        file = questions.scene(case["id"], text)
        right = case["outer_race_control"]
        balls = right["balls"]
        largest = max(balls["inner_load"])
        most = balls["inner_load"].index(largest)
        ask = lambda quantity, unit, value, tolerance: questions.ask(
            f"{case['id']}.{quantity}", "equilibria", quantity, unit, value, tolerance, file, JONES
        )
        # [-] loads and displacements within a percent, angles within half a degree: what models of one kind should agree in.
        ask("largest_inner_load", "N", largest, 0.01 * largest)
        ask("largest_outer_load", "N", max(balls["outer_load"]), 0.01 * largest)
        ask("inner_contact_angle_there", "deg", math.degrees(balls["inner_contact_angle"][most]), 0.5)
        ask("outer_contact_angle_there", "deg", math.degrees(balls["outer_contact_angle"][most]), 0.5)
        place = right["displacement"]
        size = max(abs(place[axis]) for axis in "xyz")
        for axis in "xyz":
            if "displacement" not in case["conditions"].get(axis, {}):
                ask(f"displacement.{axis}", "um", 1e6 * place[axis], 1e4 * size)
        if right["cage_speed"]:
            ask("cage_speed", "rad/s", right["cage_speed"], 0.005 * abs(right["cage_speed"]))


# Fa [N], speed [rpm], angles [deg], loads [N], axial shift [um]: tests/data/bearing/README.md.
OF_218 = [
    (17800, 0, 41.502, 41.502, 1678.9, 1678.9, 36.096),
    (17800, 6000, 44.750, 38.005, 1580.2, 1738.9, 33.01),
    (17800, 10000, 50.030, 31.224, 1451.6, 1925.5, 14.46),
    (17800, 15000, 56.868, 19.037, 1328.5, 2736.0, -49.16),
    (22250, 10000, 48.773, 33.531, 1849.0, 2307.9, 27.24),
    (44500, 6000, 44.025, 41.208, 4002.0, 4157.6, 63.98),
    (44500, 15000, 50.847, 32.929, 3586.6, 4629.6, 45.00),
]


def bearing_218(questions):
    """The 218 of the textbooks under thrust, up to 15,000 rpm."""
    source = f"{JONES}; an independent public code agrees within 0.03 deg and 0.2 %"
    for thrust, rpm, *right in OF_218:
        name = f"218-{thrust}N-{rpm}rpm"
        bearing = {"balls": 16, "ball_diameter": 0.02223, "pitch_diameter": 0.12526, "contact_angle": math.radians(40.0)}
        bearing |= {"inner_conformity": 0.5232, "outer_conformity": 0.5232}
        held = {"displacement": 0.0}
        load = {"inner_speed": rpm * math.tau / 60.0, "x": {"force": float(thrust)}, "y": held, "z": held}
        load |= {"ry": {"rotation": 0.0}, "rz": {"rotation": 0.0}}
        text = "# Angular contact bearing 218. Gyroscopic moments are carried by friction at the outer race (Jones). SI units, radians.\n"
        text += section("bearing", bearing) + section("ball", {"density": 7870.0}) + section("load", load)
        file = questions.scene(name, text)
        for quantity, unit, value, tolerance in zip(
            ["inner_contact_angle_there", "outer_contact_angle_there", "largest_inner_load", "largest_outer_load", "displacement.x"],
            ["deg", "deg", "N", "N", "um"],
            right,
            [0.2, 0.2, 0.01 * right[2], 0.01 * right[3], 0.5],
        ):
            questions.ask(f"{name}.{quantity}", "equilibria", quantity, unit, value, tolerance, file, source)


# --- Contacts ----------------------------------------------------------------------------------------------------------------


def contacts(questions, rows):
    """100 rolling contacts of chance: creep forces and spin moment."""
    with open(DATA / "contact" / "random.csv", newline="") as file:
        for row in csv.DictReader(file):
            inputs = list(row)[: list(row).index("fx")]
            rows.append({key: row[key] for key in inputs})
            for quantity, unit in (("fx", "mu N"), ("fy", "mu N"), ("mz", "mu N c")):
                # What the reference itself may be off, and a hundredth of the friction limit.
                tolerance = 0.01 + float(row["grid_error"])
                source = "public boundary-element code for rolling contact, extrapolated to cells of no size (tests/data/contact)"
                questions.ask(f"{row['id']}.{quantity}", "contacts", quantity, unit, float(row[quantity]), tolerance, "contacts.csv", source)


# --- Torque ------------------------------------------------------------------------------------------------------------------

# Name: mean diameter, bore, outside diameter [mm], C0 [N], balls, ball diameter [mm], diametral clearance [m].
BEARINGS = {"6206": (46.0, 30.0, 62.0, 11.2e3, 9, 9.525, 10e-6), "6210": (70.0, 50.0, 90.0, 23.2e3, 10, 12.7, 12e-6)}
BOUNDARY = 0.12
DENSITY = 880.0
# Bearing, radial and axial load [N], speed [rpm], kinematic viscosity [mm2/s].
POINTS = [
    ("6206", 1000, 0, 1500, 32),
    ("6206", 2000, 0, 6000, 32),
    ("6206", 2000, 500, 6000, 32),
    ("6206", 500, 0, 500, 10),
    ("6206", 3000, 1000, 3000, 68),
    ("6206", 1500, 0, 100, 19.9),
    ("6206", 1500, 0, 300, 19.9),
    ("6206", 1500, 0, 1000, 19.9),
    ("6206", 1500, 0, 3000, 19.9),
    ("6206", 1500, 0, 6000, 19.9),
    ("6206", 1500, 0, 12000, 19.9),
    ("6206", 500, 0, 3000, 32),
    ("6206", 500, 0, 12000, 15),
    ("6206", 3000, 0, 1500, 32),
    ("6206", 0, 1000, 3000, 32),
    ("6206", 1000, 1000, 6000, 32),
    ("6210", 2000, 0, 500, 68),
    ("6210", 2000, 0, 3000, 32),
    ("6210", 4000, 0, 1500, 32),
    ("6210", 1000, 0, 8000, 15),
]


def skf(bearing, radial, axial, speed, viscosity, boundary):
    """Rolling and sliding moment [N mm] of SKF's model for deep groove bearings of the series 62 in an oil bath."""
    mean, bore, outside, static, *_ = BEARINGS[bearing]
    if axial:
        sine = math.sin(math.radians(24.6 * (axial / static) ** 0.24))
        rolling = 3.9e-7 * mean**1.96 * (radial + 1.7 / sine * axial) ** 0.54
        sliding = 3.23e-3 * mean**-0.145 * (radial**5 + 36.5 * mean**1.5 / sine * axial**4) ** (1 / 3)
    else:
        rolling = 3.9e-7 * mean**1.96 * radial**0.54
        sliding = 3.23e-3 * mean**-0.26 * radial ** (5 / 3)
    heating = 1.0 / (1.0 + 1.84e-9 * (speed * mean) ** 1.28 * viscosity**0.64)
    starving = math.exp(-3e-8 * viscosity * speed * (bore + outside) * math.sqrt(3.1 / (2.0 * (outside - bore))))
    touching = math.exp(-2.6e-8 * (speed * viscosity) ** 1.4 * mean)
    friction = touching * boundary + (1.0 - touching) * 0.05
    return heating * starving * rolling * (viscosity * speed) ** 0.6, friction * sliding


def torque(questions):
    """Friction torque of whole bearings in oil."""
    for bearing, radial, axial, rpm, viscosity in POINTS:
        mean, bore, outside, _, balls, diameter, clearance = BEARINGS[bearing]
        name = f"{bearing}-{radial}N-{axial}N-{rpm}rpm-{viscosity:g}mm2s"
        # For the conformities, which no catalogue tells, those that are usual.
        text = f"# {bearing} in an oil bath, settled; mean friction torque. SI units.\n"
        text += section("bearing", {"balls": balls, "ball_diameter": diameter * 1e-3, "pitch_diameter": mean * 1e-3, "diametral_clearance": clearance, "inner_conformity": 0.52, "outer_conformity": 0.53})
        text += section("friction", {"ball_race": BOUNDARY}) + "[effects]\nhysteresis = true\n"
        text += section("film", {"viscosity": round(viscosity * 1e-6 * DENSITY, 12), "temperature_viscosity": 0.045, "bore": bore * 1e-3, "outside": outside * 1e-3})
        text += '[inner]\ndrive = "wrench"\nmass = 1.0\ninertia = [6e-4, 5e-4, 5e-4]\n'
        load = {"inner_speed": rpm * math.tau / 60.0, "x": {"force": float(axial)}, "y": {"force": float(radial)}, "z": {"displacement": 0.0}}
        load |= {"ry": {"rotation": 0.0}, "rz": {"rotation": 0.0}}
        # Ten passages of a ball or more, of which the second half counts.
        cage = 0.5 * rpm / 60.0 * (1.0 - diameter / mean)
        load |= {"duration": round(max(0.02, 2.0 / (balls * cage)), 6), "output_interval": 1e-3}
        text += section("load", load) + '[solver]\naccuracy = "balanced"\n'
        file = questions.scene(name, text)
        right = sum(skf(bearing, radial, axial, rpm, viscosity, BOUNDARY))
        # [-] what models of the torque differ from each other and from measurements.
        questions.ask(f"{name}.torque", "torque", "friction_torque", "N mm", right, 0.3 * right, file, SKF)


# --- Hard cases --------------------------------------------------------------------------------------------------------------

BALL, PITCH, COUNT, ANGLE, THRUST = 9.525e-3, 46e-3, 10, math.radians(25.0), 1500.0


def elliptic(m):
    """Complete elliptic integrals K and E of a parameter, by the arithmetic-geometric mean."""
    a, b, c, power, total = 1.0, math.sqrt(1.0 - m), math.sqrt(m), 1.0, 0.0
    while abs(c) > 1e-16:
        total += 0.5 * power * c * c
        a, b, c, power = 0.5 * (a + b), math.sqrt(a * b), 0.5 * (a - b), 2.0 * power
    k = 0.5 * math.pi / a
    return k, k * (1.0 - total)


def hertz(curvatures):
    """[N/m^1.5] stiffness of a steel contact from its curvatures along and across [1/m], E 206 GPa, nu 0.3 (Harris and Kotzalas 2006, chapter 6)."""
    total = sum(curvatures)
    difference = abs(curvatures[0] - curvatures[1]) / total
    low, high = 1.0 + 1e-9, 1e3
    for _ in range(200):
        kappa = math.sqrt(low * high)
        k, e = elliptic(1.0 - kappa**-2)
        found = ((kappa**2 + 1.0) * e - 2.0 * k) / ((kappa**2 - 1.0) * e)
        low, high = (kappa, high) if found < difference else (low, kappa)
    k, e = elliptic(1.0 - kappa**-2)
    shape = 2.0 * k / math.pi * (math.pi / (2.0 * kappa**2 * e)) ** (1.0 / 3.0)
    compliance = 2.0 * (1.0 - 0.3**2) / 206e9
    # Approach d = shape (3/2 Q compliance/total)^(2/3) total/2.
    return (shape * total / 2.0) ** -1.5 * total / (1.5 * compliance)


def between_races():
    """[N/m^1.5] a ball between its two races, Q = K (d_i + d_o)^1.5, conformities 0.52."""
    ratio = BALL * math.cos(ANGLE) / PITCH
    along = lambda sign: 2.0 / BALL + sign * 2.0 / BALL * ratio / (1.0 - sign * ratio)
    contact = lambda sign: hertz([along(sign), 2.0 / BALL - 1.0 / (0.52 * BALL)])
    return (contact(1.0) ** (-2.0 / 3.0) + contact(-1.0) ** (-2.0 / 3.0)) ** -1.5


def pressed():
    """Of ten balls under thrust at rest: shift [m], slope of the force [N/m], contact angle [rad]."""
    free, stiffness = 0.04 * BALL, between_races()

    def force(x):
        axial, radial = free * math.sin(ANGLE) + x, free * math.cos(ANGLE)
        length = math.hypot(axial, radial)
        return COUNT * stiffness * max(0.0, length - free) ** 1.5 * axial / length

    low, high = 0.0, 1e-3
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if force(middle) < THRUST else (low, middle)
    slope = (force(low + 1e-9) - force(low - 1e-9)) / 2e-9
    return low, slope, math.atan2(free * math.sin(ANGLE) + low, free * math.cos(ANGLE))


def thrust_bearing(**more):
    """A scene of ten balls under thrust."""
    parts = {"bearing": {"balls": COUNT, "ball_diameter": BALL, "pitch_diameter": PITCH, "contact_angle": ANGLE, "inner_conformity": 0.52, "outer_conformity": 0.52}}
    held = {"y": {"displacement": 0.0}, "z": {"displacement": 0.0}, "ry": {"rotation": 0.0}, "rz": {"rotation": 0.0}}
    parts |= {"friction": {"ball_race": 0.08}, "inner": {"drive": "wrench", "mass": 1.0, "inertia": [6e-4, 5e-4, 5e-4]}}
    # How exact a run has to be is no part of the question: steps with which ours does not show.
    parts |= {"effects": {}, "solver": {"tolerance": 1e-7, "max_step": 1e-5}, "load": {"x": {"force": THRUST}} | held}
    for name, values in more.items():
        parts[name] = parts.get(name, {}) | values
    return "".join(section(name, values) for name, values in parts.items() if values)


# Scenes that break models: files of the project, what is hard about them, and how long they run [s].
HARD = {
    "stop-and-reverse": ("tests/data/rest/stop_and_reverse.toml", "slows down, stands still under load and turns back"),
    "oscillating": ("tests/data/rest/oscillating.toml", "swings through rest"),
    "tilted": ("scenes/misalignment.toml", "tilted by 1 mrad while it turns"),
    "rattling-cage": ("scenes/cage.toml", "a cage that balls strike"),
    "spall": ("scenes/effects/spall.toml", "balls drop into a spall"),
}


def hard_cases(questions):
    """Closed forms in motion, and energy where impacts and rest make it hard."""
    _, slope, angle = pressed()
    ratio = BALL * math.cos(angle) / PITCH
    for inner, outer in ((300, 0), (300, -120), (100, 250), (0, 300)):
        name = f"turning-{inner}-{outer}rpm"
        load = {"inner_speed": inner * math.tau / 60.0, "outer_speed": outer * math.tau / 60.0, "duration": 0.02, "output_interval": 1e-4}
        file = questions.scene(name, "# Both rings turn, slowly; mean cage speed. SI units.\n" + thrust_bearing(load=load))
        right = 0.5 * (inner * (1.0 - ratio) + outer * (1.0 + ratio)) * math.tau / 60.0
        tolerance = 0.003 * (inner + abs(outer)) * math.tau / 60.0
        questions.ask(f"{name}.cage_speed", "hard", "cage_speed", "rad/s", right, tolerance, file, "kinematics of rolling at the contact angle under load")
    balls = COUNT * 7800.0 * BALL**3 * math.pi / 6.0
    # Half of the balls' displacement is the race's: a quarter of their mass moves along.
    right = math.sqrt(slope / (20.0 + 0.25 * balls)) / math.tau
    more = {"inner": {"mass": 20.0}, "effects": {"creep": "frictionless"}, "start": {"inner_velocity": [2e-4, 0.0, 0.0], "spin_balance": False}}
    more["load"] = {"inner_speed": 0.0, "duration": 0.06, "output_interval": 1e-5}
    text = thrust_bearing(**more).replace("'", '"').replace("False", "false")
    file = questions.scene("vibration", "# A heavy race, struck along the axis; without friction and damping. SI units.\n" + text)
    questions.ask("vibration.frequency", "hard", "frequency", "Hz", right, 0.002 * right, file, "root of Hertz's stiffness over the mass")
    for name, (path, what) in HARD.items():
        file = questions.scene(name, f"# {what[0].upper()}{what[1:]}; the energy that is not accounted for, over work and losses together.\n" + (ROOT / path).read_text())
        questions.ask(f"{name}.energy", "hard", "energy_left_open", "%", 0.0, 1.0, file, ENERGY)


def main(folder):
    """Writes all files."""
    questions, rows = Questions(), []
    equilibria(questions)
    bearing_218(questions)
    contacts(questions, rows)
    torque(questions)
    hard_cases(questions)
    (folder / "scenes").mkdir(parents=True, exist_ok=True)
    for name, text in questions.scenes.items():
        (folder / "scenes" / f"{name}.toml").write_text(text)
    for name, table in (("questions.csv", questions.rows), ("contacts.csv", rows)):
        with open(folder / name, "w", newline="") as file:
            writer = csv.DictWriter(file, table[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(table)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).resolve().parent)
