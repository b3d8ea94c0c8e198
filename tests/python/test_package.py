"""The package in FMPy: validation, simulation, agreement with the native run, wrong calls."""

import csv
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT, Slave, build, oriented, pose_drive, roulement
from fmpy import read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

STEP = 1e-4


def native_rows(scene_text, directory):
    """Result table of `roulement run`, exact numbers by column name without unit."""
    scene = directory / "native.toml"
    scene.write_text(scene_text)
    roulement("run", scene, "-o", directory / "native", "--steps-end-at-rows")
    with open(directory / "native" / "results.csv") as table:
        rows = list(csv.DictReader(table))
    return [{name.split(" [")[0]: float(value) for name, value in row.items()} for row in rows]


@pytest.mark.parametrize("drive", ["wrench", "pose", "shaft"])
def test_fmpy_finds_no_problem(packages, drive):
    assert validate_fmu(str(packages[drive])) == []


def test_interface_is_that_of_the_drive(packages):
    names = {
        drive: {v.name: v.causality for v in read_model_description(package).modelVariables}
        for drive, package in packages.items()
    }
    for component in ["position.x", "orientation.w", "velocity.z", "angular_velocity.y"]:
        assert names["pose"][f"inner.{component}"] == "input"
        assert names["wrench, quaternion"][f"inner.{component}"] == "output"
    for component in ["position.x", "rotation.y", "velocity.z", "rotation_rate.z"]:
        assert names["shaft"][f"inner.{component}"] == "input"
        assert names["wrench"][f"inner.{component}"] == "output"
    assert names["shaft"]["inner.speed"] == "input" and names["shaft"]["inner.turned"] == "output"
    assert not any(name.startswith("inner.orientation") for name in [*names["shaft"], *names["wrench"]])
    for component in ["force.x", "moment.z"]:
        assert names["pose"][f"inner.{component}"] == names["wrench"][f"inner.{component}"] == "output"
    for name in ["inner.applied_force.x", "inner.applied_moment.y", "inner.speed", "inner.drive_torque"]:
        assert name in names["wrench"] and name not in names["pose"]
    assert names["pose"]["friction"] == names["wrench"]["friction"] == "input"
    assert not any(name.startswith("ball[") for name in names["pose"])


@pytest.mark.parametrize("drive", ["wrench", "pose", "shaft"])
def test_simulate_fmu_reaches_the_load(packages, drive):
    result = simulate_fmu(str(packages[drive]), stop_time=0.02, output_interval=STEP)
    force = result["inner.force.x"][-1]
    assert math.isclose(force, -1500, rel_tol=0.01), force
    assert all(np.isfinite(result[name]).all() for name in result.dtype.names)


@pytest.mark.parametrize("drive", ["wrench", "pose", "counter-rotating"])
def test_native_run_and_package_agree_to_the_last_bit(thrust_text, tmp_path, drive):
    text = pose_drive(thrust_text) if drive == "pose" else thrust_text
    if drive == "counter-rotating":
        text = text.replace("[load]", '[load]\nouter_speed = "-3000 rpm"')
    # A power of two: sums of communication steps are exact, so that both have equal communication points.
    text = text.replace('"50 ms"', "0.009765625").replace('"100 us"', "0.0001220703125")
    package = build(text, tmp_path, drive)
    rows = native_rows(text, tmp_path)
    bearing = Slave(package, tmp_path / "unzipped").start()
    names = [v.name for v in bearing.description.modelVariables if v.type == "Real" and v.causality == "output"]
    assert len(rows) == 81
    assert [rows[0][name] for name in names] == list(bearing.get(*names))
    for before, row in zip(rows, rows[1:]):
        if drive == "pose":
            # The native run drives the race by its script: here a steady turn: inputs are those at the start of a step.
            poses = {
                name: before[name]
                for name in before
                if name.startswith("inner.") and name.split(".")[1] in ("position", "orientation", "velocity")
            }
            poses |= {name: before[name] for name in before if name.startswith("inner.angular_velocity")}
            bearing.set(**{name.replace(".", "__"): value for name, value in poses.items()})
        bearing.fmu.doStep(before["time"], row["time"] - before["time"])
        got = bearing.get(*names)
        differing = [(n, row[n], value) for n, value in zip(names, got) if row[n] != value]
        assert not differing, differing[:3]
    bearing.close()


