"""A shaft with its bearings as one package, in FMPy."""

import json
import math

import numpy as np
import pytest
from conftest import Slave, build, roulement
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

STEP = 2e-5
MASS = 1.8
TEXT = f"""
gravity = [0, 0, -9.81]

[shaft]
speed = "6000 rpm"
mass = "{MASS} kg"
polar_inertia = "6e-4 kg m^2"
transverse_inertia = "4e-3 kg m^2"

[[shaft.load]]
name = "mesh"
position = "-10 mm"
force = [337.8, -475.0, 1260.5]
moment = [30.0, 0, -8.04]

[[shaft.point]]
name = "drive-end"
position = "80 mm"

[[bearing]]
name = "left"
catalogue = "7206 B"
mounting = {{ position = "-50 mm", direction = "+x", preload = {{ force = "1500 N" }} }}

[[bearing]]
name = "right"
catalogue = "7206 B"
mounting = {{ position = "50 mm", direction = "-x", preload = {{ force = "1500 N" }} }}

[load]
duration = "5 ms"
output_interval = "100 us"
"""


@pytest.fixture(scope="module")
def package(tmp_path_factory):
    return build(TEXT, tmp_path_factory.mktemp("system"), "gear")


def of_bearings(result, row=-1):
    """[N] force of both bearings on the shaft; the axes of the right one are turned by half a turn about z."""
    left, right = (
        np.array([result[f"{side}.inner.force.{axis}"][row] for axis in "xyz"]) for side in ["left", "right"]
    )
    return left + right * [-1, -1, 1]


def test_fmpy_finds_no_problem(package):
    assert validate_fmu(str(package)) == []


def test_a_package_of_chosen_outputs_is_the_same_with_less(package, tmp_path):
    chosen = tmp_path / "chosen.fmu"
    roulement("fmu", package.with_suffix(".toml"), "-o", chosen, "--columns", "*.inner.force.*,shaft.torque")
    assert validate_fmu(str(chosen)) == []
    names = [v.name for v in read_model_description(chosen).modelVariables if v.causality == "output"]
    assert sorted(names) == sorted([f"{side}.inner.force.{axis}" for side in ("left", "right") for axis in "xyz"] + ["shaft.torque"])
    settings = {"stop_time": 20 * STEP, "step_size": STEP, "output_interval": STEP, "output": names}
    found, wanted = (simulate_fmu(str(fmu), **settings) for fmu in (chosen, package))
    for name in names:
        assert np.array_equal(found[name], wanted[name]), name
    # Derivatives of what is there are those of the whole package.
    known = ["mesh.force.y", "shaft.speed"]
    derivatives = []
    for fmu in (chosen, package):
        slave = Slave(fmu, tmp_path / f"unzipped-{fmu.stem}").start()
        slave.fmu.doStep(0.0, STEP)
        references = [[slave.references[name] for name in of] for of in (names, known)]
        derivatives.append(list(slave.fmu.getDirectionalDerivative(*references, [1.0, 0.1])))
        slave.fmu.terminate()
        slave.fmu.freeInstance()
    assert derivatives[0] == derivatives[1] and any(derivatives[0])


def test_names_units_and_abilities(package):
    description = read_model_description(package)
    variables = {v.name: v for v in description.modelVariables}
    for name, unit, causality, start in [
        ("mesh.force.x", "N", "input", 337.8),
        ("mesh.moment.z", "N.m", "input", -8.04),
        ("shaft.speed", "rad/s", "input", 200 * math.pi),
        ("shaft.torque", "N.m", "output", None),
        ("shaft.angle", "rad", "output", None),
        ("'drive-end'.displacement.y", "m", "output", None),
        ("left.seat.tilt.z", "rad", "output", None),
        ("right.inner.moment.y", "N.m", "output", None),
        ("left.friction", "1", "input", None),
    ]:
        variable = variables[name]
        assert (variable.unit, variable.causality) == (unit, causality), name
        assert start is None or math.isclose(float(variable.start), start), name
    abilities = description.coSimulation
    assert abilities.canGetAndSetFMUstate and abilities.canSerializeFMUstate
    assert abilities.providesDirectionalDerivative
    assert float(description.defaultExperiment.stopTime) == 5e-3


