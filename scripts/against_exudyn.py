"""Radial bearing in Exudyn and in roulement: CPU time against error. `scripts/against-exudyn` runs it.

The same in both: geometry, masses, Hertz stiffness of the contacts (elliptic integrals, Harris and Kotzalas 2006, ch. 6), friction
coefficient, load, speed, and the place where all begins, the equilibrium. Exudyn 1.13.6 has a contact of sphere and torus
(`ObjectContactSphereTorus`) with Coulomb friction that is proportional to the slip speed below a limit; that limit is set so that
the slope is that of Kalker's linear theory at the mean load. Damping is linear there and follows Hunt and Crossley here, of
equal size at the mean load. Exudyn's explicit solvers take no constraints, so its ring gets rotational inertias that nothing changes
within the run; roulement holds tilt and speed.

Errors are those of each program against itself with far smaller steps: the root mean square, over all rows, of the distance of the ring's centre
from where it should be, over the mean approach of the balls.
"""
import csv
import math
import re
import resource
import subprocess
import sys
import tempfile
import time
import tomllib
import warnings
from pathlib import Path

import exudyn
import numpy
from exudyn.utilities import (
    InertiaSphere,
    MarkerBodyRigid,
    NodeGenericData,
    ObjectContactSphereTorus,
    ObjectGround,
    RigidBodyInertia,
    SensorBody,
)

ROOT = Path(__file__).resolve().parent.parent
SCENE = ROOT / "scenes/radial.toml"
warnings.simplefilter("ignore", DeprecationWarning)
# [s] distance of rows.
ROW = 5e-5
# [Pa], [-], [kg/m3]: bearing steel, as scenes have it where they do not say.
YOUNGS, POISSON, DENSITY = 206e9, 0.3, 7800.0


def number(text):
    """A number in SI units from a scene's text such as "10 um"."""
    if not isinstance(text, str):
        return float(text)
    value, unit = text.split()
    return float(value) * {"mm": 1e-3, "um": 1e-6, "rpm": 2 * math.pi / 60, "kg": 1, "N": 1, "kg m^2": 1, "s/m": 1}[
        text[len(value) :].strip() or unit
    ]


def elliptic(m):
    """Complete elliptic integrals of the first and second kind by the arithmetic-geometric mean."""
    a, b, total, power = 1.0, math.sqrt(1 - m), 0.5 * m, 1.0
    while abs(a - b) > 1e-15:
        a, b, c = 0.5 * (a + b), math.sqrt(a * b), 0.5 * (a - b)
        total += power * c * c
        power *= 2
    first = 0.5 * math.pi / a
    return first, first * (1 - total)


def hertz(rolling, transverse):
    """Stiffness [N/m^1.5] and semi-axes over the root of the approach [m^0.5] of relative curvatures [1/m]."""
    total = rolling + transverse
    wanted = abs(rolling - transverse) / total
    low, high = 1.0 + 1e-9, 1e6
    for _ in range(200):
        k = math.sqrt(low * high)
        first, second = elliptic(1 - 1 / (k * k))
        if ((k * k + 1) * second - 2 * first) / ((k * k - 1) * second) < wanted:
            low = k
        else:
            high = k
    first, second = elliptic(1 - 1 / (k * k))
    approach = 2 * first / math.pi * (math.pi / (2 * k * k * second)) ** (1 / 3)
    per_root = math.sqrt(2 / (approach * total))
    compliance = 2 * (1 - POISSON**2) / YOUNGS
    long, short = (2 * k * k * second / math.pi) ** (1 / 3), (2 * second / (math.pi * k)) ** (1 / 3)
    return per_root**3 * total / (1.5 * compliance), per_root * math.sqrt(long * short)


class Bearing:
    """Numbers of the scene."""

    def __init__(self, scene):
        section = scene["bearing"]
        self.balls = section["balls"]
        self.radius = 0.5 * number(section["ball_diameter"])
        self.pitch = 0.5 * number(section["pitch_diameter"])
        clearance = number(section["diametral_clearance"])
        conformities = [section["inner_conformity"], section["outer_conformity"]]
        self.grooves = [2 * f * self.radius for f in conformities]
        outer = self.pitch + self.radius + clearance / 4 - self.grooves[1]
        self.circles = [outer + sum(self.grooves) - 2 * self.radius - clearance / 2, outer]
        self.mass = DENSITY * 4 / 3 * math.pi * self.radius**3
        self.friction = scene["friction"]["ball_race"]
        self.damping = number(scene["effects"]["damping"])
        self.race_mass = number(scene["inner"]["mass"])
        self.speed = number(scene["load"]["inner_speed"])
        self.force = number(scene["load"]["y"]["force"])
        # Ring surfaces where balls touch: convex inside, concave outside.
        rolling = [1 / (self.pitch - self.radius), -1 / (self.pitch + self.radius)]
        contacts = [hertz(1 / self.radius + r, 1 / self.radius - 1 / g) for r, g in zip(rolling, self.grooves)]
        self.stiffness = [stiffness for stiffness, _ in contacts]
        self.semi_axes = [semi_axis for _, semi_axis in contacts]

    def slip_limit(self, load):
        """[m/s] slip speed at which linear theory reaches the friction limit: C11 of a patch 8 times as wide as long is 3.4."""
        approach = (load / self.stiffness[0]) ** (2 / 3)
        shear = YOUNGS / (2 * (1 + POISSON))
        slope = shear * self.semi_axes[0] ** 2 * approach * 3.4
        rolling = self.speed * (self.pitch - self.radius) * (self.pitch + self.radius) / (2 * self.pitch)
        return self.friction * load / slope * rolling


