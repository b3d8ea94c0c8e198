"""Coupling of a bearing in pose drive to a rigid shaft, and of a shaft's package to the housing of its bearings: the recipes of
docs/coupling.md, in Python alone.

Places, velocities and wrenches have the five components x, y, z, about y, about z. A bearing is anything that has
`wrench()`, `place()` and `step(step, place, velocity)`: `Bearing` is one on a `Simulation`, `FmuBearing` on a package in FMPy.

>>> scene = roulement.Scene.load("scenes/thrust.toml").with_({"inner.drive": "pose"})
>>> bearing = Bearing(roulement.Simulation(scene))
>>> shaft = Leapfrog(bearing, rigid(mass=1.0, transverse=1e-3), lambda time: [1500.0, 30.0, 0.0, 0.0, 0.0])
>>> shaft.step(2e-5)

`Leapfrog` is right for steps up to 80 us for a shaft of 1 kg, `Implicit` for longer ones; `Euler` is what simple masters do. How they
compare, with each other and with schemes not to be used, is measured by `examples/coupling/coupling.py`.
"""

import shutil

import numpy as np



def _variables(race):
    """Names of place, velocity and wrench of a race."""
    five = lambda along, about: [f"{race}.{along}.{axis}" for axis in "xyz"] + [f"{race}.{about}.{axis}" for axis in "yz"]
    return five("position", "rotation"), five("velocity", "rotation_rate"), five("force", "moment")


PLACE, VELOCITY, WRENCH = _variables("inner")


def rigid(mass, transverse):
    """Inertia (5 x 5) of a rigid shaft: its mass [kg] and moment of inertia about the transverse axes [kg m2]."""
    return np.diag([mass] * 3 + [transverse] * 2)


def gyroscopic(polar, speed):
    """Gyroscopic matrix (5 x 5) of a shaft with a polar moment of inertia [kg m2] that turns at a speed [rad/s]."""
    matrix = np.zeros((5, 5))
    matrix[3, 4], matrix[4, 3] = -polar * speed, polar * speed
    return matrix


class Bearing:
    """The inner race of a `Simulation` in pose drive, with `interface.orientation = "shaft"` (the default)."""

    def __init__(self, simulation):
        self.simulation = simulation
        self._inputs = [simulation.signal(name) for name in PLACE + VELOCITY]
        self._outputs = [simulation.signal(name) for name in WRENCH]

    def place(self):
        """Place of the race [m, rad]."""
        return np.array([signal.value for signal in self._inputs[:5]])

    def wrench(self):
        """What the bearing exerts on the shaft [N, N m]."""
        return np.array([signal.value for signal in self._outputs])

    def read(self, names):
        """Values of any variables by their names."""
        return np.array([self.simulation.signal(name).value for name in names])

    def step(self, step, place, velocity):
        """Wrench after a step [s] that ends in a place and velocity."""
        # Inputs are those at the start: they lead to the end where this velocity comes from.
        for signal, value in zip(self._inputs, [*(place - velocity * step), *velocity]):
            signal.value = value
        self.simulation.step(step)
        return self.wrench()

    def save(self):
        """This point, for `restore`."""
        return self.simulation.snapshot()

    def restore(self, point):
        """Goes back to a point."""
        self.simulation.restore(point)

    def derivative(self, step, place_gain, velocity_gain):
        """Derivative (5 x 5) of the wrench at the end of the last step by what changes place and velocity there with these
        gains."""
        by = self.simulation.derivatives(WRENCH, PLACE + VELOCITY)
        return by[:, :5] * (place_gain - velocity_gain * step) + by[:, 5:] * velocity_gain