def test_means_since_the_last_point_add_up_whatever_the_points_are(thrust_text, tmp_path):
    text = thrust_text.replace("[effects]", "[effects]\nmean_outputs = true", 1)
    bearing = Slave(build(text, tmp_path, "means"), tmp_path / "unzipped").start()
    names = ("energy.dissipated", "mean.loss.total", "inner.force.x", "mean.inner.force.x")
    before, time = bearing.get(*names), 0.0
    for step in (1e-4, 1e-3, 3e-4, 1e-5, 2e-3):
        state = bearing.fmu.getFMUstate()
        bearing.fmu.doStep(time, step)
        now = bearing.get(*names)
        assert math.isclose(now[1] * step, now[0] - before[0], rel_tol=1e-9), (step, now, before)
        if step < 5e-5:
            # One step: between the forces at its ends.
            assert min(before[2], now[2]) - 1e-9 <= now[3] <= max(before[2], now[2]) + 1e-9
        # The same again from a saved state.
        bearing.fmu.setFMUstate(state)
        bearing.fmu.doStep(time, step)
        assert bearing.get(*names) == now
        bearing.fmu.freeFMUstate(state)
        before, time = now, time + step
    bearing.close()


def test_two_instances_are_independent(slave):
    alone = slave().start()
    for k in range(20):
        alone.fmu.doStep(k * STEP, STEP)
    one, other = slave(name="one").start(), slave(name="other").start()
    other.set(friction=0.02, inner__speed=300.0)
    for k in range(20):
        one.fmu.doStep(k * STEP, STEP)
        other.fmu.doStep(k * STEP, STEP)
    assert list(one.outputs()) == list(alone.outputs())
    assert list(one.outputs()) != list(other.outputs())


def test_reset_is_a_fresh_instance(slave):
    bearing, fresh = slave().start(), slave()
    for k in range(5):
        bearing.fmu.doStep(k * STEP, STEP)
    bearing.fmu.reset()
    bearing.start()
    fresh.start()
    assert bearing.state_bytes() == fresh.state_bytes()


def test_state_replays_to_the_same_bits_in_another_instance(slave):
    one, other = slave().start(), slave().start()
    for k in range(7):
        one.fmu.doStep(k * STEP, STEP)
    saved = one.state_bytes()
    for k in range(7, 14):
        one.fmu.doStep(k * STEP, STEP)
    other.fmu.setFMUState(other.fmu.deserializeFMUState(saved))
    for k in range(7, 14):
        other.fmu.doStep(k * STEP, STEP)
    assert one.state_bytes() == other.state_bytes()


