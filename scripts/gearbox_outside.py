"""The three-stage gearbox of examples/gearbox as one package, and from the outside: four packages of its shafts, and the meshes in a master. Over the
communication step: what is stable, how large the error of the bearing forces is, and what it costs.

Usage: gearbox_outside.py [--keep]   (--keep: the last results in the document only)

Writes docs/figures/gearbox-outside.csv, and what docs/gearbox.md has of it between `<!-- begin outside of the gearbox -->` and `<!-- end -->`. The torque at the output
grows by a tenth within 0.2 ms. Some minutes of CPU. Needs the program (ROULEMENT_BIN, or that of target/release) and FMPy.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
import time as clock
import tomllib
from pathlib import Path

import numpy as np
import rows_by_step
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "examples/gearbox"))
import gearbox  # noqa: E402

SCENE = ROOT / "examples/gearbox/three_stage.toml"
RESULTS, DOCUMENT = ROOT / "docs/figures/gearbox-outside.csv", ROOT / "docs/gearbox.md"
PROGRAM = os.environ.get("ROULEMENT_BIN", ROOT / "target/release/roulement")
STEPS = [1, 2, 5, 10, 20, 50, 100, 500]  # communication steps [us], parts of LOOK or of which it is a part
LOOK, DURATION = 5e-4, 3e-3  # between looks at the forces, and of a run [s]
STIFFNESS, DAMPING_RATIO = 2e8, 0.05  # of all teeth [N/m, -]
TORQUE = 500.0  # at the output, at first [N m]
TIGHT = {"max_step": 1e-6, "tolerance": 1e-10}
FAR = 5.0  # [-] times the largest force at first, beyond which a run is lost
RATIOS = {"input": 1.0, "second": -23 / 67, "third": 23 / 67 * 13 / 76, "output": -23 / 67 * 13 / 76 * 14 / 87}
UNIT, HELD, AHEAD = "one package", "meshes in the master, held", "meshes in the master, ahead"


def number(text):
    """A length, an angle or a speed of the scene in SI units."""
    value, unit = text.split() if isinstance(text, str) else (text, "")
    return float(value) * {"": 1, "mm": 1e-3, "deg": math.pi / 180, "rpm": 2 * math.pi / 60}[unit]


def toml(value):
    """A value as TOML in one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    return json.dumps(value) if isinstance(value, (str, bool, int)) else repr(float(value))


class Mesh:
    """Two gears in the axes of all shafts: a spring and a damper along the normal of the flank that presses."""

    def __init__(self, section, shafts):
        self.name, gears = section["name"], section["gears"]
        self.shafts = [gear["shaft"] for gear in gears]
        places = [np.array([number(c) for c in shafts[name].get("origin", [0, 0, 0])]) for name in self.shafts]
        teeth = [gear["teeth"] for gear in gears]
        helix, pressure, module = number(section["helix_angle"]), math.radians(20), number(section["normal_module"])
        across = places[1] - places[0]
        across[0] = 0.0
        distance = np.linalg.norm(across)
        towards = across / distance
        transverse = math.atan(math.tan(pressure) / math.cos(helix))
        working = math.acos(module * sum(teeth) / (2 * math.cos(helix)) * math.cos(transverse) / distance)
        base_helix = math.asin(math.sin(helix) * math.cos(pressure))
        # Where a tooth of the first gear goes as it turns about +x; it is pressed back, away from the other gear, and, right-hand, along +x.
        along = np.cross([1, 0, 0], towards)
        drives = math.copysign(1, RATIOS[self.shafts[0]])
        pressed = np.array([math.sin(base_helix), 0, 0]) - math.cos(base_helix) * math.cos(working) * along
        self.normal = drives * pressed - math.cos(base_helix) * math.sin(working) * towards
        radii = [distance * count / sum(teeth) for count in teeth]
        self.arms = [radii[0] * towards, -radii[1] * towards]
        # In the middle of the common face width, along each shaft.
        starts = [place[0] + number(gear["position"]) for place, gear in zip(places, gears)]
        halves = [number(gear["face_width"]) / 2 for gear in gears]
        middle = (max(s - h for s, h in zip(starts, halves)) + min(s + h for s, h in zip(starts, halves))) / 2
        self.positions = [middle - place[0] for place in places]
        self.bases = [radius * math.cos(working) * math.cos(base_helix) for radius in radii]

    def damping(self, inertias):
        """Damping of both shafts turning against each other [N s/m]."""
        mobility = sum(base**2 / inertias[shaft] for base, shaft in zip(self.bases, self.shafts))
        return 2 * DAMPING_RATIO * math.sqrt(STIFFNESS / mobility)

    def wrench(self, end, force):
        """Force and moment on a shaft where the mesh is along its axis, by the normal force [N, N m]."""
        on = (self.normal if end == 0 else -self.normal) * force
        return np.concatenate([on, np.cross(self.arms[end], on)])


