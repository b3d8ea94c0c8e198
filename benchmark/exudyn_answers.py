#!/usr/bin/env python3
"""Answers of Exudyn 1.13.6 to those questions of this folder that it can be asked.

Usage: exudyn_answers.py [--print] [SCENE ...]     writes answers/exudyn.csv and renews the table of docs/benchmark.md; with names of scenes (P-01 ...)
                                                   these rows alone; with --print it writes nothing and prints the answers
       exudyn_answers.py --sphere-torus            Exudyn's contact of sphere and torus, round a torus that is the same everywhere

Needs `pip install -r scripts/against-exudyn-requirements.txt`. Nothing here calls roulement.

Exudyn's are bodies, constraints, connectors, the static solver (Newton, tolerances 1e-9) and the integrator (RK44, steps of 0.5 us with friction and
2 us without). Its user brings what it does not know, a bearing by its dimensions:

- Contacts are a function that Exudyn calls (`ObjectConnectorRigidBodySpringDamper`): distance of ball and groove, stiffness by Hertz (Harris and
  Kotzalas 2006, chapter 6). Its own contact of sphere and torus is right only where balls stay in the plane of the torus: see --sphere-torus.
- Equilibria at speed are static ones with the centrifugal force of each ball, and the force at the outer race that carries its gyroscopic moment
  (Jones). All balls go round at one speed. Forces and stiffness follow the contact angles: the solver runs again with those of its last angles
  until nothing changes. Cage speeds of equilibria are not answered: they would be this kinematics and no answer of Exudyn.
- Cage speeds while rings turn are simulated: balls begin at rest and are taken along by Coulomb friction, proportional to slip below 0.02 m/s.
- Neither creep laws nor films of oil nor a balance of energy are there: families `contacts` and `torque` and energies are not answered.
"""

import math
import sys
import time
import tomllib
from pathlib import Path

import exudyn
import numpy
from exudyn.utilities import (
    CoordinateConstraint,
    CoordinateVectorConstraint,
    InertiaSphere,
    LoadForceVector,
    LoadTorqueVector,
    MarkerBodyPosition,
    MarkerBodyRigid,
    MarkerNodeCoordinate,
    MarkerNodeCoordinates,
    NodeGenericData,
    NodePointGround,
    ObjectConnectorCartesianSpringDamper,
    ObjectConnectorRigidBodySpringDamper,
    ObjectContactSphereTorus,
    ObjectGround,
    RigidBodyInertia,
    SensorBody,
)

import answer
import check
from make import elliptic

HERE = Path(__file__).resolve().parent
STEEL = {"youngs_modulus": 206e9, "poisson_ratio": 0.3, "density": 7800.0}
# [N/m] springs that hold balls without load where they are, a hundred millionth of the contacts: no part of an answer.
SOFT = 1.0
# [m] how deep the ring is pressed in where the static solver starts, along the axis and across it: from some it finds no equilibrium.
STARTS = [(2e-5, 0.0), (2e-5, 1e-5), (1e-5, 2e-5), (0.0, 2e-5)]
# Solutions until the loads are those of the scene; [N] loads of balls that no scene has: a root of the equations, but of another bearing.
RAMP, FAR = 10, 1e5
# [m/s] slip up to which friction is proportional to it. What rolls freely does not slip, whatever this is. [s] steps of RK44.
SLIP = 0.02
STEP = {"frequency": 2e-6, "cage_speed": 5e-7}


def hertz(along, across, compliance):
    """[N/m^1.5] stiffness from the relative curvatures [1/m] along and across rolling."""
    total, wanted = along + across, abs(along - across) / (along + across)
    low, high = 1.0 + 1e-9, 1e6
    for _ in range(200):
        kappa = math.sqrt(low * high)
        k, e = elliptic(1.0 - kappa**-2)
        found = ((kappa**2 + 1.0) * e - 2.0 * k) / ((kappa**2 - 1.0) * e)
        low, high = (kappa, high) if found < wanted else (low, kappa)
    k, e = elliptic(1.0 - kappa**-2)
    shape = 2.0 * k / math.pi * (math.pi / (2.0 * kappa**2 * e)) ** (1.0 / 3.0)
    # Approach d = shape (3/2 Q compliance/total)^(2/3) total/2.
    return (shape * total / 2.0) ** -1.5 * total / (1.5 * compliance)