class FmuBearing:
    """The same on an instance of a package in FMPy (`fmpy.fmi2.FMU2Slave`) after its initialization; `references` are value
    references by name. `race` is one in pose drive: of a shaft's package such as `left.outer`. Needs FMPy."""

    def __init__(self, fmu, references, time=0.0, race="inner"):
        self.fmu, self.references, self.time = fmu, references, time
        place, velocity, wrench = _variables(race)
        self._inputs = [references[name] for name in place + velocity]
        self._outputs = [references[name] for name in wrench]
        self._folder = None

    @classmethod
    def load(cls, package, **options):
        """Opens a package by its path, and starts it at time 0; options are those of the class. `close` frees it."""
        from fmpy import extract, read_model_description
        from fmpy.fmi2 import FMU2Slave

        description, folder = read_model_description(str(package)), extract(str(package))
        identifier = description.coSimulation.modelIdentifier
        fmu = FMU2Slave(guid=description.guid, unzipDirectory=folder, modelIdentifier=identifier, instanceName="bearing")
        fmu.instantiate()
        cls._start_at_0(fmu)
        references = {variable.name: variable.valueReference for variable in description.modelVariables}
        bearing = cls(fmu, references, **options)
        bearing._folder = folder
        return bearing

    @staticmethod
    def _start_at_0(fmu):
        fmu.setupExperiment(startTime=0.0)
        fmu.enterInitializationMode()
        fmu.exitInitializationMode()

    def restart(self):
        """Back to time 0, where the bearing carries what its scene loads it with."""
        self.fmu.reset()
        self._start_at_0(self.fmu)
        self.time = 0.0

    def close(self):
        """Frees the instance, and what `load` unpacked."""
        self.fmu.freeInstance()
        if self._folder:
            shutil.rmtree(self._folder)

    def place(self):
        """Place of the race [m, rad]."""
        return np.array(self.fmu.getReal(self._inputs[:5]))

    def wrench(self):
        """What the bearing exerts on the shaft [N, N m]."""
        return np.array(self.fmu.getReal(self._outputs))

    def read(self, names):
        """As of `Bearing`."""
        return np.array(self.fmu.getReal([self.references[name] for name in names]))

    def step(self, step, place, velocity):
        """Wrench after a step [s] that ends in a place and velocity."""
        self.fmu.setReal(self._inputs, [*(place - velocity * step), *velocity])
        self.fmu.doStep(self.time, step)
        self.time += step
        return self.wrench()

    def save(self):
        """This point, for `restore`."""
        return self.fmu.getFMUState(), self.time

    def restore(self, point):
        """Goes back to a point, which is then forgotten."""
        state, self.time = point
        self.fmu.setFMUState(state)
        self.fmu.freeFMUState(state)

    def derivative(self, step, place_gain, velocity_gain):
        """As of `Bearing`."""
        columns = []
        for direction in np.eye(5):
            change = [*(direction * (place_gain - velocity_gain * step)), *(direction * velocity_gain)]
            columns.append(self.fmu.getDirectionalDerivative(self._outputs, self._inputs, change))
        return np.array(columns).T


def _seen(position, direction):
    """Motion of a bearing (5 x 5), in its axes, by that of a rigid body with its origin at another point of the same axis."""
    if direction not in (1, -1):
        raise ValueError(f"direction = {direction}: has to be 1 or -1")
    seen = np.diag([direction, direction, 1.0, direction, 1.0])
    seen[1, 4], seen[2, 3] = direction * position, -position
    return seen


class FmuHousing(FmuBearing):
    """Outer races of a shaft's package that sit in one rigid body, a housing outside: seen as one race about the origin of that body. `seats` are the
    name of each bearing, its position along the shaft from there [m], and its direction, as of `Bearings`. Their races are in pose drive
    (`set = { outer = { drive = "pose" } }`). Places are those from the start. Needs FMPy."""

    def __init__(self, fmu, references, seats, time=0.0):
        self.fmu, self.references, self.time, self._folder = fmu, references, time, None
        races = [_variables(f"{name}.outer") for name, _, _ in seats]
        self._inputs = [references[name] for place, velocity, _ in races for name in place + velocity]
        self._outputs = [references[name] for _, _, wrench in races for name in wrench]
        self._seen = [_seen(position, direction) for _, position, direction in seats]
        self._start = [self.fmu.getReal(self._inputs[10 * k : 10 * k + 5]) for k in range(len(seats))]

    def _of_races(self, place, velocity):
        """Values of all inputs by place and velocity of the body."""
        return np.concatenate([[*(seen @ place), *(seen @ velocity)] for seen in self._seen])

    def place(self):
        """Place of the body from the start [m, rad]: at the start, which is when it is asked for, 0."""
        return np.zeros(5)

    def wrench(self):
        """What all bearings exert on the body, about its origin [N, N m]."""
        return self._on_body(np.array(self.fmu.getReal(self._outputs)))

    def _on_body(self, on_races):
        return sum(seen.T @ one for seen, one in zip(self._seen, np.split(on_races, len(self._seen))))

    def step(self, step, place, velocity):
        """Wrench after a step [s] that ends in a place and velocity of the body."""
        start = np.concatenate([[*place, *[0.0] * 5] for place in self._start])
        self.fmu.setReal(self._inputs, list(start + self._of_races(place - velocity * step, velocity)))
        self.fmu.doStep(self.time, step)
        self.time += step
        return self.wrench()

    def derivative(self, step, place_gain, velocity_gain):
        """As of `Bearing`: five derivatives of the package, each by a motion of all races together."""
        columns = []
        for direction in np.eye(5):
            change = self._of_races(direction * (place_gain - velocity_gain * step), direction * velocity_gain)
            found = self.fmu.getDirectionalDerivative(self._outputs, self._inputs, list(change))
            columns.append(self._on_body(np.array(found)))
        return np.array(columns).T


