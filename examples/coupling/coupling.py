"""A rigid shaft on a bearing package, coupled in six ways.

The shaft carries the bearing's thrust and turns at a prescribed speed; at time 0 a radial force is put on it. It moves
in five directions: x, y, z and the tilts about y and z. A communication step takes it to a new place and velocity, and
the bearing along a smooth path to the same. The schemes differ in the wrench that the shaft is moved with, and in how:

(a) leapfrog       half a kick by the wrench at the start, drift, half a kick by the wrench at the end (velocity Verlet)
(b) Euler          velocity first, by the wrench at the start, then position with that velocity (semi-implicit Euler)
(c) held           the wrench at the start of the step, as a constant force
(d) extrapolated   the line through the last two wrenches
(e) rollback       the mean of start and end: the step is done three times, from a saved FMU state
(f) implicit       start and end weighted as in the bearing's own time integration (HHT), by one step of Newton's method:
                   the step is done twice, and the directional derivatives of the first time give its matrix

(a), (b) and (f) are those of the Python package (`roulement.coupling`); the others are here, to compare with.

Usage: coupling.py PACKAGE.fmu DOCUMENT.md     measures stability, accuracy and cost, and writes the tables into the document
"""

import math
import sys
import time as clock
from pathlib import Path

import numpy as np
from roulement.coupling import Euler, FmuBearing, Implicit, Leapfrog, Shaft, gyroscopic, rigid

THRUST, RADIAL = 1500.0, 30.0  # external force on the shaft along x, and along y from time 0 on [N]
SPEED = 200 * math.pi  # 6000 rpm [rad/s]
DENSITY = 7800.0  # of the shaft, a cylinder three diameters long [kg/m3]

MASSES = [1.0, 5.0, 20.0]  # [kg]
STEPS = [5e-7, 1e-6, 2e-6, 5e-6, *(1e-5 * 2**k for k in range(9))]  # communication steps tried [s]
DURATION, FEWEST = 0.04, 60  # of a run that tells whether a scheme is stable [s], and its fewest steps
ERROR_DURATION = 0.00512  # of a run whose error is measured [s]


def cylinder(mass):
    """Inertia and gyroscopic matrix of the shaft."""
    radius = (mass / (6 * math.pi * DENSITY)) ** (1 / 3)
    tilting = mass * (3 * radius**2 + (6 * radius) ** 2) / 12
    return rigid(mass, tilting), gyroscopic(0.5 * mass * radius**2, SPEED)


class Constant(Shaft):
    """Schemes that move the shaft by a force that is constant over the step."""

    def end(self, force, step):
        """Place and velocity after a step."""
        acceleration = np.linalg.solve(self.inertia, force)
        place = self.place + self.velocity * step + acceleration * (0.5 * step**2)
        return place, self.velocity + acceleration * step

    def take(self, step, end, wrench):
        """Takes over the end of a step."""
        (self.place, self.velocity), self.wrench, self.time = end, wrench, self.time + step


class Held(Constant):
    def step(self, step):
        end = self.end(self.total(self.wrench, self.velocity, self.time), step)
        self.take(step, end, self.bearing.step(step, *end))


class Extrapolated(Constant):
    before = None

    def step(self, step):
        before, self.before = self.wrench if self.before is None else self.before, self.wrench
        end = self.end(self.total(1.5 * self.wrench - 0.5 * before, self.velocity, self.time), step)
        self.take(step, end, self.bearing.step(step, *end))


class Rollback(Constant):
    def step(self, step):
        start = force = self.total(self.wrench, self.velocity, self.time)
        fmu = self.bearing.fmu
        state, time = fmu.getFMUState(), self.bearing.time
        for sweep in range(3):
            if sweep > 0:
                fmu.setFMUState(state)
                self.bearing.time = time
            end = self.end(0.5 * (start + force), step)
            wrench = self.bearing.step(step, *end)
            force = self.total(wrench, end[1], self.time + step)
        fmu.freeFMUState(state)
        self.take(step, end, wrench)


SCHEMES = {
    "(a) leapfrog": Leapfrog,
    "(b) Euler": Euler,
    "(c) held": Held,
    "(d) extrapolated": Extrapolated,
    "(e) rollback": Rollback,
    "(f) implicit": Implicit,
}


def start(bearing, scheme, mass):
    """The shaft at time 0."""
    bearing.restart()
    inertia, turning = cylinder(mass)
    return scheme(bearing, inertia, lambda time: [THRUST, RADIAL, 0, 0, 0], turning)