class Results:
    """Rows of a run: time [s] and place of the ring's centre [m]; CPU time [s]."""

    def __init__(self, times, places, seconds):
        self.times, self.places, self.seconds = times, places, seconds

    def error(self, reference, scale):
        return float(numpy.sqrt(numpy.mean(numpy.sum((self.places - reference.places) ** 2, axis=1)))) / scale


def run_roulement(program, duration, step, goal=None, row=ROW):
    """Runs the scene with fixed steps [s], or with a goal; returns the first row, too."""
    text = SCENE.read_text()
    text = re.sub(r"^duration = .*", f'duration = "{duration} s"', text, flags=re.M)
    text = re.sub(r"^output_interval = .*", f'output_interval = "{row} s"', text, flags=re.M)
    steps = f'accuracy = "{goal}"' if goal else f'tolerance = 0.01\nmax_step = "{step} s"\ninitial_step = "{step} s"'
    text = re.sub(r"^tolerance = .*\nmax_step = .*", steps, text, flags=re.M)
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder, "scene.toml")
        scene.write_text(text)
        command = [program, "run", scene, "-o", folder]
        before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(done.stderr)
        seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
        with open(Path(folder, "results.csv")) as file:
            rows = list(csv.DictReader(file))
    column = lambda name: numpy.array([float(row[name]) for row in rows])
    places = numpy.stack([column("inner.position.y [m]"), column("inner.position.z [m]")], axis=1)
    return Results(column("time [s]"), places, seconds), rows[0]


def run_exudyn(bearing, start, duration, solver, step=None, tolerance=None):
    """Runs the same bearing in Exudyn from the first row of a run of the scene."""
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    value = lambda name: float(start[name])
    ground = system.AddObject(ObjectGround())
    outer = system.AddMarker(MarkerBodyRigid(bodyNumber=ground))
    place = numpy.array([0.0, value("inner.position.y [m]"), value("inner.position.z [m]")])
    heavy = 1e3
    ring = system.CreateRigidBody(
        referencePosition=list(place),
        inertia=RigidBodyInertia(mass=bearing.race_mass, inertiaTensor=numpy.diag([heavy] * 3)),
        initialAngularVelocity=[bearing.speed, 0, 0],
        nodeType=exudyn.NodeType.RotationRotationVector,
    )
    inner = system.AddMarker(MarkerBodyRigid(bodyNumber=ring))
    system.CreateForce(bodyNumber=ring, loadVector=[0, bearing.force, 0])
    loads = [value(f"ball[{k + 1}].inner.load [N]") for k in range(bearing.balls)]
    mean = sum(loads) / sum(load > 0 for load in loads)
    for k in range(bearing.balls):
        azimuth = value(f"ball[{k + 1}].azimuth [rad]")
        orbit = value(f"ball[{k + 1}].orbital_speed [rad/s]")
        depth = (value(f"ball[{k + 1}].outer.load [N]") / bearing.stiffness[1]) ** (2 / 3)
        distance = bearing.circles[1] + bearing.grooves[1] - bearing.radius + depth
        radial = numpy.array([0.0, math.cos(azimuth), math.sin(azimuth)])
        around = numpy.array([0.0, -math.sin(azimuth), math.cos(azimuth)])
        # Rolling on the inner ring.
        spin = (orbit * bearing.pitch - bearing.speed * (bearing.pitch - bearing.radius)) / bearing.radius
        ball = system.CreateRigidBody(
            referencePosition=list(distance * radial),
            initialVelocity=list(distance * orbit * around),
            initialAngularVelocity=[spin, 0, 0],
            inertia=InertiaSphere(mass=bearing.mass, radius=bearing.radius),
            nodeType=exudyn.NodeType.RotationRotationVector,
        )
        marker = system.AddMarker(MarkerBodyRigid(bodyNumber=ball))
        for side, race in enumerate([inner, outer]):
            data = system.AddNode(NodeGenericData(initialCoordinates=[0, 0, 0, 0], numberOfDataCoordinates=4))
            system.AddObject(
                ObjectContactSphereTorus(
                    markerNumbers=[marker, race],
                    nodeNumber=data,
                    sphereRadius=bearing.radius,
                    torusMajorRadius=bearing.circles[side],
                    torusMinorRadius=bearing.grooves[side],
                    torusAxis=[1, 0, 0],
                    dynamicFriction=bearing.friction,
                    frictionProportionalZone=bearing.slip_limit(mean),
                    contactStiffness=bearing.stiffness[side],
                    contactStiffnessExponent=1.5,
                    contactDamping=bearing.damping * mean,
                    restitutionCoefficient=1,
                    impactModel=0,
                )
            )
    sensor = system.AddSensor(
        SensorBody(bodyNumber=ring, outputVariableType=exudyn.OutputVariableType.Position, storeInternal=True)
    )
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = ROW
    settings.displayComputationTime = False
    integration = settings.timeIntegration
    integration.verboseMode = 0
    integration.endTime = duration
    # Steps that the contacts recommend end in failures at some step sizes.
    integration.discontinuous.useRecommendedStepSize = False
    integration.minimumStepSize = 1e-13
    integration.automaticStepSize = step is None
    if step:
        integration.numberOfSteps = round(duration / step)
    else:
        integration.initialStepSize = 1e-8
        integration.numberOfSteps = round(duration / ROW)
        integration.relativeTolerance = tolerance
        integration.absoluteTolerance = 1e-3 * tolerance
    begin = time.process_time()
    system.SolveDynamic(settings, solverType=getattr(exudyn.DynamicSolverType, solver))
    seconds = time.process_time() - begin
    table = numpy.atleast_2d(system.GetSensorStoredData(sensor))
    return Results(table[:, 0], table[:, 2:4], seconds)


