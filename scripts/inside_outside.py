"""The gearbox shaft inside one package, and the same shaft coupled to two packages of bearings: over the communication step, what is stable,
how large the error is and what it costs.

Usage: inside_outside.py [--keep]   (--keep: the last results, documents and figure only)

Writes docs/figures/inside-outside.csv and .svg, and what docs/coupling.md, docs/shaft.md and docs/gearbox.md have of it between `<!-- begin NAME -->` and
`<!-- end -->`. About ten minutes of CPU. Needs the program (ROULEMENT_BIN, or that of target/release), the Python package
(scripts/python-package), FMPy and matplotlib.
"""

import math
import os
import shutil
import subprocess
import sys
import tempfile
import time as clock
from pathlib import Path

import numpy as np
import roulement
import rows_by_step
from roulement.coupling import Bearings, Euler, FmuBearing, Implicit, Leapfrog, gyroscopic, rigid

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "examples/gearbox"))
import gearbox  # noqa: E402

RESULTS, FIGURE = ROOT / "docs/figures/inside-outside.csv", ROOT / "docs/figures/inside-outside.svg"
PROGRAM = os.environ.get("ROULEMENT_BIN", ROOT / "target/release/roulement")
STEPS = [5, 10, 20, 40, 50, 80, 100, 200, 500, 1000]  # communication steps [us], parts of DURATION
DURATION = 0.02  # of a run whose error and CPU time are measured [s]
ON = 0.01  # within this the torque comes on [s]
KICK, LONG, FEWEST = 30.0, 0.04, 60  # radial force [N], time [s] and least steps of a run that tells whether a step is stable
REPEATS, ENOUGH = 5, 10.0  # runs of which the least CPU time counts, or as many as take this together [s]
ACCURATE = 1.0  # error of a step that serves [%]
REFERENCE, FINE = 5, 2  # communication step of the reference, and of leapfrog beside it [us]
TIGHT = {"max_step": 1e-6, "tolerance": 1e-10}
SIDES = {"left": (gearbox.LEFT, 1), "right": (gearbox.RIGHT, -1)}
RADIAL = [f"inner.force.{axis}" for axis in "yz"]
OIL = {key: value for key, value in gearbox.OIL.items() if key != "film.lubrication"}

# What is coupled how: settings of [solver], and where the load of the shaft is from (inside) or the recipe (outside).
FROM_FILE, FROM_MASTER = "file", "master"
WAYS = {
    "inside, mesh in the file": ({}, FROM_FILE),
    "inside, mesh from the master": ({}, FROM_MASTER),
    "inside, mesh in the file, `balanced`": ({"accuracy": "balanced"}, FROM_FILE),
    "leapfrog": ({}, Leapfrog),
    "leapfrog, `fast`": ({"accuracy": "fast"}, Leapfrog),
    "Euler": ({}, Euler),
    "implicit": ({}, Implicit),
}
SHORTEST = {"implicit": 10}  # [us] shorter steps are not tried: they take half a minute
LOADS = {
    "mesh": f"""
[[shaft.gear]]
torque = {{ ramp = [0, {gearbox.TORQUE}], from = 0, to = {ON} }}
pitch_radius = {gearbox.PITCH_RADIUS}
pressure_angle = {gearbox.PRESSURE}
helix_angle = {gearbox.HELIX}
offset = {gearbox.PINION}
teeth = {gearbox.TEETH}
ripple = {gearbox.RIPPLE}
""",
    "kick": f"""
[[shaft.load]]
name = "mesh"
position = 0.0
force = [0, {{ step = [0, {KICK}], at = 0 }}, 0]
""",
    FROM_MASTER: f"""
[[shaft.load]]
name = "mesh"
position = {gearbox.PINION}
force = [0, 0, 0]
""",
}


def load(name):
    """Wrench on the shaft about its middle [N, N m] as a function of time [s]: the mesh, or the kick."""
    if name == "kick":
        return lambda time: np.array([0, KICK, 0, 0, 0])
    swing = lambda time: 1 + gearbox.RIPPLE * np.sin(gearbox.TEETH * gearbox.SPEED * time)
    return lambda time: gearbox.mesh(gearbox.TORQUE * min(time / ON, 1) * swing(time))