def simulate(bearing, scheme, mass, step, duration):
    """Places of the shaft, one row per communication point; ends early when the shaft leaves the bearing or the bearing
    refuses a step."""
    shaft = start(bearing, scheme, mass)
    path = [shaft.place]
    for _ in range(round(duration / step)):
        try:
            shaft.step(step)
        except Exception as refused:  # FMPy has no narrower one
            print(f"  {scheme.__name__}, {mass:g} kg, {step * 1e6:g} us: {refused}", file=sys.stderr)
            break
        path.append(shaft.place)
        if not np.abs(shaft.place).max() < 1e-2:
            break
    return np.array(path)


def stable(bearing, scheme, mass, step):
    """Does the vibration after the force has come on die down? The largest speed of the last quarter of a run is below
    that of the first."""
    steps = max(round(DURATION / step), FEWEST)
    path = simulate(bearing, scheme, mass, step, steps * step)
    if len(path) <= steps:
        return False
    speed = np.linalg.norm(np.diff(path[:, :3], axis=0), axis=1) / step
    return speed[-(steps // 4) :].max() < speed[: steps // 4].max()


def largest_stable_step(bearing, scheme, mass):
    """The last of the steps tried, from small to large, before the first that is unstable; 0 if the first is."""
    largest = 0.0
    # Schemes that are known to stand 10 us need not be tried below.
    for step in STEPS if scheme is Held else STEPS[4:]:
        if not stable(bearing, scheme, mass, step):
            break
        largest = step
    return largest


def error(bearing, scheme, mass, step, reference, reference_step):
    """Largest distance from the reference path over the largest displacement there."""
    path = simulate(bearing, scheme, mass, step, ERROR_DURATION)[:, :3]
    if len(path) <= round(ERROR_DURATION / step):
        return math.inf
    every = round(step / reference_step)
    exact = reference[::every][: len(path), :3]
    return np.abs(path - exact).max() / np.abs(reference[:, :3] - reference[0, :3]).max()


def cost(bearing, scheme, step=1e-5, steps=512):
    """CPU time of a communication step [us], with the master's own part."""
    least = math.inf
    for _ in range(3):
        begin = clock.process_time()
        simulate(bearing, scheme, MASSES[0], step, steps * step)
        least = min(least, clock.process_time() - begin)
    # The start is not part of it.
    begin = clock.process_time()
    start(bearing, scheme, MASSES[0])
    return (least - (clock.process_time() - begin)) / steps * 1e6


def table(head, rows):
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def main():
    bearing = FmuBearing.load(sys.argv[1])
    document = Path(sys.argv[2])
    micro = lambda step: f"{step * 1e6:g}"
    rows = []
    for mass in MASSES:
        largest = {name: largest_stable_step(bearing, scheme, mass) for name, scheme in SCHEMES.items()}
        rows.append([f"{mass:g} kg"])
        for name, step in largest.items():
            tried = STEPS if SCHEMES[name] is Held else STEPS[4:]
            mark = "below " + micro(tried[0]) if step == 0 else micro(step)
            rows[-1].append(mark + (" and more" if step == STEPS[-1] else ""))
        print(rows[-1], flush=True)
    stability = table(["shaft", *(f"{name} [us]" for name in SCHEMES)], rows)

    reference_step = 1e-6
    reference = simulate(bearing, Rollback, MASSES[0], reference_step, ERROR_DURATION)
    rows = []
    for step in [1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 4e-5, 8e-5, 1.6e-4, 3.2e-4, 6.4e-4]:
        errors = [error(bearing, scheme, MASSES[0], step, reference, reference_step) for scheme in SCHEMES.values()]
        rows.append([f"{micro(step)} us", *(f"{100 * e:.2g} %" if e < 1 else "lost" for e in errors)])
        print(rows[-1], flush=True)
    accuracy = table(["step", *SCHEMES], rows)
    costs = [f"{cost(bearing, scheme):.0f}" for scheme in SCHEMES.values() if scheme is not Held]
    costs = table([name for name in SCHEMES if "held" not in name], [costs])
    print(costs, flush=True)
    bearing.close()

    text = document.read_text()
    for name, content in [("stability", stability), ("accuracy", accuracy), ("cost", costs)]:
        before, rest = text.split(f"<!-- {name} -->\n", 1)
        after = rest.split("<!-- end -->", 1)[1]
        text = f"{before}<!-- {name} -->\n{content}\n<!-- end -->{after}"
    document.write_text(text)


if __name__ == "__main__":
    main()
