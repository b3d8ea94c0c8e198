"""A helical pinion shaft on two 7206 B, back to back: mesh ripple, a housing that tilts, a loss of lubrication. docs/gearbox.md explains it.

Usage: gearbox.py DIRECTORY [MILLISECONDS [DOCUMENT]]    (all 80 ms if not given; the table is put into the document)
Leaves there: the packages of both bearings, gearbox.csv, and gearbox.png where matplotlib is installed. Needs FMPy.
"""

import importlib.util
import sys
import time as clock
from pathlib import Path

import numpy as np
import roulement
from roulement import load_cases
from roulement.coupling import Bearings, FmuBearing, Leapfrog, gyroscopic, rigid

BEARING, BALLS = "7206 B", 13
LEFT, RIGHT = -0.05, 0.05  # middles of the bearings along the shaft [m]
PRELOAD = 1500.0  # axial force of one bearing on the other [N]
SPEED = 6000 * np.pi / 30  # [rad/s]
MASS, POLAR, TRANSVERSE = 1.8, 6e-4, 4e-3  # of shaft and pinion [kg, kg m2, kg m2]
WEIGHT = 9.81 * MASS  # along -z [N]
TEETH, PITCH_RADIUS, PRESSURE, HELIX = 23, 0.0238, np.radians(20), np.radians(-15)
PINION = -0.01  # its middle along the shaft [m]; the pitch point is at y = PITCH_RADIUS
TORQUE, RIPPLE = 30.0, 0.1  # [N m], and the part of it that swings at mesh frequency
STEP, ROWS = 2e-5, 2  # communication step [s], and steps of a row
PHASES = {"aligned": (0.02, 0.03), "tilted by 1 mrad": (0.05, 0.06), "without oil": (0.07, 0.08)}  # [s], 23 periods of the mesh each
TILT = load_cases.misalignment(rz=1e-3, start=0.03, rise=0.01)
OIL = {"friction.ball_race": 0.2, "film.iso_vg": 68, "film.temperature": "70 degC", "film.lubrication": load_cases.ramp(1.0, 0.0, start=0.06, rise=1e-3)}


def mesh(torque):
    """Wrench of the mesh on the shaft about its middle [N, N m]: forces at the pitch point, moments about y and z."""
    tangential = torque / PITCH_RADIUS
    force = tangential * np.array([-np.tan(HELIX), -np.tan(PRESSURE) / np.cos(HELIX), 1.0])
    return np.array([*force, *np.cross([PINION, PITCH_RADIUS, 0.0], force)[1:]])


def load(time):
    """Load of the shaft at a time [s]: the torque comes on within 10 ms, the weight was always there."""
    on = 0.5 - 0.5 * np.cos(np.pi * min(time / 0.01, 1.0))
    return mesh(TORQUE * on * (1 + RIPPLE * np.sin(TEETH * SPEED * time))) - [0, 0, WEIGHT, 0, 0]


def by_hand():
    """Radial forces (y, z) of the shaft on the left and right bearing [N] by statics: each acts where the cone of its contacts meets the
    axis, pitch radius times tan(contact angle) outside its middle."""
    cone = 0.023 * np.tan(np.radians(40))
    left, right = LEFT - cone, RIGHT + cone
    _, y, z, about_y, about_z = mesh(TORQUE) - [0, 0, WEIGHT, 0, 0]
    on_right = np.array([about_z - left * y, -about_y - left * z]) / (right - left)
    return {"left": np.array([y, z]) - on_right, "right": on_right}


def scenes():
    """Both bearings under their preload. The right one has its x axis, and so the shaft's speed, the other way. Nothing keeps the balls apart, as in
    those of a machine (shaft.toml)."""
    common = {"effects.cage": "none", "inner.drive": "pose", "load.x.force": PRELOAD, "load.duration": 0.2, "effects.per_ball_outputs": True} | OIL
    scene = roulement.catalogue.bearing(BEARING).with_(common)
    return {"left": scene.with_({"load.inner_speed": SPEED}), "right": scene.with_({"load.inner_speed": -SPEED} | TILT)}


def of_ball(name):
    """That variable of every ball."""
    return [f"ball[{ball}].{name}" for ball in range(1, BALLS + 1)]


