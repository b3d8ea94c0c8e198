"""Example FMUs with stimuli, reference results and options, in the folders of the FMI cross-check:

    DIRECTORY/fmus/2.0/cs/linux64/roulement/0.1.0/thrust/thrust.fmu, thrust_in.csv, thrust_ref.csv, thrust_ref.opt, README.md

Usage: reference_results.py DIRECTORY [--keep]

Every package, of FMI 2.0 and of 3.0, is validated and run in FMPy under its stimuli, in fixed steps. What it gives has to be what is kept in
examples/reference, within the tolerances of its options; with --keep that of 2.0 is written there first. Needs the program (ROULEMENT_BIN, or that of
target/release) and FMPy.
"""

import csv
import math
import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

ROOT = Path(__file__).resolve().parents[1]
KEPT = ROOT / "examples" / "reference"
PROGRAM = os.environ.get("ROULEMENT_BIN", ROOT / "target/release/roulement")
VERSIONS = {"2.0": ("2", "linux64"), "3.0": ("3", "x86_64-linux")}
RELATIVE, ABSOLUTE = 1e-4, 1e-6  # band about the reference: of the largest value of a variable [-], and beside that [its unit]
MEMBERS = ["modelDescription.xml", "resources/scene.toml", "terminalsAndIcons/terminalsAndIcons.xml", "documentation/index.html", "documentation/licenses/license.txt"]

RPM = math.pi / 30  # [rad/s]


def tilted(time):
    """Tilt [rad] and its rate [rad/s]: 1 mrad within 8 ms, smoothly."""
    size, begin, duration = 1e-3, 2e-3, 8e-3
    part = min(max((time - begin) / duration, 0.0), 1.0)
    rate = size * math.pi / (2 * duration) * math.sin(math.pi * part)
    return size * (1 - math.cos(math.pi * part)) / 2, rate


TILTS = [k * 1e-4 for k in range(201)]

# Scene, step and end [s], what is given (name and values at times [s], between which they are linear), what is watched.
EXAMPLES = {
    "thrust": {
        "scene": "scenes/thrust.toml",
        "what": "An angular-contact bearing under thrust, its inner ring a rigid body; a radial force comes on, and lubrication gets better.",
        "step": 1e-4,
        "stop": 0.02,
        "times": [0.0, 0.002, 0.006, 0.010, 0.012, 0.02],
        "inputs": {"inner.applied_force.y": [0, 0, 300, 300, 300, 300], "friction": [0.08, 0.08, 0.08, 0.08, 0.02, 0.02]},
        "outputs": ["inner.position.x", "inner.position.y", "inner.rotation.z", "inner.force.y", "inner.drive_torque", "cage.speed",
                    "balls.largest_load", "friction_power"],
    },
    "misalignment": {
        "scene": "scenes/misalignment.toml",
        "what": "The same bearing with the pose of its inner ring as inputs: the ring is tilted by 1 mrad.",
        "step": 1e-4,
        "stop": 0.02,
        "times": TILTS,
        "inputs": {"inner.rotation.y": [tilted(t)[0] for t in TILTS], "inner.rotation_rate.y": [tilted(t)[1] for t in TILTS]},
        "outputs": ["inner.force.x", "inner.force.y", "inner.force.z", "inner.moment.y", "inner.moment.z", "cage.speed",
                    "balls.largest_load", "ball[1].inner.load", "friction_torque"],
    },
    "speed_ramp": {
        "scene": "scenes/cost/speed_ramp.toml",
        "what": "A bearing that starts from rest and runs up to 6000 rpm.",
        "step": 2e-4,
        "stop": 0.04,
        "times": [0.0, 0.002, 0.032, 0.04],
        "inputs": {"inner.speed": [0, 0, 6000 * RPM, 6000 * RPM]},
        "outputs": ["inner.position.x", "inner.drive_torque", "inner.turned", "cage.speed", "friction_torque", "energy.work",
                    "energy.dissipated"],
    },
    "pinion": {
        "scene": "scenes/shafts/pinion.toml",
        "what": "A pinion shaft on two angular-contact bearings in one FMU; the force of its teeth rises by half.",
        "step": 1e-4,
        "stop": 0.01,
        "times": [0.0, 0.003, 0.005, 0.01],
        "inputs": {"mesh.force.z": [1260.5, 1260.5, 1890.0, 1890.0]},
        "outputs": ["mesh.displacement.y", "mesh.displacement.z", "left.inner.force.x", "left.inner.force.z", "right.inner.force.z",
                    "left.balls.largest_load", "right.balls.largest_load", "shaft.torque", "left.cage.speed"],
    },
}  # fmt: skip

README = """# {name}

{what} Made by roulement {version} (`{scene}` of its sources), FMI {fmi} for co-simulation, {folder}.

No licence or other software is needed. Apply `{name}_in.csv` (linear between its rows) at the beginning of each communication step of {step} s up to
{stop} s; FMI 2.0: without derivatives of inputs. `{name}_ref.csv` has the outputs after each step. They repeat to the last bit on one machine; inputs are
gone to within the step that follows, so that with another step, or applied in another way, they come at another time.

In FMPy: `simulate_fmu("{name}.fmu", stop_time={stop}, output_interval={step}, input=..., set_input_derivatives=False)`; `scripts/reference_results.py` is a
complete example.
"""