def test_bearings_carry_the_load_that_is_set(package):
    time = [0, 1e-3, 1.5e-3, 4e-3]
    load = np.array(
        [(t, z) for t, z in zip(time, [1260.5, 1260.5, 1600, 1600])], dtype=[("time", float), ("mesh.force.z", float)]
    )
    names = [f"{side}.inner.force.{axis}" for side in ["left", "right"] for axis in "xyz"]
    result = simulate_fmu(
        str(package),
        stop_time=4e-3,
        step_size=STEP,
        output_interval=STEP,
        input=load,
        output=[*names, "shaft.angle", "left.inner.turned", "shaft.energy.stored"],
    )
    weight = -9.81 * MASS
    # Balls start at one common speed: their creep takes 1 ms to fade.
    assert np.allclose(of_bearings(result, 50), [-337.8, 475, -1260.5 - weight], atol=0.01 * 1260)
    # What is left of the oscillation after the ramp is averaged out.
    last = np.mean([of_bearings(result, row) for row in range(-50, 0)], axis=0)
    assert np.allclose(last, [-337.8, 475, -1600 - weight], atol=0.01 * 1600), last
    assert math.isclose(result["shaft.angle"][-1], 200 * math.pi * 4e-3, rel_tol=1e-9)
    assert math.isclose(result["left.inner.turned"][-1], result["shaft.angle"][-1], rel_tol=1e-6)


def test_a_saved_state_is_replayed_to_the_bit(package, tmp_path):
    slave = Slave(package, tmp_path / "unzipped").start()
    try:
        for k in range(5):
            slave.fmu.doStep(k * STEP, STEP)
        state = slave.fmu.getFMUState()
        ends = []
        for _ in range(2):
            slave.fmu.setFMUState(state)
            slave.set(mesh__force__z=1000.0)
            for k in range(5, 10):
                slave.fmu.doStep(k * STEP, STEP)
            ends.append(list(slave.outputs()))
        slave.fmu.freeFMUState(state)
        assert ends[0] == ends[1] and len(ends[0]) > 100
    finally:
        slave.close()


def test_a_package_of_equilibria_is_that_of_the_command(tmp_path):
    text = TEXT + '\n[solver]\nlevel = "equilibrium"\n'
    shaft = Slave(build(text, tmp_path, "level"), tmp_path / "unzipped").start()
    assert any("outputs are those of the equilibrium" in message[2] for message in shaft.messages), shaft.messages
    time = 0.0
    for force, step in ((1260.5, 1e-3), (600.0, 2e-4), (-300.0, 5.0)):
        shaft.set(mesh__force__z=force)
        shaft.fmu.doStep(time, step)
        time += step
        scene = tmp_path / "there.toml"
        scene.write_text(TEXT.replace("1260.5", str(force)))
        told = json.loads(roulement("equilibrium", scene, "--json").stdout)
        wanted = told["bearings"]
        # What holds the shaft at its speed has the losses of both bearings, as there.
        torque = shaft.get("shaft.torque")[0]
        assert math.isclose(torque, told["shafts"]["shaft"]["torque"], rel_tol=1e-5), (force, torque)
        for side in ("left", "right"):
            found = shaft.get(*(f"{side}.seat.displacement.{axis}" for axis in "xyz"), f"{side}.friction_torque")
            of = wanted[side]
            expected = [*of["displacement"].values(), of["friction_torque"]]
            # Spins of the balls, which friction comes from, are iterated: they end a little differently where rounding does.
            assert np.allclose(found, expected, rtol=[1e-8, 1e-8, 1e-8, 1e-4], atol=1e-13), (force, side)
    # Steps of any length: there is no motion in between.
    assert math.isclose(shaft.get("shaft.angle")[0], time * 100 * 2 * math.pi, rel_tol=1e-12)
    shaft.close()


