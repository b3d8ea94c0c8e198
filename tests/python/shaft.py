"""A rigid shaft on two bearings, as a package that pythonfmu builds: for masters that connect packages.

It moves in five directions and spins at a constant speed. Wrenches of the bearings are inputs; the place of each inner
race and its rates are outputs, by the names that a bearing in its shaft interface has. Semi-implicit Euler.
"""

from pythonfmu import Fmi2Causality, Fmi2Slave, Real

MASS, TILTING = 5.0, 0.02  # [kg], [kg m2] about y and z
START, THRUST, SPEED = 0.0, 0.0, 0.0  # place along the axis [m], force [N], spin [rad/s]: whoever builds it writes others
ENDS = {"front": 0.05, "rear": -0.05}  # places of the bearings along the shaft [m]
WRENCH = ["force.x", "force.y", "force.z", "moment.y", "moment.z"]
PLACE = ["position.x", "position.y", "position.z", "rotation.y", "rotation.z"]
RATES = ["velocity.x", "velocity.y", "velocity.z", "rotation_rate.y", "rotation_rate.z"]


class Shaft(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.place, self.rates = [START, 0.0, 0.0, 0.0, 0.0], [0.0] * 5
        self.wrenches = {end: [0.0] * 5 for end in ENDS}
        for end, offset in ENDS.items():
            for index, name in enumerate(WRENCH):
                self.input(f"{end}.{name}", self.wrenches[end], index)
            for index, (place, rate) in enumerate(zip(PLACE, RATES)):
                self.output(f"{end}.{place}", lambda index=index, offset=offset: self.at(self.place, index, offset))
                self.output(f"{end}.{rate}", lambda index=index, offset=offset: self.at(self.rates, index, offset))
            self.output(f"{end}.speed", lambda: SPEED)

    def input(self, name, values, index):
        def put(value):
            values[index] = value

        causality, get = Fmi2Causality.input, lambda: values[index]
        self.register_variable(Real(name, causality=causality, getter=get, setter=put, start=0.0))

    def output(self, name, get):
        self.register_variable(Real(name, causality=Fmi2Causality.output, getter=get))

    @staticmethod
    def at(values, index, offset):
        """Component of the motion of a point on the axis."""
        _, y, z, about_y, about_z = values
        return {1: y + about_z * offset, 2: z - about_y * offset}.get(index, values[index])

    def do_step(self, current_time, step_size):
        force = [THRUST, 0.0, 0.0, 0.0, 0.0]
        for end, offset in ENDS.items():
            x, y, z, about_y, about_z = self.wrenches[end]
            for index, value in enumerate([x, y, z, about_y - offset * z, about_z + offset * y]):
                force[index] += value
        for index in range(5):
            self.rates[index] += step_size * force[index] / (MASS if index < 3 else TILTING)
            self.place[index] += step_size * self.rates[index]
        return True
