"""Scenes, equilibria, effects: as the command line has them."""

import json
import pickle

import numpy as np
import pytest
import roulement
from conftest import ROOT, program


def test_keys_are_edited_with_units(thrust):
    by_keys = thrust.with_({"load.x.force": "2 kN", "bearing.balls": 12, "friction.ball_race": [[0, 0.05], ["1 ms", 0.1]]})
    by_sections = thrust.with_(load={"x": {"force": 2000.0}}, bearing={"balls": 12}, friction={"ball_race": [[0.0, 0.05], [1e-3, 0.1]]})
    one, other = (roulement.run(scene)["inner.force"] for scene in (by_keys, by_sections))
    assert np.array_equal(one, other) and abs(one[-1, 0] + 2000) < 50
    assert "alpha_f" in thrust.source and "alpha_f" not in thrust.with_({"solver.alpha_f": None}).source
    assert pickle.loads(pickle.dumps(by_keys)).source == by_keys.source


def test_errors_are_those_of_the_program(thrust, tmp_path):
    for changes, parts in [
        ({"bearing.bals": 3}, ["bearing.bals", "did you mean balls?"]),
        ({"friction.ball_race": -1.0}, ["friction.ball_race = -1", "[0, 2]"]),
        ({"load.x.force": "1 kg"}, ["load.x.force", "kg measures something else"]),
    ]:
        with pytest.raises(ValueError) as refused:
            thrust.with_(changes)
        assert all(part in str(refused.value) for part in parts), refused.value
    text = thrust.source.replace("balls = 10", "balls = 0")
    (tmp_path / "wrong.toml").write_text(text)
    with pytest.raises(ValueError) as refused:
        roulement.Scene.load(tmp_path / "wrong.toml")
    said = program("run", tmp_path / "wrong.toml", check=False).stderr
    assert said.strip() == f"error: {refused.value}"
    with pytest.raises(FileNotFoundError, match="nowhere.toml"):
        roulement.Scene.load("nowhere.toml")
    with pytest.raises(TypeError):
        thrust.with_({"load.x.force": object()})


def test_consistency_equilibrium_is_that_of_the_command_line(tmp_path):
    path = ROOT / "scenes" / "radial.toml"
    for choice in ("outer-race-control", "none", "friction"):
        printed = json.loads(program("equilibrium", path, "--json", "--gyroscopic", choice).stdout)
        found = roulement.equilibrium(roulement.Scene.load(path), choice)
        assert found.stiffness.tolist() == printed["stiffness"]
        assert found.balls.inner_load.tolist() == printed["balls"]["inner_load"]
        assert found.load.tolist() == [printed["load"][of] for of in ("Fx", "Fy", "Fz", "My", "Mz")]
        assert found.cage_speed == printed["cage_speed"] and found.life is None
    rated = roulement.Scene.load(path).with_({"rating": {"reliability": 0.95}})
    assert roulement.equilibrium(rated).life.L10r > 1
    with pytest.raises(ValueError, match="outer-race-control"):
        roulement.equilibrium(rated, "both")


def test_consistency_equilibrium_of_a_shaft_is_that_of_the_command_line():
    path = ROOT / "scenes" / "shafts" / "pinion.toml"
    printed = json.loads(program("equilibrium", path, "--json").stdout)
    scene = roulement.Scene.load(path)
    found = roulement.equilibrium(scene)
    assert found.report == printed
    left = found.bearings["left"]
    assert left.stiffness.shape == (6, 6) and left.stiffness.tolist() == printed["bearings"]["left"]["stiffness"]
    assert left.force[2] == printed["bearings"]["left"]["force"]["z"] and left.life.L10r > 1 and len(left.balls.inner_load) > 5
    assert found.modes[0].frequency == printed["modes"][0]["frequency"] and found.meshes == {}
    with pytest.raises(ValueError, match="friction carries"):
        roulement.equilibrium(scene, "none")


def test_consistency_effects_and_model_description(thrust, tmp_path):
    (tmp_path / "scene.toml").write_text(thrust.source)
    assert roulement.effects(thrust) == json.loads(program("effects", tmp_path / "scene.toml", "--json").stdout)
    with pytest.raises(RuntimeError, match="there is no cage in this scene"):
        roulement.cage(thrust)
    assert thrust.describe("scene") == program("describe", tmp_path / "scene.toml").stdout


def test_consistency_package_has_the_library_of_the_program(thrust, tmp_path):
    (tmp_path / "scene.toml").write_text(thrust.source)
    program("fmu", tmp_path / "scene.toml", "-o", tmp_path / "program.fmu", "--name", "thrust")
    ours = roulement.package(thrust, tmp_path / "python.fmu", name="thrust")
    assert ours.read_bytes() == (tmp_path / "program.fmu").read_bytes()
