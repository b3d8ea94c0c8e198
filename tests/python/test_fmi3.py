"""Packages of FMI 3.0 in FMPy: validation, the same results as those of FMI 2.0, and terminals of both."""

import os
import shutil
import zipfile
from pathlib import Path

import fmpy
import numpy as np
import pytest
from conftest import ROOT, pose_drive, roulement
from fmpy import extract, fmi3, read_model_description, simulate_fmu
from fmpy.validation import validate_fmu

SCENES = ["thrust.toml", "cage.toml", "shafts/pinion.toml"]
EVERY = sorted(str(scene.relative_to(ROOT)) for folder in ["scenes", "examples"] for scene in (ROOT / folder).rglob("*.toml"))


def both(scene, directory, *options):
    """Packages of both versions of a scene's file."""
    made = []
    for version in [2, 3]:
        package = directory / str(version) / "bearing.fmu"
        package.parent.mkdir(exist_ok=True)
        roulement("fmu", scene, "-o", package, "--fmi", version, *options)
        made.append(str(package))
    return made


def outputs(package, steps=40, step=5e-5, **options):
    description = read_model_description(package)
    names = [v.name for v in description.modelVariables if v.causality == "output"]
    return simulate_fmu(package, stop_time=steps * step, output_interval=step, output=names, **options)


def with_arrays(text):
    """The same scene with arrays."""
    if "[interface]\n" in text:
        return text.replace("[interface]\n", "[interface]\narrays = true\n", 1)
    return f"{text}\n[interface]\narrays = true\n"


def elements(results, description):
    """Results by the names of scalars: an array of FMPy has one column, which is split as its elements come in the table."""
    sizes = {v.name: v.shape for v in description.modelVariables}
    return {name: results[name].reshape(len(results), -1) for name in results.dtype.names if sizes.get(name)}


@pytest.mark.parametrize("scene", SCENES)
def test_arrays_have_the_results_of_scalars_to_the_last_bit(scene, tmp_path):
    text = (ROOT / "scenes" / scene).read_text()
    if "per_ball_outputs" not in text and "shafts" not in scene:
        text = text.replace("[effects]\n", "[effects]\nper_ball_outputs = true\n", 1)
    packages = []
    for name, form in [("scalars", text), ("arrays", with_arrays(text))]:
        (tmp_path / f"{name}.toml").write_text(form)
        packages.append(tmp_path / f"{name}.fmu")
        roulement("fmu", tmp_path / f"{name}.toml", "-o", packages[-1], "--fmi", 3)
        assert validate_fmu(str(packages[-1])) == []
    scalars, arrays = (outputs(str(package)) for package in packages)
    of = elements(arrays, read_model_description(str(packages[1])))
    found = 0
    for name in arrays.dtype.names:
        # An array of vectors has its components last, one of every ball its balls.
        if name not in of:
            assert np.array_equal(arrays[name], scalars[name]), name
            continue
        head, _, tail = name.partition("ball.")
        names = [f"{name}.{axis}" for axis in "wxyz"] if f"{name}.y" in scalars.dtype.names else None
        names = names or [f"{head}ball[{k + 1}].{tail}" for k in range(of[name].shape[1])]
        names = [one for one in names if one in scalars.dtype.names]
        if names:
            assert np.array_equal(of[name], np.column_stack([scalars[one] for one in names])), name
            found += 1
    assert found > 4 and ("shafts" in scene or "ball.inner.load" in of)
    assert len(arrays.dtype.names) < 0.8 * len(scalars.dtype.names)


@pytest.mark.parametrize("scene", SCENES)
def test_results_are_those_of_2_0_to_the_last_bit(scene, tmp_path):
    packages = both(ROOT / "scenes" / scene, tmp_path)
    assert [validate_fmu(package) for package in packages] == [[], []]
    results = [outputs(package) for package in packages]
    assert results[0].dtype.names == results[1].dtype.names and len(results[0].dtype.names) > 20
    for name in results[0].dtype.names:
        assert np.array_equal(results[0][name], results[1][name]), name
    assert len({row.tobytes() for row in results[0]}) == 41


def test_results_are_those_of_2_0_with_inputs_driven(thrust_text, tmp_path):
    scene = tmp_path / "driven.toml"
    scene.write_text(pose_drive(thrust_text, "shaft"))
    times = np.linspace(0, 2e-3, 41)
    signals = np.zeros(41, dtype=[("time", float), ("inner.position.y", float), ("inner.velocity.y", float), ("friction", float)])
    signals["time"], signals["friction"] = times, np.where(times < 1e-3, 0.1, 0.03)
    signals["inner.position.y"], signals["inner.velocity.y"] = 2e-6 * np.sin(3e3 * times), 6e-3 * np.cos(3e3 * times)
    # FMPy gives 2.0 packages derivatives of inputs, 3.0 has none.
    packages = both(scene, tmp_path)
    results = [outputs(package, input=signals, set_input_derivatives=False) for package in packages]
    for name in results[0].dtype.names:
        assert np.array_equal(results[0][name], results[1][name]), name
    assert np.ptp(results[0]["inner.force.y"]) > 50


