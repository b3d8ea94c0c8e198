"""Parameters: one package serves a family of bearings; the model description says which."""

import math
import xml.etree.ElementTree as ElementTree
import zipfile

import pytest
from conftest import Slave, build
from fmpy.validation import validate_fmu

STEP = 1e-4

# Another bearing: keys of the scene, the scene's text, and the text and value in SI that stand there instead.
OTHER = [
    ("bearing.ball_diameter", '"9.525 mm"', '"9 mm"', 9e-3),
    ("bearing.contact_angle", '"25 deg"', "0.5", 0.5),
    ("bearing.inner_conformity", "inner_conformity = 0.52", "inner_conformity = 0.53", 0.53),
    ("effects.damping", '"0.02 s/m"', '"0.05 s/m"', 0.05),
    ("inner.mass", '"0.2 kg"', '"0.5 kg"', 0.5),
    ("solver.alpha_f", "alpha_f = 0.05", "alpha_f = 0.1", 0.1),
    ("solver.max_step", '"10 us"', '"5 us"', 5e-6),
]


def initialise(bearing, values):
    bearing.instantiate()
    bearing.fmu.setupExperiment(startTime=0.0)
    bearing.set(**{name.replace(".", "__"): value for name, value in values.items()})
    bearing.fmu.enterInitializationMode()
    bearing.fmu.exitInitializationMode()
    return bearing


def steps(bearing, first, last):
    for k in range(first, last):
        bearing.fmu.doStep(k * STEP, STEP)
    return list(bearing.outputs())


def test_parameters_make_the_bearing_that_the_scene_would(slave, thrust_text, tmp_path):
    text = thrust_text
    for _, old, new, _ in OTHER:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    expected = Slave(build(text, tmp_path, "other"), tmp_path / "other").start()
    tuned = initialise(slave(), {name: value for name, _, _, value in OTHER})
    assert steps(tuned, 0, 20) == steps(expected, 0, 20)
    assert steps(slave().start(), 0, 20) != steps(tuned, 20, 20)
    expected.close()


def test_parameters_before_the_start_and_inputs_given_with_them(slave):
    before, within = slave(), slave().instantiate()
    initialise(before, {"bearing.ball_diameter": 9e-3, "inner.applied_force.x": 1000.0})
    within.fmu.setupExperiment(startTime=0.0)
    within.fmu.enterInitializationMode()
    within.set(inner__applied_force__x=1000.0)
    within.set(bearing__ball_diameter=9e-3)
    assert within.get("bearing.ball_diameter") == [9e-3]
    assert math.isclose(within.get("inner.force.x")[0], -1000, rel_tol=0.02)
    within.fmu.exitInitializationMode()
    assert steps(before, 0, 5) == steps(within, 0, 5)


def test_reset_goes_back_to_the_scene(slave):
    bearing, fresh = initialise(slave(), {"bearing.ball_diameter": 9e-3}), slave().start()
    bearing.fmu.reset()
    bearing.start()
    assert bearing.get("bearing.ball_diameter") == fresh.get("bearing.ball_diameter")
    assert bearing.state_bytes() == fresh.state_bytes()


def test_tunable_parameters_act_from_the_next_step_on(slave):
    bearing = slave().start()
    steps(bearing, 0, 2)
    bearing.set(effects__gravity__y=-5e3)
    forces = []
    for k in range(2, 102):
        steps(bearing, k, k + 1)
        forces += bearing.get("inner.force.y")
    # On average over its vibration, the bearing carries the weight of the race now.
    assert math.isclose(sum(forces) / len(forces), 0.2 * 5e3, rel_tol=0.05)


def test_fixed_parameters_are_refused_after_the_start(slave):
    bearing = slave().start()
    with pytest.raises(Exception):
        bearing.set(bearing__ball_diameter=9e-3)
    assert "bearing.ball_diameter is fixed" in bearing.messages[-1][2]
    steps(bearing, 0, 1)