def bearings(solver):
    """Scenes of both bearings alone, in pose drive, under their preload; nothing keeps their balls apart, as in those of a machine."""
    common = {"effects.cage": "none", "inner.drive": "pose", "load.x.force": gearbox.PRELOAD, "load.duration": 1.0} | OIL
    scene = roulement.catalogue.bearing(gearbox.BEARING).with_(common | {f"solver.{key}": value for key, value in solver.items()})
    return {side: scene.with_({"load.inner_speed": direction * gearbox.SPEED}) for side, (_, direction) in SIDES.items()}


def system(solver, acting, preload):
    """Text of the file of the whole. `acting` is a key of LOADS; `preload` is the way of a race [m] that bearings alone make under their preload at
    speed. Shaft and bearings have no weight: both ways then begin at the same equilibrium."""
    written = {key: f'"{value}"' if isinstance(value, str) else value for key, value in solver.items()}
    text = f"""
[solver]
{"".join(f"{key} = {value}{chr(10)}" for key, value in written.items())}
[shaft]
speed = {gearbox.SPEED}
mass = {gearbox.MASS}
polar_inertia = {gearbox.POLAR}
transverse_inertia = {gearbox.TRANSVERSE}

[[shaft.point]]
name = "middle"
position = 0.0
{LOADS[acting]}"""
    for side, (position, direction) in SIDES.items():
        text += f"""
[[bearing]]
name = "{side}"
catalogue = "{gearbox.BEARING}"
mounting = {{ position = {position}, direction = "{"+x" if direction > 0 else "-x"}", preload = {{ displacement = {preload} }} }}
[bearing.set]
friction = {{ ball_race = {OIL["friction.ball_race"]} }}
film = {{ iso_vg = {OIL["film.iso_vg"]}, temperature = "{OIL["film.temperature"]}" }}
"""
    return text + "\n[load]\nduration = 1.0\noutput_interval = 1e-4\n"


class Inside:
    """The package of the whole in FMPy. `acting` gives the wrench on the shaft that the master sets, or is None where the file has it."""

    def __init__(self, package, acting=None):
        from fmpy import extract, read_model_description
        from fmpy.fmi2 import FMU2Slave

        description = read_model_description(str(package))
        references = {variable.name: variable.valueReference for variable in description.modelVariables}
        identifier = description.coSimulation.modelIdentifier
        self.folder, self.acting = extract(str(package)), acting
        self.fmu = FMU2Slave(guid=description.guid, unzipDirectory=self.folder, modelIdentifier=identifier, instanceName="gear")
        self.inputs = [references[f"mesh.{name}"] for name in ("force.x", "force.y", "force.z", "moment.y", "moment.z")] if acting else None
        self.radial = [references[f"{side}.{name}"] for side in SIDES for name in RADIAL]
        self.velocity = [references[f"middle.velocity.{axis}"] for axis in "xyz"]
        self.fmu.instantiate()
        self.restart()

    def restart(self):
        """Back to time 0."""
        self.fmu.reset()
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        self.time = 0.0

    def step(self, step):
        """A communication step [s]."""
        if self.acting:
            # Loads go straight to what they are at its end.
            force, moment = np.split(self.acting(self.time + step), [3])
            self.fmu.setReal(self.inputs, [*force, *(moment - np.cross([gearbox.PINION, 0, 0], force)[1:])])
        self.fmu.doStep(self.time, step)
        self.time += step

    def forces(self):
        """Radial forces y, z of the left bearing on the shaft, then of the right one [N], in the axes of the bearing."""
        return np.array(self.fmu.getReal(self.radial))

    def speed(self):
        """Speed of the shaft's middle [m/s]."""
        return np.linalg.norm(self.fmu.getReal(self.velocity))

    def close(self):
        """Frees the instance, and what was unpacked."""
        self.fmu.freeInstance()
        shutil.rmtree(self.folder)