class Bearing:
    """Numbers of a scene, and the geometry of its grooves: [0] inner, [1] outer."""

    def __init__(self, scene):
        section = scene["bearing"]
        ball, race = STEEL | scene.get("ball", {}), STEEL | scene.get("race", {})
        self.balls, diameter, self.pitch = section["balls"], section["ball_diameter"], section["pitch_diameter"]
        self.radius = 0.5 * diameter
        self.mass = ball["density"] * math.pi / 6.0 * diameter**3
        self.compliance = sum((1.0 - of["poisson_ratio"] ** 2) / of["youngs_modulus"] for of in (ball, race))
        self.grooves = [section["inner_conformity"] * diameter, section["outer_conformity"] * diameter]
        distance = sum(self.grooves) - diameter
        if "contact_angle" in section:
            self.angle, clearance, half = section["contact_angle"], 0.0, [groove - self.radius for groove in self.grooves]
            sine, cosine = math.sin(self.angle), math.cos(self.angle)
            self.circles = [0.5 * self.pitch + half[0] * cosine, 0.5 * self.pitch - half[1] * cosine]
            self.offsets = [half[0] * sine, -half[1] * sine]
        else:
            clearance = section["diametral_clearance"]
            self.angle = 0.0
            outer = 0.5 * self.pitch + self.radius + 0.25 * clearance - self.grooves[1]
            self.circles = [outer + distance - 0.5 * clearance, outer]
            self.offsets = [0.0, 0.0]
        self.clearance = clearance
        # Axial displacement at which a bearing with clearance touches.
        self.play = distance * math.sin(math.acos(1.0 - 0.5 * clearance / distance))
        first = section.get("first_ball_azimuth", 0.0)
        self.azimuths = [first + math.tau * k / self.balls for k in range(self.balls)]

    def stiffness(self, race, angle):
        """Of a contact at an angle: the race is curved along rolling as its cone there."""
        sign = 1.0 if race == 0 else -1.0
        at = self.circles[race] - sign * self.grooves[race] * math.cos(angle)
        return hertz(1.0 / self.radius + sign * math.cos(angle) / at, 1.0 / self.radius - 1.0 / self.grooves[race], self.compliance)

    def orbit(self, speed, inner, outer):
        """[rad/s] at which a ball goes round that rolls at the outer race (Harris and Kotzalas 2006, chapter 2)."""
        return speed * (1.0 - 2.0 * self.radius / self.pitch * math.cos(inner)) / (1.0 + math.cos(outer - inner))

    def gyroscopic(self, orbit, outer):
        """[N] friction at the outer race that carries the gyroscopic moment of a ball, towards its contact angle."""
        ratio = 2.0 * self.radius / self.pitch
        # Neither slip nor spin at the outer race. It turns the other way than it goes round.
        pitch = math.atan2(math.sin(outer), math.cos(outer) + ratio)
        spin = -orbit * (1.0 + ratio * math.cos(outer)) / (ratio * math.cos(outer - pitch))
        return 0.4 * self.mass * self.radius * spin * orbit * math.sin(pitch)


class Contact:
    """Hertz's contact of a ball and a groove: a function that Exudyn calls with where the ball is, seen from the race and in its axes."""

    def __init__(self, bearing, race):
        self.circle, self.reach = bearing.circles[race], bearing.grooves[race] - bearing.radius
        self.stiffness = bearing.stiffness(race, bearing.angle)

    def force(self, x, y, z):
        """[N] on the ball."""
        distance = math.hypot(y, z)
        radial = distance - self.circle
        length = math.hypot(x, radial)
        size = self.stiffness * max(0.0, length - self.reach) ** 1.5 / length
        return -size * x, -size * radial * y / distance, -size * radial * z / distance

    def __call__(self, system, time, number, displacement, *_):
        # What is given back acts on the race, at its centre.
        force = [-of for of in self.force(*displacement)]
        return [*force, *cross(displacement, force)]