def roulement(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], check=True, capture_output=True, text=True).stdout


def write_csv(path, names, rows):
    """A table as the rules of the cross-check have it: quoted names, numbers as in C, no comma at the end."""
    with path.open("w") as file:
        file.write(",".join(f'"{name}"' for name in names) + "\n")
        file.writelines(",".join(f"{value:.12g}" for value in row) + "\n" for row in rows)


def read_csv(path):
    """Names and rows of such a table."""
    with path.open() as file:
        names, *rows = csv.reader(file)
    return names, np.array(rows, dtype=float)


def stimuli(name):
    """The inputs of an example as FMPy takes them, from its file."""
    names, rows = read_csv(KEPT / f"{name}_in.csv")
    return np.array([tuple(row) for row in rows], dtype=[(one, float) for one in names])


def simulated(name, package):
    """Time and outputs of a package under its stimuli."""
    example = EXAMPLES[name]
    result = simulate_fmu(
        str(package),
        stop_time=example["stop"],
        output_interval=example["step"],
        input=stimuli(name),
        output=example["outputs"],
        set_input_derivatives=False,
    )
    return np.column_stack([result["time"], *(result[one] for one in example["outputs"])])


def options(example):
    """Text of the options of an example."""
    return (
        f"StartTime, 0.0\nStopTime, {example['stop']}\nStepSize, {example['step']}\nRelTol, {RELATIVE}\nAbsTol, {ABSOLUTE}\n"
        f"SolverType, FixedStep\nOutputIntervalLength, {example['step']}\n"
    )


def keep(name, package):
    """Writes stimuli, reference and options of an example."""
    example = EXAMPLES[name]
    KEPT.mkdir(exist_ok=True)
    columns = zip(example["times"], *example["inputs"].values())
    write_csv(KEPT / f"{name}_in.csv", ["time", *example["inputs"]], columns)
    (KEPT / f"{name}_ref.opt").write_text(options(example))
    write_csv(KEPT / f"{name}_ref.csv", ["time", *example["outputs"]], simulated(name, package))


def deviation(name, package):
    """Largest deviation of a package from the reference, over what is allowed; of all variables."""
    names, reference = read_csv(KEPT / f"{name}_ref.csv")
    assert names == ["time", *EXAMPLES[name]["outputs"]] and (KEPT / f"{name}_ref.opt").read_text() == options(EXAMPLES[name])
    found = simulated(name, package)
    assert found.shape == reference.shape, f"{name}: {found.shape} numbers, {reference.shape} in the reference"
    allowed = RELATIVE * np.abs(reference).max(axis=0) + ABSOLUTE
    return float((np.abs(found - reference) / allowed).max())


def check_contents(package, version):
    """What a tool vendor looks for beside the model."""
    with zipfile.ZipFile(package) as archive:
        missing = set(MEMBERS + ["terminalsAndIcons/terminalsAndIcons.xml"] * (version == "3.0")) - set(archive.namelist())
    assert not missing, f"{package}: {missing}"
    description = read_model_description(str(package))
    said = [description.author, description.copyright, description.license, description.generationDateAndTime]
    assert all(said), f"{package}: {said}"
    problems = validate_fmu(str(package))
    assert not problems, f"{package}: {problems}"


def main():
    directory, keeps = Path(sys.argv[1]), "--keep" in sys.argv[2:]
    release = roulement("--version").split()[1]
    # Of the sources, so that the same sources make the same packages.
    seconds = subprocess.run(["git", "log", "-1", "--format=%ct"], cwd=ROOT, check=True, capture_output=True, text=True).stdout.strip()
    date = subprocess.run(["date", "-u", "-d", f"@{seconds}", "+%FT%TZ"], check=True, capture_output=True, text=True).stdout.strip()
    for version, (number, folder) in VERSIONS.items():
        for name, example in EXAMPLES.items():
            place = directory / "fmus" / version / "cs" / folder / "roulement" / release / name
            place.mkdir(parents=True, exist_ok=True)
            package = place / f"{name}.fmu"
            imprint = ["--author", "the authors of roulement", "--copyright", "the authors of roulement", "--date", date]
            roulement("fmu", ROOT / example["scene"], "-o", package, "--fmi", number, *imprint)
            check_contents(package, version)
            if keeps and version == "2.0":
                keep(name, package)
            apart = deviation(name, package)
            print(f"{version} {name}: {apart:.1e} of what is allowed from the reference", flush=True)
            if apart > 1.0:
                sys.exit(f"{package} does not give the results in {KEPT}")
            for ending in ["in.csv", "ref.csv", "ref.opt"]:
                shutil.copy(KEPT / f"{name}_{ending}", place)
            text = README.format(name=name, version=release, fmi=version, folder=folder, **example)
            (place / "README.md").write_text(text)


if __name__ == "__main__":
    main()