def scenes(solver, step_at=1e-3):
    """Text of the file of the whole, of each shaft by itself, and the meshes with their normal forces at first [N]."""
    scene = tomllib.loads(SCENE.read_text())
    shafts = {shaft["name"]: shaft for shaft in scene["shaft"]}
    meshes = [Mesh(section, shafts) for section in scene["mesh"]]
    torque = [[0.0, TORQUE], [step_at, TORQUE], [step_at + 2e-4, 1.1 * TORQUE], [1.0, 1.1 * TORQUE]]
    for name, shaft in shafts.items():
        shaft["torsion"] = False
        shaft.pop("drive_position", None)
        if name == "output":
            shaft["torque"] = torque
    for section in scene["mesh"]:
        section |= {"stiffness": STIFFNESS, "damping_ratio": DAMPING_RATIO, "backlash": 1e-4}
    load = {"duration": DURATION, "output_interval": 1e-4}
    join = lambda parts: "\n".join(f"{key} = {toml(part)}" for key, part in parts.items() if part) + "\n"
    whole = join({"title": "", "solver": solver, "shaft": scene["shaft"], "mesh": scene["mesh"], "bearing": scene["bearing"], "load": load})
    # By the torques that the teeth pass on, from the output back.
    forces, passed = {}, TORQUE
    for mesh in reversed(meshes):
        forces[mesh.name] = passed / mesh.bases[1]
        passed *= mesh.bases[0] / mesh.bases[1]
    alone = {}
    for name, shaft in shafts.items():
        own = {key: value for key, value in shaft.items() if key not in ("name", "origin")}
        if name != "input":
            own |= {"torque": own.get("torque", 0.0), "start_speed": RATIOS[name] * number(shafts["input"]["speed"])}
        own["load"] = []
        for mesh in meshes:
            for end in (0, 1):
                if mesh.shafts[end] == name:
                    wrench = mesh.wrench(end, forces[mesh.name]).tolist()
                    own["load"].append({"name": mesh.name, "position": mesh.positions[end], "force": wrench[:3], "moment": wrench[3:]})
        bearings = [{key: value for key, value in bearing.items() if key != "shaft"} for bearing in scene["bearing"] if bearing["shaft"] == name]
        alone[name] = join({"solver": solver, "shaft": own, "bearing": bearings, "load": load})
    return whole, alone, meshes, forces


class Package:
    """A package in FMPy."""

    def __init__(self, text, folder, name):
        scene, package = folder / f"{name}.toml", folder / f"{name}.fmu"
        scene.write_text(text)
        subprocess.run([PROGRAM, "fmu", scene, "-o", package], check=True, capture_output=True)
        description = read_model_description(str(package))
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        identifier = description.coSimulation.modelIdentifier
        self.fmu = FMU2Slave(guid=description.guid, unzipDirectory=extract(str(package)), modelIdentifier=identifier, instanceName=name)
        self.fmu.instantiate()
        self.radial = sorted(number for name, number in self.references.items() if name.endswith(("inner.force.y", "inner.force.z")))

    def restart(self):
        self.fmu.reset()
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()

    def forces(self):
        return self.fmu.getReal(self.radial)


class Unit:
    """The whole in one package."""

    def __init__(self, text, folder, name):
        self.package = Package(text, folder, name)

    def restart(self):
        self.package.restart()

    def step(self, time, step):
        self.package.fmu.doStep(time, step)

    def forces(self):
        return self.package.forces()


class Master:
    """Shafts in packages of their own; normal forces of the meshes from where these are at a communication point, `ahead` by where their rates, which go on changing, lead to in the step."""

    ACROSS = ["displacement.x", "displacement.y", "displacement.z", "velocity.x", "velocity.y", "velocity.z", "tilt.y", "tilt.z"]

    def __init__(self, alone, meshes, forces, folder, inertias):
        self.shafts = {name: Package(text, folder, name) for name, text in alone.items()}
        self.meshes, self.first, self.ahead = meshes, forces, False
        self.dampings = {mesh.name: mesh.damping(inertias) for mesh in meshes}
        self.ends = []
        for mesh in meshes:
            for end, name in enumerate(mesh.shafts):
                of = self.shafts[name].references
                seen = [of[f"{mesh.name}.{what}"] for what in self.ACROSS] + [of["shaft.angle"], of["shaft.speed"]]
                set_to = [of[f"{mesh.name}.{kind}.{axis}"] for kind in ("force", "moment") for axis in "xyz" if f"{mesh.name}.{kind}.{axis}" in of]
                self.ends.append((mesh, end, self.shafts[name].fmu, seen, set_to))

    def restart(self):
        for shaft in self.shafts.values():
            shaft.restart()
        self.tilts, self.rates = {}, {}
        self.origin = {name: value for name, (value, _) in self.approaches(1.0).items()}

    def approaches(self, step):
        """Approach of the teeth of every mesh along the normal, and its rate [m, m/s], that of tilts over the last step [s]: packages do not tell it."""
        found = {mesh.name: np.zeros(2) for mesh in self.meshes}
        for mesh, end, fmu, seen, _ in self.ends:
            values = np.array(fmu.getReal(seen))
            tilt, turn, sign = values[6:8], values[8:], -1 if end == 0 else 1
            tilting = (tilt - self.tilts.get((mesh.name, end), tilt)) / step
            self.tilts[mesh.name, end] = tilt
            # The turn is that since the start.
            found[mesh.name] += [sign * mesh.normal @ (move + np.cross([turned, *tilted], mesh.arms[end])) for move, turned, tilted in ((values[:3], turn[0], tilt), (values[3:6], turn[1], tilting))]
        return found

    def step(self, time, step):
        approaches = self.approaches(step)
        for mesh, end, fmu, _, set_to in self.ends:
            way, rate = approaches[mesh.name]
            way -= self.origin[mesh.name]
            if self.ahead:
                change = rate - self.rates.get((mesh.name, end), rate)
                self.rates[mesh.name, end] = rate
                way, rate = way + step * (rate + change / 2), rate + change
            wrench = mesh.wrench(end, self.first[mesh.name] + STIFFNESS * way + self.dampings[mesh.name] * rate)
            fmu.setReal(set_to, wrench[: len(set_to)] if len(set_to) == 6 else [*wrench[:3], *wrench[4:]])
        for shaft in self.shafts.values():
            shaft.fmu.doStep(time, step)

    def forces(self):
        return [force for shaft in self.shafts.values() for force in shaft.forces()]