def cross(a, b):
    """The vector product, for three numbers faster than numpy's."""
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


class Statics:
    """The bearing as bodies of Exudyn: the inner ring with five coordinates held or loaded, balls that keep their azimuth, two contacts for each."""

    def __init__(self, bearing, load, depths):
        self.bearing, self.load = bearing, load
        # The container has to live as long as its system.
        self.container = exudyn.SystemContainer()
        self.system = system = self.container.AddSystem()
        ground = system.AddObject(ObjectGround())
        zero = system.AddMarker(MarkerNodeCoordinate(nodeNumber=system.AddNode(NodePointGround()), coordinate=0))
        zeros = system.AddMarker(MarkerNodeCoordinates(nodeNumber=system.AddNode(NodePointGround())))
        fixed = system.AddMarker(MarkerBodyRigid(bodyNumber=ground, localPosition=[bearing.offsets[1], 0.0, 0.0]))
        ring = system.CreateRigidBody(inertia=RigidBodyInertia(mass=1.0, inertiaTensor=1e-3 * numpy.eye(3)), nodeType=exudyn.NodeType.RotationRxyz, returnDict=True)
        self.ring, self.node = ring["bodyNumber"], ring["nodeNumber"]
        centre = system.AddMarker(MarkerBodyRigid(bodyNumber=self.ring))
        inner = system.AddMarker(MarkerBodyRigid(bodyNumber=self.ring, localPosition=[bearing.offsets[0], 0.0, 0.0]))
        force, moment, start = numpy.zeros(3), numpy.zeros(3), numpy.zeros(6)

        def hold(node, coordinate, value=0.0):
            marker = system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))
            system.AddObject(CoordinateConstraint(markerNumbers=[zero, marker], offset=value))

        hold(self.node, 3)
        for coordinate, name in [(0, "x"), (1, "y"), (2, "z"), (4, "ry"), (5, "rz")]:
            given = load[name]
            of, what = (force, "displacement") if coordinate < 3 else (moment, "rotation")
            if what in given:
                hold(self.node, coordinate, given[what])
                start[coordinate] = given[what]
            else:
                of[coordinate % 3] = given["force" if coordinate < 3 else "moment"]
        # At first with more thrust, which presses all balls: from there the solver gets to where some have no load.
        self.force, self.thrust = force, numpy.array([math.copysign(math.hypot(*force[1:]), force[0]) if force[0] else 0.0, 0.0, 0.0])
        self.on_ring = system.AddLoad(LoadForceVector(markerNumber=centre, loadVector=list(force + self.thrust)))
        if moment.any():
            system.AddLoad(LoadTorqueVector(markerNumber=centre, loadVector=list(moment)))
        # Where the solver starts: in contact, in the direction of the load.
        radial = math.hypot(force[1], force[2])
        if "force" in load["x"] and force[0]:
            start[0] = math.copysign(bearing.play + depths[0], force[0])
        if radial > 0.0:
            start[1:3] = (0.5 * bearing.clearance * (not force[0]) + depths[1]) * force[1:] / radial
        system.SetNodeParameter(self.node, "initialCoordinates", list(start))
        self.contacts, self.motion = [], []
        for azimuth in bearing.azimuths:
            out, around = numpy.array([0.0, math.cos(azimuth), math.sin(azimuth)]), numpy.array([0.0, -math.sin(azimuth), math.cos(azimuth)])
            centres = [numpy.array([offset, 0.0, 0.0]) + circle * out for offset, circle in zip(bearing.offsets, bearing.circles)]
            moved = centres[0] + start[:3] + numpy.cross(start[3:], centres[0])
            line = moved - centres[1]
            reach = bearing.grooves[1] - bearing.radius
            # Between both grooves, as deep in one as in the other.
            depth = numpy.linalg.norm(line) - (sum(bearing.grooves) - 2.0 * bearing.radius)
            place = centres[1] + line / numpy.linalg.norm(line) * (reach + 0.5 * depth)
            body = system.CreateRigidBody(referencePosition=list(place), inertia=InertiaSphere(mass=bearing.mass, radius=bearing.radius), nodeType=exudyn.NodeType.RotationRxyz, returnDict=True)
            ball, node = body["bodyNumber"], body["nodeNumber"]
            for coordinate in (3, 4, 5):
                hold(node, coordinate)
            # A cage: the ball keeps its azimuth.
            held = system.AddMarker(MarkerNodeCoordinates(nodeNumber=node))
            system.AddObject(CoordinateVectorConstraint(markerNumbers=[zeros, held], scalingMarker1=[[0.0, around[1], around[2], 0.0, 0.0, 0.0]], offset=[0.0]))
            there = system.AddMarker(MarkerBodyPosition(bodyNumber=ground, localPosition=list(place)))
            here = system.AddMarker(MarkerBodyPosition(bodyNumber=ball))
            system.AddObject(ObjectConnectorCartesianSpringDamper(markerNumbers=[there, here], stiffness=[SOFT] * 3))
            self.motion.append((system.AddLoad(LoadForceVector(markerNumber=here, loadVector=[0.0] * 3)), out, ball))
            marker = system.AddMarker(MarkerBodyRigid(bodyNumber=ball))
            pair = []
            for side, race in enumerate((inner, fixed)):
                contact = Contact(bearing, side)
                pair.append((system.AddObject(ObjectConnectorRigidBodySpringDamper(markerNumbers=[race, marker], springForceTorqueUserFunction=contact)), contact))
            self.contacts.append(pair)
        system.Assemble()

    def state(self):
        """Loads [N] and contact angles [rad] of all balls at inner and outer race."""
        turned = numpy.array(self.system.GetNodeOutput(self.node, exudyn.OutputVariableType.RotationMatrix)).reshape(3, 3)
        loads, angles = numpy.zeros((2, self.bearing.balls)), numpy.zeros((2, self.bearing.balls))
        for k, (pair, (_, out, _)) in enumerate(zip(self.contacts, self.motion)):
            for side, (number, _) in enumerate(pair):
                # On the race, in its axes: along the line from the inner to the outer contact.
                force = numpy.array(self.system.GetObjectOutput(number, exudyn.OutputVariableType.ForceLocal)) * (-1.0 if side == 0 else 1.0)
                loads[side, k] = numpy.linalg.norm(force)
                angles[side, k] = math.atan2(force[0], force @ (turned.T @ out if side == 0 else out)) if loads[side, k] > 0.0 else math.nan
        return loads, angles

    def move(self, loads, angles, share):
        """Puts forces of motion on the balls. All go round at one speed, as a cage keeps them: the mean of what they roll at, by their inner loads."""
        speed = self.load["inner_speed"]
        orbit = numpy.average([self.bearing.orbit(speed, *of_ball) for of_ball in angles.T], weights=loads[0])
        for (load, out, body), outer, inside in zip(self.motion, angles[1], loads[0]):
            place = numpy.array(self.system.GetObjectOutputBody(body, exudyn.OutputVariableType.Position))
            # What lies at the outer race alone turns about the axis of the bearing.
            friction = self.bearing.gyroscopic(orbit, outer) if inside > 0.0 else 0.0
            along = friction * (math.cos(outer) * numpy.array([1.0, 0.0, 0.0]) - math.sin(outer) * out)
            self.system.SetLoadParameter(load, "loadVector", list(share * (along + self.bearing.mass * (place @ out) * orbit**2 * out)))

    def solve(self):
        """Solves until neither stiffness nor forces of motion change; how many times it was solved."""
        settings = exudyn.SimulationSettings()
        settings.solution.file.write = False
        settings.staticSolver.verboseMode = 0
        settings.staticSolver.newton.relativeTolerance = 1e-9
        settings.staticSolver.newton.absoluteTolerance = 1e-9
        settings.staticSolver.newton.maxIterations = 60
        before, share = None, 0.0
        for times in range(1, 101):
            self.system.SolveStatic(settings)
            self.system.systemData.SetSystemState(self.system.systemData.GetSystemState(), configuration=exudyn.ConfigurationType.Initial)
            loads, angles = self.state()
            if not 0.0 < loads.max() < FAR:
                raise RuntimeError("a solution far from the bearing")
            now = numpy.concatenate([loads / loads.max(), numpy.nan_to_num(angles)])
            if share == 1.0 and before is not None and numpy.abs(now - before).max() < 1e-7:
                return times
            before, share = now, min(1.0, times / RAMP)
            angles = numpy.where(numpy.isnan(angles), self.bearing.angle, angles)
            for pair, of_ball in zip(self.contacts, angles.T):
                for side, ((_, contact), angle) in enumerate(zip(pair, of_ball)):
                    contact.stiffness = self.bearing.stiffness(side, angle)
            self.system.SetLoadParameter(self.on_ring, "loadVector", list(self.force + (1.0 - share) * self.thrust))
            if self.load["inner_speed"]:
                self.move(loads, angles, share)
        raise RuntimeError("loads and angles go on changing")


