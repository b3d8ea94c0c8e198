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

Usage: coupling.py PACKAGE.fmu DOCUMENT.md     measures stability, accuracy and cost, and writes the tables into the document
"""

import math
import shutil
import sys
import tempfile
import time as clock
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

THRUST, RADIAL = 1500.0, 30.0  # external force on the shaft along x, and along y from time 0 on [N]
SPEED = 200 * math.pi  # 6000 rpm [rad/s]
DENSITY = 7800.0  # of the shaft, a cylinder three diameters long [kg/m3]
ALPHA = 0.3  # numerical damping of scheme (f), 0 to 1/3

MASSES = [1.0, 5.0, 20.0]  # [kg]
STEPS = [5e-7, 1e-6, 2e-6, 5e-6, *(1e-5 * 2**k for k in range(9))]  # communication steps tried [s]
DURATION, FEWEST = 0.04, 60  # of a run that tells whether a scheme is stable [s], and its fewest steps
ERROR_DURATION = 0.00512  # of a run whose error is measured [s]

PLACE = [f"inner.position.{axis}" for axis in "xyz"] + [f"inner.rotation.{axis}" for axis in "yz"]
VELOCITY = [f"inner.velocity.{axis}" for axis in "xyz"] + [f"inner.rotation_rate.{axis}" for axis in "yz"]
WRENCH = ["inner.force.x", "inner.force.y", "inner.force.z", "inner.moment.y", "inner.moment.z"]


class Bearing:
    """A pose-driven package. Places, velocities and wrenches have the five components x, y, z, about y, about z."""

    def __init__(self, package):
        description = read_model_description(package)
        references = {v.name: v.valueReference for v in description.modelVariables}
        self.package, self.directory = package, tempfile.mkdtemp()
        extract(package, unzipdir=self.directory)
        self.fmu = FMU2Slave(
            guid=description.guid,
            unzipDirectory=self.directory,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="bearing",
        )
        self.fmu.instantiate()
        self.outputs = [references[name] for name in WRENCH]
        self.inputs = [references[name] for name in PLACE + VELOCITY]
        self.restart()

    def restart(self):
        """To time 0, where the bearing carries the scene's thrust; returns the place of its inner race."""
        self.fmu.reset()
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        return np.array(self.fmu.getReal(self.inputs[:5]))

    def wrench(self):
        """What the bearing exerts on the shaft."""
        return np.array(self.fmu.getReal(self.outputs))

    def step(self, time, step, place, velocity):
        """Wrench after a step that ends in the given place and velocity: they lead there from where this velocity comes."""
        self.fmu.setReal(self.inputs, [*(place - velocity * step), *velocity])
        self.fmu.doStep(time, step)
        return self.wrench()

    def derivative(self, step, place_gain, velocity_gain):
        """Derivative (5 by 5) of the wrench at the end of the last step by something that changes place and velocity
        there with the given gains."""
        columns = []
        for direction in np.eye(5):
            change = [*(direction * (place_gain - velocity_gain * step)), *(direction * velocity_gain)]
            columns.append(self.fmu.getDirectionalDerivative(self.outputs, self.inputs, change))
        return np.array(columns).T

    def close(self):
        """Frees the package."""
        self.fmu.freeInstance()
        shutil.rmtree(self.directory)


class Shaft:
    """A rigid cylinder."""

    def __init__(self, mass, place, wrench):
        radius = (mass / (6 * math.pi * DENSITY)) ** (1 / 3)
        tilting = mass * (3 * radius**2 + (6 * radius) ** 2) / 12
        self.inertia = np.diag([mass] * 3 + [tilting] * 2)
        self.gyroscopic = np.zeros((5, 5))
        self.gyroscopic[3, 4] = -0.5 * mass * radius**2 * SPEED
        self.gyroscopic[4, 3] = -self.gyroscopic[3, 4]
        self.place, self.velocity, self.wrench = place, np.zeros(5), wrench
        # what schemes remember of the step before
        self.wrench_before = wrench
        self.acceleration = np.linalg.solve(self.inertia, self.force(wrench, self.velocity))

    def force(self, wrench, velocity):
        """All forces and moments on the shaft."""
        return wrench + [THRUST, RADIAL, 0, 0, 0] + self.gyroscopic @ velocity

    def constant(self, force, step):
        """Place and velocity after a step under a constant force."""
        acceleration = np.linalg.solve(self.inertia, force)
        place = self.place + self.velocity * step + acceleration * (0.5 * step**2)
        return place, self.velocity + acceleration * step

    def end(self, place, velocity, wrench):
        """Takes over the end of a step."""
        self.wrench_before = self.wrench
        self.place, self.velocity, self.wrench = place, velocity, wrench


def leapfrog(bearing, shaft, time, step):
    half = 0.5 * step
    force = shaft.force(shaft.wrench, shaft.velocity)
    kicked = shaft.velocity + half * np.linalg.solve(shaft.inertia, force)
    place, foreseen = shaft.constant(force, step)
    wrench = bearing.step(time, step, place, foreseen)
    # The gyroscopic moment of the velocity at the end is known with it.
    momentum = shaft.inertia @ kicked + half * shaft.force(wrench, np.zeros(5))
    shaft.end(place, np.linalg.solve(shaft.inertia - half * shaft.gyroscopic, momentum), wrench)


