"""A running bearing, or a shaft with its bearings, step by step."""

import numpy as np

from . import _native
from ._names import unknown
from .scene import Scene


class Signal:
    """Variables of a simulation that were looked up once: `value` reads them, and sets those of inputs."""

    def __init__(self, simulation, references, scalar):
        self._native, self._references, self._scalar = simulation._native, references, scalar
        self._array = np.empty(len(references))

    @property
    def value(self):
        """A number, or an array of the components."""
        self._native.get(self._references, self._array)
        return float(self._array[0]) if self._scalar else self._array.copy()

    @value.setter
    def value(self, value):
        self._array[:] = value
        self._native.set(self._references, self._array)

    def set_rate(self, rate):
        """First derivative of inputs by time [unit/s], for the next step."""
        self._array[:] = rate
        self._native.set_derivatives(self._references, self._array)


class Simulation:
    """A bearing, or a shaft with its bearings, that is moved step by step, with the variables of its FMI package: inputs are those at the
    start of a step. Names of a shaft's bearings stand before their variables, as in `left.inner.force`.

    It starts at a time [s] from the equilibrium; `values` are parameters and inputs at the start by name. What the scene gives
    as a table over time is played until an input of that group is set. Raises RuntimeError if it cannot start.
    """

    def __init__(self, scene, start=0.0, values=None):
        scene = Scene.of(scene)
        table = _native.Simulation.variables(scene._native)
        self._table = {name: (place, unit, causality, text) for place, (name, unit, causality, text) in enumerate(table)}
        pairs = []
        for name, value in (values or {}).items():
            places = self._places(name)
            pairs += [(place, float(part)) for place, part in zip(places, np.broadcast_to(value, len(places)))]
        self._native = _native.Simulation(scene._native, float(start), pairs)
        self._tell()

    def _tell(self):
        self.messages = self._native.messages()
        """What the bearing had to say at its start, or in its last step that had something to say."""

    def _places(self, name):
        """References of a variable, or of its components x, y, z (of the balls, for `ball.`, or `left.ball.` of a shaft)."""
        if name in self._table:
            return [self._table[name][0]]
        bearing, of_balls, what = name.rpartition("ball.")
        if of_balls and (not bearing or bearing.endswith(".")):
            count = range(1, 201)
            found = [self._table[of][0] for of in (f"{bearing}ball[{ball}].{what}" for ball in count) if of in self._table]
        else:
            found = [self._table[of][0] for of in (f"{name}.{axis}" for axis in "wxyz") if of in self._table]
        if not found:
            raise unknown(name, "variable of this simulation", self._table)
        return found

    @property
    def variables(self):
        """Name, then unit, causality and description, of all variables."""
        return {name: of[1:] for name, of in self._table.items()}

    def signal(self, name):
        """A `Signal` of a variable such as `friction_power`, or of all its components, such as `inner.force`.

        Raises KeyError if it is not there.
        """
        return Signal(self, self._places(name), name in self._table)

    input = output = signal

    def __getitem__(self, name):
        return self.signal(name).value

    def __setitem__(self, name, value):
        self.signal(name).value = value

    @property
    def time(self):
        """Time reached [s]."""
        return self._native.time

    def step(self, step):
        """Advances by a step [s] and returns the time reached.

        Raises RuntimeError if the step cannot be finished; the state is then that of the last time reached.
        """
        return self._native.step(step)

    def copy(self):
        """Another simulation at the same point, which goes on to the same bits."""
        other = object.__new__(Simulation)
        other._table, other._native, other.messages = self._table, self._native.copy(), []
        return other

    __copy__ = copy

    def snapshot(self):
        """This point, for `restore`."""
        return self._native.snapshot()

    def restore(self, snapshot):
        """Goes back to a point of this simulation or of one of the same scene; goes on from there to the same bits."""
        self._native.restore(snapshot)

    def dumps(self):
        """This point as bytes, for another process."""
        return self._native.to_bytes(self._native.snapshot())

    def loads(self, data):
        """Goes to a point from `dumps` of a simulation of the same scene. Raises ValueError for others."""
        self._native.restore(self._native.state_of_bytes(data))

    def derivatives(self, outputs, inputs):
        """How outputs would have changed with the inputs of the last step (before the first: of the equilibrium): a matrix
        with a row for each component of the outputs. Names as of `signal`, one or a list."""
        rows, columns = ([place for name in ([of] if isinstance(of, str) else of) for place in self._places(name)] for of in (outputs, inputs))
        matrix = np.empty((len(rows), len(columns)))
        self._native.derivatives(rows, columns, matrix)
        return matrix