class Bearings:
    """Several bearings on a rigid shaft, seen as one about the shaft's origin: pairs (or more) of `Bearing` or `FmuBearing`, position along the
    shaft [m], and direction: 1 where the bearing's x axis is the shaft's, -1 where it points the other way (half a turn about z;
    speeds of its scene then have the other sign). Places are those from the start, where each carries what its scene loads it with."""

    def __init__(self, *mounted):
        self.parts = []
        for bearing, position, direction in mounted:
            self.parts.append((bearing, bearing.place(), _seen(position, direction)))

    def place(self):
        """Place of the shaft from the start [m, rad]: at the start, which is when it is asked for, 0."""
        return np.zeros(5)

    def wrench(self):
        """What all bearings exert on the shaft, about its origin [N, N m]."""
        return sum(seen.T @ bearing.wrench() for bearing, _, seen in self.parts)

    def step(self, step, place, velocity):
        """Wrench after a step [s] that ends in a place and velocity of the shaft."""
        return sum(seen.T @ bearing.step(step, start + seen @ place, seen @ velocity) for bearing, start, seen in self.parts)

    def save(self):
        """This point, for `restore`."""
        return [bearing.save() for bearing, _, _ in self.parts]

    def restore(self, point):
        """Goes back to a point."""
        for (bearing, _, _), one in zip(self.parts, point):
            bearing.restore(one)

    def derivative(self, step, place_gain, velocity_gain):
        """As of `Bearing`."""
        return sum(seen.T @ bearing.derivative(step, place_gain, velocity_gain) @ seen for bearing, _, seen in self.parts)


class Shaft:
    """A rigid shaft on a bearing, or another rigid body on what has the methods of one, without a scheme (`step`) yet: `inertia` (5 x 5), `force(time)` the external wrench on it, `gyroscopic` (5 x 5, with the sign
    of `gyroscopic()`), and a `velocity` at the start."""

    def __init__(self, bearing, inertia, force, gyroscopic=None, velocity=None, time=0.0):
        self.bearing, self.inertia, self.external = bearing, np.asarray(inertia, float), force
        self.gyroscopic = np.zeros((5, 5)) if gyroscopic is None else np.asarray(gyroscopic, float)
        self.place, self.wrench, self.time = bearing.place(), bearing.wrench(), time
        self.velocity = np.zeros(5) if velocity is None else np.asarray(velocity, float)

    def total(self, wrench, velocity, time):
        """All forces and moments on it under a wrench of the bearing, at a velocity and a time [s]."""
        return wrench + np.asarray(self.external(time), float) + self.gyroscopic @ velocity


class Leapfrog(Shaft):
    """Half a kick by the wrench at the start, drift, half a kick by the wrench at the end (velocity Verlet): one step of the
    bearing per communication step."""

    def step(self, step):
        """Takes shaft and bearing a step [s] on."""
        half, end = 0.5 * step, self.time + step
        acceleration = np.linalg.solve(self.inertia, self.total(self.wrench, self.velocity, self.time))
        kicked = self.velocity + half * acceleration
        place = self.place + step * kicked
        wrench = self.bearing.step(step, place, self.velocity + step * acceleration)
        # The gyroscopic moment of the velocity at the end is known with it.
        momentum = self.inertia @ kicked + half * self.total(wrench, np.zeros(5), end)
        self.velocity = np.linalg.solve(self.inertia - half * self.gyroscopic, momentum)
        self.place, self.wrench, self.time = place, wrench, end


class Euler(Shaft):
    """Velocity by the wrench at the start, then place by that velocity (semi-implicit Euler): one step of the bearing per communication
    step. What a master does that gives the shaft its velocity first."""

    def step(self, step):
        """Takes shaft and bearing a step [s] on."""
        acceleration = np.linalg.solve(self.inertia, self.total(self.wrench, self.velocity, self.time))
        self.velocity = self.velocity + step * acceleration
        self.place, self.time = self.place + step * self.velocity, self.time + step
        self.wrench = self.bearing.step(step, self.place, self.velocity)


class Implicit(Shaft):
    """Linearly implicit (HHT): the step is done twice, the derivatives of the first time give the matrix of the second. `alpha` in
    [0, 1/3] damps what the step cannot resolve."""

    def __init__(self, *arguments, alpha=0.3, **options):
        super().__init__(*arguments, **options)
        self.alpha = alpha
        self._acceleration = np.linalg.solve(self.inertia, self.total(self.wrench, self.velocity, self.time))

    def step(self, step):
        """Takes shaft and bearing a step [s] on."""
        alpha, before, finish = self.alpha, self._acceleration, self.time + step
        beta, gamma = 0.25 * (1 + alpha) ** 2 * step**2, (0.5 + alpha) * step

        def end(after):
            place = self.place + self.velocity * step + before * (0.5 * step**2 - beta) + after * beta
            return place, self.velocity + before * (step - gamma) + after * gamma

        point = self.bearing.save()
        guessed = before * (1 - step / gamma)
        guess = end(guessed)
        force = self.total(self.bearing.step(step, *guess), guess[1], finish)
        derivative = self.bearing.derivative(step, beta, gamma) + self.gyroscopic * gamma
        self.bearing.restore(point)
        start = self.total(self.wrench, self.velocity, self.time)
        right = (1 - alpha) * (force - derivative @ guessed) + alpha * start
        self._acceleration = np.linalg.solve(self.inertia - (1 - alpha) * derivative, right)
        self.place, self.velocity = end(self._acceleration)
        self.wrench, self.time = self.bearing.step(step, self.place, self.velocity), finish