@pytest.mark.parametrize(
    "name, value, message",
    [
        ("bearing.ball_diameter", -1.0, "bearing.ball_diameter = -1 m is out of range"),
        ("solver.alpha_f", 0.5, "solver.alpha_f = 0.5"),
        ("bearing.pitch_diameter", 0.012, "do not fit"),
        ("inner.mass", math.nan, "not a finite number"),
    ],
)
def test_values_out_of_range_are_refused(slave, name, value, message):
    bearing = slave()
    with pytest.raises(Exception):
        initialise(bearing, {name: value})
    assert message in bearing.messages[-1][2]
    bearing.fmu.reset()
    bearing.start()
    steps(bearing, 0, 1)


def test_states_take_their_parameters_with_them(slave):
    one, other = initialise(slave(), {"bearing.ball_diameter": 9e-3}), slave().start()
    steps(one, 0, 5)
    saved = one.state_bytes()
    other.fmu.setFMUState(other.fmu.deserializeFMUState(saved))
    assert other.get("bearing.ball_diameter") == [9e-3]
    assert steps(one, 5, 10) == steps(other, 5, 10)
    assert one.state_bytes() == other.state_bytes()


@pytest.mark.parametrize("drive", ["wrench", "pose"])
def test_the_model_description_is_complete(packages, drive):
    assert validate_fmu(str(packages[drive])) == []
    with zipfile.ZipFile(packages[drive]) as package:
        root = ElementTree.fromstring(package.read("modelDescription.xml"))
        names = package.namelist()
        assert package.read("model.png").startswith(b"\x89PNG")
        page = package.read("documentation/index.html").decode()
        licences = package.read("documentation/licenses/license.txt").decode()
    assert {"modelDescription.xml", "resources/scene.toml"} <= set(names)
    units = {unit.get("name"): {d.get("name") for d in unit.findall("DisplayUnit")} for unit in root.iter("Unit")}
    types = {kind.get("name"): kind[0].attrib for kind in root.iter("SimpleType")}
    assert {"deg", "rev/min", "um"} <= set().union(*units.values())
    variables = list(root.iter("ScalarVariable"))
    outputs = set()
    for index, variable in enumerate(variables, 1):
        value = variable[0]
        assert len(variable.get("description")) > 5
        assert variable.get("valueReference") == str(index - 1)
        assert f"<code>{variable.get('name')}</code>" in page
        if value.tag == "Real":
            kind = types[value.get("declaredType")]
            assert kind["unit"] == value.get("unit") and value.get("unit") in units
            assert float(value.get("nominal")) > 0
            assert value.get("displayUnit") is None or value.get("displayUnit") in units[value.get("unit")]
        if variable.get("causality") == "output":
            outputs.add(index)
        elif variable.get("causality") != "local":
            start = float(value.get("start"))
            assert float(value.get("min", -math.inf)) <= start <= float(value.get("max", math.inf))
        if variable.get("causality") == "parameter":
            assert value.get("min") is not None and value.get("max") is not None
    for name in ("Outputs", "InitialUnknowns"):
        assert {int(u.get("index")) for u in root.find(f"ModelStructure/{name}")} == outputs
    experiment = root.find("DefaultExperiment")
    # The balls pass a point of the inner race 577 times a second: a twentieth of that period is 87 us.
    # A shaft of 0.2 kg that its master moves by leapfrog asks for less.
    assert float(experiment.get("stepSize")) == {"wrench": 5e-5, "pose": 1e-5}[drive]
    for section in ("Frames", "Effects", "Interface", "Limits", "Parameters"):
        assert f"<h2>{section}</h2>" in page
    for crate in ("nalgebra", "serde", "quick-xml", "toml"):
        assert f"\n{crate} " in licences
    # What packs it is not in it.
    assert "\nzip " not in licences and "\nclap " not in licences