def at_rest(bearing, load):
    """The first static solution that is found from some starts."""
    for depths in STARTS:
        statics = Statics(bearing, load, depths)
        try:
            statics.times = statics.solve()
        except (exudyn.SolverError, RuntimeError):
            continue
        return statics
    raise RuntimeError("the static solver finds no equilibrium")


def equilibrium(scene, quantities):
    """Quantities of the static solution."""
    statics = at_rest(Bearing(scene), scene["load"])
    loads, angles = statics.state()
    most = int(numpy.argmax(loads[0]))
    place = numpy.array(statics.system.GetNodeOutput(statics.node, exudyn.OutputVariableType.Coordinates))
    known = {
        "largest_inner_load": loads[0, most],
        "largest_outer_load": loads[1].max(),
        "inner_contact_angle_there": math.degrees(angles[0, most]),
        "outer_contact_angle_there": math.degrees(angles[1, most]),
    }
    known |= {f"displacement.{axis}": 1e6 * place[k] for k, axis in enumerate("xyz")}
    return [known.get(quantity) for quantity in quantities]


class Rolling(Contact):
    """The same with friction, on a race that turns about its axis: that is imposed, so that its body stands and its surface moves."""

    def __init__(self, contact, friction, speed, radius):
        self.circle, self.reach, self.stiffness = contact.circle, contact.reach, contact.stiffness
        self.friction, self.speed, self.radius = friction, speed, radius

    def __call__(self, system, time, number, place, rotation, velocity, turning, *_):
        force = self.force(*place)
        load = math.sqrt(force[0] ** 2 + force[1] ** 2 + force[2] ** 2)
        if load == 0.0 or self.friction == 0.0:
            return [-force[0], -force[1], -force[2], 0.0, 0.0, 0.0]
        normal = [-of / load for of in force]
        arm = [self.radius * of for of in normal]
        around = cross(turning, arm)
        slip = [velocity[0] + around[0], velocity[1] + around[1] + self.speed * (place[2] + arm[2]), velocity[2] + around[2] - self.speed * (place[1] + arm[1])]
        along = sum(a * b for a, b in zip(slip, normal))
        slip = [a - along * b for a, b in zip(slip, normal)]
        size = self.friction * load / max(SLIP, math.sqrt(sum(a * a for a in slip)))
        rubbing = [-size * of for of in slip]
        # What is given back acts on the race, and the moment the other way on the ball.
        return [*(-a - b for a, b in zip(force, rubbing)), *(-of for of in cross(arm, rubbing))]


