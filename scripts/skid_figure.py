#!/usr/bin/env python3
"""Draws the maps of skidding of docs/oil.md from their tables, which tests write: slip over thrust, a panel for each speed.

Usage: skid_figure.py FIGURE.svg
"""

import math
import pathlib
import re
import sys

PAGE = pathlib.Path(__file__).resolve().parent.parent / "docs" / "oil.md"
# Colours of the other figures, from the lower edge of what the model says to its upper one.
CURVES = {
    "`hertz`": ("hertz", "#0072B2"),
    "`mean`": ("mean", "#56B4E9"),
    "`hertz`, cage": ("hertz, cage", "#009E73"),
    "`mean`, cage": ("mean, cage", "#E69F00"),
    "`mean`, cage, mist of 50 kg/m3": ("mean, cage, dense mist", "#D55E00"),
}
WIDTH, HEIGHT, LEFT, TOP, PANEL, GAP = 800, 330, 58, 62, 154, 30
FLOOR = HEIGHT - 48
THRUSTS = [20, 50, 100, 200, 500]
MOST = 25


def tables(text):
    """Slips [%] by film and thrust [N], and the speeds that they are at."""
    slips = {}
    for name in ("skid", "skid-cage"):
        inside = text.split(f"<!-- begin {name} -->\n", 1)[1].split("<!-- end -->", 1)[0]
        header, _, *rows = inside.strip().splitlines()
        speeds = re.findall(r"[\d,]+(?= /| rpm)", header)
        for row in rows:
            thrust, film, values = (cell.strip() for cell in row.strip("|").split(" | "))
            slips.setdefault(film, {})[int(thrust)] = [float(value) for value in values.removesuffix("%").split("/")]
    return speeds, slips


def drawn(speeds, slips):
    """The figure's lines."""
    def word(x, y, text, anchor="middle", more=""):
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {more}>{text}</text>'

    def along(panel, thrust):
        return LEFT + panel * (PANEL + GAP) + PANEL * math.log(thrust / THRUSTS[0]) / math.log(THRUSTS[-1] / THRUSTS[0])

    def up(slip):
        return FLOOR - (FLOOR - TOP) * slip / MOST

    yield f'<svg width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" xmlns="http://www.w3.org/2000/svg" font-family="sans-serif" font-size="11">'
    yield f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#FFFFFF"/>'
    yield word(10, 20, "slip of the balls of a 7206 over the thrust", "start", 'font-size="15"')
    x = LEFT
    for text, colour in CURVES.values():
        yield f'<line x1="{x}" y1="36" x2="{x + 18}" y2="36" stroke="{colour}" stroke-width="2"/>'
        yield word(x + 23, 40, text, "start")
        x += 44 + 6.2 * len(text)
    for panel, speed in enumerate(speeds):
        x = LEFT + panel * (PANEL + GAP)
        yield word(x + PANEL / 2, TOP - 6, f"{speed} rpm")
        for slip in range(0, MOST + 1, 5):
            yield f'<line x1="{x}" y1="{up(slip):.1f}" x2="{x + PANEL}" y2="{up(slip):.1f}" stroke="#DDDDDD"/>'
            if panel == 0:
                yield word(x - 6, up(slip) + 4, slip, "end")
        for thrust in THRUSTS:
            yield word(along(panel, thrust), FLOOR + 15, thrust)
        for film, (_, colour) in CURVES.items():
            points = " ".join(f"{along(panel, thrust):.1f},{up(slips[film][thrust][panel]):.1f}" for thrust in THRUSTS)
            yield f'<polyline points="{points}" fill="none" stroke="{colour}" stroke-width="1.8"/>'
    yield word(LEFT + 2 * PANEL + 1.5 * GAP, HEIGHT - 10, "thrust [N]")
    yield word(16, (TOP + FLOOR) / 2, "slip [%]", more=f'transform="rotate(-90 16 {(TOP + FLOOR) / 2:.1f})"')
    yield "</svg>"


if __name__ == "__main__":
    pathlib.Path(sys.argv[1]).write_text("\n".join(drawn(*tables(PAGE.read_text()))) + "\n")