# What is drawn and tabled of each bearing: names of its variables.
WANTED = {
    "force": [f"inner.force.{axis}" for axis in "xyz"],
    "loss": ["friction_power"],
    "rolling": ["rolling_power.inner", "rolling_power.outer"],
    "cage": ["cage.speed"],
    "damage": ["life.damage"],
    "load": of_ball("inner.load"),
    "azimuth": of_ball("azimuth"),
}


def run(folder, duration):
    """Runs both packages on the shaft; returns columns over time by names, those of a bearing by its side and a name."""
    sides = {side: FmuBearing.load(roulement.package(scene, folder / f"{side}.fmu")) for side, scene in scenes().items()}
    both = Bearings((sides["left"], LEFT, 1), (sides["right"], RIGHT, -1))
    shaft = Leapfrog(both, rigid(MASS, TRANSVERSE), load, gyroscopic(POLAR, SPEED))
    rows, began = [], clock.process_time()
    for step in range(1, round(duration / STEP) + 1):
        shaft.step(STEP)
        if step % ROWS == 0:
            row = {"time": shaft.time, "shaft": shaft.place}
            rows.append(row | {(side, key): bearing.read(names) for side, bearing in sides.items() for key, names in WANTED.items()})
    print(f"{duration * 1e3:.0f} ms in {clock.process_time() - began:.1f} s of CPU time (two packages, communication steps of {STEP * 1e6:.0f} us)")
    for bearing in sides.values():
        bearing.close()
    return in_axes_of_shaft({key: np.array([row[key] for row in rows]) for key in rows[0]})


def in_axes_of_shaft(found):
    """The same with what is in the axes of the right bearing turned to those of the shaft."""
    turned = {"force": found["right", "force"] * [-1, -1, 1], "azimuth": np.pi - found["right", "azimuth"], "cage": -found["right", "cage"]}
    return found | {("right", key): of for key, of in turned.items()}


def table(found):
    """What each phase comes to, as a table of Markdown."""
    lines = ["| phase | bearing | radial force, by hand [N] | axial force [N] | ball loads [N] | losses [W] | life L10r [h] |"]
    lines.append("|---|---|---:|---:|---:|---:|---:|")
    for phase, (start, end) in PHASES.items():
        at = (found["time"] > start) & (found["time"] < end + STEP)
        for side, hand in by_hand().items() if at.any() else ():
            # What the shaft does to the bearing is the opposite of the bearing's force on it.
            axial, *radial = -found[side, "force"][at].mean(axis=0)
            radial, hand = np.linalg.norm(radial), np.linalg.norm(hand)
            loads, losses = found[side, "load"][at], found[side, "loss"][at].mean()
            # The part of the life that was used up in the phase, in the time that it took.
            used, time = (np.ptp(of[at]) for of in (found[side, "damage"], found["time"]))
            hours = time / used / 3600
            balls = f"{loads.min():.0f} to {loads.max():.0f}"
            lines.append(f"| {phase} | {side} | {radial:.0f}, {hand:.0f} | {abs(axial):.0f} | {balls} | {losses:.1f} | {hours:.0f} |")
    return "\n".join(lines)


def put(path, name, text):
    """Puts a text into a document, between `<!-- begin NAME -->` and `<!-- end -->`."""
    begin, end = f"<!-- begin {name} -->", "<!-- end -->"
    head, rest = path.read_text().split(begin)
    path.write_text(f"{head}{begin}\n\n{text}\n\n{end}{rest.split(end, 1)[1]}")


def over_azimuth(found, side, at, bins=72):
    """Middles of sectors [rad], and in each the mean, least and largest load of the balls [N]."""
    sector = np.floor(np.mod(found[side, "azimuth"][at], 2 * np.pi) * bins / (2 * np.pi)).astype(int).ravel() % bins
    # In a short run some sectors have seen no ball.
    loads = [((k + 0.5) * 2 * np.pi / bins, found[side, "load"][at].ravel()[sector == k]) for k in range(bins) if np.any(sector == k)]
    # Closed, for a curve all around.
    return np.array([(azimuth, of.mean(), of.min(), of.max()) for azimuth, of in loads + loads[:1]]).T