class Motion:
    """The bearing in motion, from its static solution, without constraints: explicit integrators of Exudyn take none."""

    def __init__(self, scene):
        self.bearing, load = Bearing(scene), scene["load"]
        statics = at_rest(self.bearing, load | {"inner_speed": 0.0})
        self.container = exudyn.SystemContainer()
        self.system = system = self.container.AddSystem()
        ground = system.AddObject(ObjectGround())
        races = [None, system.AddMarker(MarkerBodyRigid(bodyNumber=ground, localPosition=[self.bearing.offsets[1], 0.0, 0.0]))]
        place = statics.system.GetObjectOutputBody(statics.ring, exudyn.OutputVariableType.Position)
        # Tilts and turns of the ring are held: by inertia.
        self.ring = system.CreateRigidBody(
            referencePosition=list(place),
            initialVelocity=scene.get("start", {}).get("inner_velocity", [0.0] * 3),
            inertia=RigidBodyInertia(mass=scene["inner"]["mass"], inertiaTensor=1e6 * numpy.eye(3)),
            nodeType=exudyn.NodeType.RotationRotationVector,
        )
        races[0] = system.AddMarker(MarkerBodyRigid(bodyNumber=self.ring, localPosition=[self.bearing.offsets[0], 0.0, 0.0]))
        centre = system.AddMarker(MarkerBodyRigid(bodyNumber=self.ring))
        system.AddLoad(LoadForceVector(markerNumber=centre, loadVector=[load["x"]["force"], 0.0, 0.0]))
        friction = 0.0 if scene.get("effects", {}).get("creep") == "frictionless" else scene["friction"]["ball_race"]
        speeds = [load.get("inner_speed", 0.0), load.get("outer_speed", 0.0)]
        self.balls, self.contacts = [], []
        for pair, (_, _, body) in zip(statics.contacts, statics.motion):
            ball = system.CreateRigidBody(
                referencePosition=list(statics.system.GetObjectOutputBody(body, exudyn.OutputVariableType.Position)),
                inertia=InertiaSphere(mass=self.bearing.mass, radius=self.bearing.radius),
                nodeType=exudyn.NodeType.RotationRotationVector,
            )
            self.balls.append(ball)
            marker = system.AddMarker(MarkerBodyRigid(bodyNumber=ball))
            for race, speed, (_, contact) in zip(races, speeds, pair):
                rolling = Rolling(contact, friction, speed, self.bearing.radius)
                self.contacts.append(rolling)
                system.AddObject(ObjectConnectorRigidBodySpringDamper(markerNumbers=[race, marker], springForceTorqueUserFunction=rolling))
        self.sensor = system.AddSensor(SensorBody(bodyNumber=self.ring, outputVariableType=exudyn.OutputVariableType.Position, storeInternal=True))
        system.Assemble()

    def run(self, begin, end, step, row):
        """Goes on from a time to another [s]."""
        settings = exudyn.SimulationSettings()
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = row
        settings.timeIntegration.verboseMode = 0
        settings.timeIntegration.startTime, settings.timeIntegration.endTime = begin, end
        settings.timeIntegration.numberOfSteps = round((end - begin) / step)
        self.system.SolveDynamic(settings, solverType=exudyn.DynamicSolverType.RK44, updateInitialValues=True)

    def azimuths(self):
        """[rad] of all balls."""
        places = [self.system.GetObjectOutputBody(ball, exudyn.OutputVariableType.Position) for ball in self.balls]
        return numpy.array([math.atan2(place[2], place[1]) for place in places])