def test_altered_states_are_refused(slave):
    bearing = slave().start()
    saved = bearing.state_bytes()
    flipped = bytearray(saved)
    flipped[len(saved) // 2] ^= 1
    for wrong in [bytes(flipped), saved[:-1], saved + b"x", b"", b"nonsense"]:
        with pytest.raises(Exception):
            bearing.fmu.deserializeFMUState(wrong)
        assert "refused" in bearing.messages[-1][2]
    bearing.fmu.doStep(0.0, STEP)


def test_wrong_guid(slave):
    bearing = slave(guid="{00000000-0000-0000-0000-000000000000}")
    with pytest.raises(Exception):
        bearing.instantiate()
    assert any("guid" in message for _, _, message in bearing.messages)


def test_wrong_inputs_name_the_variable(slave):
    bearing = slave("pose").start()
    for name, value in [("inner__position__x", math.nan), ("inner__velocity__y", math.inf)]:
        with pytest.raises(Exception):
            bearing.set(**{name: value})
        assert name.replace("__", ".") in bearing.messages[-1][2]
    with pytest.raises(Exception):
        bearing.set(inner__force__x=1.0)
    assert "inner.force.x is an output" in bearing.messages[-1][2]
    # None of that did any harm.
    bearing.fmu.doStep(0.0, STEP)


def test_unnormalised_quaternions(slave):
    near = slave("pose").start()
    near.set(inner__orientation__w=1.0005)
    near.fmu.doStep(0.0, STEP)
    opposite = slave("pose").start()
    exact = slave("pose").start()
    components = [f"inner.orientation.{c}" for c in "wxyz"]
    values = exact.get(*components)
    opposite.set(**{name.replace(".", "__"): -value for name, value in zip(components, values)})
    for bearing in (opposite, exact):
        bearing.fmu.doStep(0.0, STEP)
    np.testing.assert_allclose(opposite.outputs(), exact.outputs(), rtol=1e-9, atol=1e-9)
    far = slave("pose").start()
    far.set(inner__orientation__w=0.9)
    with pytest.raises(Exception):
        far.fmu.doStep(0.0, STEP)
    assert "inner.orientation" in far.messages[-1][2]


@pytest.mark.parametrize("time, step", [(0.0, -1e-4), (0.0, 0.0), (0.0, math.nan), (1.0, 1e-4), (math.nan, 1e-4)])
def test_wrong_steps(slave, time, step):
    bearing = slave().start()
    with pytest.raises(Exception):
        bearing.fmu.doStep(time, step)
    assert "communication" in bearing.messages[-1][2]
    # An error can be left by a reset.
    bearing.fmu.reset()
    bearing.start()
    bearing.fmu.doStep(0.0, STEP)


def test_illegal_call_orders(slave):
    bearing = slave().instantiate()
    for call in [
        lambda: bearing.fmu.doStep(0.0, STEP),
        lambda: bearing.fmu.exitInitializationMode(),
        lambda: bearing.fmu.terminate(),
        lambda: bearing.get("inner.force.x"),
    ]:
        with pytest.raises(Exception):
            call()
        assert "not allowed in phase" in bearing.messages[-1][2]
        bearing.fmu.reset()
    bearing.start()
    with pytest.raises(Exception):
        bearing.fmu.enterInitializationMode()
    bearing.fmu.terminate()
    with pytest.raises(Exception):
        bearing.fmu.doStep(0.0, STEP)


def test_unknown_references_and_types(slave):
    bearing = slave().start()
    for call in [
        lambda: bearing.fmu.getReal([99999]),
        lambda: bearing.fmu.getInteger([bearing.references["inner.force.x"]]),
        lambda: bearing.fmu.getBoolean([0]),
        lambda: bearing.fmu.setReal([99999], [1.0]),
    ]:
        with pytest.raises(Exception):
            call()
        assert bearing.messages
    assert bearing.fmu.getInteger([bearing.references["integrator.steps"]]) == [0]


def test_a_scene_that_cannot_start_is_refused_by_the_packer(thrust_text, tmp_path):
    with pytest.raises(Exception):
        build(thrust_text.replace("1500 N", "900 MN"), tmp_path, "crushed")
    scene = tmp_path / "crushed.toml"
    outcome = roulement("fmu", scene, "-o", tmp_path / "crushed.fmu", check=False)
    assert outcome.returncode != 0 and "equilibrium" in outcome.stderr
    assert not (tmp_path / "crushed.fmu").exists()


def test_per_ball_outputs_only_when_asked_for(thrust_text, tmp_path):
    text = thrust_text.replace("[effects]", "[effects]\nper_ball_outputs = true")
    package = build(text, tmp_path, "balls")
    assert validate_fmu(str(package)) == []
    slave = Slave(package, tmp_path / "unzipped").start()
    loads = slave.get(*[f"ball[{j}].inner.load" for j in range(1, 11)])
    slave.close()
    assert min(loads) > 300 and max(loads) - min(loads) < 1e-6


def test_cardan_angles(thrust_text, tmp_path):
    text = pose_drive(thrust_text, "cardan")
    package = build(text, tmp_path, "cardan")
    assert validate_fmu(str(package)) == []
    slave = Slave(package, tmp_path / "unzipped").start()
    assert "inner.orientation.w" not in slave.references
    slave.set(inner__angle__x=1000 * math.pi)
    slave.fmu.doStep(0.0, STEP)
    assert math.isclose(slave.get("inner.force.x")[0], -1500, rel_tol=0.02)
    slave.close()


def lists(unknowns):
    """What FMPy reads of lists of dependencies: names by output; None where the output depends on everything."""
    named = lambda known: None if known is None else {variable.name for variable in known}
    return {unknown.variable.name: named(unknown.dependencies) for unknown in unknowns}


def test_no_output_depends_on_an_input_at_a_communication_point(packages, slave):
    description = read_model_description(packages["wrench"])
    outputs = [v.name for v in description.modelVariables if v.causality == "output"]
    assert lists(description.outputs) == dict.fromkeys(outputs, set())
    start = lists(description.initialUnknowns)
    assert list(start) == outputs
    assert {name: known for name, known in start.items() if known is not None} == dict.fromkeys(
        ["inner.turned", "energy.work", "energy.dissipated"], set()
    )
    bearing = slave().start()
    bearing.fmu.doStep(0.0, STEP)
    before = list(bearing.outputs())
    for variable in description.modelVariables:
        if variable.causality == "input":
            bearing.fmu.setReal([variable.valueReference], [0.9 * float(variable.start) + 0.01])
            assert list(bearing.outputs()) == before, variable.name


@pytest.mark.parametrize("drive", ["wrench", "pose"])
def test_dependencies_of_a_step_are_the_sparsity_of_its_derivatives(thrust_text, tmp_path, drive):
    """What a master does that takes the lists as sparsity: it asks for listed derivatives alone,
    and has the whole matrix."""
    text = pose_drive(thrust_text, "shaft") if drive == "pose" else oriented(thrust_text, "shaft")
    package = build(text + 'dependencies = "step"\n', tmp_path, "step")
    assert validate_fmu(str(package)) == []
    bearing = Slave(package, tmp_path / "unzipped").start()
    inputs = [v.name for v in bearing.description.modelVariables if v.causality == "input"]
    for name in inputs:
        if name.startswith("inner.applied_force"):
            bearing.set(**{name.replace(".", "__"): bearing.get(name)[0] + 20.0})
    for k in range(5):
        bearing.fmu.doStep(k * STEP, STEP)
    known = lists(bearing.description.outputs)
    outputs = list(known)
    derivatives = lambda unknowns, names: bearing.fmu.getDirectionalDerivative(
        [bearing.references[u] for u in unknowns], [bearing.references[n] for n in names], [1.0] * len(names)
    )
    full = np.array([derivatives(outputs, [name]) for name in inputs]).T
    sparse = np.zeros_like(full)
    for row, output in enumerate(outputs):
        for column, name in enumerate(inputs):
            if name in known[output]:
                (sparse[row, column],) = derivatives([output], [name])
    bearing.close()
    assert np.array_equal(sparse, full)
    turned = {"wrench": ["speed"], "pose": ["rotation.y", "rotation.z", "rotation_rate.y", "rotation_rate.z", "speed"]}
    assert known["inner.turned"] == {f"inner.{name}" for name in turned[drive]}
    assert all(known[output] == set(inputs) for output in outputs if output != "inner.turned")


def test_a_package_is_named_after_its_file_or_as_asked(thrust_text, tmp_path):
    package = build(thrust_text, tmp_path, "2nd bearing")
    description = read_model_description(package)
    assert (description.modelName, description.coSimulation.modelIdentifier) == ("2nd bearing", "_2nd_bearing")
    assert validate_fmu(str(package)) == []
    Slave(package, tmp_path / "unzipped").start().close()
    assert any((tmp_path / "unzipped" / "binaries").rglob("_2nd_bearing.*"))
    roulement("fmu", tmp_path / "2nd bearing.toml", "-o", tmp_path / "x.fmu", "--name", "rear")
    description = read_model_description(tmp_path / "x.fmu")
    assert description.modelName == description.coSimulation.modelIdentifier == "rear"


def test_committed_model_description_is_current():
    printed = roulement("describe", ROOT / "scenes" / "thrust.toml").stdout
    committed = (ROOT / "modelDescription" / "modelDescription.xml").read_text()
    assert printed == committed, "run: roulement describe scenes/thrust.toml > modelDescription/modelDescription.xml"


def test_outer_race_by_its_pose(thrust_text, tmp_path):
    package = build(thrust_text.replace('drive = "fixed"', 'drive = "pose"'), tmp_path, "outer")
    assert validate_fmu(str(package)) == []
    slave = Slave(package, tmp_path / "unzipped").start()
    # The outer race moves off at 1 mm/s: the inner one, a body under its thrust, follows.
    for k in range(100):
        slave.set(outer__position__x=1e-3 * k * STEP, outer__velocity__x=1e-3)
        slave.fmu.doStep(k * STEP, STEP)
    inner, outer = slave.get("inner.position.x", "outer.position.x")
    force = slave.get("outer.force.x")[0]
    slave.close()
    assert math.isclose(outer, 1e-3 * 99 * STEP, rel_tol=1e-12)
    assert 20e-6 < inner - outer < 25e-6
    assert math.isclose(force, 1500, rel_tol=0.02)


# What an importer does, in a process of its own: a run, refused calls, a state there and back.
HOST = """
import sys
from conftest import Slave
slave = Slave(sys.argv[1], sys.argv[2]).start()
for k in range(20):
    slave.fmu.doStep(currentCommunicationPoint=k * 1e-4, communicationStepSize=1e-4)
state = slave.fmu.getFMUState()
for refused in [slave.fmu.enterInitializationMode, lambda: slave.fmu.doStep(0.5, -1.0), lambda: slave.fmu.getReal([10**6])]:
    try:
        refused()
    except Exception:
        continue
    sys.exit("not refused")
slave.fmu.reset()
slave.fmu.setFMUState(state)
slave.fmu.freeFMUState(state)
print(slave.get("inner.force.x")[0], len(slave.messages), file=sys.stderr)
slave.close()
"""


@pytest.mark.parametrize("drive", ["wrench", "pose"])
def test_nothing_is_written_to_the_hosts_output(packages, tmp_path, drive):
    process = subprocess.run(
        [sys.executable, "-c", HOST, packages[drive], tmp_path / "unpacked"],
        cwd=Path(__file__).parent,
        capture_output=True,
        text=True,
    )
    assert process.returncode == 0, process.stderr
    # Through the descriptor, hence also what C's or Rust's library would print.
    assert process.stdout == ""
    # The library was at work, and its messages went to the logger.
    force, messages = process.stderr.split()
    assert float(force) < -1000 and int(messages) >= 3