def euler(bearing, shaft, time, step):
    velocity = shaft.velocity + step * np.linalg.solve(shaft.inertia, shaft.force(shaft.wrench, shaft.velocity))
    place = shaft.place + step * velocity
    shaft.end(place, velocity, bearing.step(time, step, place, velocity))


def held(bearing, shaft, time, step):
    end = shaft.constant(shaft.force(shaft.wrench, shaft.velocity), step)
    shaft.end(*end, bearing.step(time, step, *end))


def extrapolated(bearing, shaft, time, step):
    middle = 1.5 * shaft.wrench - 0.5 * shaft.wrench_before
    end = shaft.constant(shaft.force(middle, shaft.velocity), step)
    shaft.end(*end, bearing.step(time, step, *end))


def rollback(bearing, shaft, time, step):
    start = force = shaft.force(shaft.wrench, shaft.velocity)
    state = bearing.fmu.getFMUState()
    for sweep in range(3):
        if sweep > 0:
            bearing.fmu.setFMUState(state)
        end = shaft.constant(0.5 * (start + force), step)
        wrench = bearing.step(time, step, *end)
        force = shaft.force(wrench, end[1])
    bearing.fmu.freeFMUState(state)
    shaft.end(*end, wrench)


def implicit(bearing, shaft, time, step):
    beta, gamma = 0.25 * (1 + ALPHA) ** 2 * step**2, (0.5 + ALPHA) * step
    before = shaft.acceleration

    def end(after):
        """Place and velocity for an acceleration at the end (Newmark)."""
        place = shaft.place + shaft.velocity * step + before * (0.5 * step**2 - beta) + after * beta
        return place, shaft.velocity + before * (step - gamma) + after * gamma

    # a first guess, which leaves the velocity as it is, and how the force at the end answers to the acceleration there
    state = bearing.fmu.getFMUState()
    guessed = before * (1 - step / gamma)
    guess = end(guessed)
    force = shaft.force(bearing.step(time, step, *guess), guess[1])
    derivative = bearing.derivative(step, beta, gamma) + shaft.gyroscopic * gamma
    bearing.fmu.setFMUState(state)
    bearing.fmu.freeFMUState(state)
    # inertia after = (1 - alpha) (force + derivative (after - guessed)) + alpha start
    start = shaft.force(shaft.wrench, shaft.velocity)
    right = (1 - ALPHA) * (force - derivative @ guessed) + ALPHA * start
    shaft.acceleration = np.linalg.solve(shaft.inertia - (1 - ALPHA) * derivative, right)
    solved = end(shaft.acceleration)
    shaft.end(*solved, bearing.step(time, step, *solved))


SCHEMES = {
    "(a) leapfrog": leapfrog,
    "(b) Euler": euler,
    "(c) held": held,
    "(d) extrapolated": extrapolated,
    "(e) rollback": rollback,
    "(f) implicit": implicit,
}


def simulate(bearing, scheme, mass, step, duration):
    """Places of the shaft, one row per communication point; ends early when the shaft leaves the bearing or the bearing
    refuses a step."""
    shaft = Shaft(mass, bearing.restart(), bearing.wrench())
    path = [shaft.place]
    for k in range(round(duration / step)):
        try:
            scheme(bearing, shaft, k * step, step)
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
    for step in STEPS if scheme is held else STEPS[4:]:
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
    Shaft(MASSES[0], bearing.restart(), bearing.wrench())
    return (least - (clock.process_time() - begin)) / steps * 1e6


def table(head, rows):
    """A Markdown table."""
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def main():
    bearing = Bearing(sys.argv[1])
    document = Path(sys.argv[2])
    micro = lambda step: f"{step * 1e6:g}"
    rows = []
    for mass in MASSES:
        largest = {name: largest_stable_step(bearing, scheme, mass) for name, scheme in SCHEMES.items()}
        rows.append([f"{mass:g} kg"])
        for name, step in largest.items():
            tried = STEPS if SCHEMES[name] is held else STEPS[4:]
            mark = "below " + micro(tried[0]) if step == 0 else micro(step)
            rows[-1].append(mark + (" and more" if step == STEPS[-1] else ""))
        print(rows[-1], flush=True)
    stability = table(["shaft", *(f"{name} [us]" for name in SCHEMES)], rows)

    reference_step = 1e-6
    reference = simulate(bearing, rollback, MASSES[0], reference_step, ERROR_DURATION)
    rows = []
    for step in [1e-6, 2e-6, 5e-6, 1e-5, 2e-5, 4e-5, 8e-5, 1.6e-4, 3.2e-4, 6.4e-4]:
        errors = [error(bearing, scheme, MASSES[0], step, reference, reference_step) for scheme in SCHEMES.values()]
        rows.append([f"{micro(step)} us", *(f"{100 * e:.2g} %" if e < 1 else "lost" for e in errors)])
        print(rows[-1], flush=True)
    accuracy = table(["step", *SCHEMES], rows)
    costs = [f"{cost(bearing, scheme):.0f}" for scheme in (leapfrog, euler, extrapolated, rollback, implicit)]
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