def terminals(package):
    """Terminals of a package with their members, after a look by the standard's schema."""
    from lxml import etree

    with zipfile.ZipFile(package) as archive:
        document = etree.fromstring(archive.read("terminalsAndIcons/terminalsAndIcons.xml"))
        assert "terminalsAndIcons/icon.png" in archive.namelist()
    # That of the schema, in packages of both versions.
    assert document.get("fmiVersion") == "3.0"
    schema = etree.XMLSchema(etree.parse(Path(fmpy.__file__).parent / "schema" / "fmi3" / "fmi3TerminalsAndIcons.xsd"))
    schema.assertValid(document)
    members = {
        terminal.get("name"): {m.get("memberName"): (m.get("variableName"), m.get("variableKind")) for m in terminal}
        for terminal in document.find("Terminals")
    }
    variables = {v.name for v in read_model_description(package).modelVariables}
    assert all(name in variables for terminal in members.values() for name, _ in terminal.values())
    return members


def test_races_loads_and_seats_are_terminals(thrust_text, tmp_path):
    scene = tmp_path / "pose.toml"
    scene.write_text(pose_drive(thrust_text, "shaft"))
    expected = {f"{motion}.{axis}" for motion in ["position", "velocity"] for axis in "xyz"}
    expected |= {f"{motion}.{axis}" for motion in ["rotation", "rotation_rate"] for axis in "yz"}
    expected |= {f"{effort}.{axis}" for effort in ["force", "moment"] for axis in "xyz"} | {"speed", "turned"}
    # Inputs of 3.0, and derivatives of inputs in 2.0.
    accelerations = {f"acceleration.{axis}" for axis in "xyz"} | {f"rotation_acceleration.{axis}" for axis in "yz"} | {"speed_rate"}
    for package, more in zip(both(scene, tmp_path), [set(), accelerations]):
        assert validate_fmu(package) == []
        inner = terminals(package)["inner"]
        assert set(inner) == expected | more
        assert inner["force.x"] == ("inner.force.x", "outflow") and inner["position.y"] == ("inner.position.y", "signal")
    for package in both(ROOT / "scenes" / "shafts" / "pinion.toml", tmp_path):
        of_shaft = terminals(package)
        seats = [name for name in of_shaft if name.endswith(".seat")]
        assert len(seats) >= 2 and all("displacement.y" in of_shaft[name] for name in seats)
        assert any({"force.x", "moment.z", "displacement.x"} <= set(members) for members in of_shaft.values())
        assert "torque" in of_shaft["shaft"] and sum(name.endswith(".inner") for name in of_shaft) >= 2


def test_an_importer_sets_inputs_within_steps(thrust_text, tmp_path):
    """A shaft of 1 kg that FMPy's callback moves, at communication steps of 1 ms."""
    scene = tmp_path / "pose.toml"
    scene.write_text(pose_drive(thrust_text, "shaft").replace('max_step = "10 us"', 'max_step = "5 us"'))
    _, package = both(scene, tmp_path)
    description = read_model_description(package)
    references = {v.name: v.valueReference for v in description.modelVariables}
    assert description.coSimulation.providesIntermediateUpdate
    place, velocity, force = (references[f"inner.{name}"] for name in ["position.y", "velocity.y", "force.y"])
    mass, load = 1.0, 200.0  # [kg], [N]
    shaft = {"time": 0.0, "place": 0.0, "velocity": 0.0}
    places = []

    def update(environment, time, may_set, may_get, finished, may_return, requested, end):
        step = time - shaft["time"]
        (exerted,) = bearing.getFloat64([force])
        shaft["place"] += shaft["velocity"] * step
        shaft["velocity"] += (exerted + load) / mass * step
        shaft["time"] = time
        bearing.setFloat64([place, velocity], [shaft["place"], shaft["velocity"]])
        places.append(shaft["place"])

    unzipped = extract(package, unzipdir=tmp_path / "unzipped")
    bearing = fmi3.FMU3Slave(
        guid=description.guid, unzipDirectory=unzipped, modelIdentifier=description.coSimulation.modelIdentifier, instanceName="b"
    )
    bearing.instantiate(intermediateUpdate=update)
    bearing.enterInitializationMode()
    bearing.exitInitializationMode()
    for k in range(20):
        event, end, early, reached = bearing.doStep(currentCommunicationPoint=k * 1e-3, communicationStepSize=1e-3)
        assert (event, end, early) == (False, False, False) and abs(reached - (k + 1) * 1e-3) < 1e-12
    bearing.terminate()
    bearing.freeInstance()
    assert len(places) > 20 * 200 and 1e-7 < max(np.abs(places)) < 2e-5
    # It swings about where the bearing carries the load, and comes to rest.
    assert np.ptp(places[-400:]) < np.ptp(places[:1000])


def validated(scene, directory):
    """What FMPy finds in packages of a scene: 2.0, 3.0, and 3.0 with arrays."""
    result = roulement("fmu", ROOT / scene, "-o", directory / "probe.fmu", check=False)
    if result.returncode != 0:
        # Descriptions of sweeps and systems, and scenes that are part of others, have no package.
        return None
    # Beside the files that it names.
    folder = directory / "arrays"
    shutil.copytree((ROOT / scene).parent, folder)
    (folder / "arrays.toml").write_text(with_arrays((ROOT / scene).read_text()))
    arrays = folder / "arrays.fmu"
    roulement("fmu", folder / "arrays.toml", "-o", arrays, "--fmi", 3)
    packages = [*both(ROOT / scene, directory), str(arrays)]
    for package in packages:
        terminals(package)
    return [validate_fmu(package) for package in packages]


@pytest.mark.skipif("ROULEMENT_LONG" not in os.environ, reason="long: scripts/soak")
@pytest.mark.parametrize("scene", EVERY)
def test_fmpy_finds_no_problem_in_any_scene_that_is_shipped(scene, tmp_path):
    assert validated(scene, tmp_path) in (None, [[], [], []])