class Outside:
    """The shaft in the master, on two packages of bearings; the same methods as of `Inside`."""

    def __init__(self, packages, acting, recipe):
        self.sides, self.acting, self.recipe = [FmuBearing.load(package) for package in packages], acting, recipe
        self.restart()

    def restart(self):
        for bearing in self.sides:
            bearing.restart()
        both = Bearings(*((bearing, *mounted) for bearing, mounted in zip(self.sides, SIDES.values())))
        turning = gyroscopic(gearbox.POLAR, gearbox.SPEED)
        self.shaft = self.recipe(both, rigid(gearbox.MASS, gearbox.TRANSVERSE), self.acting, turning)

    def step(self, step):
        self.shaft.step(step)
        if not np.abs(self.shaft.place).max() < 1e-3:
            raise ArithmeticError("the shaft has left its bearings")

    def forces(self):
        return np.concatenate([bearing.read(RADIAL) for bearing in self.sides])

    def speed(self):
        return np.linalg.norm(self.shaft.velocity[:3])

    def close(self):
        for bearing in self.sides:
            bearing.close()


class Packages:
    """Packages of the system, each made when it is first asked for, in a folder."""

    def __init__(self, folder):
        self.folder, self.made, self._preload = Path(folder), {}, None

    def preload(self):
        """Way of a race under its preload, at speed [m]."""
        if self._preload is None:
            bearing = FmuBearing.load(self.outside({})[0])
            self._preload = float(bearing.place()[0])
            bearing.close()
        return self._preload

    def outside(self, solver):
        """Packages of the left and the right bearing."""
        key = ("bearings", *solver)
        if key not in self.made:
            name = lambda side: self.folder / f"{side}{len(self.made)}.fmu"
            self.made[key] = [roulement.package(scene, name(side)) for side, scene in bearings(solver).items()]
        return self.made[key]

    def inside(self, solver, acting):
        """The package of the whole."""
        key = (acting, *solver)
        if key not in self.made:
            file = self.folder / f"system{len(self.made)}.toml"
            file.write_text(system(solver, acting, self.preload()))
            subprocess.run([PROGRAM, "fmu", file, "-o", file.with_suffix(".fmu")], check=True, stdout=subprocess.DEVNULL)
            self.made[key] = file.with_suffix(".fmu")
        return self.made[key]

    def start(self, way, name):
        """A way of WAYS under the load of that name, at time 0."""
        solver, how = WAYS[way] if isinstance(way, str) else way
        if how == FROM_FILE:
            return Inside(self.inside(solver, name))
        if how == FROM_MASTER:
            return Inside(self.inside(solver, FROM_MASTER), load(name))
        return Outside(self.outside(solver), load(name), how)


def run(simulation, step, duration, read):
    """Runs from the start with communication steps [us] over a duration [s]. Returns what `read` gave at every point, and the CPU time [s];
    no rows where the run has ended early."""
    simulation.restart()
    rows, began = [], clock.process_time()
    for _ in range(round(duration * 1e6 / step)):
        try:
            simulation.step(step * 1e-6)
        except Exception:  # FMPy has no narrower one
            return None, 0.0
        rows.append(read())
    return np.array(rows), clock.process_time() - began


def settles(simulation, step):
    """Does the vibration after the kick die down? Largest speeds [m/s] of the first and the last quarter of a run, the latter inf where it ended early."""
    speeds, _ = run(simulation, step, max(LONG, FEWEST * step * 1e-6), simulation.speed)
    if speeds is None:
        return math.nan, math.inf
    quarter = len(speeds) // 4
    return speeds[:quarter].max(), speeds[-quarter:].max()