def run(simulation, step):
    """Radial forces of all ball bearings at the looks [N], and CPU time [s]; None where it is lost."""
    simulation.restart()
    rows, begin = [simulation.forces()], clock.process_time()
    count, per_look = round(DURATION / step), max(round(LOOK / step), 1)
    for n in range(count):
        try:
            simulation.step(n * step, step)
        except Exception:
            return None, clock.process_time() - begin
        if (n + 1) % per_look == 0:
            rows.append(simulation.forces())
            if np.abs(rows[-1]).max() > FAR * np.abs(rows[0]).max():
                return None, clock.process_time() - begin
    return np.array(rows), clock.process_time() - begin


def order(unit, master):
    """Places of the master's forces among those of the unit."""
    names = [name for shaft in master.shafts.values() for name, number in sorted(shaft.references.items(), key=lambda item: item[1]) if number in shaft.radial]
    return [unit.package.radial.index(unit.package.references[name]) for name in names]


def measure():
    """Rows of the results."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        whole, alone, meshes, forces = scenes({})
        unit, exactly = Unit(whole, folder, "whole"), Unit(scenes(TIGHT)[0], folder, "exact")
        inertias = polar(folder, whole)
        master = Master(alone, meshes, forces, folder, inertias)
        places = order(unit, master)
        exact, _ = run(exactly, 1e-5)
        exact = exact[:, places]
        size = np.abs(exact[0]).max()
        for way, simulation in ((UNIT, unit), (HELD, master), (AHEAD, master)):
            for step in STEPS:
                if way == UNIT and step < 10:
                    continue
                master.ahead = way == AHEAD
                found, seconds = run(simulation, step * 1e-6)
                row = {"way": way, "step [us]": step, "stable": "no" if found is None else "yes"}
                if found is not None:
                    own = found[:, places] if way == UNIT else found
                    row |= {"error [%]": f"{100 * np.abs(own - exact).max() / size:.2g}", "CPU [s]": seconds}
                rows.append(row)
                print(*row.values(), flush=True)
    # What else the machine does slows both: over the mean of the one package, whose steps are its own at any communication step.
    own = np.mean([row["CPU [s]"] for row in rows if row["way"] == UNIT])
    for row in rows:
        if seconds := row.pop("CPU [s]", None):
            row["CPU over the package [-]"] = f"{seconds / own:.2g}"
    return rows


def polar(folder, whole):
    """Polar inertia of every shaft [kg m2]: from what it has in sections and discs."""
    found = {}
    for shaft in tomllib.loads(whole)["shaft"]:
        discs = sum(float(disc["polar_inertia"].split()[0]) for disc in shaft["disc"])
        rods = sum(math.pi / 32 * number(s["outer_diameter"]) ** 4 * (number(s["to"]) - number(s["from"])) * 7800 for s in shaft["section"])
        found[shaft["name"]] = discs + rods
    return found


def write(rows):
    rows_by_step.write(RESULTS, ["way", "step [us]", "stable", "error [%]", "CPU over the package [-]"], rows)


def read():
    """Results as written: rows by way and step [us]."""
    return rows_by_step.read(RESULTS)


def table(results):
    """Error and CPU time, over that of the one package, over the communication step."""
    ways = [UNIT, HELD, AHEAD]
    lines = ["| step: error, CPU time | " + " | ".join(ways) + " |", "|---|" + "---:|" * len(ways)]
    for step in STEPS:
        cells = []
        for way in ways:
            row = results.get((way, step))
            cells.append("" if row is None else "lost" if row["stable"] == "no" else f"{row['error [%]']} %, {row['CPU over the package [-]']}")
        lines.append(f"| {step} us | " + " | ".join(cells) + " |")
    return "\n".join(lines)


if __name__ == "__main__":
    if sys.argv[1:] not in ([], ["--keep"]):
        sys.exit(__doc__)
    if not sys.argv[1:]:
        write(measure())
    gearbox.put(DOCUMENT, "outside of the gearbox", table(read()))
    print(table(read()))