def test_a_motion_that_is_set_is_that_of_a_table(tmp_path):
    # A point that goes 3 um away, in 0.2 ms: from rest to rest, a cubic.
    end, way = 2e-4, 3e-6
    of_load = "force = [337.8, 0, 1260.5]\nmoment = [30.0, 0, -8.04]\ndisplacement = { y = %s }"
    given = TEXT.replace("force = [337.8, -475.0, 1260.5]\nmoment = [30.0, 0, -8.04]", of_load)
    names = ["mesh.force.y", "left.inner.force.y", "right.inner.force.x", "shaft.energy.work"]
    settings = {"stop_time": 4e-4, "step_size": STEP, "output_interval": STEP}
    table = build(given % f"[[0, 0], [{end}, {way}]]", tmp_path, "table")
    wanted = simulate_fmu(str(table), output=names, **settings)
    package = build(given % "0", tmp_path, "set")
    assert validate_fmu(str(package)) == []
    variables = {v.name: v for v in read_model_description(package).modelVariables}
    assert [variables[f"mesh.{name}"].causality for name in ("displacement.y", "velocity.y", "force.y", "displacement.z")] == [
        "input",
        "input",
        "output",
        "output",
    ]

    def at(time):
        t = min(time / end, 1.0)
        return way * t * t * (3 - 2 * t), way / end * 6 * t * (1 - t)

    slave = Slave(package, tmp_path / "unzipped").start()
    try:
        for k in range(20):
            (_, rate), (value, end_rate) = at(k * STEP), at((k + 1) * STEP)
            # Value, rate and rate of that which lead to where the table is at the next point.
            slave.set(mesh__displacement__y=value - 0.5 * (rate + end_rate) * STEP, mesh__velocity__y=rate)
            slave.fmu.setRealInputDerivatives([slave.references["mesh.velocity.y"]], [1], [(end_rate - rate) / STEP])
            slave.fmu.doStep(k * STEP, STEP)
            for name in names:
                found = slave.fmu.getReal([slave.references[name]])[0]
                size = max(abs(wanted[name][k + 1]), 1.0)
                assert abs(found - wanted[name][k + 1]) < 1e-9 * size, (name, k)
    finally:
        slave.fmu.terminate()
        slave.fmu.freeInstance()
    assert abs(wanted["mesh.force.y"][-1]) > 10


ROLLERS = """
[shaft]
speed = "1500 rpm"
mass = "2 kg"
polar_inertia = "1e-3 kg m^2"
transverse_inertia = "3e-3 kg m^2"

[[shaft.load]]
name = "mesh"
position = 0
force = ["400 N", "3 kN", 0]

[[bearing]]
name = "left"
catalogue = "30206"
mounting = { position = "-40 mm" }

[[bearing]]
name = "right"
catalogue = "30206"
mounting = { position = "40 mm", direction = "-x" }

[load]
duration = "1 ms"
output_interval = "100 us"
"""


def test_a_package_without_balls_steps_goes_back_and_offers_its_steps(tmp_path):
    package = build(ROLLERS, tmp_path, "rollers")
    assert not validate_fmu(package)
    names = [variable.name for variable in read_model_description(package).modelVariables]
    assert {"solver.tolerance", "left.force.y", "right.force.x"} <= set(names)
    unit = Slave(package, tmp_path / "unpacked").start()

    def five_steps(begin):
        for row in range(5):
            unit.fmu.doStep(currentCommunicationPoint=begin + row * 1e-4, communicationStepSize=1e-4)
        return unit.get("left.force.x", "left.force.y", "right.force.y")

    five_steps(0.0)
    unit.set(solver__tolerance=1e-9)
    state = unit.fmu.getFMUState()
    ends = []
    for _ in range(2):
        unit.fmu.setFMUState(state)
        ends.append(five_steps(5e-4))
    unit.fmu.freeFMUState(state)
    unit.close()
    assert ends[0] == ends[1]
    assert ends[0][1] + ends[0][2] == pytest.approx(-3000, rel=0.05)
