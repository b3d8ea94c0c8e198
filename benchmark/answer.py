#!/usr/bin/env python3
"""Answers of roulement to the questions of this folder, by its command line. Usage: answer.py PROGRAM [FAMILY ...]

Writes answers/roulement.csv, and answers/roulement-default-law.csv with the contacts by the law that runs use; with families only these rows are
made anew, and the table of docs/benchmark.md. With `--print` it writes nothing and prints the answers. A script for another program may look like this one.
"""

import csv
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import check

HERE = Path(__file__).resolve().parent
DOCUMENT = HERE.parent / "docs" / "benchmark.md"
BEGIN, END = "<!-- begin verdicts -->\n", "<!-- end -->"
# Tables of answers as the document has them: whose they are, the file, and its families where it has not all.
SHOWN = [("roulement", "roulement.csv", None), ("roulement, contacts by the table that runs use", "roulement-default-law.csv", "contacts"), ("Exudyn 1.13.6", "exudyn.csv", None)]


def called(program, *arguments):
    """What the program prints. It warns beside that."""
    return subprocess.run([program, *map(str, arguments)], check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True).stdout


def equilibrium(program, file, quantities):
    """Quantities of the quasi-static solution of a scene."""
    found = json.loads(called(program, "equilibrium", HERE / file, "--json", "--gyroscopic", "outer-race-control"))
    balls = found["balls"]
    most = max(range(len(balls["inner_load"])), key=lambda ball: balls["inner_load"][ball])
    known = {
        "largest_inner_load": balls["inner_load"][most],
        "largest_outer_load": max(balls["outer_load"]),
        "inner_contact_angle_there": math.degrees(balls["inner_contact_angle"][most]),
        "outer_contact_angle_there": math.degrees(balls["outer_contact_angle"][most]),
        "cage_speed": found["cage_speed"],
    }
    known |= {f"displacement.{axis}": 1e6 * found["displacement"][axis] for axis in "xyz"}
    return [known[quantity] for quantity in quantities]


def run(program, file, quantities):
    """Quantities of a run: means over its second half, energy over all of it."""
    with tempfile.TemporaryDirectory() as folder:
        found = json.loads(called(program, "run", HERE / file, "--json", "-o", folder, "--columns", "inner.position.x"))
        means = {row["quantity"]: row["mean"] for row in found["means"]["quantities"]}
        figures = found["figures"]
        known = {
            "friction_torque": lambda: 1e3 * means["friction torque"],
            "cage_speed": lambda: means["cage speed"],
            "energy_left_open": lambda: 100.0 * abs(found["energy_balance"]) / (abs(figures["work"]) + figures["lost"]),
            "frequency": lambda: frequency(Path(folder) / "results.csv"),
        }
        return [known[quantity]() for quantity in quantities]


def frequency(table):
    """[Hz] of a vibration, from its passages through where it begins."""
    with open(table, newline="") as file:
        rows = [(float(row["time [s]"]), float(row["inner.position.x [m]"])) for row in csv.DictReader(file)]
    rest = rows[0][1]
    up = [(a, b) for a, b in zip(rows, rows[1:]) if a[1] < rest <= b[1]]
    times = [a[0] + (rest - a[1]) * (b[0] - a[0]) / (b[1] - a[1]) for a, b in up]
    return (len(times) - 1) / (times[-1] - times[0])


def contacts(program, exact):
    """Creep forces and spin moments of all contacts."""
    options = ["--exact", "--no-cache"] if exact else []
    rows = csv.DictReader(called(program, "contact", "--law", "kalker_table", *options, HERE / "contacts.csv").splitlines())
    return {f"{row['id']}.{key}": float(row[key]) for row in rows for key in ("fx", "fy", "mz")}


def answers(program, families):
    """Answers to all questions of some families."""
    with open(HERE / "questions.csv", newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["family"] in families]
    found = contacts(program, True) if "contacts" in families else {}
    for file in dict.fromkeys(row["file"] for row in rows if row["family"] != "contacts"):
        own = [row for row in rows if row["file"] == file]
        by = equilibrium if own[0]["family"] == "equilibria" else run
        found |= dict(zip((row["id"] for row in own), by(program, file, [row["quantity"] for row in own])))
    return {row["id"]: found[row["id"]] for row in rows}


def write(name, found):
    """A table of answers; rows of other families stay."""
    path = HERE / "answers" / name
    old = {}
    if path.exists():
        with open(path, newline="") as file:
            old = {row["id"]: row["value"] for row in csv.DictReader(file)}
    with open(HERE / "questions.csv", newline="") as file:
        order = [row["id"] for row in csv.DictReader(file)]
    all_of = old | {key: f"{value:.9g}" for key, value in found.items()}
    path.parent.mkdir(exist_ok=True)
    lines = [f"{key},{all_of[key]}" for key in order if key in all_of]
    path.write_text("\n".join(["id,value", *lines]) + "\n")


def table():
    """Verdicts on all answers that are here, as rows of Markdown."""
    rows = ["| answers | family | right | wrong | not answered | largest error [tolerances] |", "|---|---|---:|---:|---:|---:|"]
    known = check.questions()
    for whose, file, only in SHOWN:
        counts = check.counted(check.verdicts(check.answers(HERE / "answers" / file, known), known))
        for family, count in counts.items():
            if only in (None, family):
                largest = f"{count['worst']:.2g}" if count["right"] + count["wrong"] else "-"
                rows.append(f"| {whose} | {family} | {count['right']} | {count['wrong']} | {count['not answered']} | {largest} |")
    return "\n".join(rows) + "\n"


def renew():
    """Puts the table into the document."""
    head, rest = DOCUMENT.read_text().split(BEGIN)
    DOCUMENT.write_text(head + BEGIN + table() + END + rest.split(END, 1)[1])


def main(program, *given):
    """The command line."""
    families = [name for name in given if name != "--print"] or ["equilibria", "contacts", "torque", "hard"]
    found = answers(program, families)
    if "--print" in given:
        print("id,value")
        print("\n".join(f"{key},{value:.9g}" for key, value in found.items()))
        return
    write("roulement.csv", found)
    if "contacts" in families:
        write("roulement-default-law.csv", contacts(program, False))
    renew()


if __name__ == "__main__":
    main(*sys.argv[1:])
