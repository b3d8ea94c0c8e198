#!/usr/bin/env python3
"""Runs the sweeps examples/sweeps/dry_running.toml and smearing.toml and prints their tables as docs/oil.md has them; the map of smearing is drawn, too.

Usage: oil_maps.py [--keep]    --keep renews docs/oil.md and docs/figures/smearing.svg
"""

import csv
import math
import pathlib
import statistics
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "target" / "release" / "roulement"
FASTER, LOST = 400.0, 0.02  # of the scene: everything warms so much faster, and the oil is gone at [s]
LIMITS = {"clearance<0": "no clearance", "ball[*].inner.peak_pressure>4.2e9": "4.2 GPa", "temperature_rise.inner>60": "60 K"}
DRY = {"friction.ball_race": "friction", "bearing.diametral_clearance": "clearance \\[um]", "effects.heat_balance.inner_shaft": "inner ring to shaft \\[W/K]"}


def swept(name, columns, folder):
    """Rows of the summary of a sweep of the examples, by the names of its columns without units."""
    cases = ROOT / "examples" / "sweeps" / f"{name}.toml"
    output = pathlib.Path(folder) / name
    subprocess.run([PROGRAM, "sweep", cases, "--columns", ",".join(columns), "-o", output], check=True, stdout=subprocess.DEVNULL)
    with open(output / "summary.csv", newline="") as file:
        rows = [{key.split(" [")[0]: cell for key, cell in row.items()} for row in csv.DictReader(file)]
    assert all(row["status"] == "done" for row in rows), rows
    return rows


def dry(rows):
    """Times from the loss of the oil to each limit, and how far each input moves them."""
    seconds = lambda row, limit: FASTER * (float(row[f"{limit}.time"]) - LOST) if row[f"{limit}.time"] else math.inf
    told = lambda time: f"{time:.0f}" if math.isfinite(time) else "never"
    number = lambda row, key: row[key].removesuffix(" um")
    yield "| " + " | ".join(list(DRY.values()) + [f"{name} \\[s]" for name in LIMITS.values()]) + " |"
    yield "|---:" * (len(DRY) + len(LIMITS)) + "|"
    for row in sorted(rows, key=lambda row: [float(number(row, key)) for key in DRY]):
        yield "| " + " | ".join([number(row, key) for key in DRY] + [told(seconds(row, limit)) for limit in LIMITS]) + " |"
    times = {limit: sorted(seconds(row, limit) for row in rows) for limit in LIMITS}
    for name, of in (("shortest", min), ("median", statistics.median_low), ("longest", max)):
        yield "| " + " | ".join([name, "", ""] + [told(of(times[limit])) for limit in LIMITS]) + " |"


def smearing(rows):
    """Load times slip speed of entering balls over load and speed: the mean over turns of the largest of each."""
    speeds, loads = grid(rows)
    yield "| radial load \\[N] | " + " / ".join(f"{speed} rpm" for speed in speeds) + ": load times slip speed \\[W] | slip of the balls \\[%] |"
    yield "|---:|---|---|"
    at = lambda speed, load, column: float(next(row for row in rows if of(row) == (speed, load))[column])
    for load in loads:
        powers = " / ".join(f"{at(speed, load, 'entering_slip_load.per_turn'):.1f}" for speed in speeds)
        slips = " / ".join(f"{round(100 * at(speed, load, 'balls.slip.mean'), 1) + 0.0:.1f}" for speed in speeds)
        yield f"| {load} | {powers} | {slips} |"


def of(row):
    """Speed [rpm] and load [N] of a case."""
    return int(row["load.inner_speed"].removesuffix(" rpm")), int(row["load.y.force"])


def grid(rows):
    return [sorted(set(values)) for values in zip(*map(of, rows))]


def drawn(rows):
    """The map as SVG: a cell for each case, darker where more power slips under load."""
    speeds, loads = grid(rows)
    wide, high, left, top = 120, 34, 90, 46
    values = {of(row): float(row["entering_slip_load.per_turn"]) for row in rows}
    most = max(values.values())
    size = f'width="{left + wide * len(speeds) + 20}" height="{top + high * len(loads) + 50}"'
    yield f'<svg {size} xmlns="http://www.w3.org/2000/svg" font-family="sans-serif" font-size="12">'
    yield f'<rect {size} fill="#FFFFFF"/>'
    yield '<text x="10" y="22" font-size="15">Load times slip speed of entering balls [W], 6206 in oil</text>'
    for column, speed in enumerate(speeds):
        for line, load in enumerate(reversed(loads)):
            value = values[speed, load]
            share = math.sqrt(value / most)
            red, green, blue = (round(255 + share * (dark - 255)) for dark in (178, 24, 43))
            x, y = left + wide * column, top + high * line
            yield f'<rect x="{x}" y="{y}" width="{wide}" height="{high}" fill="rgb({red},{green},{blue})" stroke="#FFFFFF"/>'
            ink = "#FFFFFF" if share > 0.6 else "#222222"
            yield f'<text x="{x + wide / 2}" y="{y + high / 2 + 4}" text-anchor="middle" fill="{ink}">{value:.1f}</text>'
        yield f'<text x="{left + wide * (column + 0.5)}" y="{top + high * len(loads) + 18}" text-anchor="middle">{speed} rpm</text>'
    for line, load in enumerate(reversed(loads)):
        yield f'<text x="{left - 8}" y="{top + high * (line + 0.5) + 4}" text-anchor="end">{load} N</text>'
    yield "</svg>"


def main():
    with tempfile.TemporaryDirectory() as folder:
        slips = swept("smearing", ["balls.entering_slip_load", "balls.slip"], folder)
        tables = {"dry": dry(swept("dry_running", LIMITS, folder)), "smearing": smearing(slips)}
        text = "".join(f"<!-- begin {name} -->\n" + "\n".join(lines) + "\n<!-- end -->\n" for name, lines in tables.items())
        print(text)
        if sys.argv[1:] == ["--keep"]:
            page = ROOT / "docs" / "oil.md"
            for name, lines in ((part.split(" ")[0], part) for part in text.split("<!-- begin ")[1:]):
                head, rest = page.read_text().split(f"<!-- begin {name} -->\n")
                page.write_text(f"{head}<!-- begin {lines.rstrip()}{rest[rest.index('<!-- end -->') + len('<!-- end -->'):]}")
            (ROOT / "docs" / "figures" / "smearing.svg").write_text("\n".join(drawn(slips)) + "\n")


main()