def main():
    program, duration = sys.argv[1], float(sys.argv[2]) * 1e-3
    bearing = Bearing(tomllib.loads(SCENE.read_text()))
    # What errors are measured by; the last row is where Exudyn ends as well.
    reference, start = run_roulement(program, duration, 2.5e-7)
    loads = [float(start[f"ball[{k + 1}].inner.load [N]"]) for k in range(bearing.balls)]
    scale = (max(loads) / bearing.stiffness[0]) ** (2 / 3)
    print("| program | steps | CPU [s/s] | error |")
    print("|---|---|---:|---:|")
    ours = []
    for step, goal in [(2.5e-5, None), (1e-5, None), (5e-6, None), (2.5e-6, None), (None, "fast"), (None, "balanced")]:
        result, _ = run_roulement(program, duration, step, goal)
        # Long enough for the clock, without the start, and with few rows to be written.
        short, long = (
            min(run_roulement(program, time, step, goal, row=1e-3)[0].seconds for _ in range(3)) for time in (0.05, 0.35)
        )
        seconds = (long - short) / 0.3
        print(f"| roulement | {goal or f'{step * 1e6:g} us'} | {seconds:.2f} | {result.error(reference, scale):.1e} |", flush=True)
        if step:
            ours.append((math.log(result.error(reference, scale)), math.log(seconds)))
    errors, times = numpy.array(sorted(ours)).T
    theirs = run_exudyn(bearing, start, duration, "RK44", 1e-7)
    cases = [("RK44", 4e-7, None), ("RK44", 2e-7, None), ("ODE23", None, 1e-4), ("DOPRI5", None, 1e-2), ("DOPRI5", None, 1e-5)]
    times_longer = []
    for solver, step, tolerance in cases:
        how = f"{solver}, {step * 1e6:g} us" if step else f"{solver}, tolerance {tolerance:g}"
        try:
            result = run_exudyn(bearing, start, duration, solver, step, tolerance)
            seconds, error = result.seconds / duration, result.error(theirs, scale)
            print(f"| Exudyn | {how} | {seconds:.0f} | {error:.1e} |", flush=True)
            # Between fixed steps of roulement, on logarithmic axes; beyond them nothing is said.
            if errors[0] <= math.log(error) <= errors[-1]:
                same = math.exp(numpy.interp(math.log(error), errors, times))
                times_longer.append(f"At its error of {error:.1e} {how} of Exudyn takes {seconds / same:.0f} times the CPU time of roulement.")
        except exudyn.SolverError:
            print(f"| Exudyn | {how} | - | its solver gives up |", flush=True)
    print("", *times_longer, sep="\n")
    apart = theirs.error(reference, scale)
    print(f"\nThe finest runs of both are {apart:.1e} apart: damping and friction follow different laws.")


if __name__ == "__main__":
    main()