def frequency(scene, quantities):
    """[Hz] of a vibration, from its passages through where it begins."""
    motion = Motion(scene)
    motion.run(0.0, scene["load"]["duration"], STEP["frequency"], scene["load"]["output_interval"])
    rows = [(row[0], row[1]) for row in motion.system.GetSensorStoredData(motion.sensor)]
    rest = rows[0][1]
    up = [(a, b) for a, b in zip(rows, rows[1:]) if a[1] < rest <= b[1]]
    times = [a[0] + (rest - a[1]) * (b[0] - a[0]) / (b[1] - a[1]) for a, b in up]
    return [(len(times) - 1) / (times[-1] - times[0])]


def cage_speed(scene, quantities):
    """[rad/s] at which the balls go round, mean of all over the second half. They begin at rest: friction takes them along."""
    motion, end = Motion(scene), scene["load"]["duration"]
    motion.run(0.0, 0.5 * end, STEP["cage_speed"], end)
    before = motion.azimuths()
    motion.run(0.5 * end, end, STEP["cage_speed"], end)
    turned = (motion.azimuths() - before + math.pi) % math.tau - math.pi
    return [float(turned.mean()) / (0.5 * end)]


def answers(known):
    """Answers to all questions that Exudyn can be asked."""
    found = {}
    for file in dict.fromkeys(row["file"] for row in known.values()):
        own = [row for row in known.values() if row["file"] == file]
        by = {"frequency": frequency, "cage_speed": cage_speed}.get(own[0]["quantity"], equilibrium if own[0]["family"] == "equilibria" else None)
        if by is None:
            continue
        begin = time.process_time()
        try:
            values = by(tomllib.loads((HERE / file).read_text()), [row["quantity"] for row in own])
        except (exudyn.SolverError, RuntimeError) as why:
            print(f"{file}: {why}", file=sys.stderr)
            continue
        print(f"{file}: {time.process_time() - begin:.1f} s", file=sys.stderr)
        found |= {row["id"]: float(value) for row, value in zip(own, values) if value is not None}
    return found