def error(rows, step, reference):
    """Difference of radial forces, in the root mean square over the run, over their own [%], at the points [us] that both have."""
    every = math.lcm(step, REFERENCE)
    ours, exact = rows[every // step - 1 :: every // step], reference[every // REFERENCE - 1 :: every // REFERENCE]
    return 100 * math.sqrt(((ours - exact) ** 2).sum() / (exact**2).sum())


def reference(packages, step=REFERENCE):
    """Radial forces (rows, 4) of the whole with small steps inside [N], at multiples of a step [us]."""
    simulation = packages.start((TIGHT, FROM_FILE), "mesh")
    rows, _ = run(simulation, step, DURATION, simulation.forces)
    simulation.close()
    return rows


def measure():
    """Rows of the table of results."""
    rows = []
    with tempfile.TemporaryDirectory() as folder:
        packages = Packages(folder)
        exact = reference(packages)
        fine = packages.start((TIGHT, Leapfrog), "mesh")
        found, _ = run(fine, FINE, DURATION, fine.forces)
        fine.close()
        rows.append({"way": "leapfrog, fine", "step [us]": FINE, "error [%]": f"{error(found, FINE, exact):.2g}"})
        print(*rows[-1].values(), flush=True)
        cases = {}
        for way in WAYS:
            kicked = packages.start(way, "kick")
            for step in STEPS:
                if step >= SHORTEST.get(way, 0):
                    first, last = settles(kicked, step)
                    row = {"way": way, "step [us]": step, "speed at first [m/s]": f"{first:.3g}", "speed at last [m/s]": f"{last:.3g}"}
                    cases[way, step] = row | {"stable": "yes" if last < first else "no"}
                    print(*cases[way, step].values(), flush=True)
            kicked.close()
        spent = {case: [] for case in cases}
        started = {way: packages.start(way, "mesh") for way in WAYS}
        # In turn, so that what else the machine does meets all alike.
        for _ in range(REPEATS):
            for (way, step), row in cases.items():
                if row["stable"] == "yes" and sum(spent[way, step]) < ENOUGH:
                    found, seconds = run(started[way], step, DURATION, started[way].forces)
                    if found is None:
                        row["stable"] = "no"
                        continue
                    spent[way, step].append(seconds)
                    row["error [%]"] = f"{error(found, step, exact):.2g}"
                    row["CPU [s/s]"] = f"{min(spent[way, step]) / DURATION:.3g}"
        for simulation in started.values():
            simulation.close()
    return rows + list(cases.values())


def write(rows):
    """Writes the results."""
    rows_by_step.write(RESULTS, ["way", "step [us]", "stable", "speed at first [m/s]", "speed at last [m/s]", "error [%]", "CPU [s/s]"], rows)


def read():
    """Results as written: rows by way and step [us]."""
    return rows_by_step.read(RESULTS)


def served(results, way):
    """Steps [us] of a way from small to large before the first that is unstable."""
    steps = sorted(step for of, step in results if of == way)
    bad = [step for step in steps if results[way, step]["stable"] != "yes"]
    return [step for step in steps if step < min(bad, default=math.inf)]


def by_step(results):
    """Table of error and CPU time over communication step and way."""
    lines = ["| step: error, CPU time [s/s] | " + " | ".join(WAYS) + " |", "|---|" + "---:|" * len(WAYS)]
    for step in STEPS:
        cells = []
        for way in WAYS:
            row = results.get((way, step))
            ok = row and row["stable"] == "yes" and row["error [%]"]
            cells.append(f"{row['error [%]']} %, {float(row['CPU [s/s]']):.0f}" if ok else "lost" if row else "")
        lines.append(f"| {step} us | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def by_way(results):
    """Table of the largest stable step, and of what an error of ACCURATE costs."""
    micro = lambda step: f"{step} us" + (" and more" if step == STEPS[-1] else "")
    head = f"| shaft | largest stable step | largest step with an error of {ACCURATE:g} % at most | CPU time then [s/s] |"
    lines = [head, "|---|---:|---:|---:|"]
    for way in WAYS:
        stable = served(results, way)
        good = [step for step in stable if float(results[way, step]["error [%]"]) <= ACCURATE]
        least = f"{micro(max(good))} | {float(results[way, max(good)]['CPU [s/s]']):.0f}" if good else "none | "
        lines.append(f"| {way if way.startswith('inside') else f'outside, {way}'} | {micro(max(stable))} | {least} |")
    return "\n".join(lines)


def in_words(results):
    """The comparison in some sentences."""
    error = lambda way, step: f"{results[way, step]['error [%]']} %"
    cost = lambda way, step: f"{float(results[way, step]['CPU [s/s]']):.0f} s"
    inside, quick, outside = "inside, mesh in the file", "inside, mesh in the file, `balanced`", "leapfrog, `fast`"
    longest, most = STEPS[-1], max(served(results, "leapfrog"))
    return f"""Measured on this shaft, without weight: one FMU has an error of the radial forces of {error(inside, longest)} at communication steps of {longest} us.
Two FMUs under leapfrog have {error("leapfrog", 20)} at 20 us, {error("leapfrog", most)} at {most} us, and are unstable beyond.
CPU time of the same error is about the same. A simulated second takes {cost(quick, longest)} inside with `balanced`
({error(quick, longest)}, steps of {longest} us), and {cost(outside, 20)} outside with `fast` ({error(outside, 20)}, steps of 20 us).
[Coupling](coupling.md#the-shaft-inside-instead) has all of it."""


# What stands between the marks of which document.
PARTS = {
    "coupling.md": ("error and CPU over the communication step", by_step),
    "shaft.md": ("largest communication step", by_way),
    "gearbox.md": ("inside or outside", in_words),
}


def picture(results, path):
    """Error and CPU time over the communication step, and error over CPU time."""
    import matplotlib

    matplotlib.use("Agg")
    # The same bytes from the same results, and words that are words.
    matplotlib.rcParams |= {"svg.hashsalt": "roulement", "svg.fonttype": "none", "font.family": "sans-serif"}
    from matplotlib import pyplot

    colours = ["#0072B2", "#56B4E9", "#0072B2", "#D55E00", "#D55E00", "#009E73", "#CC79A7"]
    figure, panels = pyplot.subplots(1, 3, figsize=(13, 4.9), layout="constrained")
    for (way, (solver, how)), colour in zip(WAYS.items(), colours):
        steps = served(results, way)
        of = lambda name: [float(results[way, step][name]) for step in steps]
        look = dict(color=colour, marker="s" if how in (FROM_FILE, FROM_MASTER) else "o", ms=4, lw=1.4, ls="--" if solver else "-")
        name = (way if way.startswith("inside") else f"outside, {way}").replace("`", "")
        for axes, x, y in zip(panels, (steps, steps, of("CPU [s/s]")), (of("error [%]"), of("CPU [s/s]"), of("error [%]"))):
            axes.loglog(x, y, label=name, **look)
            if steps[-1] < STEPS[-1] and axes is not panels[2]:
                axes.plot(x[-1], y[-1], "x", color=colour, ms=11, mew=2)
    panels[0].set(title="a  error", xlabel="communication step [us]", ylabel="error of the radial forces [%]")
    panels[1].set(title="b  cost", xlabel="communication step [us]", ylabel="CPU time of a simulated second [s]")
    panels[2].set(title="c  error over cost", xlabel="CPU time of a simulated second [s]", ylabel="error of the radial forces [%]")
    for axes in panels:
        axes.grid(alpha=0.3, lw=0.6)
        for axis in (axes.xaxis, axes.yaxis):
            axis.set_major_formatter("{x:g}")
        axes.title.set_ha("left")
        axes.title.set_position((0, 1))
    panels[0].plot([], [], "x", color="black", ms=9, mew=2, label="largest stable step", ls="")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, frameon=False)
    figure.savefig(path, metadata={"Date": None})


def main():
    if sys.argv[1:] not in ([], ["--keep"]):
        sys.exit(__doc__)
    if not sys.argv[1:]:
        write(measure())
    results = read()
    for document, (name, part) in PARTS.items():
        gearbox.put(ROOT / "docs" / document, name, part(results))
        print(part(results), end="\n\n")
    picture(results, FIGURE)


if __name__ == "__main__":
    main()