def picture(found, path):
    """Ball loads over azimuth in each phase, path of the shaft; losses, cage speeds, and loads of three balls of each bearing over time."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure = pyplot.figure(figsize=(12, 10.2), layout="constrained")
    grid = figure.add_gridspec(3, 6, height_ratios=(1.25, 1, 1))
    time, colours = found["time"] * 1e3, dict(zip(PHASES, ("tab:blue", "tab:orange", "tab:green")))
    within = {phase: (found["time"] > start) & (found["time"] <= end) for phase, (start, end) in PHASES.items() if np.any(found["time"] > start)}
    for place, side in enumerate(("left", "right")):
        polar = figure.add_subplot(grid[0, 2 * place : 2 * place + 2], projection="polar")
        for phase, at in within.items():
            azimuth, mean, least, largest = over_azimuth(found, side, at)
            polar.plot(azimuth, mean, lw=1.5, color=colours[phase], label=phase)
            if phase == "aligned":
                polar.fill_between(azimuth, least, largest, color=colours[phase], alpha=0.2, lw=0)
        polar.set_title(f"{side} bearing: ball load [N] over azimuth")
        polar.set_xticks(np.radians([0, 90, 180, 270]), ["y", "z", "-y", "-z"])
        polar.set_rlabel_position(315)
    polar.legend(loc="lower left", bbox_to_anchor=(-0.5, -0.15), frameon=False)
    orbit = figure.add_subplot(grid[0, 4:])
    for phase, at in within.items():
        orbit.plot(found["shaft"][at, 1] * 1e6, found["shaft"][at, 2] * 1e6, lw=0.7, color=colours[phase])
    orbit.set(title="path of the shaft's middle", xlabel="y [um]", ylabel="z [um]", aspect="equal", adjustable="datalim")
    losses, cages, *loads = (figure.add_subplot(grid[row, half]) for row in (1, 2) for half in (slice(3), slice(3, None)))
    for side, colour in (("left", "tab:gray"), ("right", "tab:red")):
        losses.plot(time, found[side, "loss"], lw=0.6, color=colour, label=side)
        losses.plot(time, found[side, "rolling"].sum(axis=1), lw=0.6, ls="--", color=colour, label=f"{side}, rolling in oil alone")
        cages.plot(time, found[side, "cage"] * 30 / np.pi, lw=0.8, color=colour, label=side)
    losses.set(title="friction losses of both bearings", ylabel="[W]")
    losses.legend(loc="lower left", frameon=False, ncols=2, fontsize=8)
    cages.set(title="cage speeds (mean of the balls)", ylabel="[rpm]")
    cages.legend(loc="lower left", frameon=False, ncols=2)
    for axes, side in zip(loads, ("left", "right")):
        for ball, colour in zip((0, 4, 8), ("tab:purple", "tab:brown", "tab:cyan")):
            axes.plot(time, found[side, "load"][:, ball], lw=0.7, color=colour, label=f"ball {ball + 1}")
        axes.set(title=f"{side} bearing: loads of three of its {BALLS} balls", xlabel="time [ms]", ylabel="[N]")
        axes.legend(loc="upper right", bbox_to_anchor=(1, 0.95), frameon=False, ncols=3)
    for axes in (losses, cages, *loads):
        # Room for what happens; cage speeds are all but the same.
        low, high = axes.get_ylim() if axes is cages else (0, axes.get_ylim()[1])
        axes.set_ylim(low, high + 0.25 * (high - low))
        for start, what in ((0, "torque comes on"), (30, "right housing tilts by 1 mrad"), (60, "oil is lost")):
            if start <= time[-1]:
                axes.axvline(start, color="black", lw=0.6, ls=":")
                axes.annotate(what, (start + 0.5, 0.99), xycoords=("data", "axes fraction"), va="top", fontsize=8)
    figure.savefig(path, dpi=110)


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    found = run(folder, float(sys.argv[2]) * 1e-3 if len(sys.argv) > 2 else 0.08)
    print(table(found))
    if len(sys.argv) > 3:
        put(Path(sys.argv[3]), "packages coupled", table(found))
    columns = {"time [s]": found["time"]} | {f"shaft.{name}": found["shaft"][:, k] for k, name in enumerate(("x [m]", "y [m]", "z [m]", "ry [rad]", "rz [rad]"))}
    columns |= {f"{side}.force.{axis} [N]": found[side, "force"][:, k] for side in ("left", "right") for k, axis in enumerate("xyz")}
    columns |= {f"{side}.friction_power [W]": found[side, "loss"][:, 0] for side in ("left", "right")}
    np.savetxt(folder / "gearbox.csv", np.column_stack(list(columns.values())), delimiter=",", header=",".join(columns), comments="", fmt="%.9g")
    if importlib.util.find_spec("matplotlib"):
        picture(found, folder / "gearbox.png")
