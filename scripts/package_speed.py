"""CPU time of a bearing that runs by itself, is stepped in Python, and is stepped as an FMU in FMPy. Usage: package_speed.py FILE...

Writes the table into the files, between `<!-- begin package speed -->` and `<!-- end -->`; without files it is printed. Needs the Python
package (scripts/python-package) and FMPy.
"""

import sys
import tempfile
import time
from pathlib import Path

import roulement
from roulement.coupling import VELOCITY, WRENCH, PLACE, FmuBearing

SHORT, LONG = 0.1, 0.3  # [s] the start is in both
REPEATS = 5


def per_second(run):
    """CPU seconds of a simulated second, without the start: the least of some differences of a long and a short run."""
    found = []
    for _ in range(REPEATS):
        spent = []
        for duration in (SHORT, LONG):
            began = time.process_time()
            run(duration)
            spent.append(time.process_time() - began)
        found.append((spent[1] - spent[0]) / (LONG - SHORT))
    return min(found)


def native(scene):
    """The program's own run, with a row of results every millisecond."""
    return lambda duration: roulement.run(scene.with_({"load.duration": duration, "load.output_interval": 1e-3}))


def stepped(scene, step):
    """`Simulation` in Python: pose and its rates given and the wrench read at every communication point."""

    def run(duration):
        simulation = roulement.Simulation(scene)
        inputs = [simulation.signal(name) for name in PLACE + VELOCITY]
        outputs = [simulation.signal(name) for name in WRENCH]
        values = [signal.value for signal in inputs]
        for _ in range(round(duration / step)):
            for signal, value in zip(inputs, values):
                signal.value = value
            simulation.step(step)
            [signal.value for signal in outputs]

    return run


def packaged(package, step):
    """The FMU in FMPy, in the same way."""

    def run(duration):
        bearing = FmuBearing.load(package)
        place = bearing.place()
        still = 0.0 * place
        for _ in range(round(duration / step)):
            bearing.step(step, place, still)
        bearing.close()

    return run


def table():
    """Rows of Markdown."""
    base = roulement.Scene.load("scenes/misalignment.toml").with_({"load.duration": 1.0})
    rows = ["| 10 balls, race in pose drive, internal steps of 10 us at most | `saturated` [s/s] | default law [s/s] |", "|---|---:|---:|"]
    scenes = [base.with_({"effects.per_ball_outputs": False}), base.with_({"effects.per_ball_outputs": False, "effects.creep": "kalker_table", "effects.heathcote_slip": True})]
    with tempfile.TemporaryDirectory() as folder:
        packages = [roulement.package(scene, Path(folder) / f"{index}.fmu") for index, scene in enumerate(scenes)]
        ways = [("native: `roulement run`, a row every 1 ms", [native(scene) for scene in scenes])]
        for step in (2e-5, 1e-4, 1e-3):
            ways.append((f"`roulement.Simulation`, steps of {step * 1e6:.0f} us", [stepped(scene, step) for scene in scenes]))
            ways.append((f"FMU in FMPy, steps of {step * 1e6:.0f} us", [packaged(package, step) for package in packages]))
        for name, runs in ways:
            print(name, file=sys.stderr)
            rows.append(f"| {name} | " + " | ".join(f"{per_second(run):.2f}" for run in runs) + " |")
    return "\n".join(rows)


def put(path, text):
    """Puts a text between the marks of a file."""
    begin, end = "<!-- begin package speed -->", "<!-- end -->"
    head, rest = path.read_text().split(begin)
    path.write_text(f"{head}{begin}\n\n{text}\n\n{end}{rest.split(end, 1)[1]}")


if __name__ == "__main__":
    text = table()
    for path in sys.argv[1:]:
        put(Path(path), text)
    print(text)