def sphere_torus():
    """Gaps of Exudyn's contact of sphere and torus for a ball beside the plane of the torus, at some azimuths. All should be the same."""
    ball, circle, groove, beside, out = 5e-3, 30e-3, 5.2e-3, 1e-4, 1.8e-4
    exact = groove - ball - math.hypot(beside, out)
    print(f"a ball {1e3 * beside:g} mm beside the plane: the gap is {1e6 * exact:.2f} um. Exudyn {exudyn.config.Version()}:")
    print("azimuth [deg]  gap [um]")
    for azimuth in range(0, 360, 45):
        container = exudyn.SystemContainer()
        system = container.AddSystem()
        place = [beside, *((circle + out) * of(math.radians(azimuth)) for of in (math.cos, math.sin))]
        body = system.CreateRigidBody(referencePosition=place, inertia=InertiaSphere(mass=1.0, radius=ball))
        markers = [system.AddMarker(MarkerBodyRigid(bodyNumber=number)) for number in (body, system.AddObject(ObjectGround()))]
        data = system.AddNode(NodeGenericData(initialCoordinates=[0.0] * 4, numberOfDataCoordinates=4))
        shape = {"sphereRadius": ball, "torusMajorRadius": circle, "torusMinorRadius": groove, "torusAxis": [1.0, 0.0, 0.0]}
        contact = system.AddObject(ObjectContactSphereTorus(markerNumbers=markers, nodeNumber=data, contactStiffness=1e8, **shape))
        system.Assemble()
        print(f"{azimuth:13} {1e6 * float(system.GetObjectOutput(contact, exudyn.OutputVariableType.DisplacementLocal)):9.2f}")


def main(*given):
    """The command line."""
    # What its solvers say of starts from which they find nothing.
    exudyn.config.printToConsole = False
    if "--sphere-torus" in given:
        sphere_torus()
        return
    names = [name for name in given if name != "--print"]
    known = {key: row for key, row in check.questions().items() if not names or Path(row["file"]).stem in names}
    found = answers(known)
    if "--print" in given:
        print("id,value")
        print("\n".join(f"{key},{value:.9g}" for key, value in found.items()))
        return
    answer.write("exudyn.csv", found)
    answer.renew()


if __name__ == "__main__":
    main(*sys.argv[1:])
