#!/usr/bin/env python3
"""Figures of the three-stage gearbox for docs/gearbox.md: its spectrum, its pictures on the page, its lines over the speed, and loads over a mesh.

Its teeth are given a stiffness that varies by 15 % and, at twice the frequency of the mesh, by 5 %: how those of this gearbox vary is not known. Its
shafts have a third of critical damping at 10 kHz, so that motions of the start are gone sooner.

Usage: scripts/gearbox_figures.py    renews docs/figures/gearbox-{spectrum,meshes,third}.png, gearbox-lines.svg and gearbox-loads.svg, and the numbers
                                     of the run in docs/gearbox.md; some minutes of CPU. Needs matplotlib, Node and Chromium as scripts/report-page does.
ROULEMENT_BIN is the program.
"""

import csv
import json
import os
import re
import resource
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

HERE = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(HERE / "examples" / "gearbox"))
import gearbox  # noqa: E402

FIGURES = HERE / "docs" / "figures"
PROGRAM = Path(os.environ.get("ROULEMENT_BIN", HERE / "target" / "release" / "roulement"))
SCENE = HERE / "examples" / "gearbox" / "three_stage.toml"
VARIATION = '[{ amplitude = "15 %" }, { order = 2, amplitude = "5 %" }]'
#: The run: its end, and the distance of its rows.
DURATION, ROWS = "0.2 s", "50 us"
#: [Hz] first mesh, by speed and teeth, and how many of its periods are drawn.
STAGE1 = 1400 / 60 * 23
PERIODS = 4


def varying() -> str:
    """The scene with teeth that vary, and the rows of the run."""
    text = SCENE.read_text(encoding="utf-8")
    text = text.replace("[[mesh]]\n", f"[[mesh]]\nstiffness_variation = {VARIATION}\n")
    text = re.sub(r"(?m)^duration = .*", f'duration = "{DURATION}"', text)
    text = re.sub(r"(?m)^retardation_time = \"[^\"]*\"", 'retardation_time = "10 us"', text)
    return re.sub(r"(?m)^output_interval = .*", f'output_interval = "{ROWS}"', text)


def run(*arguments: str | Path) -> float:
    """Runs the program; gives its CPU time [s]."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([PROGRAM, *arguments], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime


def loads_over_meshes(folder: Path) -> None:
    """Normal force of the first mesh, and what the bearings of both its shafts carry across, over some of its periods at the end of the run."""
    with open(folder / "shaft.csv", newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    names = {name.split(" [")[0]: name for name in rows[0]}
    end = float(rows[-1][names["time"]])
    begin = end - PERIODS / STAGE1
    late = [row for row in rows if float(row[names["time"]]) >= begin]
    time = [1e3 * (float(row[names["time"]]) - begin) for row in late]
    plt.rcParams.update({"font.size": 9, "svg.hashsalt": "gearbox", "svg.fonttype": "none"})
    figure, (above, below) = plt.subplots(2, 1, figsize=(8, 5), sharex=True, layout="constrained")
    above.plot(time, [float(row[names["stage1.normal_force"]]) for row in late], color="k")
    above.set_ylabel("teeth of stage1: normal force [N]")
    for bearing in ["input-left", "input-right", "second-left", "second-right"]:
        with open(folder / bearing / "results.csv", newline="", encoding="utf-8") as file:
            own = [row for row in csv.DictReader(file) if float(row["time [s]"]) >= begin]
        force = [sum(float(row[f"inner.force.{axis} [N]"]) ** 2 for axis in "yz") ** 0.5 for row in own]
        mean = sum(force) / len(force)
        below.plot([1e3 * (float(row["time [s]"]) - begin) for row in own], [one - mean for one in force], label=f"{bearing} ({mean:.0f} N)")
    below.set_ylabel("bearings: radial force less its mean [N]")
    below.set_xlabel(f"time [ms], {PERIODS} periods of stage1")
    below.legend(ncols=4, loc="upper right", fontsize=8)
    for axes in (above, below):
        axes.grid(alpha=0.3)
        axes.margins(x=0)
    figure.savefig(FIGURES / "gearbox-loads.svg", metadata={"Date": None})


def main() -> None:
    if len(sys.argv) > 1:
        sys.exit(f"error: {sys.argv[1]} is no option of this script: it has none")
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        scene = scratch / "gearbox.toml"
        scene.write_text(varying(), encoding="utf-8")
        # Few columns, so that the page has all rows.
        columns = "*.normal_force,*.angle,*.speed,*.force.*,*.azimuth"
        spent = run("run", scene, "-o", scratch / "run", "--columns", columns)
        record = json.loads((scratch / "run" / "run.json").read_text(encoding="utf-8"))
        run("report", scratch / "run", "-o", scratch / "gearbox.html")
        parts = {"#spectra@third.speed": "spectrum", "figure:has(.meshes)": "meshes", "figure[data-shaft=third]": "third"}
        pictures = [f"{selector}={FIGURES}/gearbox-{name}.png" for selector, name in parts.items()]
        subprocess.run([HERE / "scripts" / "report-page", "--parts", scratch / "gearbox.html", *pictures], check=True)
        run("modes", SCENE, "-o", scratch / "modes")
        shutil.copy(scratch / "modes" / "campbell.svg", FIGURES / "gearbox-lines.svg")
        loads_over_meshes(scratch / "run")
        steps = record["cost"]["steps"]
        text = f"Such a run takes {steps:,} steps of {1e6 * float(DURATION.split()[0]) / steps:.1f} us and {spent:.0f} s of CPU time, tables and warnings included."
        gearbox.put(HERE / "docs" / "gearbox.md", "teeth that vary", text)


if __name__ == "__main__":
    main()
